"""Drive a perfect square by odometry alone, and end where it began.

robolink run square -p side:=1.5 -p direction:=right
"""

import contextlib
import math
import sys
from collections.abc import Iterator
from typing import Any, NamedTuple

import robolink
from robolink import Future, Node, Parameter
from robolink.exceptions import ExternalShutdownException, RobolinkError
from robolink.geometry.plane import Pose, Speeds, clipped, is_finite, placed_on, pose_of, seen_from
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.parameters.descriptors import described

SETTLING = 4.0
"""Rate of approach at the very end of a leg, in 1/s, since no command takes effect at once."""

K_ASIDE, K_HEADING = 3.0, 4.0
"""Gains of the distance from the line (1/m) and of the heading (1/s) with which it returns to its line."""

MOST_ASIDE = 0.5
"""Largest angle at which it returns to its line, in radians."""

ENOUGH = 0.001
"""Tolerance of the end of a leg, in metres or radians."""

STUCK = 10.0
"""Time without progress after which it gives up, in seconds."""


class Way(NamedTuple):
    """A part of the square, which ends at `goal`: a straight side, or a turn on the spot."""

    goal: Pose
    is_turn: bool


class Left(NamedTuple):
    """Remaining way to a goal, seen along the goal's heading: metres ahead and to the left, and radians."""

    ahead: float
    aside: float
    turn: float


class Limits(NamedTuple):
    """Limits of the robot, in m/s, m/s², rad/s and rad/s²."""

    speed: float = 0.3
    acceleration: float = 0.5
    turn_speed: float = 1.0
    turn_acceleration: float = 2.0


class Square(Node):
    """A node that drives one leg after the other, a command for each odometry message; `done` has the exit code.

    `side` and `direction` are those of the next square, when they change on the way; all else counts at once.
    """

    speeds = Speeds()

    def __init__(self, **options: Any) -> None:
        super().__init__("square", **options)
        self.add_on_set_parameters_callback(check_direction)
        self.declare_parameter("side", 1.0, described("metres; of the next square, where it drives several", 0.05, 1e3))
        self.declare_parameter("turns", 1, described("how often it goes round before it ends", 1, 1000))
        direction = described("to which side it turns: left or right, from the next square on")
        direction.additional_constraints = "left or right"
        self.declare_parameter("direction", "left", direction)
        usual = Limits()
        self.declare_parameter("speed", usual.speed, described("m/s along a side", 0.01, 10.0))
        self.declare_parameter("acceleration", usual.acceleration, described("m/s², and to brake", 0.01, 10.0))
        self.declare_parameter("turn_speed", usual.turn_speed, described("rad/s at a corner", 0.05, 20.0))
        self.declare_parameter("turn_acceleration", usual.turn_acceleration, described("rad/s²", 0.05, 100.0))
        self.done: Future[int] = Future()
        self.start: Pose | None = None
        self.ways, self.squares = list[Way](), 0
        """The remaining legs of this square, and the number of squares done before."""
        self.stamp = 0
        self.least_left, self.nearer_at = math.inf, 0
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10)
        self.create_timer(5.0, self.on_timer)

    def on_odom(self, odometry: Odometry) -> None:
        """Send the next command."""
        pose, stamp = pose_of(odometry.pose.pose), odometry.header.stamp
        now = stamp.sec * 10**9 + stamp.nanosec
        if self.done.done() or not is_finite(pose):
            return
        if self.start is None:
            self.start, self.stamp, self.nearer_at = pose, now, now
            self.begin_square(pose)
        dt, self.stamp = min(max((now - self.stamp) / 1e9, 0.0), 0.2), now
        left = left_to(self.ways[0].goal, pose)
        if has_ended(self.ways[0], left, self.speeds):
            self.begin_next(pose)
            return
        self.give_up_if_stuck(pose, left, now)
        if not self.done.done():
            limits = Limits(*(self.get_parameter(name).value for name in Limits._fields))
            self.drive(decide(self.ways[0], left, self.speeds, limits, dt))

    def begin_square(self, start: Pose) -> None:
        """Plan the legs of a square with the present parameters."""
        side, to_left = self.get_parameter("side").value, self.get_parameter("direction").value == "left"
        self.ways = list(square(start, side, 1 if to_left else -1))
        turns = self.get_parameter("turns").value
        number = f", {self.squares + 1} of {turns}" if turns > 1 else ""
        self.get_logger().info(f"driving a square with sides of {side:g} m{number}")

    def drive(self, speeds: Speeds) -> None:
        """Publish a velocity command."""
        self.speeds = speeds
        self.cmd_vel.publish(Twist(linear=Vector3(x=speeds.v), angular=Vector3(z=speeds.w)))

    def begin_next(self, pose: Pose) -> None:
        """Stop at the end of a leg; after the last one the square is done."""
        self.drive(Speeds())
        ended = self.ways.pop(0)
        self.least_left, self.nearer_at = math.inf, self.stamp
        if not ended.is_turn:
            self.get_logger().info(f"at a corner: ({pose.x:.3f}, {pose.y:.3f})")
        if not self.ways:
            self.end_square(pose)

    def end_square(self, pose: Pose) -> None:
        """Drive the next square from where the first one began, or be done."""
        assert self.start is not None
        self.squares += 1
        off = math.dist(pose[:2], self.start[:2])
        self.get_logger().info(f"square done, {100 * off:.1f} cm from the start")
        if self.squares < self.get_parameter("turns").value:
            self.begin_square(self.start)
        else:
            self.done.set_result(0)

    def give_up_if_stuck(self, pose: Pose, left: Left, now: int) -> None:
        """Fail if there has been no progress for `STUCK` seconds: something is in the way."""
        remaining = abs(left.turn) if self.ways[0].is_turn else abs(left.ahead)
        if remaining < self.least_left - ENOUGH / 10:
            self.least_left, self.nearer_at = remaining, now
        elif now - self.nearer_at > STUCK * 1e9:
            self.drive(Speeds())
            words = f"gave up at ({pose.x:.2f}, {pose.y:.2f}): no nearer to the corner for {STUCK:g} s"
            self.get_logger().error(f"{words}; is something in the way?")
            self.done.set_result(1)

    def on_timer(self) -> None:
        """Warn while there is no odometry."""
        if self.start is None:
            topic = self.resolve_topic_name("odom")
            self.get_logger().warning(f"no odometry so far on {topic}: is a robot, or robolink run world, there?")

    def destroy_node(self) -> None:
        """Stop the robot if the context still runs, then destroy the node."""
        if self.speeds != Speeds():
            with contextlib.suppress(RobolinkError):
                self.drive(Speeds())
        super().destroy_node()


def check_direction(changed: list[Parameter[Any]]) -> SetParametersResult:
    """Reject an unknown direction."""
    for each in changed:
        if each.name == "direction" and each.value not in ("left", "right"):
            reason = f"direction: expected 'left' or 'right', got {each.value!r}"
            return SetParametersResult(successful=False, reason=reason)
    return SetParametersResult(successful=True)


def square(start: Pose, side: float, to_left: int) -> Iterator[Way]:
    """Yield the sides and turns of a square that begins and ends at `start`; `to_left` is 1, or -1 to the right.

    All goals are computed from the start and not from where the robot came to, so that errors do not add up.
    """
    here, quarter = start, to_left * math.pi / 2
    for _ in range(4):
        here = placed_on(here, Pose(x=side))
        yield Way(here, is_turn=False)
        here = placed_on(here, Pose(theta=quarter))
        yield Way(here, is_turn=True)


def left_to(goal: Pose, pose: Pose) -> Left:
    """Return the remaining way from a pose to a goal."""
    beyond = seen_from(goal, pose)
    return Left(-beyond.x, -beyond.y, -beyond.theta)


def has_ended(way: Way, left: Left, speeds: Speeds) -> bool:
    """True if the robot is at the end of a leg and nearly stands."""
    remaining, speed = (left.turn, speeds.w) if way.is_turn else (left.ahead, speeds.v)
    return abs(remaining) < ENOUGH and abs(speed) <= 2 * SETTLING * ENOUGH


def decide(way: Way, left: Left, speeds: Speeds, limits: Limits, dt: float) -> Speeds:
    """Return the speeds `dt` seconds after `speeds`: along a side, kept on its line, or round a corner."""
    if way.is_turn:
        return Speeds(0.0, eased(left.turn, speeds.w, limits.turn_speed, limits.turn_acceleration, dt))
    v = eased(left.ahead, speeds.v, limits.speed, limits.acceleration, dt)
    to_line = clipped(K_ASIDE * left.aside, MOST_ASIDE)
    w = K_HEADING * (left.turn + (to_line if v >= 0.0 else -to_line))
    return Speeds(v, clipped(w, limits.turn_speed))


def eased(left: float, speed: float, most: float, acceleration: float, dt: float) -> float:
    """Return the next speed when `left` is left to go: a trapezoidal velocity profile.

    It rises by the acceleration up to `most`, and falls in time to be 0 at the end; `left` may be negative.
    """
    distance = abs(left)
    braking = min(math.sqrt(2.0 * acceleration * distance), SETTLING * distance)
    rising = math.copysign(1.0, left) * speed + acceleration * dt
    return math.copysign(max(0.0, min(most, braking, rising)), left)


def main(args: list[str] | None = None) -> int:
    """Drive the square; return the exit code: 0 if it is done, or ended by Ctrl-C, and 1 if it gave up."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = Square()
        try:
            robolink.spin_until_future_complete(node, node.done)
        finally:
            node.destroy_node()
        return node.done.result() or 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
