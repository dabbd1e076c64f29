"""Where a network's threads leave what arrives, and where an executor picks it up.

What Zenoh calls must be C from end to end: a Python function called on a foreign thread costs a thread state and a
page of memory each time, five times the price of the message. So a sink is a `functools.partial` of a Struct class
whose `__post_init__` is a queue's `put`: calling it makes an Arrival and queues it, and no Python frame runs.

Arrivals wait in a queue without a bound, but not for long: whoever spins moves them to the mailboxes of their targets,
which keep the last `depth`; and while nobody spins, the context's sweeper does so four times a second.
"""

from __future__ import annotations

import functools
import queue
import threading
import weakref
from collections import deque
from collections.abc import Callable
from typing import Any, Protocol

import msgspec

from robolink.queues import A_WHILE, get_within


class Target(Protocol):
    """What can be delivered to: a subscription, a service, a client's call under way."""

    sink: functools.partial[Any]

    straight: bool
    """Whether an executor may take what arrives straight from the inbox: a plain mailbox would only hand it on."""

    def deliver(self, arrived: Any) -> None:
        """Take what arrived, under the inbox's lock; quick, and no user code."""


class Mailbox:
    """The last `depth` things that arrived for one target; 0 keeps all. The oldest is dropped, and counted."""

    __slots__ = ("depth", "dropped", "waiting")

    def __init__(self, depth: int) -> None:
        self.depth = depth
        self.waiting: deque[Any] = deque(maxlen=depth or None)
        self.dropped = 0

    def put(self, arrived: Any) -> bool:
        """Keep it; whether there is one more now than before."""
        waiting = self.waiting
        full = len(waiting) == waiting.maxlen
        if full:
            self.dropped += 1
        waiting.append(arrived)
        return not full

    def take(self) -> Any:
        """Give the oldest. Raises IndexError when there is none."""
        return self.waiting.popleft()

    def __len__(self) -> int:
        return len(self.waiting)


class Inbox:
    """One executor's (or one context's) queue of arrivals."""

    def __init__(self) -> None:
        self._queue: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._arrival = _arrival_type(self._queue)
        self.lock = threading.RLock()
        """Guards the mailboxes of this inbox's targets."""
        self.empty: Callable[[], bool] = self._queue.empty
        """Whether nothing waits here."""

    def sink(self, target: Target) -> functools.partial[Any]:
        """Make what a transport is given: it queues whatever it is called with, for `target`, without Python code."""
        return functools.partial(self._arrival, target)

    def take_over(self, sink: functools.partial[Any]) -> None:
        """Lead an existing sink here. What was left at its old inbox stays there until that is swept."""
        sink.__setstate__((self._arrival, sink.args, {}, None))  # type: ignore[attr-defined]

    def wake(self) -> None:
        """Let whoever waits look around."""
        self._queue.put(None)

    def sweep(self) -> None:
        """Deliver all that is here; for whoever waits here."""
        with self.lock:
            for _ in range(self._queue.qsize()):
                self._deliver()

    def clear(self) -> None:
        """Deliver all that is here; for others than whoever waits here, whom this may keep from noticing it."""
        if not self._queue.empty():
            self.sweep()
            self.wake()

    def wait(self, timeout: float | None) -> Any:
        """Wait for something to arrive and give it, undelivered; None after `timeout` seconds, or a while, or a wake.

        A while, since a signal that comes just before the wait begins would otherwise be noticed only at its end.
        """
        try:
            return get_within(self._queue, A_WHILE if timeout is None else min(timeout, A_WHILE))
        except queue.Empty:
            return None

    def deliver(self, arrival: Any) -> None:
        """Deliver what `wait` gave."""
        with self.lock:
            if arrival.target.sink.func is self._arrival:
                arrival.target.deliver(arrival.content)
                return
        arrival.target.sink(arrival.content)  # it moved to another inbox, whose lock guards it now

    def _deliver(self) -> None:
        try:
            arrival = self._queue.get_nowait()
        except queue.Empty:  # somebody else was faster
            return
        if arrival is not None:
            arrival.target.deliver(arrival.content)


def _arrival_type(destination: queue.SimpleQueue[Any]) -> Any:
    """Make the class of things that arrive for somebody; making one queues it."""
    return msgspec.defstruct("Arrival", ["target", "content"], namespace={"__post_init__": destination.put}, gc=False)


class Sweeper:
    """Empties inboxes that nobody looks into, so that what arrives there stays bounded by the mailboxes."""

    PERIOD = 0.25
    """Seconds. A camera at 30 Hz leaves eight pictures in that time."""

    def __init__(self) -> None:
        self._inboxes: weakref.WeakSet[Inbox] = weakref.WeakSet()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()

    def add(self, inbox: Inbox) -> None:
        """Look after an inbox from now on."""
        with self._lock:
            self._inboxes.add(inbox)
            if self._thread is None and not self._stop.is_set():
                self._thread = threading.Thread(target=self._run, name="robolink sweeper", daemon=True)
                self._thread.start()

    def remove(self, inbox: Inbox) -> None:
        """Look after it no longer."""
        with self._lock:
            self._inboxes.discard(inbox)

    def close(self) -> None:
        """Stop."""
        self._stop.set()

    def _run(self) -> None:
        while not self._stop.wait(self.PERIOD):
            self._sweep_all()

    def _sweep_all(self) -> None:
        with self._lock:
            inboxes = list(self._inboxes)
        for inbox in inboxes:
            inbox.clear()
