"""Checkers of a drive: whether the goal is reached, and whether the robot gets on."""

from __future__ import annotations

import math
from dataclasses import dataclass

from robolink.counterparts.nav2_util.options import plugin_of, read_options
from robolink.geometry.plane import Pose, Speeds
from robolink.node import Node

WORDS = {
    "xy_goal_tolerance": "distance to the goal in metres that is near enough",
    "yaw_goal_tolerance": "turn to the goal's heading in radians that is small enough",
    "stateful": "a place that was reached once stays reached, while the robot turns",
    "symmetric_yaw_tolerance": "the opposite heading will do, too",
    "trans_stopped_velocity": "speed in m/s at which the robot counts as standing",
    "rot_stopped_velocity": "turning speed in rad/s at which the robot counts as standing",
    "required_movement_radius": "metres from a place to which the robot has to get in time",
    "required_movement_angle": "turn in radians that will do instead",
    "movement_time_allowance": "seconds that it has for this",
}


@dataclass(frozen=True)
class GoalOptions:
    """Parameters of SimpleGoalChecker."""

    xy_goal_tolerance: float = 0.25
    yaw_goal_tolerance: float = 0.25
    stateful: bool = True
    symmetric_yaw_tolerance: bool = False


@dataclass(frozen=True)
class StoppedOptions(GoalOptions):
    """Parameters of StoppedGoalChecker."""

    trans_stopped_velocity: float = 0.25
    rot_stopped_velocity: float = 0.25


@dataclass(frozen=True)
class PositionOptions:
    """Parameters of PositionGoalChecker."""

    xy_goal_tolerance: float = 0.25
    stateful: bool = True


class GoalChecker:
    """Checker of the goal: place, heading, and speed, as far as its options have them."""

    def __init__(self, options: GoalOptions | PositionOptions) -> None:
        self.options = options
        self.reset()

    @property
    def tolerance(self) -> float:
        """Distance in metres that is near enough."""
        return self.options.xy_goal_tolerance

    def reset(self) -> None:
        """Forget that the place was reached."""
        self.is_there = False

    def is_reached(self, pose: Pose, goal: Pose, speed: Speeds) -> bool:
        """Return whether the goal is reached; poses are in one frame."""
        options = self.options
        if not (self.is_there and options.stateful):
            self.is_there = math.hypot(pose.x - goal.x, pose.y - goal.y) <= options.xy_goal_tolerance
        if not self.is_there or isinstance(options, PositionOptions):
            return self.is_there
        turn = abs(math.remainder(pose.theta - goal.theta, math.tau))
        turn = min(turn, math.pi - turn) if options.symmetric_yaw_tolerance else turn
        if turn > options.yaw_goal_tolerance:
            return False
        if not isinstance(options, StoppedOptions):
            return True
        return abs(speed.v) <= options.trans_stopped_velocity and abs(speed.w) <= options.rot_stopped_velocity


@dataclass(frozen=True)
class ProgressOptions:
    """Parameters of SimpleProgressChecker."""

    required_movement_radius: float = 0.5
    movement_time_allowance: float = 10.0


@dataclass(frozen=True)
class PoseProgressOptions(ProgressOptions):
    """Parameters of PoseProgressChecker."""

    required_movement_angle: float = 0.5


class ProgressChecker:
    """Checker of progress: the robot moves, or turns, in the time that it has for this."""

    def __init__(self, options: ProgressOptions) -> None:
        self.options = options
        self.reset()

    def reset(self) -> None:
        """Begin anew where the robot is next."""
        self._base: Pose | None = None
        self._since = 0.0

    def gets_on(self, pose: Pose, time: float) -> bool:
        """Return False once the robot has not moved in time; `time` is in seconds."""
        if self._base is None or self._has_moved(self._base, pose) or time < self._since:
            self._base, self._since = pose, time
        return time - self._since <= self.options.movement_time_allowance

    def _has_moved(self, base: Pose, pose: Pose) -> bool:
        if math.hypot(pose.x - base.x, pose.y - base.y) > self.options.required_movement_radius:
            return True
        if not isinstance(self.options, PoseProgressOptions):
            return False
        return abs(math.remainder(pose.theta - base.theta, math.tau)) > self.options.required_movement_angle


GOAL_CHECKERS: dict[str, type[GoalOptions] | type[PositionOptions]] = {
    "nav2_controller::SimpleGoalChecker": GoalOptions,
    "nav2_controller::StoppedGoalChecker": StoppedOptions,
    "nav2_controller::PositionGoalChecker": PositionOptions,
}
PROGRESS_CHECKERS: dict[str, type[ProgressOptions]] = {
    "nav2_controller::SimpleProgressChecker": ProgressOptions,
    "nav2_controller::PoseProgressChecker": PoseProgressOptions,
}


def goal_checker(node: Node, name: str) -> GoalChecker:
    """Return the goal checker that a node's parameters describe. Raises PluginError for one that is not here."""
    plugin = plugin_of(node, name, "nav2_controller::SimpleGoalChecker", GOAL_CHECKERS)
    return GoalChecker(read_options(node, name, GOAL_CHECKERS[plugin], WORDS))


def progress_checker(node: Node, name: str) -> ProgressChecker:
    """Return the progress checker that a node's parameters describe. Raises PluginError for one that is not here."""
    plugin = plugin_of(node, name, "nav2_controller::SimpleProgressChecker", PROGRESS_CHECKERS)
    return ProgressChecker(read_options(node, name, PROGRESS_CHECKERS[plugin], WORDS))
