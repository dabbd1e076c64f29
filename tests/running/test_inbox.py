"""Inboxes: nothing lost, nothing kept for ever, and no Python code where the network calls."""

from __future__ import annotations

import functools
import gc
import queue
import sys
import threading
import weakref
from typing import Any

import pytest

from robolink.running.inbox import Inbox, Sweeper
from robolink.system.waits import get_within

PATIENCE = 30.0


class Target:
    """Keeps what it is given."""

    straight = False

    def __init__(self, inbox: Inbox) -> None:
        self.sink: functools.partial[Any] = inbox.sink(self)
        self.got: list[Any] = []
        self.delivered = threading.Event()

    def deliver(self, arrived: Any) -> None:
        self.got.append(arrived)
        self.delivered.set()


def test_whoever_clears_an_inbox_for_others_wakes_who_waits_there() -> None:
    """The one who waits would otherwise sleep on, beside what is ready and what it was woken for."""
    inbox = Inbox()
    target = Target(inbox)
    inbox.clear()
    assert inbox.empty()
    target.sink(1)
    inbox.clear()
    assert target.got == [1]
    assert not inbox.empty()
    inbox.sweep()
    inbox.wake()
    inbox.clear()
    assert not inbox.empty()


def test_what_arrives_waits_until_the_inbox_is_swept() -> None:
    inbox = Inbox()
    one, other = Target(inbox), Target(inbox)
    one.sink(1)
    other.sink(2)
    one.sink(3)
    assert one.got == other.got == []
    assert not inbox.empty()
    inbox.sweep()
    assert (one.got, other.got) == ([1, 3], [2])
    assert inbox.empty()


def test_no_python_code_runs_when_something_arrives() -> None:
    target, called = Target(Inbox()), []
    sys.setprofile(lambda frame, event, _: called.append(frame.f_code.co_name) if event == "call" else None)
    try:
        target.sink(b"payload")
    finally:
        sys.setprofile(None)
    assert called == []


def test_waiting_ends_with_an_arrival_a_wake_or_the_timeout() -> None:
    inbox = Inbox()
    target = Target(inbox)
    target.sink("here")
    inbox.deliver(inbox.wait(PATIENCE))
    assert target.got == ["here"]
    inbox.wake()
    assert inbox.wait(PATIENCE) is None
    assert inbox.wait(0.001) is None


def test_an_inbox_takes_over_a_sink_that_is_in_use() -> None:
    before, after = Inbox(), Inbox()
    target = Target(before)
    sink = target.sink
    sink(1)
    after.take_over(target.sink)
    sink(2)
    after.sweep()
    assert target.got == [2]
    before.sweep()
    assert target.got == [2, 1]


def test_what_was_on_its_way_when_its_target_moved_follows_it() -> None:
    before, after = Inbox(), Inbox()
    target = Target(before)
    target.sink("late")
    on_its_way = before.wait(PATIENCE)
    after.take_over(target.sink)
    before.deliver(on_its_way)
    assert target.got == []
    after.sweep()
    assert target.got == ["late"]


@pytest.fixture(autouse=True)
def _often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Sweeper, "PERIOD", 0.005)


def test_the_sweeper_empties_what_nobody_looks_into() -> None:
    inbox, sweeper = Inbox(), Sweeper()
    target = Target(inbox)
    sweeper.add(inbox)
    target.sink(1)
    assert target.delivered.wait(PATIENCE)
    target.delivered.clear()
    target.sink(2)
    assert target.delivered.wait(PATIENCE)
    sweeper.close()


def test_the_sweeper_does_not_keep_an_inbox_alive() -> None:
    inbox, sweeper = Inbox(), Sweeper()
    sweeper.add(inbox)
    lives = weakref.ref(inbox)
    del inbox
    gc.collect()
    assert lives() is None
    sweeper.close()


def test_an_inbox_that_was_let_go_is_not_swept() -> None:
    left, kept, sweeper = Inbox(), Inbox(), Sweeper()
    mine, other = Target(left), Target(kept)
    sweeper.add(left)
    sweeper.add(kept)
    sweeper.remove(left)
    mine.sink(1)
    other.sink(1)
    assert other.delivered.wait(PATIENCE)
    assert mine.got == []
    sweeper.close()


def test_a_wait_that_is_shorter_than_the_call_ends() -> None:
    """Python's own `SimpleQueue.get` waits for ever then, before 3.13: after a few hundred of these."""
    inbox = Inbox()
    for _ in range(20_000):
        inbox.wake()
        inbox.sweep()
        assert inbox.wait(1e-6) is None


def test_taking_from_a_queue_within_a_time() -> None:
    source: queue.SimpleQueue[int] = queue.SimpleQueue()
    for seconds in (-1.0, 0.0, 1e-6, 0.01):
        source.put(1)
        assert get_within(source, seconds) == 1
        with pytest.raises(queue.Empty):
            get_within(source, seconds)
    threading.Timer(0.01, source.put, (2,)).start()
    assert get_within(source, PATIENCE) == 2
