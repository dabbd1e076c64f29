"""A navigator: carries out the goals of one action, by the decisions of `decisions` and the work of `servers`."""

from __future__ import annotations

import contextlib
from collections import deque
from collections.abc import Callable, Coroutine
from typing import Any

import numpy as np

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.counterparts.nav2_bt_navigator.decisions import RECOVERIES, Do, Event, Happened, State, decide
from robolink.counterparts.nav2_bt_navigator.progress import Places, Speed, metres_left, passed, seconds_left
from robolink.counterparts.nav2_bt_navigator.servers import Servers
from robolink.counterparts.nav2_util.robot_pose import fault, in_frame, robot_pose
from robolink.counterparts.nav2_util.simple_action_server import SimpleActionServer
from robolink.counterparts.program import pause
from robolink.duration import Duration
from robolink.exceptions import RobolinkError
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.nav2_msgs.action import ComputePathToPose
from robolink.interfaces.nav_msgs.msg import Path
from robolink.node import Node
from robolink.task import Future
from robolink.tf2 import Buffer, TransformException

UNKNOWN, FAILED_TO_LOAD_BEHAVIOR_TREE, TF_ERROR = 9000, 9001, 9002
"""Error codes of a navigation of its own, Kilted's; the others are those of planner and controller."""

FEEDBACK_PERIOD = 0.1
"""Time between two messages of feedback, in seconds."""
OLDEST = 2.0
"""Age in seconds from which a pose counts as not known: localization has ended, or odometry."""
PATIENCE = 1.0
"""Longest wait for a pose at the begin, in seconds."""
LOST = 5.0
"""Seconds without a pose after which the navigation has failed."""
SETTLE = 1.0
"""Longest time for the controller to stop the robot at the end, in seconds."""
PASSED = 0.7
"""Distance in metres within which a goal on the way counts as passed, as in Nav2."""

CLEARING = {Do.CLEAR_GLOBAL: "plan", Do.CLEAR_LOCAL: "follow"}


class GoalError(RobolinkError, ValueError):
    """A goal that cannot be carried out, with Nav2's error code."""

    def __init__(self, code: int, words: str) -> None:
        super().__init__(words)
        self.code = code


class Trip:
    """The goal that is carried out, its path, and the robot on it."""

    def __init__(self, goals: list[PoseStamped], started: int) -> None:
        self.goals, self.started = goals, started
        self.path: Path | None = None
        self.places: Places = np.empty((0, 2))
        self.pose: PoseStamped | None = None
        self.seen = started
        """Time at which the robot's pose was known last, in nanoseconds."""
        self.speed = Speed()


class Navigator:
    """The server of one action of navigation.

    Args:
        node: Node of the server.
        action_type: NavigateToPose or NavigateThroughPoses.
        name: Name of the action.
        period: Time between two plans, in seconds.
        trees: Names of behaviour trees that it takes as its own, without their suffix.
        buffer: Transforms.
        servers: The servers that it calls.
        claim: Called with True before a goal is carried out, with False after it; False says that another navigator is
            at work.
    """

    def __init__(
        self,
        node: Node,
        action_type: type[Any],
        name: str,
        *,
        period: float,
        trees: tuple[str, ...],
        buffer: Buffer,
        servers: Servers,
        claim: Callable[[bool], bool],
    ) -> None:
        self.name, self.action_type, self._period, self._trees = name, action_type, period, trees
        self._node, self._buffer, self._servers, self._claim = node, buffer, servers, claim
        self._frame: str = node.get_parameter("global_frame").value
        self._base: str = node.get_parameter("robot_base_frame").value
        self._through = hasattr(action_type.Goal(), "poses")
        self._log = node.get_logger()
        self._group = ReentrantCallbackGroup()
        self._events: deque[Event] = deque()
        self._awake: Future[None] = Future()
        self._numbers: dict[str, int] = {}
        self._running: dict[str, Future[None]] = {}
        self._state = State()
        self.server = SimpleActionServer(node, action_type, name, self._execute, on_change=self._wake)

    # A goal, from its begin to its end

    async def _execute(self) -> None:
        if not self._claim(True):
            words = f"Requested navigation from {self.name} while another navigator is processing, rejecting request."
            self._log.error(words)
            return self.server.terminate_current(self._result(UNKNOWN, words))
        timer = None
        try:
            try:
                await self._pose_known()
                trip = self._begun(self.server.goal)
            except GoalError as error:
                self._log.error(str(error))
                return self.server.terminate_current(self._result(error.code, str(error)))
            timer = self._node.create_timer(FEEDBACK_PERIOD, self._wake, callback_group=self._group)
            await self._navigate(trip)
        finally:
            self._claim(False)
            self._drop("plan", "follow", "recovery")
            self._servers.stop()
            self._servers.halt()
            if timer is not None:
                self._node.destroy_timer(timer)

    async def _navigate(self, trip: Trip) -> None:
        self._state, self._events = State(), deque([Event(Happened.BEGUN)])
        planned = looked = self._now()
        while True:
            if self.server.is_cancel_requested:
                await self._settle()
                self._log.info("Goal canceled")
                return self.server.terminate_all(self._result(0, ""))
            if self.server.is_preempt_requested:
                trip = self._taken_over(trip)
                planned = self._now()
            while self._events:
                event = self._events.popleft()
                how = self._step(trip, event)
                if how is not None:
                    await self._settle()
                    return self._end(how)
                planned = self._now() if event.of is Do.PLAN else planned
            if self._now() - looked >= FEEDBACK_PERIOD * 1e9:
                looked = self._now()
                self._look(trip)
            if self._now() - planned >= self._period * 1e9 and not self._events:
                self._events.append(Event(Happened.DUE))
                planned = self._now()
            if not self._events:
                self._awake = Future()
                await self._awake

    async def _pose_known(self) -> None:
        """Wait until the robot's pose is known, for `PATIENCE` at most: localization may have begun just now."""
        until = self._now() + PATIENCE * 1e9
        while self._now() < until and not self.server.is_cancel_requested:
            with contextlib.suppress(TransformException):
                robot_pose(self._buffer, self._node, self._frame, self._base, OLDEST)
                return
            await pause(self._node, FEEDBACK_PERIOD, self._group)

    def _begun(self, goal: Any) -> Trip:
        """Return the trip of a goal. Raises GoalError."""
        tree = goal.behavior_tree.replace("\\", "/").rpartition("/")[2].removesuffix(".xml")
        if tree and tree not in self._trees:
            known = ", ".join(self._trees)
            raise GoalError(
                FAILED_TO_LOAD_BEHAVIOR_TREE,
                f"Error loading XML file: {goal.behavior_tree}. robolink has no behaviour trees: leave the field empty,"
                f" or name the tree whose work is built in: {known}",
            )
        poses = list(goal.poses) if self._through else [goal.pose]
        if not poses:
            raise GoalError(UNKNOWN, "the goal has no poses: expected one or more")
        try:
            here = robot_pose(self._buffer, self._node, self._frame, self._base, OLDEST)
        except TransformException as error:
            raise GoalError(TF_ERROR, f"Initial robot pose is not available: {error}") from error
        goals = [self._in_frame(each) for each in poses]
        now, place, to = self._now(), here.pose.position, goals[-1].pose.position
        self._log.info(
            f"Begin navigating from current location ({place.x:.2f}, {place.y:.2f}) to ({to.x:.2f}, {to.y:.2f})"
        )
        trip = Trip(goals, now)
        trip.pose = here
        return trip

    def _in_frame(self, pose: PoseStamped) -> PoseStamped:
        words = fault(pose.pose)
        if words:
            raise GoalError(UNKNOWN, f"the goal: {words}")
        try:
            found = in_frame(self._buffer, pose, self._frame)
        except TransformException as error:
            raise GoalError(
                TF_ERROR,
                f"Failed to transform a goal pose provided with frame_id '{pose.header.frame_id}' to the global frame"
                f" '{self._frame}': {error}",
            ) from error
        found.header.frame_id = self._frame
        return found

    def _taken_over(self, trip: Trip) -> Trip:
        """Let the pending goal take over if it can be carried out; the old one goes on otherwise."""
        self._log.info("Received goal preemption request")
        try:
            renewed = self._begun(self.server.pending_goal)
        except GoalError as error:
            self._log.warning(f"Preemption request was rejected: {error}")
            self.server.terminate_pending_goal(self._result(error.code, str(error)))
            return trip
        self.server.accept_pending_goal()
        renewed.path, renewed.places = trip.path, trip.places
        self._events.append(Event(Happened.RENEWED))
        return renewed

    # Events

    def _wake(self) -> None:
        if not self._awake.over():
            self._awake.set_result(None)

    def _push(self, event: Event) -> None:
        self._events.append(event)
        self._wake()

    def _step(self, trip: Trip, event: Event) -> Do | None:
        """Take an event in, and begin what is to be done; return how the goal ends, None if it goes on."""
        if event.kind is Happened.FAILED:
            self._log.warning(f"{event.words} (error code {event.code})")
        self._state, steps = decide(self._state, event)
        for each in steps:
            if each in (Do.SUCCEED, Do.FAIL):
                return each
            self._begin(trip, each)
        return None

    def _end(self, how: Do) -> None:
        if how is Do.SUCCEED:
            self._log.info("Goal succeeded")
            return self.server.succeeded_current(self._result(0, ""))
        code, words = self._state.code or UNKNOWN, self._state.words
        self._log.error(f"Goal failed error_code:{code} error_msg:'{words}'")
        return self.server.terminate_current(self._result(code, words))

    def _result(self, code: int, words: str) -> Any:
        return self.action_type.Result(error_code=code, error_msg=words)

    def _begin(self, trip: Trip, what: Do) -> None:
        """Begin with something; its end is an event."""
        if what is Do.STOP:
            self._drop("plan", "follow")
            self._servers.stop()
        elif what is Do.HALT:
            self._drop("recovery")
            self._servers.halt()
        elif what is Do.PLAN:
            self._start("plan", self._plan(trip))
        elif what is Do.FOLLOW:
            assert trip.path is not None
            self._start("follow", self._servers.follow(trip.path))
        else:
            if what in RECOVERIES:
                self._log.info(f"Running recovery: {what.value}")
                self._drop("plan", "follow")
            self._start(CLEARING.get(what, "recovery"), self._servers.recover(what))

    async def _plan(self, trip: Trip) -> Event:
        planned = await self._servers.plan(trip.goals, through=self._through)
        if planned.path is None:
            return planned.event
        if not planned.path.poses:
            words, code = "the planner returned an empty path", ComputePathToPose.Result.NO_VALID_PATH
            return Event(Happened.FAILED, Do.PLAN, code, words)
        trip.path = planned.path
        trip.places = np.array([(each.pose.position.x, each.pose.position.y) for each in planned.path.poses])
        return planned.event

    def _start(self, channel: str, work: Coroutine[Any, Any, Event]) -> None:
        """Run a coroutine beside this one, in place of an older one of its channel, whose end makes no event then."""
        executor = self._node.executor
        assert executor is not None
        self._drop(channel)
        number = self._numbers[channel]

        async def run() -> None:
            try:
                event = await work
            except Exception as error:  # noqa: BLE001 - the goal has failed, not the node
                words = f"{type(error).__name__}: {error}"
                event = Event(Happened.FAILED, Do.PLAN, UNKNOWN, words, is_hopeless=True)
            if self._numbers[channel] == number:
                self._push(event)

        self._running[channel] = executor.create_task(run())

    async def _settle(self) -> None:
        """End everything that runs, and let it stop the robot, for a second at most, before the goal ends."""
        self._drop("plan", "follow", "recovery")
        self._servers.stop()
        self._servers.halt()
        until = self._now() + SETTLE * 1e9
        while self._now() < until and not all(each.over() for each in self._running.values()):
            self._awake = Future()
            await self._awake  # the timer wakes it

    def _drop(self, *channels: str) -> None:
        for each in channels:
            self._numbers[each] = self._numbers.get(each, 0) + 1

    # Feedback

    def _now(self) -> int:
        return self._node.get_clock().now_ns()

    def _look(self, trip: Trip) -> None:
        """Look where the robot is, and send feedback; a robot that is lost for long ends the goal."""
        now = self._now()
        try:
            trip.pose = robot_pose(self._buffer, self._node, self._frame, self._base, OLDEST)
        except TransformException as error:
            self._log.error(f"Robot pose is not available: {error}", throttle_duration_sec=2.0)
            if not trip.seen <= now <= trip.seen + LOST * 1e9:
                words = f"the robot's pose has not been known for {LOST:g} s: {error}"
                self._push(Event(Happened.FAILED, Do.PLAN, TF_ERROR, words, is_hopeless=True))
            return
        trip.seen = now
        place = trip.pose.pose.position
        if self._through:
            ends = [(each.pose.position.x, each.pose.position.y) for each in trip.goals]
            del trip.goals[: passed(ends, place.x, place.y, PASSED)]
        metres = metres_left(trip.places, place.x, place.y)
        feedback = self.action_type.Feedback(
            current_pose=trip.pose,
            navigation_time=Duration(nanoseconds=max(0, now - trip.started)).to_msg(),
            distance_remaining=metres,
            number_of_recoveries=self._state.recoveries,
        )
        seconds = seconds_left(metres, trip.speed.at(now / 1e9, place.x, place.y))
        feedback.estimated_time_remaining = Duration(seconds=min(seconds, 1e6)).to_msg()
        if self._through:
            feedback.number_of_poses_remaining = len(trip.goals)
        self.server.publish_feedback(feedback)
