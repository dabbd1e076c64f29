"""Inboxes: thread-safe queues between a network's threads and an executor.

What Zenoh calls must be C from end to end: a Python function called on a foreign thread costs a thread state and a
page of memory each time, five times the price of the message. So a sink is a `functools.partial` of a Struct class
whose `__post_init__` is a queue's `put`: calling it makes an Arrival and queues it, and no Python frame runs.

Arrivals wait in a queue without a bound, but not for long: whoever spins moves them to the mailboxes of their targets
(`transport/history.py`), which store the last `depth`; and while nobody spins, the context's sweeper does so four times
a second.
"""

from __future__ import annotations

import functools
import queue
import threading
import weakref
from collections.abc import Callable
from typing import Any, Protocol

import msgspec

from robolink.system.waits import A_WHILE, get_within


class Target(Protocol):
    """Receiver of arrivals: a subscription, a service, a client's call under way."""

    sink: functools.partial[Any]

    straight: bool
    """True if an executor may take what arrives at once, by `arrives_for` and `take_arrived` as a Receiver has them."""

    @property
    def deliver(self) -> Callable[[Any], None]:
        """Function that takes what arrived, under the inbox's lock; quick, and no user code."""


class Inbox:
    """Thread-safe queue of arrivals, of one executor or one context."""

    def __init__(self) -> None:
        self._queue: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._arrival = arrival_type(self._queue.put)
        self.lock = threading.RLock()
        """Lock of the mailboxes of this inbox's targets."""
        self.get = self._queue.get
        """Returns the oldest arrival, undelivered, as `queue.SimpleQueue.get` does; for time bases, who wait here."""
        self.empty: Callable[[], bool] = self._queue.empty
        """True if nothing waits here."""

    def sink(self, target: Target) -> functools.partial[Any]:
        """Return the sink that a transport is given: it queues its argument for `target`, without Python code."""
        return functools.partial(self._arrival, target)

    def take_over(self, sink: functools.partial[Any]) -> None:
        """Redirect an existing sink here. What was left at its old inbox stays there until that is swept."""
        sink.__setstate__((self._arrival, sink.args, {}, None))  # type: ignore[attr-defined]

    def wake(self) -> None:
        """Wake the thread in `wait`."""
        self._queue.put(None)

    def sweep(self) -> None:
        """Deliver all that is here; for the thread that calls `wait`."""
        get = self._queue.get_nowait
        with self.lock:
            for _ in range(self._queue.qsize()):
                try:
                    arrival = get()
                except queue.Empty:  # somebody else was faster
                    return
                if arrival is not None:
                    arrival.target.deliver(arrival.content)

    def clear(self) -> None:
        """Like `sweep`, for a thread other than the one in `wait`, which it wakes: that one would miss it."""
        if not self._queue.empty():
            self.sweep()
            self.wake()

    def wait(self, timeout: float | None) -> Any:
        """Wait for something to arrive and return it, undelivered; None after `timeout` seconds, or a while, or a wake.

        A while, since a signal that comes just before the wait begins would otherwise be noticed only at its end.
        """
        try:
            if timeout is None:  # so long that it cannot pass within the call, as `get_within` guards against
                return self.get(True, A_WHILE)
            return get_within(self._queue, min(timeout, A_WHILE))
        except queue.Empty:
            return None

    def close(self) -> None:
        """Do nothing: no thread belongs to this inbox."""

    def deliver(self, arrival: Any) -> None:
        """Deliver what `wait` returned."""
        with self.lock:
            if arrival.target.sink.func is self._arrival:
                arrival.target.deliver(arrival.content)
                return
        arrival.target.sink(arrival.content)  # it moved to another inbox, whose lock guards it now


def arrival_type(put: Callable[[Any], object]) -> Any:
    """Return a new class of arrivals; making one of it calls `put` with it."""
    return msgspec.defstruct("Arrival", ["target", "content"], namespace={"__post_init__": put}, gc=False)


class Sweepable(Protocol):
    """Queue that the sweeper empties: an inbox, or what stands for one."""

    def clear(self) -> None:
        """Deliver all that is there."""


class Sweeper:
    """Periodic thread that empties inboxes of busy executors, so that what waits stays bounded by the mailboxes."""

    PERIOD = 0.25
    """Period in seconds. A camera at 30 Hz leaves eight pictures in that time."""

    def __init__(self) -> None:
        self._inboxes: weakref.WeakSet[Sweepable] = weakref.WeakSet()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()

    def add(self, inbox: Sweepable) -> None:
        """Sweep `inbox` from now on; no harm if it is swept already."""
        with self._lock:
            self._inboxes.add(inbox)
            if self._thread is None and not self._stop.is_set():
                self._thread = threading.Thread(target=self._run, name="robolink sweeper", daemon=True)
                self._thread.start()

    def remove(self, inbox: Sweepable) -> None:
        """Sweep it no longer."""
        with self._lock:
            self._inboxes.discard(inbox)

    def close(self) -> None:
        """Stop the thread."""
        self._stop.set()

    def _run(self) -> None:
        while not self._stop.wait(self.PERIOD):
            self._sweep_all()

    def _sweep_all(self) -> None:
        with self._lock:
            inboxes = list(self._inboxes)
        for inbox in inboxes:
            inbox.clear()
