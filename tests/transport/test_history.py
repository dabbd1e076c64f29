"""What a receiver stores and what a publisher retains: the last of them, in order, and the rest is counted."""

from __future__ import annotations

from collections import deque

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, qos_profile_system_default
from robolink.transport.history import ALL, Latch, Mailbox, latched_depth, stored_depth


@given(st.integers(0, 5), st.lists(st.integers(0, 9)))
def test_a_mailbox_stores_the_last_and_counts_the_rest(depth: int, steps: list[int]) -> None:
    events: list[str] = []
    mailbox = Mailbox(depth, lambda: events.append("stored"), lambda: events.append("dropped"))
    model = deque[int]()
    for step in steps:
        if step == 0 and model:
            assert mailbox.take() == model.popleft()
            continue
        mailbox.put(step)
        model.append(step)
        is_full = bool(depth) and len(model) > depth
        if is_full:
            model.popleft()
        assert events[-1] == ("dropped" if is_full else "stored")
    assert (list(mailbox.waiting), len(mailbox), mailbox.dropped) == (list(model), len(model), events.count("dropped"))


def test_a_receiver_that_is_listed_is_not_told_of_the_next_one() -> None:
    stored: list[int] = []
    mailbox = Mailbox(5, lambda: stored.append(len(mailbox)))
    mailbox.put("first")
    mailbox.listed = True
    mailbox.put("second")
    assert stored == [1]


def test_what_arrives_may_be_replaced_or_refused_before_it_is_stored() -> None:
    mailbox = Mailbox(ALL, prepare=lambda number: 10 * number if number else None)
    for number in range(3):
        mailbox.put(number)
    assert list(mailbox.waiting) == [10, 20]


@given(st.integers(1, 5), st.integers(1, 6), st.lists(st.integers(0, 9)))
def test_a_latch_has_the_last_in_their_order(depth: int, most: int, items: list[int]) -> None:
    latch = Latch[int](depth)
    for each in items:
        latch.retain(each)
    assert latch.last() == items[-depth:]
    assert latch.last(most) == items[-depth:][-most:]
    latch.clear()
    assert latch.last() == []


@given(st.integers(1, 5), st.lists(st.integers(0, 12)))
def test_a_latch_has_no_more_bytes_than_it_may(depth: int, sizes: list[int]) -> None:
    latch, model = Latch[int](depth, most_bytes=10), list[int]()
    for size in sizes:
        latch.retain(size, size)
        model = [*model, size][-depth:]
        while sum(model) > 10:
            model.pop(0)
        assert latch.last() == model


@pytest.mark.parametrize(
    ("qos", "stored", "latched"),
    [
        (QoSProfile(depth=7), 7, 7),
        (qos_profile_system_default, 42, 42),
        (QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=7), ALL, 7),
        (QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL), 1, 1),
    ],
)
def test_depth_is_the_profile_s_own_or_rmw_zenoh_s(qos: QoSProfile, stored: int, latched: int) -> None:
    assert (stored_depth(qos), latched_depth(qos)) == (stored, latched)
