"""draw_square: has turtle1 draw a square, again and again."""

from __future__ import annotations

import math
from enum import Enum
from typing import Any, NamedTuple

from robolink import Node
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.counterparts.turtlesim.turtle import PERIOD, normalized
from robolink.counterparts.turtlesim.turtlesim_node import DEPTH
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_srvs.srv import Empty
from robolink.interfaces.turtlesim.msg import Pose
from robolink.task import Future

SIDE = 2.0
"""Length of a side, in metres."""
NEAR, ALIGNED, STILL = 0.1, 0.01, 0.0001
"""Tolerances of a goal, in metres and radians, and of standing still, in m/s and rad/s."""


class Phase(Enum):
    """Parts of a square: sides, turns, and the stops after them."""

    FORWARD = 1
    STOP_FORWARD = 2
    TURN = 3
    STOP_TURN = 4


SPEEDS = {
    Phase.FORWARD: (1.0, 0.0),
    Phase.STOP_FORWARD: (0.0, 0.0),
    Phase.TURN: (0.0, 0.4),
    Phase.STOP_TURN: (0.0, 0.0),
}
"""Speeds that are commanded, in m/s and rad/s."""


class Goal(NamedTuple):
    """Pose to reach, in metres and radians."""

    x: float
    y: float
    theta: float


class State(NamedTuple):
    """State of the drawing: the part, and where it ends."""

    phase: Phase
    goal: Goal


class DrawSquare(Node):
    """A node that drives turtle1 along squares, once it has seen its pose and turtlesim was reset."""

    def __init__(self, **options: Any) -> None:
        super().__init__("draw_square", **options)
        self.pose: Pose | None = None
        self.state: State | None = None
        self.cmd_vel = self.create_publisher(Twist, "turtle1/cmd_vel", DEPTH)
        self.reset = self.create_client(Empty, "reset")
        self.create_subscription(Pose, "turtle1/pose", self.on_pose, DEPTH)
        self.answer: Future[Any] | None = None
        steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=self.context.time)
        self.create_timer(PERIOD, self.on_timer, clock=steady)

    def on_pose(self, pose: Pose) -> None:
        """Note the newest pose, unless it is not finite."""
        if all(map(math.isfinite, (pose.x, pose.y, pose.theta))):
            self.pose = pose
        else:
            self.get_logger().warning("ignored a pose that is not finite", once=True)

    def on_timer(self) -> None:
        """Reset turtlesim first, then drive on."""
        if self.answer is None:
            if self.reset.service_is_ready():
                self.answer, self.pose = self.reset.call_async(Empty.Request()), None
        elif self.answer.done() and self.pose is not None:
            self.drive(self.pose)

    def drive(self, pose: Pose) -> None:
        """Command what comes next, or begin the next side or turn."""
        if self.state is None:
            self.begin(State(Phase.FORWARD, ahead_of(pose)))
        elif (after := advanced(self.state, pose)).goal != self.state.goal:
            self.get_logger().info("Reached goal")
            self.begin(after)
        else:
            self.state = after
            twist = Twist()
            twist.linear.x, twist.angular.z = SPEEDS[after.phase]
            self.cmd_vel.publish(twist)

    def begin(self, state: State) -> None:
        """Begin a side or a turn."""
        self.state, goal = state, state.goal
        self.get_logger().info(f"New goal [{goal.x:f} {goal.y:f}, {goal.theta:f}]")


def advanced(state: State, pose: Pose) -> State:
    """Return the next phase: the turtle stops where a side or a turn ends, and once it stands the next one begins."""
    phase, goal = state
    if phase is Phase.FORWARD:
        return State(Phase.STOP_FORWARD if is_reached(goal, pose) else phase, goal)
    if phase is Phase.TURN:
        return State(Phase.STOP_TURN if is_reached(goal, pose) else phase, goal)
    if abs(pose.linear_velocity) >= STILL or abs(pose.angular_velocity) >= STILL:
        return state
    if phase is Phase.STOP_FORWARD:
        return State(Phase.TURN, Goal(pose.x, pose.y, normalized(pose.theta + math.pi / 2)))
    return State(Phase.FORWARD, ahead_of(pose))


def ahead_of(pose: Pose) -> Goal:
    """Return the end of a side that begins at a pose."""
    return Goal(pose.x + SIDE * math.cos(pose.theta), pose.y + SIDE * math.sin(pose.theta), pose.theta)


def is_reached(goal: Goal, pose: Pose) -> bool:
    """True if a pose is near enough to a goal."""
    turned = math.remainder(pose.theta - goal.theta, math.tau)
    return abs(pose.x - goal.x) < NEAR and abs(pose.y - goal.y) < NEAR and abs(turned) < ALIGNED
