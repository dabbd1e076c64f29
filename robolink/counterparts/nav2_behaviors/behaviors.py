"""Behaviours: turn on the spot, drive straight, back up, wait, drive by hand; each goes on by one step at a time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from robolink.counterparts.nav2_util.options import read_options
from robolink.duration import Duration
from robolink.geometry.plane import Pose, Speeds
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.nav2_msgs.action import AssistedTeleop as AssistedTeleopAction
from robolink.interfaces.nav2_msgs.action import BackUp as BackUpAction
from robolink.interfaces.nav2_msgs.action import DriveOnHeading as DriveOnHeadingAction
from robolink.interfaces.nav2_msgs.action import Spin as SpinAction
from robolink.interfaces.nav2_msgs.action import Wait as WaitAction
from robolink.interfaces.std_msgs.msg import Empty
from robolink.navigation.grid import Floats

if TYPE_CHECKING:
    from robolink.counterparts.nav2_behaviors.behavior_server import BehaviorServer


class BehaviorError(Exception):
    """A behaviour that has failed: `code` is one of its action's error codes."""

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text)
        self.code = code


class Behavior:
    """One behaviour of a server, `name` of which is its action's."""

    action: ClassVar[Any]
    """Class of the action."""
    drives: ClassVar[bool] = True
    """True if it moves the robot, which is stopped at its end."""

    def __init__(self, server: BehaviorServer, name: str) -> None:
        self.server, self.name = server, name
        self.started = 0.0
        self._end = math.inf

    def begin(self, goal: Any) -> None:
        """Take a goal. Raises BehaviorError."""
        self.started = self.server.seconds()
        allowed = _seconds(goal.time_allowance)
        self._end = self.started + allowed if allowed > 0.0 else math.inf

    def step(self) -> Any:
        """Go on by a step; return True at the end, otherwise the feedback. Raises BehaviorError."""
        raise NotImplementedError

    def destroy(self) -> None:
        """Withdraw what it subscribed to."""

    def _fail(self, code: int, text: str) -> None:
        raise BehaviorError(code, text)

    def _look_at_time(self) -> None:
        if self.server.seconds() > self._end:
            self._fail(
                self.action.Result.TIMEOUT,
                f"Exceeded time allowance before reaching the {self.name} goal - Exiting {self.name}",
            )

    def _pose(self) -> Pose:
        pose = self.server.pose()
        if isinstance(pose, str):
            raise BehaviorError(self.action.Result.TF_ERROR, f"Current robot pose is not available. {pose}")
        return pose

    def _look_ahead(self, poses: Floats) -> None:
        """Fail if the robot collides at one of some poses, of which the first is its own."""
        problem = self.server.collisions.problem()
        if problem or self.server.collisions.free(poses) < len(poses):
            self._fail(self.action.Result.COLLISION_AHEAD, f"Collision Ahead - Exiting {self.name}: {problem or 'yes'}")


class Spin(Behavior):
    """Turn on the spot by an angle."""

    action = SpinAction

    def begin(self, goal: Any) -> None:
        """Note where the robot looks."""
        super().begin(goal)
        if not math.isfinite(goal.target_yaw):
            self._fail(SpinAction.Result.UNKNOWN, f"expected a finite angle, got {goal.target_yaw:g}")
        self._last, self._turned, self._target = self._pose().theta, 0.0, float(goal.target_yaw)
        self.server.get_logger().info(f"Turning {goal.target_yaw:0.2f} for spin behavior.")

    def step(self) -> Any:
        """Turn on, slower towards the end."""
        self._look_at_time()
        pose, server = self._pose(), self.server
        self._turned += math.remainder(pose.theta - self._last, math.tau)
        self._last = pose.theta
        left = abs(self._target) - abs(self._turned)
        if left < 1e-6:
            return True
        speed = math.sqrt(2.0 * server.value("rotational_acc_lim") * left)
        speed = min(max(speed, server.value("min_rotational_vel")), server.value("max_rotational_vel"))
        turn = math.copysign(min(speed * server.value("simulate_ahead_time"), left), self._target)
        angles = pose.theta + np.linspace(0.0, turn, max(2, math.ceil(abs(turn) / 0.05)))
        self._look_ahead(np.stack((np.full(len(angles), pose.x), np.full(len(angles), pose.y), angles), axis=1))
        server.drive(0.0, math.copysign(speed, self._target))
        return SpinAction.Feedback(angular_distance_traveled=self._turned)


@dataclass(frozen=True)
class DriveOptions:
    """Parameters of a drive: m/s² and m/s."""

    acceleration_limit: float = 2.5
    deceleration_limit: float = -2.5
    minimum_speed: float = 0.1


WORDS = {
    "acceleration_limit": "greatest acceleration in m/s²",
    "deceleration_limit": "greatest braking in m/s², negative",
    "minimum_speed": "least speed in m/s",
}


class DriveOnHeading(Behavior):
    """Drive straight ahead over a distance."""

    action: ClassVar[Any] = DriveOnHeadingAction

    def __init__(self, server: BehaviorServer, name: str) -> None:
        super().__init__(server, name)
        self._options = read_options(server, name, DriveOptions, WORDS)
        self._speed = 0.0

    def begin(self, goal: Any) -> None:
        """Note where the robot is."""
        super().begin(goal)
        invalid = self.action.Result.INVALID_INPUT
        if goal.target.y or goal.target.z:
            self._fail(invalid, f"{self.name} in Y and Z is not supported: it moves in X only")
        if not (math.isfinite(goal.target.x) and math.isfinite(goal.speed)):
            self._fail(invalid, f"expected a finite distance and speed, got {goal.target.x:g}, {goal.speed:g}")
        self._take(goal.target.x, goal.speed)
        self._first, self._speed = self._pose(), 0.0

    def _take(self, distance: float, speed: float) -> None:
        if (distance > 0.0) != (speed > 0.0):
            self._fail(self.action.Result.INVALID_INPUT, "Speed and command sign did not match")
        self._distance, self._requested = distance, speed

    def step(self) -> Any:
        """Drive on, slower towards the end."""
        self._look_at_time()
        pose, options = self._pose(), self._options
        driven = math.hypot(pose.x - self._first.x, pose.y - self._first.y)
        left = abs(self._distance) - driven
        if left <= 0.0:
            return True
        period = 1.0 / self.server.value("cycle_frequency")
        most = abs(self._speed) + abs(options.acceleration_limit) * period
        speed = min(abs(self._requested), most, math.sqrt(2.0 * abs(options.deceleration_limit) * left))
        speed = math.copysign(max(speed, options.minimum_speed), self._distance)
        way = math.copysign(min(abs(speed) * self.server.value("simulate_ahead_time"), left), speed)
        ways = np.linspace(0.0, way, max(2, math.ceil(abs(way) / 0.02)))
        x, y = pose.x + ways * math.cos(pose.theta), pose.y + ways * math.sin(pose.theta)
        self._look_ahead(np.stack((x, y, np.full(len(ways), pose.theta)), axis=1))
        self._speed = speed
        self.server.drive(speed, 0.0)
        return self.action.Feedback(distance_traveled=driven)


class BackUp(DriveOnHeading):
    """Drive straight back over a distance, whatever the signs of distance and speed."""

    action: ClassVar[Any] = BackUpAction

    def _take(self, distance: float, speed: float) -> None:
        self._distance, self._requested = -abs(distance), -abs(speed)


class Wait(Behavior):
    """Stand still for a while."""

    action = WaitAction
    drives = False

    def begin(self, goal: Any) -> None:
        """Note when it ends."""
        self.started = self.server.seconds()
        self._end = self.started + _seconds(goal.time)

    def step(self) -> Any:
        """Look whether it is over."""
        left = self._end - self.server.seconds()
        return WaitAction.Feedback(time_left=Duration(seconds=left).to_msg()) if left > 0.0 else True


class AssistedTeleop(Behavior):
    """Drive by hand, slower where a collision is near."""

    action = AssistedTeleopAction

    def __init__(self, server: BehaviorServer, name: str) -> None:
        super().__init__(server, name)
        self._twist, self._is_over = Speeds(), False
        self._subscriptions: list[Any] = [
            server.create_subscription(Twist, server.value("cmd_vel_teleop"), self.on_twist, 10),
            server.create_subscription(Empty, "preempt_teleop", self.on_preempt, 10),
        ]

    def on_twist(self, twist: Twist) -> None:
        """Note the speeds that are requested; none that is not finite."""
        if math.isfinite(twist.linear.x) and math.isfinite(twist.angular.z):
            self._twist = Speeds(twist.linear.x, twist.angular.z)

    def on_preempt(self, _: Empty) -> None:
        """End it as reached."""
        self._is_over = True

    def begin(self, goal: Any) -> None:
        """Begin at a standstill."""
        super().begin(goal)
        self._twist, self._is_over = Speeds(), False

    def step(self) -> Any:
        """Drive as requested, scaled down by the share of the time ahead that is free."""
        self._look_at_time()
        if self._is_over:
            return True
        pose, server = self._pose(), self.server
        time, step = server.value("projection_time"), server.value("simulation_time_step")
        times = np.arange(0.0, time, step)
        theta = pose.theta + self._twist.w * times
        middle = theta - self._twist.w * step / 2
        x, y = pose.x + np.zeros(len(times)), pose.y + np.zeros(len(times))
        x[1:] += np.cumsum(self._twist.v * step * np.cos(middle[1:]))
        y[1:] += np.cumsum(self._twist.v * step * np.sin(middle[1:]))
        problem = server.collisions.problem()
        free = 0 if problem else server.collisions.free(np.stack((x, y, theta), axis=1))
        share = 1.0 if free == len(times) else 0.0 if free < 2 else free * step / time
        server.drive(self._twist.v * share, self._twist.w * share)
        spent = Duration(seconds=server.seconds() - self.started).to_msg()
        return AssistedTeleopAction.Feedback(current_teleop_duration=spent)

    def destroy(self) -> None:
        """Withdraw the subscriptions."""
        for each in self._subscriptions:
            self.server.destroy_subscription(each)
        self._subscriptions = []


def _seconds(duration: Any) -> float:
    return float(duration.sec + duration.nanosec * 1e-9)


PLUGINS: dict[str, type[Behavior]] = {
    "nav2_behaviors::Spin": Spin,
    "nav2_behaviors::BackUp": BackUp,
    "nav2_behaviors::DriveOnHeading": DriveOnHeading,
    "nav2_behaviors::Wait": Wait,
    "nav2_behaviors::AssistedTeleop": AssistedTeleop,
}
DEFAULTS = {
    "spin": "nav2_behaviors::Spin",
    "backup": "nav2_behaviors::BackUp",
    "drive_on_heading": "nav2_behaviors::DriveOnHeading",
    "wait": "nav2_behaviors::Wait",
}
"""Behaviours of a server whose parameters name none."""
