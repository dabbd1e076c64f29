"""The states of a goal and the rules of cancelling: every sequence of events stays on the way that ROS 2 draws."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Context, Node, VirtualTime
from robolink.action.server import ActionServer, ServerGoalHandle
from robolink.action.states import ACTIVE, ENDED, NAMES, GoalEvent, goals_to_cancel, is_cancelable, next_status
from robolink.exceptions import RCLError
from robolink.interfaces.action_msgs.msg import GoalInfo, GoalStatus
from robolink.interfaces.action_msgs.srv import CancelGoal
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.transport.memory import Bus, MemoryTransport

ARROWS = {
    ("ACCEPTED", "EXECUTE"): "EXECUTING",
    ("ACCEPTED", "CANCEL_GOAL"): "CANCELING",
    ("EXECUTING", "CANCEL_GOAL"): "CANCELING",
    ("EXECUTING", "SUCCEED"): "SUCCEEDED",
    ("EXECUTING", "ABORT"): "ABORTED",
    ("CANCELING", "SUCCEED"): "SUCCEEDED",
    ("CANCELING", "ABORT"): "ABORTED",
    ("CANCELING", "CANCELED"): "CANCELED",
}
"""The drawing in https://design.ros2.org/articles/actions.html."""

statuses = st.sampled_from(sorted(NAMES))
events = st.sampled_from(GoalEvent)


@given(statuses, events)
def test_each_event_leads_where_the_drawing_says_or_is_refused(status: int, event: GoalEvent) -> None:
    expected = ARROWS.get((NAMES[status], event.name))
    if expected is None:
        with pytest.raises(RCLError, match=f"{NAMES[status]} cannot {event.name}"):
            next_status(status, event)
    else:
        assert NAMES[next_status(status, event)] == expected


def test_the_states_are_sorted_by_whether_more_will_come() -> None:
    assert {NAMES[each] for each in ACTIVE} == {start for start, _ in ARROWS}
    assert {NAMES[each] for each in ENDED} == set(ARROWS.values()) - {start for start, _ in ARROWS}
    assert {NAMES[each] for each in NAMES if is_cancelable(each)} == {"ACCEPTED", "EXECUTING"}


@pytest.fixture(scope="module")
def server() -> Iterator[ActionServer]:
    context = Context(transport=MemoryTransport(bus=Bus()), time=VirtualTime())
    context.init([])
    with context:
        yield ActionServer(Node("node", context=context), Fibonacci, "fibonacci", print)


ACTS: dict[str, Any] = {
    "EXECUTE": ServerGoalHandle.execute,
    "CANCEL_GOAL": lambda handle: handle._update_state(GoalEvent.CANCEL_GOAL),
    "SUCCEED": ServerGoalHandle.succeed,
    "ABORT": ServerGoalHandle.abort,
    "CANCELED": ServerGoalHandle.canceled,
    "feedback": lambda handle: handle.publish_feedback(Fibonacci.Feedback()),
}


@given(st.lists(st.sampled_from(sorted(ACTS)), max_size=12), st.binary(min_size=16, max_size=16))
def test_a_goal_never_leaves_the_drawing(server: ActionServer, acts: list[str], goal_id: bytes) -> None:
    handle = server._accept(UUID(uuid=list(goal_id)), Fibonacci.Goal())
    assert handle is not None
    state, executed = "ACCEPTED", False
    for act in acts:
        try:
            ACTS[act](handle)
        except RCLError:
            assert (act == "EXECUTE" and executed) or (state, act) not in ARROWS
        else:
            is_late_execution = act == "EXECUTE" and state == "CANCELING"  # which is how a deferred goal is ended
            assert is_late_execution or act == "feedback" or (state, act) in ARROWS
            state = ARROWS.get((state, act), state)
            executed |= act == "EXECUTE"
        assert NAMES[handle.status] == state
        assert handle.is_active == (state in {start for start, _ in ARROWS})
        assert handle.is_cancel_requested == (state == "CANCELING")
    server._forget(goal_id)
    server._results._askers.pop(goal_id, None)
    assert (handle.status, handle.is_active) == (GoalStatus.STATUS_UNKNOWN, False)


def status(number: int, seconds: int, code: int) -> GoalStatus:
    info = GoalInfo(goal_id=UUID(uuid=[number] * 16), stamp=Time(sec=seconds))
    return GoalStatus(goal_info=info, status=code)


goals = st.lists(
    st.builds(status, st.integers(1, 6), st.integers(1, 6), statuses),
    max_size=6,
    unique_by=lambda each: int(each.goal_info.goal_id.uuid[0]),
)


@given(st.integers(0, 7), st.integers(0, 7), goals)
def test_a_request_to_cancel_means_what_its_definition_says(number: int, seconds: int, there: list[GoalStatus]) -> None:
    asked = GoalInfo(goal_id=UUID(uuid=[number] * 16), stamp=Time(sec=seconds))
    code, meant = goals_to_cancel(asked, there)
    found = {int(each.goal_id.uuid[0]) for each in meant}
    able = {int(each.goal_info.goal_id.uuid[0]) for each in there if is_cancelable(each.status)}
    early = {int(each.goal_info.goal_id.uuid[0]) for each in there if each.goal_info.stamp.sec <= seconds}
    if number and not seconds:
        known = {int(each.goal_info.goal_id.uuid[0]) for each in there}
        assert found == {number} & able
        expected = "NONE" if found else "GOAL_TERMINATED" if number in known else "UNKNOWN_GOAL_ID"
        assert code == getattr(CancelGoal.Response, f"ERROR_{expected}")
    else:
        assert code == CancelGoal.Response.ERROR_NONE
        assert found == (able & (early | {number}) if seconds else able)
