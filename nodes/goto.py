"""Drive to a pose: a goal of the action navigate_to_pose, as Nav2 has it, or a message on the topic goal_pose.

robolink action send_goal /navigate_to_pose nav2_msgs/action/NavigateToPose \
    '{pose: {pose: {position: {x: 2, y: 1}}}}' --feedback
"""

import contextlib
import math
from typing import Any

import robolink
from robolink import Duration, Future, Node, Time
from robolink.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from robolink.action.server import ServerGoalHandle
from robolink.control.approach import SETTLED, TURN_FIRST, Left, Limits, decide, has_arrived, is_reached, left_to
from robolink.control.laser import lane_ahead, points, returns
from robolink.exceptions import ExternalShutdownException, RobolinkError
from robolink.extensions.optional import DETOURS, is_here, part
from robolink.geometry.plane import Pose, Speeds, pose_of, wrapped
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMessage
from robolink.interfaces.geometry_msgs.msg import Pose as PoseMessage
from robolink.interfaces.geometry_msgs.msg import PoseStamped, Twist, Vector3
from robolink.interfaces.nav2_msgs.action import FollowPath, NavigateToPose
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.parameters.descriptors import described
from robolink.tf2 import Buffer, TransformException, TransformListener
from robolink.tf2.geometry import do_transform_pose

ACTION = "navigate_to_pose"

Codes = FollowPath.Result
"""Nav2's error codes."""

FEEDBACK_PERIOD, STALE_SCAN, LONGEST_STEP = 0.2, 1.0, 0.2
"""Period of feedback, greatest age of a scan, and longest time of one change of speed, in seconds."""

MARGIN = 0.03
"""Metres beside the lane that a way round an obstacle leaves."""

FARTHEST = 1e6
"""Largest coordinate of a goal, in metres: a place farther away is a mistake."""

PARAMETERS = {
    "speed": ("m/s at most", 0.01, 10.0),
    "acceleration": ("m/s², and to brake", 0.05, 20.0),
    "turn_speed": ("rad/s at most", 0.05, 20.0),
    "turn_acceleration": ("rad/s²", 0.1, 100.0),
    "swing": ("metres by which it may leave the straight line to arrive with the right heading", 0.0, 10.0),
    "position_tolerance": ("metres from the goal that are near enough", 0.005, 10.0),
    "heading_tolerance": ("radians off the goal's heading that are near enough", 0.01, 3.15),
}


class Trip:
    """A goal that is being driven to; `result` is the future of the action's result."""

    def __init__(self, handle: ServerGoalHandle, now: Time) -> None:
        self.handle, self.goal, self.started = handle, handle.request.pose, now
        self.result: Future[NavigateToPose.Result] = Future()
        self.arrived = False
        """True once it has reached the position, and only turns."""
        self.checkpoint: Pose | None = None
        self.moved_at = self.reported_at = now

    def note_movement(self, pose: Pose, now: Time) -> None:
        """Note progress, if the robot has moved since the last time."""
        last = self.checkpoint
        if last is None or math.dist(pose[:2], last[:2]) > 0.05 or abs(wrapped(pose.theta - last.theta)) > 0.1:
            self.checkpoint, self.moved_at = pose, now


class Goto(Node):
    """Action server that drives to one goal at a time, by odometry; a new goal replaces the one before.

    The robot must be able to turn on the spot. Goals are in the frame of odometry, or in one that /tf connects with it;
    a goal in a frame of the robot is fixed where that frame is at the start. With a scanner it drives round what stands
    in its way, and waits for what leaves no way; it has no map.
    """

    trip: Trip | None = None

    def __init__(self, **options: Any) -> None:
        super().__init__("goto", **options)
        for name, (words, low, high) in PARAMETERS.items():
            self.declare_parameter(name, Limits._field_defaults[name], described(words, low, high))
        self.declare_parameter("detours", True, described("drive round what the scanner sees"))
        self.declare_parameter("obstacle_stop", True, described("wait for what is in the lane ahead"))
        self.declare_parameter("stop_distance", 0.35, described("metres before the scanner", 0.0, 10.0))
        self.declare_parameter("half_width", 0.22, described("metres, of the lane", 0.01, 10.0))
        self.declare_parameter("progress_timeout", 10.0, described("seconds to give up after", 0.5, 3600.0))
        self.declare_parameter("odom_timeout", 1.0, described("seconds without odometry to give up after", 0.1, 60.0))
        self.here, self.base = PoseStamped(), "base_link"
        self.odom_at = self.get_clock().now()
        self.speeds, self.free = Speeds(), math.inf
        self.scan_at: Time | None = None
        self.detours = self.made_detours()
        self.aim: Pose | None = None
        """Place on the way round an obstacle, in the frame of odometry; None to drive straight to the goal."""
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)
        self.server = ActionServer(self, NavigateToPose, ACTION, self.on_execute, goal_callback=self.on_goal)
        self.server.register_cancel_callback(lambda _: CancelResponse.ACCEPT)
        self.goals = ActionClient(self, NavigateToPose, ACTION)
        self.create_subscription(PoseStamped, "goal_pose", self.on_goal_pose, 10)
        self.create_timer(0.1, self.on_timer)

    # Goals

    def on_goal_pose(self, pose: PoseStamped) -> None:
        """Send a goal from RViz's topic to the action."""
        self.goals.send_goal_async(NavigateToPose.Goal(pose=pose))

    def on_goal(self, goal: NavigateToPose.Goal) -> GoalResponse:
        """Reject a goal that cannot be reached."""
        reason = fault(goal.pose.pose)
        try:
            self.in_odom(goal.pose)
        except TransformException as error:
            reason = reason or f"its frame '{goal.pose.header.frame_id}' is not known here: {error}"
        if reason:
            self.get_logger().warning(f"refused a goal: {reason}")
        return GoalResponse.REJECT if reason else GoalResponse.ACCEPT

    async def on_execute(self, handle: ServerGoalHandle) -> NavigateToPose.Result | None:
        """Start driving to a goal, in place of another; `on_odom` does the rest."""
        if self.trip is not None:
            self.end("replaced by another goal")
        now = self.get_clock().now()
        trip = self.trip = Trip(handle, now)
        self.odom_at = now  # the timeout begins here
        place = trip.goal.pose.position
        self.get_logger().info(f"driving to ({place.x:.2f}, {place.y:.2f})")
        return await trip.result

    def end(self, words: str = "", code: int = Codes.NONE, *, succeeded: bool = False) -> None:
        """End the trip with a result."""
        trip, self.trip = self.trip, None
        assert trip is not None
        if succeeded:
            trip.handle.succeed()
        elif trip.handle.is_cancel_requested:
            trip.handle.canceled()
        else:
            trip.handle.abort()
        trip.result.set_result(NavigateToPose.Result(error_code=code, error_msg=words))

    def give_up(self, words: str, code: int) -> None:
        """Stop before the goal, and log the reason."""
        self.command(Speeds())
        self.get_logger().error(f"gave up: {words}")
        self.end(words, code)

    def destroy_node(self) -> None:
        """Stop the robot and abort its goal if the context still runs, then destroy the node."""
        if self.trip is not None:
            with contextlib.suppress(RobolinkError):
                self.command(Speeds())
                self.end("the node has ended", Codes.UNKNOWN)
        super().destroy_node()

    def in_odom(self, goal: PoseStamped) -> Pose:
        """Return the pose of a goal in the frame of odometry, as far as is known now. Raises TransformException."""
        frame, odom = self.frames(goal)
        if frame in ("", "odom", odom):
            return pose_of(goal.pose)
        return pose_of(do_transform_pose(goal.pose, self.buffer.lookup_transform(odom, frame, Time())))

    def at_rest(self, goal: PoseStamped) -> PoseStamped:
        """Return a goal in one of the robot's own frames, which would move with it, in the frame of odometry."""
        frame, odom = self.frames(goal)
        if frame in ("", "odom", odom) or self.base not in self.buffer._chain(odom, Time(), frame, Time(), odom):
            return goal
        pose = do_transform_pose(goal.pose, self.buffer.lookup_transform(odom, frame, Time()))
        return PoseStamped(header=self.here.header, pose=pose)

    def frames(self, goal: PoseStamped) -> tuple[str, str]:
        """Return the names of a goal's frame and of odometry's."""
        return goal.header.frame_id.removeprefix("/"), self.here.header.frame_id.removeprefix("/") or "odom"

    # Driving

    def made_detours(self) -> Any:
        """Return the planner of ways round obstacles; None without one: then it drives straight."""
        if not is_here(DETOURS):
            self.get_logger().info("it drives straight: robolink.navigation, which plans, is not installed")
            return None
        return part(DETOURS, "navigation")(self.get_parameter("half_width").value + MARGIN)

    def on_scan(self, scan: LaserScan) -> None:
        """Measure the free length of the lane ahead, and look for a way round what is in it."""
        self.free = lane_ahead(*returns(scan), self.get_parameter("half_width").value)
        self.scan_at, self.aim = self.get_clock().now(), None
        avoids = self.get_parameter("obstacle_stop").value and self.get_parameter("detours").value
        if self.detours is None or self.trip is None or fault(self.here.pose) or not avoids:
            return
        here = pose_of(self.here.pose)
        self.detours.see(here, *points(scan))
        with contextlib.suppress(TransformException):  # `on_odom` gives up then
            goal = self.in_odom(self.trip.goal)
            aim = self.detours.aim(here, goal)
            self.aim = None if aim == goal else aim

    def on_odom(self, odometry: Odometry) -> None:
        """Drive on towards the present place of the goal."""
        if fault(odometry.pose.pose):
            return  # after too many of them the odometry is stale
        pose = pose_of(odometry.pose.pose)
        dt = seconds(odometry.header.stamp) - seconds(self.here.header.stamp)
        self.here = PoseStamped(header=odometry.header, pose=odometry.pose.pose)
        self.base = odometry.child_frame_id.removeprefix("/") or self.base
        self.odom_at = self.get_clock().now()
        if self.trip is None:
            return
        try:
            self.trip.goal = self.at_rest(self.trip.goal)
            left = left_to(self.in_odom(self.trip.goal), pose)
        except TransformException as error:
            self.give_up(f"the goal's frame is lost: {error}", Codes.TF_ERROR)
        else:
            self.trip.note_movement(pose, self.odom_at)
            self.drive(self.trip, left, min(max(dt, 0.0), LONGEST_STEP))

    def drive(self, trip: Trip, left: Left, dt: float) -> None:
        """Send the next command, or end the trip: its goal is reached, cancelled or out of reach."""
        limits = Limits(*(self.get_parameter(name).value for name in Limits._fields))
        trip.arrived = has_arrived(left, limits, trip.arrived)
        aimed = left if self.aim is None or trip.arrived else left_to(self.aim, pose_of(self.here.pose))
        room = math.inf if trip.arrived else self.room(aimed)
        still = (self.odom_at - trip.moved_at).nanoseconds / 1e9
        is_stuck = still > self.get_parameter("progress_timeout").value
        if trip.handle.is_cancel_requested:
            self.command(Speeds())
            self.get_logger().info("cancelled")
            self.end("cancelled")
        elif (trip.arrived and is_reached(left, limits, SETTLED)) or (is_stuck and is_reached(left, limits)):
            self.command(Speeds())
            self.get_logger().info(f"reached the goal, {100 * left.distance:.1f} cm off")
            self.end(succeeded=True)
        elif is_stuck:
            reason = "something is in the way" if room <= 0.0 else "the robot does not move"
            self.give_up(f"no progress {left.distance:.2f} m from the goal: {reason}", Codes.FAILED_TO_MAKE_PROGRESS)
        else:
            self.command(decide(aimed, self.speeds, limits, room, trip.arrived, dt))
            self.tell(trip, left, limits)

    def room(self, left: Left) -> float:
        """Return the metres that it may drive ahead before it must stop; obstacles beyond the goal do not count."""
        if not self.get_parameter("obstacle_stop").value or self.scan_at is None:
            return math.inf
        if (self.odom_at - self.scan_at).nanoseconds > STALE_SCAN * 1e9:
            self.get_logger().warning("waiting: no scan has come for a second", throttle_duration_sec=2.0)
            return 0.0
        if self.free > left.distance + self.get_parameter("half_width").value:
            return math.inf
        room = self.free - float(self.get_parameter("stop_distance").value)
        if room <= 0.0 and abs(left.bearing) < TURN_FIRST:
            self.get_logger().warning(f"waiting: something is {self.free:.2f} m ahead", throttle_duration_sec=2.0)
        return max(0.0, room)

    def command(self, speeds: Speeds) -> None:
        """Publish a velocity command."""
        self.speeds = speeds
        self.cmd_vel.publish(Twist(linear=Vector3(x=speeds.v), angular=Vector3(z=speeds.w)))

    def tell(self, trip: Trip, left: Left, limits: Limits) -> None:
        """Publish feedback, once every `FEEDBACK_PERIOD`."""
        now = self.odom_at
        if (now - trip.reported_at).nanoseconds < FEEDBACK_PERIOD * 1e9:
            return
        trip.reported_at = now
        remaining = left.distance / limits.speed + abs(left.turn) / limits.turn_speed
        feedback = NavigateToPose.Feedback(
            current_pose=self.here,
            navigation_time=(now - trip.started).to_msg(),
            estimated_time_remaining=Duration(seconds=remaining).to_msg(),
            distance_remaining=left.distance,
        )
        trip.handle.publish_feedback(feedback)

    def on_timer(self) -> None:
        """Abort the trip if odometry fails: the robot's pose is unknown then."""
        silent = (self.get_clock().now() - self.odom_at).nanoseconds / 1e9
        if self.trip is not None and silent > self.get_parameter("odom_timeout").value:
            self.give_up(f"no odometry on {self.resolve_topic_name('odom')} for {silent:.1f} s", Codes.TF_ERROR)


def fault(pose: PoseMessage) -> str:
    """Return the mistake of a pose; '' if a robot can be there."""
    place, turn = pose.position, pose.orientation
    numbers = (place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w)
    if not all(abs(each) <= FARTHEST for each in numbers):
        given = ", ".join(f"{each:g}" for each in numbers)
        return f"expected finite numbers, and places within {FARTHEST:g} m, got x, y, z and a quaternion of {given}"
    if math.hypot(*numbers[3:]) < 1e-3:
        return "its orientation is all zero, which is not a quaternion: w is 1 for no rotation"
    return ""


def seconds(stamp: TimeMessage) -> float:
    """Return a stamp in seconds."""
    return float(stamp.sec + stamp.nanosec * 1e-9)


def main(args: list[str] | None = None) -> None:
    """Run the node until Ctrl-C, then stop the robot."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = Goto()
        try:
            robolink.spin(node)
        finally:
            node.destroy_node()


if __name__ == "__main__":
    main()
