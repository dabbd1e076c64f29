"""Large messages between processes: none is ever another one's data, and what is missing is counted."""

from __future__ import annotations

import sys
from contextlib import ExitStack

import pytest

from tests.support import large_messages
from tests.support.large_messages import Restarts, disturb, flood, freeze, pass_on, tight

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(sys.platform != "linux", reason="shared memory is used on Linux only, and SIGSTOP is POSIX'"),
]
needs_room = pytest.mark.skipif(
    bool(large_messages.no_room()), reason=f"no shared memory here: {large_messages.no_room()}"
)


@needs_room
def test_without_the_check_a_receiver_that_stood_still_gets_other_messages_data() -> None:
    """If this fails, Zenoh may have mended it: then the check can go."""
    assert freeze(kind="all", freezes=10, busy=0.02, unchecked=True, until_wrong=True).wrong > 0


@needs_room
@pytest.mark.parametrize("kind", ["depth", "all", "latched"])
def test_a_receiver_that_stood_still_gets_no_other_messages_data(kind: str) -> None:
    found = freeze(kind=kind, freezes=1, busy=0.02)
    assert found.fine, found


@needs_room
@pytest.mark.parametrize("size", [1_000_000, 6_200_000])
def test_in_a_flood_everything_is_right_or_counted(size: int) -> None:
    for found in flood(size=size, publishers=2, seconds=0.5):
        assert found.fine, found


@needs_room
def test_ends_of_a_flood_that_stand_still_are_killed_or_come_late_harm_no_message() -> None:
    kept = disturb()
    assert len(kept) == 3
    for found in kept:
        assert found.fine, found


@needs_room
def test_a_receiver_that_may_not_lock_memory_gets_everything() -> None:
    roomy, tight_one = pass_on(receivers=[(), tight()], messages=20)
    assert roomy.fine
    assert tight_one.fine
    assert roomy.locked > 16_000 > tight_one.locked  # one of them shares memory, the other does not
    assert (roomy.received, tight_one.received) == (20, 20)


@needs_room
def test_restarts_of_publishers_do_not_fill_memory() -> None:
    with ExitStack() as stack:
        restarts = Restarts(stack, messages=2, pools=3)
        first, second = restarts.play(1, shares=True), restarts.play(1, shares=True)
        over = second
        while not over.limited:  # a few more come before the limit is noticed: the receiver looks once a second
            assert over.locked < 30 * first.locked, "there is no limit"
            over = restarts.play(1, shares=True)
        more = restarts.play(2)
    assert first.locked < second.locked  # so it would go on
    assert more.locked == over.locked
    assert more.received > over.received
    assert not more.wrong
