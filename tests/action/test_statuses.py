"""The states of goals as bytes: what the encoder would make of them, whatever comes and goes."""

from __future__ import annotations

import time

from hypothesis import given
from hypothesis import strategies as st

from robolink.action.states import Statuses
from robolink.interfaces.action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.message import encode

IDS = st.binary(min_size=16, max_size=16)
STAMPS = st.builds(Time, sec=st.integers(-(2**31), 2**31 - 1), nanosec=st.integers(0, 2**32 - 1))
CHANGES = st.lists(st.tuples(st.sampled_from(range(6)), st.one_of(st.none(), st.integers(-128, 127))), max_size=20)


@given(st.lists(IDS, min_size=6, max_size=6, unique=True), st.lists(STAMPS, min_size=6, max_size=6), CHANGES)
def test_they_are_what_the_encoder_makes_of_them(
    ids: list[bytes], stamps: list[Time], changes: list[tuple[int, int | None]]
) -> None:
    statuses, plain = Statuses(), dict[bytes, GoalStatus]()
    assert statuses.message() == encode(GoalStatusArray())
    for which, status in changes:
        if status is None:
            statuses.drop(ids[which])
            plain.pop(ids[which], None)
        else:
            goal = GoalInfo(goal_id=UUID(uuid=ids[which]), stamp=stamps[which])
            statuses.put(goal, status)
            plain[ids[which]] = GoalStatus(goal_info=goal, status=status)
        assert statuses.message() == encode(GoalStatusArray(status_list=list(plain.values())))


def test_thousands_of_goals_cost_little() -> None:
    statuses = Statuses()
    for number in range(2258):
        statuses.put(GoalInfo(goal_id=UUID(uuid=number.to_bytes(16, "big"))), 4)
    begin = time.process_time()
    for _ in range(100):
        statuses.message()
    assert time.process_time() - begin < 0.1
