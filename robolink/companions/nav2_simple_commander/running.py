"""The running task of a navigator: it begins, is watched and cancelled, ends, and has a result or an error."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from robolink.action.client import ClientGoalHandle
from robolink.companions.nav2_simple_commander.servers import Servers
from robolink.companions.nav2_simple_commander.tasks import RESULTS, RunningTask, TaskResult, poses_in, time_of
from robolink.exceptions import ServiceError
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.nav2_msgs import action
from robolink.interfaces.nav2_msgs.msg import Route
from robolink.interfaces.nav_msgs.msg import Goals, Path
from robolink.message import Action
from robolink.spinning import spin_until_future_complete
from robolink.task import Future

A_LOOK = 0.1
"""Longest time that `isTaskComplete` waits for the end of a task, in s."""


class Tasks(Servers):
    """Node that has a goal at a server of Nav2 and waits for its end; planning is such a goal too.

    Args:
        node_name: Name of the node.
        namespace: Namespace of the node and of the servers that it uses.
    """

    def __init__(self, node_name: str, namespace: str) -> None:
        super().__init__(node_name, namespace)
        self.goal_handle: ClientGoalHandle | None = None
        self.result_future: Future[Any] | None = None
        self.feedback: Any = None
        self.status: int | None = None
        self.route_goal_handle: ClientGoalHandle | None = None
        self.route_result_future: Future[Any] | None = None
        self.route_feedback: list[Any] = []
        self.clearTaskError()

    def isTaskComplete(self, task: RunningTask | None = RunningTask.NONE) -> bool:
        """Wait a tenth of a second at most for the end of the task, and return whether it has ended.

        Callbacks of the node run meanwhile. True as well when no task was begun.

        Args:
            task: Kind of task. Only COMPUTE_AND_TRACK_ROUTE matters, which goes on beside another task.
        """
        future = self.route_result_future if task is RunningTask.COMPUTE_AND_TRACK_ROUTE else self.result_future
        if future is None:
            return True
        spin_until_future_complete(self, future, timeout_sec=A_LOOK)
        if not future.done():
            return False
        self._end_(future)
        return True

    def getFeedback(self, task: RunningTask | None = RunningTask.NONE) -> Any:
        """Return the last feedback of the task, a message of its action's ``Feedback``; None before the first.

        Args:
            task: Kind of task. Of COMPUTE_AND_TRACK_ROUTE each call returns the next feedback, None after the last.
        """
        if task is RunningTask.COMPUTE_AND_TRACK_ROUTE:
            return self.route_feedback.pop(0) if self.route_feedback else None
        return self.feedback

    def getResult(self) -> TaskResult:
        """Return the outcome of the task, UNKNOWN until `isTaskComplete` has seen its end."""
        return RESULTS.get(self.status, TaskResult.UNKNOWN)

    def getTaskError(self) -> tuple[int, str]:
        """Return the code and the words with which the task failed; 0 and nothing if it did not."""
        return self.last_action_error_code, self.last_action_error_msg

    def clearTaskError(self) -> None:
        """Forget the error of the last task."""
        self.setTaskError(0, "")

    def setTaskError(self, error_code: int, error_msg: str) -> None:
        """Set the error that `getTaskError` returns.

        Args:
            error_code: A code of the action's result.
            error_msg: Words for people.
        """
        self.last_action_error_code = error_code
        self.last_action_error_msg = error_msg

    def cancelTask(self) -> None:
        """Cancel the task, and the tracking of a route. Its end is seen by `isTaskComplete`."""
        self.info("Canceling current task.")
        goals = (self.goal_handle, self.result_future), (self.route_goal_handle, self.route_result_future)
        for handle, future in goals:
            if handle is not None and future is not None:
                self._clients_.complete(handle.cancel_goal_async())

    # Planning

    def getPath(
        self, start: PoseStamped, goal: PoseStamped, planner_id: str = "", use_start: bool = False
    ) -> Path | None:
        """Plan a path to a pose, and wait for it.

        Args:
            start: Pose at which the path begins, if `use_start`.
            goal: Pose at which it ends.
            planner_id: Name of the planner; an empty one takes the usual.
            use_start: False begins where the robot is.

        Returns:
            The path, None if there is none; `getTaskError` tells why.
        """
        asked = action.ComputePathToPose.Goal(start=start, goal=goal, planner_id=planner_id, use_start=use_start)
        result = self._ended_(action.ComputePathToPose, asked, "Getting path")
        return None if result is None else result.path

    def getPathThroughPoses(
        self, start: PoseStamped, goals: Sequence[PoseStamped] | Goals, planner_id: str = "", use_start: bool = False
    ) -> Path | None:
        """Plan a path through poses, and wait for it.

        Args:
            start: Pose at which the path begins, if `use_start`.
            goals: Poses in their order: a list, or Kilted's Goals.
            planner_id: Name of the planner; an empty one takes the usual.
            use_start: False begins where the robot is.

        Returns:
            The path, None if there is none; `getTaskError` tells why.
        """
        asked = action.ComputePathThroughPoses.Goal(
            start=start, goals=poses_in(goals), planner_id=planner_id, use_start=use_start
        )
        result = self._ended_(action.ComputePathThroughPoses, asked, "Getting path")
        return None if result is None else result.path

    def getRoute(
        self, start: int | PoseStamped, goal: int | PoseStamped, use_start: bool = False
    ) -> list[Path | Route] | None:
        """Find a route through the graph of the route server, and wait for it.

        Args:
            start: Pose or number of a node at which the route begins.
            goal: Pose or number of a node at which it ends.
            use_start: False begins where the robot is, if `start` is a pose.

        Returns:
            The path and the route, None if there are none; `getTaskError` tells why.

        Raises:
            TypeError: if one end is a pose and the other a number.
        """
        asked = _ends(action.ComputeRoute.Goal(use_start=use_start), start, goal)
        result = self._ended_(action.ComputeRoute, asked, "Getting route")
        return None if result is None else [result.path, result.route]

    def getAndTrackRoute(
        self, start: int | PoseStamped, goal: int | PoseStamped, use_start: bool = False
    ) -> RunningTask | None:
        """Find a route and report the robot's progress on it, beside a task that drives there.

        Args:
            start: Pose or number of a node at which the route begins.
            goal: Pose or number of a node at which it ends.
            use_start: False begins where the robot is, if `start` is a pose.

        Returns:
            The kind of task, for `isTaskComplete` and `getFeedback`; None if the goal was rejected.

        Raises:
            TypeError: if one end is a pose and the other a number.
        """
        asked = _ends(action.ComputeAndTrackRoute.Goal(use_start=use_start), start, goal)
        self.route_result_future, self.route_feedback = None, []
        handle = self._sent_(action.ComputeAndTrackRoute, asked, "Computing and tracking route", self._on_progress_)
        self.route_goal_handle = handle
        if handle is None:
            return None
        self.route_result_future = handle.get_result_async()
        return RunningTask.COMPUTE_AND_TRACK_ROUTE

    def smoothPath(
        self, path: Path, smoother_id: str = "", max_duration: float = 2.0, check_for_collision: bool = False
    ) -> Path | None:
        """Smooth a path, and wait for the result.

        Args:
            path: Path to smooth.
            smoother_id: Name of the smoother; an empty one takes the usual.
            max_duration: Time that the smoother may take, in s.
            check_for_collision: True refuses a smoother path that touches something.

        Returns:
            The path, None if there is none; `getTaskError` tells why.
        """
        asked = action.SmoothPath.Goal(
            path=path,
            smoother_id=smoother_id,
            max_smoothing_duration=time_of(max_duration),
            check_for_collisions=check_for_collision,
        )
        result = self._ended_(action.SmoothPath, asked, "Smoothing path")
        return None if result is None else result.path

    # Used by the tasks

    def _begin_(self, kind: type[Action], goal: Any, words: str) -> bool:
        """Send a goal, in place of the present one; False if the server rejects it."""
        self.result_future = self.feedback = self.status = None
        self.goal_handle = self._sent_(kind, goal, words, self._on_feedback_)
        if self.goal_handle is None:
            return False
        self.result_future = self.goal_handle.get_result_async()
        return True

    def _sent_(
        self, kind: type[Action], goal: Any, words: str, on_feedback: Callable[[Any], None]
    ) -> ClientGoalHandle | None:
        """Send a goal; return its handle, None if the server rejects it."""
        self.clearTaskError()
        self.info(f"{words}...")
        handle = self._clients_.send(kind, goal, on_feedback)
        if handle.accepted:
            return handle
        refused = f"{words}: the request was rejected!"
        self.error(refused)
        self.setTaskError(getattr(kind.Result, "UNKNOWN", 0), refused)
        return None

    def _ended_(self, kind: type[Action], goal: Any, words: str) -> Any:
        """Send a goal and wait for its end; return its result, None unless it succeeded."""
        if not self._begin_(kind, goal, words):
            return None
        while not self.isTaskComplete():
            pass
        if self.getResult() is TaskResult.SUCCEEDED and self.result_future is not None:
            response: Any = self.result_future.result()
            return response.result
        self.warn(f"{words} failed with status code {self.status}: {self.last_action_error_msg}")
        return None

    def _end_(self, future: Future[Any]) -> None:
        """Read status and error of a goal that has ended. One whose server went away has failed."""
        try:
            response: Any = future.result()
        except ServiceError as error:
            if self.status != GoalStatus.STATUS_ABORTED:
                self.error(str(error))
            self.status = GoalStatus.STATUS_ABORTED
            self.setTaskError(0, str(error))
            return
        self.status = response.status
        if self.status != GoalStatus.STATUS_SUCCEEDED:
            result = response.result
            self.setTaskError(getattr(result, "error_code", 0), getattr(result, "error_msg", ""))

    def _on_feedback_(self, message: Any) -> None:
        self.feedback = message.feedback

    def _on_progress_(self, message: Any) -> None:
        self.route_feedback.append(message.feedback)


def _ends(asked: Any, start: int | PoseStamped, goal: int | PoseStamped) -> Any:
    """Return a goal for the route server with both ends in it, as poses or as numbers."""
    if isinstance(start, PoseStamped) and isinstance(goal, PoseStamped):
        asked.start, asked.goal, asked.use_poses = start, goal, True
    elif isinstance(start, int) and isinstance(goal, int):
        asked.start_id, asked.goal_id = start, goal
    else:
        raise TypeError("expected two poses or two numbers of nodes for start and goal of the route")
    return asked
