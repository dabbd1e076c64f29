"""Patrol: drive from waypoint to waypoint, round and round, through the action navigate_to_pose.

robolink run patrol -p waypoints:='1,1 5,1 5,5,1.57 1,5'
"""

import contextlib
import math
from typing import Any, NamedTuple

import robolink
from robolink import Future, Node, Parameter, RobolinkError
from robolink.action import ActionClient
from robolink.action.client import ClientGoalHandle, GoalStatus
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.nav2_msgs.action import NavigateToPose
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from robolink.parameters.descriptors import described

WAYPOINTS = "1,1 5,1 5,5 1,5"

POLL = 0.1
"""Polling period in seconds, to see if the server that is to answer is still there."""

AFTER_FAILURE = 1.0
"""Shortest wait in seconds after a waypoint that was not reached: a server that refuses all must not be flooded."""


class WaypointsError(RobolinkError, ValueError):
    """A text or a list that is not a list of waypoints."""


class Waypoint(NamedTuple):
    """A position in metres, and the heading to have there in radians."""

    x: float
    y: float
    theta: float

    def __str__(self) -> str:
        return f"({self.x:.2f}, {self.y:.2f})"


def parse_waypoints(given: Any) -> list[Waypoint]:
    """Read waypoints: a text such as `1,1 5,1,1.57`, the heading being optional, or a flat list of x, y, theta.

    Where no heading is given the robot looks on to the next waypoint. Raises WaypointsError.
    """
    rows = _rows_of_text(given) if isinstance(given, str) else _rows_of_list(given)
    if not rows:
        raise WaypointsError("there must be one waypoint at least, such as 1,1")
    if not all(math.isfinite(number) for row in rows for number in row):
        raise WaypointsError("waypoints are finite numbers: metres, and radians")
    following = [*rows[1:], rows[0]]
    return [_waypoint(*each) for each in zip(rows, following, strict=True)]


def _rows_of_text(text: str) -> list[list[float]]:
    rows = []
    for word in text.split():
        try:
            rows.append([float(number) for number in word.split(",")])
        except ValueError:
            raise WaypointsError(f"'{word}': expected x,y or x,y,theta") from None
        if len(rows[-1]) not in (2, 3):
            raise WaypointsError(f"'{word}': expected x,y or x,y,theta")
    return rows


def _rows_of_list(numbers: Any) -> list[list[float]]:
    try:
        flat = [float(number) for number in numbers]
    except (TypeError, ValueError):
        raise WaypointsError(f"expected a text or a list of numbers, got {numbers!r:.80}") from None
    if len(flat) % 3:
        raise WaypointsError(f"a list has x, y and theta of each waypoint, but {len(flat)} numbers are not such threes")
    return [flat[at : at + 3] for at in range(0, len(flat), 3)]


def _waypoint(row: list[float], following: list[float]) -> Waypoint:
    x, y = row[:2]
    return Waypoint(x, y, row[2] if len(row) == 3 else math.atan2(following[1] - y, following[0] - x))


class Patrol(Node):
    """Action client that sends one goal after the other, waits at each, and goes on after a failure; `done` ends it.

    A server that is not there, or ends on the way, is waited for; then the same waypoint is the goal again.
    """

    trip: ClientGoalHandle | None = None
    """The goal that the robot is on its way to."""

    def __init__(self, **options: Any) -> None:
        super().__init__("patrol", **options)
        self.add_on_set_parameters_callback(check_waypoints)
        words = "a text such as '1,1 5,1,1.57', or a flat list of x, y, theta"
        self.declare_parameter("waypoints", WAYPOINTS, ParameterDescriptor(description=words, dynamic_typing=True))
        self.declare_parameter("frame_id", "", described("the frame of the waypoints; that of odometry if empty"))
        self.declare_parameter("loop", True, described("begin anew after the last"))
        self.declare_parameter("pause", 1.0, described("seconds to wait at each", 0.0, 3600.0))
        self.group = ReentrantCallbackGroup()
        """Reentrant, so that the patrol, which is one long callback, can wait for others."""
        self.client = ActionClient(self, NavigateToPose, "navigate_to_pose", callback_group=self.group)
        self.done: Future[None] = Future()
        self.begin = self.create_timer(0.0, self.patrol, callback_group=self.group)

    async def patrol(self) -> None:
        """Go from waypoint to waypoint: all that this node does."""
        self.begin.cancel()
        while True:
            waypoints = parse_waypoints(self.get_parameter("waypoints").value)
            reached = 0
            for number, waypoint in enumerate(waypoints, 1):
                self.get_logger().info(f"going to waypoint {number} of {len(waypoints)}: {waypoint}")
                reached += await self.go_to(waypoint)
            self.get_logger().info(f"{reached} of {len(waypoints)} waypoints reached")
            if not self.get_parameter("loop").value:
                self.done.set_result(None)
                return

    async def go_to(self, waypoint: Waypoint) -> bool:
        """Drive to a waypoint, again if the server is lost, and wait there; return True if it was reached."""
        answer = None
        while answer is None:
            await self.wait_for_server()
            answer = await self.send(waypoint)
        pause = float(self.get_parameter("pause").value)
        if answer == "":
            await self.sleep(pause)
        else:
            self.get_logger().warning(f"{waypoint} was not reached ({answer}): on to the next")
            await self.sleep(max(pause, AFTER_FAILURE))
        return answer == ""

    async def send(self, waypoint: Waypoint) -> str | None:
        """Send a goal and wait for its end: '' when it was reached, or why not; None if the server was lost."""
        handle = await self.answer(self.client.send_goal_async(self.goal(waypoint)))
        if handle is None or not handle.accepted:
            return None if handle is None else "the server refused it"
        self.trip = handle
        ended = await self.answer(handle.get_result_async())
        self.trip = None
        if ended is None or ended.status == GoalStatus.STATUS_UNKNOWN:
            self.get_logger().warning("the server was lost on the way")
            return None
        if ended.status == GoalStatus.STATUS_SUCCEEDED:
            return ""
        return ended.result.error_msg or ("cancelled" if ended.status == GoalStatus.STATUS_CANCELED else "aborted")

    async def answer(self, future: Future[Any]) -> Any:
        """Wait for a server's answer; None if the server goes away before."""
        while not future.done():
            if not self.client.server_is_ready():
                return None
            await self.sleep(POLL)
        return None if future.exception() else future.result()

    async def wait_for_server(self) -> None:
        """Wait for a server of the action."""
        while not self.client.server_is_ready():
            words = "waiting for a server of navigate_to_pose, such as robolink run goto"
            self.get_logger().warning(words, throttle_duration_sec=5.0)
            await self.sleep(POLL)

    async def sleep(self, seconds: float) -> None:
        """Let time pass, in which other callbacks run."""
        over: Future[None] = Future()

        def wake() -> None:
            timer.cancel()
            over.set_result(None)

        timer = self.create_timer(seconds, wake, callback_group=self.group)
        await over
        self.destroy_timer(timer)

    def goal(self, waypoint: Waypoint) -> NavigateToPose.Goal:
        """Make the goal of a waypoint."""
        goal = NavigateToPose.Goal()
        goal.pose.header.frame_id = self.get_parameter("frame_id").value
        goal.pose.header.stamp = self.get_clock().now().to_msg()
        place, turn = goal.pose.pose.position, goal.pose.pose.orientation
        place.x, place.y = waypoint.x, waypoint.y
        turn.z, turn.w = math.sin(waypoint.theta / 2), math.cos(waypoint.theta / 2)
        return goal

    def destroy_node(self) -> None:
        """Cancel the goal if the context still runs, so that the robot stops; then destroy the node."""
        trip, self.trip = self.trip, None
        if trip is not None:
            with contextlib.suppress(RobolinkError):
                trip.cancel_goal_async()
        super().destroy_node()


def check_waypoints(changed: list[Parameter[Any]]) -> SetParametersResult:
    """Refuse waypoints that cannot be read."""
    try:
        for each in changed:
            if each.name == "waypoints":
                parse_waypoints(each.value)
    except WaypointsError as error:
        return SetParametersResult(successful=False, reason=str(error))
    return SetParametersResult(successful=True)


def main(args: list[str] | None = None) -> None:
    """Patrol until the end or Ctrl-C, then stop the robot."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = Patrol()
        try:
            robolink.spin_until_future_complete(node, node.done)
        finally:
            node.destroy_node()


if __name__ == "__main__":
    main()
