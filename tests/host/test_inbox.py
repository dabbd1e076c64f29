"""Inboxes of hosted executors: what arrives by the short way is kept as by the long one."""

from __future__ import annotations

from collections import deque
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.host.participants import HostedInbox, ParkedInbox
from robolink.running.entity import Receiver
from robolink.running.ready_queue import ReadyQueue


class Short(Receiver):
    """Receives by `_straight_sink`, which writes out `Receiver.deliver` and `Mailbox.put`."""

    straight = True


class Long(Receiver):
    """Receives by `Receiver.deliver`."""


class Loop:
    """An executor, as far as its entities know."""

    def __init__(self, due: deque[Any]) -> None:
        self.inbox = HostedInbox(due)
        self._queue_: ReadyQueue[Any] = ReadyQueue(self.inbox, lambda: 0)


def outcome(kind: type[Receiver], depth: int, steps: list[str]) -> list[object]:
    """Return what can be seen after each step: what waits, what was dropped, what is ready, what is due."""
    due: deque[Any] = deque()
    receiver, loop = kind(ParkedInbox(due), depth), Loop(due)
    seen: list[object] = []
    for number, step in enumerate(steps):
        if step == "attach" and receiver.executor is None:
            receiver.attach(loop)  # type: ignore[arg-type]
        elif step == "detach" and receiver.executor is not None:
            receiver.detach()
            loop._queue_.ready.clear()
        elif step == "take" and loop._queue_.ready:
            seen.append(loop._queue_.ready.popleft().take())
        elif step == "arrive":
            receiver.sink(number)
        mailbox, ready = receiver.mailbox, loop._queue_.ready
        seen.append((list(mailbox.waiting), mailbox.dropped, len(ready), loop.inbox.queued, len(due)))
    return seen


@given(st.integers(1, 4), st.lists(st.sampled_from(["arrive", "arrive", "arrive", "take", "attach", "detach"])))
def test_the_short_way_keeps_what_the_long_one_keeps(depth: int, steps: list[str]) -> None:
    assert outcome(Short, depth, steps) == outcome(Long, depth, steps)


@pytest.mark.parametrize("kind", [Short, Long])
def test_a_full_mailbox_counts_what_it_drops(kind: type[Receiver]) -> None:
    after = outcome(kind, 1, ["attach", "arrive", "arrive"])
    assert after[-1] == ([2], 1, 1, 2, 2)
