"""Inboxes of hosted executors: what arrives is stored as by an executor of the real time, and makes it due at once."""

from __future__ import annotations

from collections import deque
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from robolink.host.participants import HostedInbox, ParkedInbox
from robolink.running.entity import Receiver
from robolink.running.inbox import Inbox
from robolink.running.ready_queue import ReadyQueue


class Loop:
    """An executor, as far as its entities know."""

    def __init__(self, inbox: Inbox) -> None:
        self.inbox = inbox
        self._queue_: ReadyQueue[Any] = ReadyQueue(inbox, lambda: 0)


def outcome(parking: Inbox, loop: Loop, depth: int, steps: list[str]) -> list[object]:
    """Return what can be seen after each step: what waits, what was dropped, what is ready."""
    receiver = Receiver(parking, depth)
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
            parking.sweep()
            loop.inbox.sweep()
        mailbox = receiver.mailbox
        seen.append((list(mailbox.waiting), mailbox.dropped, mailbox.listed, len(loop._queue_.ready)))
    return seen


@given(st.integers(0, 4), st.lists(st.sampled_from(["arrive", "arrive", "arrive", "take", "attach", "detach"])))
def test_a_hosted_inbox_stores_what_another_one_stores(depth: int, steps: list[str]) -> None:
    due: deque[Any] = deque()
    hosted = outcome(ParkedInbox(due), Loop(HostedInbox(due)), depth, steps)
    assert hosted == outcome(Inbox(), Loop(Inbox()), depth, steps)


def test_each_arrival_makes_a_hosted_executor_due() -> None:
    due: deque[Any] = deque()
    loop = Loop(HostedInbox(due))
    seen = outcome(ParkedInbox(due), loop, 1, ["arrive", "attach", "arrive", "arrive"])
    assert seen[-1] == ([3], 2, True, 1)
    assert list(due) == [loop.inbox] * 2
