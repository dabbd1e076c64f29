"""Goals of a navigator at Nav2's servers: their clients, their course until the end, and conversions."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from enum import Enum
from typing import Any, NamedTuple, Protocol

from robolink.action import ActionClient
from robolink.action.client import ClientGoalHandle
from robolink.client import Client
from robolink.duration import Duration
from robolink.exceptions import ROSInterruptException, ServiceError
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.builtin_interfaces.msg import Duration as DurationMsg
from robolink.interfaces.geometry_msgs.msg import Point, PoseStamped
from robolink.interfaces.nav2_msgs import action
from robolink.interfaces.nav_msgs.msg import Goals as GoalsMsg
from robolink.message import Action, Service
from robolink.node import Node
from robolink.spinning import spin_until_future_complete
from robolink.task import Future

ACTIONS: dict[type[Action], str] = {
    action.NavigateToPose: "navigate_to_pose",
    action.NavigateThroughPoses: "navigate_through_poses",
    action.FollowWaypoints: "follow_waypoints",
    action.FollowGPSWaypoints: "follow_gps_waypoints",
    action.FollowPath: "follow_path",
    action.ComputePathToPose: "compute_path_to_pose",
    action.ComputePathThroughPoses: "compute_path_through_poses",
    action.ComputeRoute: "compute_route",
    action.ComputeAndTrackRoute: "compute_and_track_route",
    action.SmoothPath: "smooth_path",
    action.Spin: "spin",
    action.BackUp: "backup",
    action.DriveOnHeading: "drive_on_heading",
    action.AssistedTeleop: "assisted_teleop",
    action.DockRobot: "dock_robot",
    action.UndockRobot: "undock_robot",
    action.FollowObject: "follow_object",
}
"""Names under which Nav2 serves its actions, relative to the namespace of the robot."""

A_LOOK = 0.1
"""Longest time that `isTaskComplete` waits for the end of a task, in s."""
PATIENCE = 1.0
"""Time between two notes that a server is not there yet, in s."""


class TaskResult(Enum):
    """Outcome of a task; UNKNOWN before its end."""

    UNKNOWN = 0
    SUCCEEDED = 1
    CANCELED = 2
    FAILED = 3


class RunningTask(Enum):
    """Kind of a task, as the methods that start one return it."""

    NONE = 0
    NAVIGATE_TO_POSE = 1
    NAVIGATE_THROUGH_POSES = 2
    FOLLOW_PATH = 3
    FOLLOW_WAYPOINTS = 4
    FOLLOW_GPS_WAYPOINTS = 5
    SPIN = 6
    BACKUP = 7
    DRIVE_ON_HEADING = 8
    ASSISTED_TELEOP = 9
    DOCK_ROBOT = 10
    UNDOCK_ROBOT = 11
    COMPUTE_AND_TRACK_ROUTE = 12
    FOLLOW_OBJECT = 13


RESULTS: dict[int | None, TaskResult] = {
    GoalStatus.STATUS_SUCCEEDED: TaskResult.SUCCEEDED,
    GoalStatus.STATUS_ABORTED: TaskResult.FAILED,
    GoalStatus.STATUS_CANCELED: TaskResult.CANCELED,
}
"""Outcomes by the status of a goal that has ended."""


KINDS = {
    RunningTask.NAVIGATE_TO_POSE: action.NavigateToPose,
    RunningTask.NAVIGATE_THROUGH_POSES: action.NavigateThroughPoses,
    RunningTask.FOLLOW_PATH: action.FollowPath,
    RunningTask.FOLLOW_WAYPOINTS: action.FollowWaypoints,
    RunningTask.FOLLOW_GPS_WAYPOINTS: action.FollowGPSWaypoints,
    RunningTask.SPIN: action.Spin,
    RunningTask.BACKUP: action.BackUp,
    RunningTask.DRIVE_ON_HEADING: action.DriveOnHeading,
    RunningTask.ASSISTED_TELEOP: action.AssistedTeleop,
    RunningTask.DOCK_ROBOT: action.DockRobot,
    RunningTask.UNDOCK_ROBOT: action.UndockRobot,
    RunningTask.FOLLOW_OBJECT: action.FollowObject,
}
"""Actions by the kind of task."""


class Clients:
    """Clients of one node. Waiting spins the node, so that its callbacks run.

    Args:
        node: Node to which the clients belong.
    """

    def __init__(self, node: Node) -> None:
        self.node = node
        self.actions: dict[type[Action], ActionClient] = {}
        self.services: dict[str, Client] = {}

    def send(self, kind: type[Action], goal: Any, on_feedback: Callable[[Any], None] | None) -> ClientGoalHandle:
        """Send a goal as soon as there is a server; return its handle, accepted or not.

        Args:
            kind: Action, one of `ACTIONS`.
            goal: Message of the action's ``Goal``.
            on_feedback: Called with each feedback message of this goal.
        """
        client = self.actions.get(kind)
        if client is None:
            client = self.actions[kind] = ActionClient(self.node, kind, ACTIONS[kind])
        self._wait(client.wait_for_server, f"'{kind.__name__}' action server not available, waiting...")
        sent = client.send_goal_async(goal, on_feedback)
        handle: ClientGoalHandle = self.complete(sent)
        return handle

    def call(self, kind: type[Service], name: str, request: Any) -> Any:
        """Call a service as soon as there is one; return its response.

        Args:
            kind: Type of the service.
            name: Name of the service.
            request: Message of the service's ``Request``.
        """
        return self.complete(self.begin_call(kind, name, request))

    def begin_call(self, kind: type[Service], name: str, request: Any) -> Future[Any]:
        """Call a service as soon as there is one; return the future of its response.

        Args:
            kind: Type of the service.
            name: Name of the service.
            request: Message of the service's ``Request``.
        """
        client = self.services.get(name)
        if client is None:
            client = self.services[name] = self.node.create_client(kind, name)
        self._wait(client.wait_for_service, f"'{name}' service not available, waiting...")
        return client.call_async(request)

    def complete(self, future: Future[Any]) -> Any:
        """Spin until a future is done; return its result.

        Args:
            future: Future to wait for.
        """
        spin_until_future_complete(self.node, future)
        return future.result()

    def pause(self, seconds: float) -> None:
        """Spin for a while.

        Args:
            seconds: Length of the pause in s.
        """
        spin_until_future_complete(self.node, Future(), timeout_sec=seconds)

    def _wait(self, is_there: Callable[[float], bool], note: str) -> None:
        while not is_there(PATIENCE):
            if not self.node.context.ok():
                raise ROSInterruptException
            self.node.get_logger().info(note)

    def destroy(self) -> None:
        """Destroy the clients of actions; the node destroys the others."""
        for client in self.actions.values():
            client.destroy()
        self.actions.clear()


class TaskError(NamedTuple):
    """Error of a goal.

    Args:
        code: A code of the action's result, 0 for none.
        message: Words for people.
    """

    code: int = 0
    message: str = ""


class Log(Protocol):
    """Log of a navigator; its user may override each method."""

    def info(self, msg: str) -> None:
        """Log `msg` at the level INFO."""

    def warn(self, msg: str) -> None:
        """Log `msg` at the level WARN."""

    def error(self, msg: str) -> None:
        """Log `msg` at the level ERROR."""


class Goal:
    """A goal at a server, from its request to its end.

    Args:
        stored: Most feedback messages that are stored, the last; None has no limit.
    """

    def __init__(self, stored: int | None) -> None:
        self.handle: ClientGoalHandle | None = None
        self.result: Future[Any] | None = None
        self.feedback: deque[Any] = deque(maxlen=stored)

    @property
    def last_feedback(self) -> Any:
        """Last feedback message, None if there is none."""
        return self.feedback[-1] if self.feedback else None


class Goals:
    """Goals of one navigator: its task, and the route that it tracks beside the task.

    Args:
        node: Node whose clients send the goals.
        log: The navigator's words.
    """

    def __init__(self, node: Node, log: Log) -> None:
        self._node, self._log = node, log
        self.clients = Clients(node)
        self.task, self.route = Goal(1), Goal(None)
        self.status: int | None = None
        """Status of the goal that has ended last; None while the task runs."""
        self.error = TaskError()
        """Its error."""

    def begin(self, goal: Goal, kind: type[Action], message: Any, words: str) -> bool:
        """Send a goal in place of the present one; return False if the server rejects it.

        Args:
            goal: The task or the route.
            kind: Action, one of `ACTIONS`.
            message: Message of the action's ``Goal``.
            words: What is to be done, for the log.
        """
        goal.result = None
        goal.feedback.clear()
        if goal is self.task:
            self.status = None
        self.error = TaskError()
        self._log.info(f"{words}...")
        handle = self.clients.send(kind, message, lambda feedback: goal.feedback.append(feedback.feedback))
        if not handle.accepted:
            goal.handle = None
            refused = f"{words}: the request was rejected!"
            self._log.error(refused)
            self.error = TaskError(getattr(kind.Result, "UNKNOWN", 0), refused)
            return False
        goal.handle, goal.result = handle, handle.get_result_async()
        return True

    def is_complete(self, goal: Goal) -> bool:
        """Wait a moment for the end of a goal; return whether it has ended. True as well if there is none.

        Args:
            goal: The task or the route.
        """
        if goal.result is None:
            return True
        spin_until_future_complete(self._node, goal.result, timeout_sec=A_LOOK)
        if not goal.result.done():
            return False
        self._end(goal.result)
        return True

    def result_of(self, kind: type[Action], message: Any, words: str) -> Any:
        """Send a goal as the task and wait for its end; return its result, None unless it succeeded.

        Args:
            kind: Action, one of `ACTIONS`.
            message: Message of the action's ``Goal``.
            words: What is to be done, for the log.
        """
        if not self.begin(self.task, kind, message, words):
            return None
        while not self.is_complete(self.task):
            pass
        if self.status == GoalStatus.STATUS_SUCCEEDED and self.task.result is not None:
            response: Any = self.task.result.result()
            return response.result
        self._log.warn(f"{words} failed with status code {self.status}: {self.error.message}")
        return None

    def cancel(self) -> None:
        """Cancel the task and the route."""
        for goal in (self.task, self.route):
            if goal.handle is not None and goal.result is not None:
                self.clients.complete(goal.handle.cancel_goal_async())

    def _end(self, future: Future[Any]) -> None:
        """Read status and error of a goal that has ended. One whose server went away has failed."""
        try:
            response: Any = future.result()
        except ServiceError as error:
            if self.status != GoalStatus.STATUS_ABORTED:
                self._log.error(str(error))
            self.status = GoalStatus.STATUS_ABORTED
            self.error = TaskError(0, str(error))
            return
        self.status = response.status
        if self.status != GoalStatus.STATUS_SUCCEEDED:
            result = response.result
            self.error = TaskError(getattr(result, "error_code", 0), getattr(result, "error_msg", ""))


def poses_in(poses: Sequence[PoseStamped] | GoalsMsg) -> list[PoseStamped]:
    """Return the poses of a list or of Kilted's Goals.

    Args:
        poses: The list or the message.
    """
    return list(poses.goals if isinstance(poses, GoalsMsg) else poses)


def spot(pose: PoseStamped) -> str:
    """Return the place of a pose, for people: ``1.5 -2.0``.

    Args:
        pose: The pose.
    """
    return f"{pose.pose.position.x} {pose.pose.position.y}"


def time_of(seconds: float) -> DurationMsg:
    """Return a time in seconds as a message.

    Args:
        seconds: The time in s.
    """
    return Duration(seconds=seconds).to_msg()


def with_ends(message: Any, start: int | PoseStamped, goal: int | PoseStamped) -> Any:
    """Return a goal for the route server with both ends in it.

    Args:
        message: The goal.
        start: Pose or number of a node at which the route begins.
        goal: Pose or number of a node at which it ends.

    Raises:
        TypeError: if one end is a pose and the other a number.
    """
    if isinstance(start, PoseStamped) and isinstance(goal, PoseStamped):
        message.start, message.goal, message.use_poses = start, goal, True
    elif isinstance(start, int) and isinstance(goal, int):
        message.start_id, message.goal_id = start, goal
    else:
        raise TypeError("expected two poses or two numbers of nodes for start and goal of the route")
    return message


def straight(goal_type: type[Any], distance: float, speed: float, time_allowance: float) -> Any:
    """Return the goal of a way straight ahead, or back.

    Args:
        goal_type: Class of the goal.
        distance: Distance in metres.
        speed: Speed in m/s.
        time_allowance: Time after which the server gives up, in s.
    """
    return goal_type(target=Point(x=float(distance)), speed=float(speed), time_allowance=time_of(time_allowance))
