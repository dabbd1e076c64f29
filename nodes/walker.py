"""Walk like a humanoid, in steps of 0.3 m: a route from /start_walk to /stop_walk, or as cmd_vel asks.

robolink run walker -p route:='0x5 90x5 180x5 270x5' -p autostart:=true
"""

import contextlib
import math
from collections import deque
from typing import Any, NamedTuple

import robolink
from robolink import Node, Parameter, RobolinkError
from robolink.control.stop_lock import TOPIC, StopLock
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.geometry_msgs.msg import (
    Point,
    Pose,
    PoseStamped,
    Quaternion,
    Transform,
    TransformStamped,
    Twist,
    Vector3,
)
from robolink.interfaces.nav_msgs.msg import Path
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.std_msgs.msg import Header, Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.tf2 import TransformBroadcaster

STEP_LENGTH = 0.3

ROUTE = "0x10 90x5 0x5"
"""Ten steps ahead, five to the left, five ahead."""

FRAME, BASE = "odom", "walker"

STORED = 2000
"""Most positions kept on `walk_path` and in a walk's history; the oldest are dropped."""

MOST_STEPS = 1_000_000

COMMAND_LASTS = 1.0
"""Timeout of a cmd_vel, in seconds; never less than a step takes."""


class RouteError(RobolinkError, ValueError):
    """A text that is not a route."""


class Leg(NamedTuple):
    """A leg of a route: a number of steps in one direction, in degrees: 0 is ahead, 90 to the left."""

    direction: float
    steps: int


class Walk:
    """The position and history of a walker: metres in the plane, from its start.

    Directions are in degrees, seen as the walker stood in the beginning: 0 is ahead, 90 to the left::

        walk = Walk()
        walk.walk_straight(10)
        walk.turn_and_walk(90, 5)
        print(walk.position)
    """

    def __init__(self) -> None:
        self.position = (0.0, 0.0)
        self.heading = 0.0
        """Direction of the last step, in degrees."""
        self.steps = 0
        self.history = deque([self.position], maxlen=STORED)

    def take_step(self, direction: float, length: float = STEP_LENGTH) -> None:
        """Turn to a direction and take one step."""
        x, y = self.position
        angle = math.radians(direction)
        self.position = (x + length * math.cos(angle), y + length * math.sin(angle))
        self.heading = direction
        self.steps += 1
        self.history.append(self.position)

    def walk_straight(self, steps: int, length: float = STEP_LENGTH) -> None:
        """Take steps ahead."""
        self.turn_and_walk(0.0, steps, length)

    def turn_and_walk(self, direction: float, steps: int, length: float = STEP_LENGTH) -> None:
        """Turn to a direction and take steps."""
        for _ in range(steps):
            self.take_step(direction, length)

    def step_by_velocity(self, velocity: Twist, seconds: float, longest: float = STEP_LENGTH) -> None:
        """Take the step, ahead or to a side, that a velocity asks for in this time; the body turns as it asks.

        A step is as long as legs make it, `longest` metres at most; a velocity that only turns is a step on the spot.
        """
        vx, vy = velocity.linear.x, velocity.linear.y
        turned = math.remainder(velocity.angular.z, math.tau / seconds) * seconds  # degrees of the largest are infinite
        facing = self.heading + math.degrees(turned)
        aside = math.degrees(math.atan2(vy, vx))
        self.take_step(self.heading + aside, min(longest, math.hypot(vx, vy) * seconds))
        self.heading = math.remainder(facing, 360.0)

    def distance_from_start(self) -> float:
        """Return the straight distance from the start, in metres."""
        return math.hypot(*self.position)


def parse_route(text: str) -> list[Leg]:
    """Read a route: words such as `90x5` (five steps at 90 degrees) or `90` (one). Raises RouteError."""
    legs = [_parse_leg(word) for word in text.replace(",", " ").split()]
    if not legs:
        raise RouteError("a route needs at least one leg, such as 0x10: ten steps ahead")
    if (steps := sum(leg.steps for leg in legs)) > MOST_STEPS:
        raise RouteError(f"{steps} steps are more than {MOST_STEPS}")
    return legs


def _parse_leg(word: str) -> Leg:
    direction, _, count = word.partition("x")
    try:
        leg = Leg(float(direction), int(count) if "x" in word else 1)
    except ValueError:
        raise RouteError(f"'{word}': expected DIRECTIONxSTEPS, degrees and a number, such as 90x5") from None
    if not math.isfinite(leg.direction) or leg.steps < 1:
        raise RouteError(f"'{word}': expected a finite direction and at least one step")
    return leg


class Walker(Node):
    """A node that takes a step at each tick of its timer while it walks, and publishes its position.

    Who comes later gets the last `walk_pose`, `steps` and `walk_path` at once: they are latched.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("walker", **options)
        self.add_on_set_parameters_callback(check_route)
        self.declare_parameter("route", ROUTE, described("legs such as 90x5: degrees (0 ahead, 90 left) x steps"))
        self.declare_parameter("step_length", STEP_LENGTH, described("metres", 0.01, 2.0))
        duration = self.declare_parameter("step_duration", 0.5, described("seconds that a step takes", 0.01, 60.0))
        autostart = self.declare_parameter("autostart", False, described("walk the route at once", read_only=True))
        self.walk, self.ahead = Walk(), deque[float]()
        """`ahead` holds the directions of the steps that are still to be taken on the route."""
        self.velocity, self.velocity_until = Twist(), 0
        self.poses = deque[PoseStamped](maxlen=STORED)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.walk_pose = self.create_publisher(PoseStamped, "walk_pose", latched)
        self.steps = self.create_publisher(Int32, "steps", latched)
        self.walk_path = self.create_publisher(Path, "walk_path", latched)
        self.tf = TransformBroadcaster(self)
        start = self.create_service(Trigger, "start_walk", self.on_start)
        self.create_service(Trigger, "stop_walk", self.on_stop)
        self.create_subscription(Twist, "cmd_vel", self.on_cmd_vel, 10)
        self.timer = self.create_timer(duration.value, self.on_timer)
        self.add_post_set_parameters_callback(self.on_parameters)
        self.stop_lock = StopLock(self, self.on_stop_lock)
        self.publish()
        if autostart.value:
            self.start()
        else:
            self.get_logger().info(f"standing; robolink service call {start.service_name} has it walk")

    def on_start(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Begin the route, unless it is being walked."""
        response.success = not self.ahead
        response.message = self.start() if response.success else f"already walking: {self.to_go()} to go"
        return response

    def on_stop(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Stop after the present step; the rest of the route is given up."""
        walking = bool(self.ahead) or self.is_commanded()
        response.success = walking
        response.message = f"stopped with {self.to_go()} to go" if walking else "standing already"
        self.ahead.clear()
        self.velocity_until = 0
        return response

    def on_stop_lock(self, held: bool) -> None:
        """Stand while STOP holds; the rest of a route is walked when it is released."""
        self.velocity_until = 0
        self.timer.reset()
        if held:
            self.get_logger().warning(f"STOP holds ({TOPIC}): standing until it is released")
        else:
            self.get_logger().info(f"STOP is released ({TOPIC}): {self.to_go()} to go")

    def start(self) -> str:
        """Begin the route; return a message. The first step ends when it has had its time."""
        legs = parse_route(self.get_parameter("route").value)
        self.ahead = deque(leg.direction for leg in legs for _ in range(leg.steps))
        self.timer.reset()
        words = f"walking {self.get_parameter('route').value}: {self.to_go()}"
        self.get_logger().info(words)
        return words

    def to_go(self) -> str:
        """Return the number of remaining steps in words."""
        return f"{len(self.ahead)} step{'' if len(self.ahead) == 1 else 's'}"

    def on_cmd_vel(self, velocity: Twist) -> None:
        """Walk at a velocity while there is no route to walk."""
        if not all(map(math.isfinite, (velocity.linear.x, velocity.linear.y, velocity.angular.z))):
            self.get_logger().warning("ignored a cmd_vel that is not finite", once=True)
            return
        if self.stop_lock.held:
            return
        if self.ahead:
            self.get_logger().warning("cmd_vel is ignored on a route: stop_walk ends it", throttle_duration_sec=5.0)
            return
        lasts = max(COMMAND_LASTS, self.get_parameter("step_duration").value)
        self.velocity, self.velocity_until = velocity, self.get_clock().now().nanoseconds + round(lasts * 1e9)

    def is_commanded(self) -> bool:
        """True if a cmd_vel that is not too old asks for steps."""
        velocity = self.velocity
        asks = any((velocity.linear.x, velocity.linear.y, velocity.angular.z))
        return asks and self.get_clock().now().nanoseconds < self.velocity_until

    def on_timer(self) -> None:
        """Take the next step, if there is one to take and STOP does not hold."""
        if self.stop_lock.held:
            return
        length, duration = (self.get_parameter(name).value for name in ("step_length", "step_duration"))
        if self.ahead:
            self.walk.take_step(self.ahead.popleft(), length)
            self.say(is_last=not self.ahead)
        elif self.is_commanded():
            self.walk.step_by_velocity(self.velocity, duration, length)
        else:
            return
        self.publish()

    def say(self, *, is_last: bool) -> None:
        """Log the position and the number of steps."""
        x, y = (round(each, 2) + 0.0 for each in self.walk.position)  # never -0.00
        steps = self.walk.steps
        if is_last:
            words = f"at ({x:.2f}, {y:.2f}), {self.walk.distance_from_start():.2f} m from the start"
            self.get_logger().info(f"walked the route: {steps} steps so far, {words}")
        else:
            self.get_logger().info(f"step {steps}: at ({x:.2f}, {y:.2f})", throttle_duration_sec=1.0)

    def publish(self) -> None:
        """Publish the walker's pose and path."""
        header = Header(stamp=self.get_clock().now().to_msg(), frame_id=FRAME)
        pose = pose_of(self.walk)
        self.poses.append(PoseStamped(header=header, pose=pose))
        self.walk_pose.publish(self.poses[-1])
        self.walk_path.publish(Path(header=header, poses=list(self.poses)))
        self.steps.publish(Int32(data=self.walk.steps))
        there = Transform(translation=Vector3(x=pose.position.x, y=pose.position.y), rotation=pose.orientation)
        self.tf.sendTransform(TransformStamped(header=header, child_frame_id=BASE, transform=there))

    def on_parameters(self, changed: list[Parameter[Any]]) -> None:
        """Change the duration of a step."""
        for each in changed:
            if each.name == "step_duration":
                self.timer.timer_period_ns = round(each.value * 1e9)
                self.timer.reset()


def check_route(changed: list[Parameter[Any]]) -> SetParametersResult:
    """Reject a route that cannot be read."""
    try:
        for each in changed:
            if each.name == "route":
                parse_route(each.value)
    except RouteError as error:
        return SetParametersResult(successful=False, reason=str(error))
    return SetParametersResult(successful=True)


def pose_of(walk: Walk) -> Pose:
    """Return the position and heading of a walker as a Pose."""
    (x, y), half = walk.position, math.radians(walk.heading) / 2
    return Pose(position=Point(x=x, y=y), orientation=Quaternion(z=math.sin(half), w=math.cos(half)))


def main(args: list[str] | None = None) -> None:
    """Run the node until Ctrl-C."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        robolink.spin(Walker())


if __name__ == "__main__":
    main()
