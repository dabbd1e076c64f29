"""Decisions of a navigation: what happened last, and what is to be done next, as a state machine without ROS.

It does what Nav2's default behaviour trees do, `navigate_to_pose_w_replanning_and_recovery` and its sibling through
poses: plan, follow the path, plan again at a fixed rate. When planning fails, the global costmap is cleared and it is
tried once more; when following fails, the same with the local costmap. After a second failure come recoveries, in turn:
clear both costmaps, spin, wait, back up. Each is followed by a new plan. After six of them, or an error that no
recovery could mend (a goal in a wall, a position that is not known), the navigation has failed.

Two things differ from the trees. A new goal begins with all its six recoveries; and it is the newest error that says
whether a recovery would help, not an older one.
"""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from robolink.interfaces.nav2_msgs.action import ComputePathThroughPoses, ComputePathToPose, FollowPath

ToPose, Through, Follow = ComputePathToPose.Result, ComputePathThroughPoses.Result, FollowPath.Result

PLANNER_HELPED = {
    *(ToPose.UNKNOWN, ToPose.TIMEOUT, ToPose.NO_VALID_PATH),
    *(Through.UNKNOWN, Through.TIMEOUT, Through.NO_VALID_PATH),
}
"""Errors of planning that a recovery may mend."""
CONTROLLER_HELPED = {
    Follow.UNKNOWN,
    Follow.PATIENCE_EXCEEDED,
    Follow.FAILED_TO_MAKE_PROGRESS,
    Follow.NO_VALID_CONTROL,
}
"""Errors of following a path that a recovery may mend."""

RETRIES = 6
"""Most recoveries of a goal."""


class Do(Enum):
    """A piece of work of a navigation."""

    PLAN = "plan a path"
    FOLLOW = "follow the newest path"
    STOP = "stop following"
    CLEAR_GLOBAL = "clear the global costmap"
    CLEAR_LOCAL = "clear the local costmap"
    CLEAR_BOTH = "clear both costmaps"
    SPIN = "turn on the spot"
    WAIT = "wait"
    BACK_UP = "back up"
    HALT = "end the recovery that runs"
    SUCCEED = "end the goal as reached"
    FAIL = "end the goal as failed"


RECOVERIES = (Do.CLEAR_BOTH, Do.SPIN, Do.WAIT, Do.BACK_UP)
"""Recoveries, in their turn."""
COUNTED = {Do.CLEAR_GLOBAL: 1, Do.CLEAR_LOCAL: 1, Do.CLEAR_BOTH: 2, Do.SPIN: 1, Do.WAIT: 1, Do.BACK_UP: 1}
"""By how much each grows `number_of_recoveries`, as in Nav2."""


class Happened(Enum):
    """Kind of an event."""

    BEGUN = "the goal is new"
    RENEWED = "another goal took over"
    DUE = "it is time to plan again"
    SUCCEEDED = "what was to be done is done"
    FAILED = "what was to be done failed"


class Event(NamedTuple):
    """Something that happened."""

    kind: Happened
    of: Do | None = None
    """The work that succeeded, or failed."""
    code: int = 0
    """Error code of Nav2 of what failed."""
    words: str = ""
    """Reason of a failure, for people."""
    is_hopeless: bool = False
    """True if no recovery can help: there is no server."""


class Phase(Enum):
    """State of planning, or of following."""

    IDLE = 0
    RUNNING = 1
    CLEARING = 2
    """Its costmap is being cleared, after which it is tried once more."""


class State(NamedTuple):
    """State of a navigation between two events."""

    plan: Phase = Phase.IDLE
    has_cleared_global: bool = False
    follow: Phase = Phase.IDLE
    has_cleared_local: bool = False
    is_path_old: bool = False
    """True from a new goal on, until there is a path to it."""
    recovery: Do | None = None
    """Recovery that runs."""
    turn: int = 0
    """Place in `RECOVERIES` of the next one."""
    failed_in_row: int = 0
    """Number of recoveries that failed since the last one that did not."""
    retries: int = 0
    recoveries: int = 0
    """Number for feedback."""
    code: int = 0
    words: str = ""
    """Newest error."""

    @property
    def is_active(self) -> bool:
        """True while it plans or follows a path."""
        return self.plan is not Phase.IDLE or self.follow is not Phase.IDLE


Step = tuple[State, list[Do]]
"""The state after an event, and what is to be done, in order."""


def decide(state: State, event: Event) -> Step:
    """Return the state after an event, and what is to be done then.

    >>> state, steps = decide(State(), Event(Happened.BEGUN))
    >>> steps
    [<Do.PLAN: 'plan a path'>]
    >>> decide(state, Event(Happened.SUCCEEDED, Do.PLAN))[1]
    [<Do.FOLLOW: 'follow the newest path'>]
    """
    after, steps = _decided(state, event)
    return after._replace(recoveries=after.recoveries + sum(COUNTED.get(each, 0) for each in steps)), steps


def _decided(state: State, event: Event) -> Step:
    if event.kind is Happened.BEGUN:
        return State(plan=Phase.RUNNING), [Do.PLAN]
    if event.kind is Happened.RENEWED:
        return _renewed(state)
    if event.kind is Happened.DUE:
        return _due(state)
    if event.of in RECOVERIES:
        return _recovered(state, event) if event.of is state.recovery else (state, [])
    if state.recovery is not None:  # of something that was stopped before the recovery
        return state, []
    if event.of in (Do.PLAN, Do.CLEAR_GLOBAL):
        return _planned(state, event)
    if event.of in (Do.FOLLOW, Do.CLEAR_LOCAL):
        return _followed(state, event)
    return state, []


def _renewed(state: State) -> Step:
    """Begin with another goal: the robot goes on along the old path until there is a new one."""
    fresh = State(plan=Phase.RUNNING, follow=state.follow, is_path_old=True, turn=state.turn)
    return fresh, [Do.HALT, Do.PLAN] if state.recovery is not None else [Do.PLAN]


def _due(state: State) -> Step:
    if state.plan is Phase.IDLE and state.follow is Phase.RUNNING:
        return state._replace(plan=Phase.RUNNING), [Do.PLAN]
    return state, []


def _planned(state: State, event: Event) -> Step:
    if event.kind is Happened.SUCCEEDED:
        if event.of is Do.CLEAR_GLOBAL:
            return state._replace(plan=Phase.RUNNING), [Do.PLAN]
        state = state._replace(plan=Phase.IDLE, has_cleared_global=False, is_path_old=False)
        if state.follow is Phase.CLEARING:  # the new path is taken once that is done
            return state, []
        return state._replace(follow=Phase.RUNNING), [Do.FOLLOW]
    if event.of is Do.PLAN and not state.has_cleared_global and _is_mendable(event, PLANNER_HELPED):
        state = state._replace(plan=Phase.CLEARING, has_cleared_global=True, code=event.code, words=event.words)
        return state, [Do.CLEAR_GLOBAL]
    return _failed(state, event)


def _followed(state: State, event: Event) -> Step:
    if state.is_path_old:  # it was the way to the goal before: the path to the new one is on its way
        return state._replace(follow=Phase.IDLE), []
    if event.kind is Happened.SUCCEEDED:
        if event.of is Do.CLEAR_LOCAL:
            return state._replace(follow=Phase.RUNNING), [Do.FOLLOW]
        return state._replace(plan=Phase.IDLE, follow=Phase.IDLE, code=0, words=""), [Do.SUCCEED]
    if event.of is Do.FOLLOW and not state.has_cleared_local and _is_mendable(event, CONTROLLER_HELPED):
        state = state._replace(follow=Phase.CLEARING, has_cleared_local=True, code=event.code, words=event.words)
        return state, [Do.CLEAR_LOCAL]
    return _failed(state, event)


def _failed(state: State, event: Event) -> Step:
    """Stop, and begin with a recovery, or give up."""
    is_clearing = event.of in (Do.CLEAR_GLOBAL, Do.CLEAR_LOCAL)  # the error before it is the one that counts
    code, words = (state.code, state.words) if is_clearing else (event.code, event.words)
    stop = [Do.STOP] if state.follow is Phase.RUNNING and event.of is not Do.FOLLOW else []
    idle = state._replace(plan=Phase.IDLE, follow=Phase.IDLE, has_cleared_global=False, has_cleared_local=False)
    idle = idle._replace(code=code, words=words)
    helped = event.is_hopeless is False and code in PLANNER_HELPED | CONTROLLER_HELPED
    if not helped or state.retries >= RETRIES:
        return idle, [*stop, Do.FAIL]
    recovery = RECOVERIES[state.turn]
    return idle._replace(recovery=recovery, retries=state.retries + 1, failed_in_row=0), [*stop, recovery]


def _recovered(state: State, event: Event) -> Step:
    turn = (state.turn + 1) % len(RECOVERIES)
    if event.kind is Happened.SUCCEEDED:
        return state._replace(recovery=None, turn=turn, plan=Phase.RUNNING), [Do.PLAN]
    if state.failed_in_row + 1 >= len(RECOVERIES):
        return state._replace(recovery=None, turn=turn), [Do.FAIL]
    state = state._replace(recovery=RECOVERIES[turn], turn=turn, failed_in_row=state.failed_in_row + 1)
    return state, [RECOVERIES[turn]]


def _is_mendable(event: Event, codes: set[int]) -> bool:
    return event.code in codes and not event.is_hopeless
