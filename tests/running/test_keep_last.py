"""Tests of the mailbox of a KEEP_LAST subscription on a network with threads."""

from __future__ import annotations

import gc
import threading
import time
import weakref
from collections import deque
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.running.entity import Receiver
from robolink.running.inbox import Inbox
from robolink.running.ready_queue import ReadyQueue


class Recorded(Receiver):
    """Receiver that notes what it is executed with."""

    overflows = 0

    def overflowed(self) -> None:
        self.overflows += 1


class Rig:
    """A receiver, its executor's queue, and what stands for the network's thread."""

    def __init__(self, depth: int, in_rounds: bool = True) -> None:
        self.parking = Inbox()
        self.receiver = Recorded(self.parking, depth, threaded=True)
        queue: ReadyQueue[Any] = ReadyQueue(Inbox(), time.perf_counter_ns)
        queue.in_rounds, queue.is_gathered = in_rounds, True
        self.queue = queue
        self.loop: Any = SimpleNamespace(_queue_=queue)
        self.sent = 0
        self.got: list[int] = []

    def arrive(self, count: int) -> None:
        """Store messages, as the network does."""
        for _ in range(count):
            self.receiver.sink(self.sent)
            self.sent += 1

    def attach(self) -> None:
        """Let the executor have the receiver, if it has not."""
        if self.receiver.executor is None:
            with self.queue.lock:
                self.receiver.attach(self.loop)

    def detach(self) -> None:
        """Let no executor have it."""
        self.receiver.detach()

    def take_told(self) -> bool:
        """Take one that a notice has told of; False if there is none."""
        self.queue.inbox.sweep()
        taken = self.queue.take()
        if taken is None:
            return False
        self.got.append(taken[1])
        taken[0].gate.ending_execution(taken[0])
        return True

    def take(self) -> bool:
        """Do a step of what an executor does: False if there is nothing to do for it, now or after a pause."""
        if self.take_told():
            return True
        if not self.queue.flooded:
            return False
        if not self.queue.gather():
            self.queue.calm()
        return True

    def drain(self) -> None:
        """Take all."""
        self.attach()
        while self.take():
            pass

    def check(self) -> None:
        """Check that each message was received in order, dropped and counted, or waits."""
        kept = self.receiver.mailbox
        assert self.got == sorted({*self.got})
        assert len(self.got) + kept.dropped + len(kept) == self.sent


STEPS = st.lists(st.sampled_from(["attach", "detach", "take", 1, 2, 7, 8, 30]), max_size=40)


@given(depth=st.sampled_from([1, 2, 3, 8, 10, 100]), in_rounds=st.booleans(), steps=STEPS)
def test_each_message_is_received_in_order_or_counted(depth: int, in_rounds: bool, steps: list[Any]) -> None:
    rig = Rig(depth, in_rounds)
    for step in steps:
        if isinstance(step, int):
            rig.arrive(step)
        else:
            getattr(rig, step)()
        rig.check()
    waiting = [each.content for each in rig.receiver.mailbox.waiting]
    rig.drain()
    assert not rig.receiver.mailbox.waiting
    assert rig.got[len(rig.got) - len(waiting) :] == waiting
    rig.arrive(3 * depth)  # and it goes on
    rig.drain()
    assert rig.got[-depth:] == [*range(rig.sent - depth, rig.sent)]
    rig.check()


def test_what_waits_has_one_notice() -> None:
    rig = Rig(10)
    rig.attach()
    rig.queue.inbox.sweep()
    rig.arrive(10)
    assert rig.queue.inbox._queue.qsize() == 1


def test_messages_of_a_flood_share_notices_until_few_come() -> None:
    rig = Rig(10)
    rig.attach()
    kept: Any = rig.receiver.mailbox
    rig.arrive(10)
    while rig.take_told():
        pass
    assert kept.in_flood
    rig.arrive(5)
    assert rig.queue.inbox.empty()
    rig.arrive(1)
    rig.arrive(1)
    assert not rig.queue.inbox.empty()
    rig.drain()
    assert (kept.in_flood, rig.queue.flooded, len(rig.got)) == (False, [], 17)
    rig.arrive(1)
    assert not rig.queue.inbox.empty()


def test_a_receiver_that_leaves_in_a_flood_is_not_looked_for_any_more() -> None:
    rig = Rig(10)
    rig.attach()
    rig.arrive(10)
    while rig.take_told():
        pass
    assert rig.queue.flooded
    rig.detach()
    assert not rig.queue.flooded
    rig.arrive(4)
    rig.drain()
    assert rig.got[-4:] == [10, 11, 12, 13]


def test_a_small_queue_never_waits_for_several() -> None:
    rig = Rig(2)
    rig.attach()
    for _ in range(100):
        rig.arrive(9)
        rig.drain()
    assert not rig.queue.flooded


def test_each_drop_is_told() -> None:
    rig = Rig(5)
    rig.attach()
    rig.arrive(12)
    rig.drain()
    assert (rig.receiver.overflows, rig.receiver.mailbox.dropped) == (1, 7)


def test_one_that_another_thread_has_overtaken_is_taken_behind_it_and_no_drop() -> None:
    rig = Rig(10)
    inbox: Any = rig.queue.inbox
    put, rivals = inbox._arrival, [rig]

    def put_and_give_way(*arguments: Any) -> Any:
        for rival in (rivals.pop() for _ in [*rivals]):
            rival.arrive(1)
        return put(*arguments)

    inbox._arrival = put_and_give_way
    rig.attach()
    rig.receiver.sink("overtaken")
    kept, dropped = rig.receiver.mailbox, list[int]()
    while rig.take():
        dropped.append(kept.dropped)
    assert rig.got == [0, "overtaken"]
    assert min(dropped) == dropped[-1] == 0
    assert rig.receiver.overflows == 1


def test_one_that_is_just_being_taken_is_no_drop_for_another_thread() -> None:
    rig = Rig(10)
    rig.attach()
    rig.arrive(2)
    kept, dropped, threads = rig.receiver.mailbox, list[int](), list[threading.Thread]()

    class Watched(deque[Any]):
        def popleft(self) -> Any:
            first = super().popleft()
            threads.append(threading.Thread(target=lambda: dropped.append(kept.dropped)))
            threads[-1].start()
            threads[-1].join(0.05)
            return first

    kept.waiting = Watched(kept.waiting, 10)
    rig.drain()
    for each in threads:
        each.join()
    assert dropped == [0, 0]


@pytest.mark.parametrize("count", [1, 100])
def test_a_receiver_that_nobody_refers_to_is_collected_while_messages_wait(count: int) -> None:
    rig = Rig(10)
    rig.attach()
    rig.arrive(count)
    sink, found, waiting = rig.receiver.sink, weakref.ref(rig.receiver), rig.receiver.mailbox.waiting
    rig.queue.ready.clear()
    del rig.receiver
    gc.collect()
    assert found() is None
    assert not waiting
    sink(0)  # what is still on its way goes nowhere
    rig.queue.inbox.sweep()
    assert rig.queue.take() is None
