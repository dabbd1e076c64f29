"""Pool of shared memory of this process, into which a large payload is written once, and from which Zenoh sends it.

Left to itself Zenoh copies a payload out of Python, and then into a pool of its own, each time to another place: it
collects what is free only when the pool is full, so that each message goes through memory that no cache holds. A pool
that is collected before each message uses the same few places again and again.

As with Zenoh's own, a place whose reader stands still for 0.1 s may be used again when there is no other; a reader
checks that after it has copied a message out (`zenoh.py:ZenohTransport.read`). A place that is just being filled is
like those: where the process stands still meanwhile, another thread could be given it before the first one goes on. So
one thread fills at a time. When every place is in use, a message goes Zenoh's way.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import zenoh

from robolink.system import clocks
from robolink.system.waits import fork_lock
from robolink.transport import lifetime
from robolink.transport.pieces import Pieces
from robolink.transport.shared_memory import LEAST_FREE, POOL, SMALLEST_SHARED, free_space

SIZE = 16 * 2**20
"""Size of the pool in bytes, as Zenoh's own has it."""

PERIOD = 1.0
"""Least time between two looks for somebody to share memory with, in seconds: each takes half a millisecond."""


class SharedPool:
    """Pool of a process: made when it is needed first, in some 20 ms, and kept until the process ends.

    It is never freed, so that a message that was just sent can still be read, and no forked child removes its file.

    Args:
        make: Function that makes Zenoh's provider of so many bytes; raises ZError if there is no room.
        free: Returns the free space of /dev/shm, in bytes.
    """

    def __init__(self, make: Callable[[int], Any] | None = None, free: Callable[[], int] = free_space) -> None:
        self._make, self._free = make or zenoh.shm.ShmProvider.default_backend, free
        self._lock = fork_lock()  # re-entrant: a signal handler may publish, too
        self._provider: Any = None
        self._was_tried = False
        self._policy: Any = None

    def filled(self, payload: bytes | Pieces, shares: Callable[[], bool]) -> Any:
        """Return a copy of `payload` in shared memory, which Zenoh sends as it is; None where there is no room.

        Args:
            payload: The payload, of at least SMALLEST_SHARED bytes.
            shares: Says if there is anybody to share memory with; called as long as there is no pool.
        """
        if self._provider is None and (self._was_tried or not shares() or not self._begin()):
            return None
        with self._lock:
            return self._fill(payload)

    def _fill(self, payload: bytes | Pieces) -> Any:
        self._provider.garbage_collect()
        try:
            place = self._provider.alloc(len(payload), self._policy)
        except zenoh.ZError:  # all of it is being read
            return None
        if not isinstance(payload, Pieces):
            place[:] = payload
            return place
        at = 0
        for part in payload:
            place[at : at + len(part)] = part
            at += len(part)
        return place

    def _begin(self) -> bool:
        with self._lock:
            if not self._was_tried:
                self._was_tried = True
                self._provider = self._made()
            return self._provider is not None

    def _made(self) -> Any:
        if self._free() < LEAST_FREE + POOL:
            return None
        shm = zenoh.shm
        self._policy = shm.Defragment(shm.GarbageCollect(safe=False), shm.JustAlloc())
        try:
            with lifetime.inside:
                made = self._make(SIZE)
        except zenoh.ZError:
            return None
        lifetime.leak(made)
        return made


POOL_OF_PROCESS = SharedPool()


class Sharing:
    """Access of one session to the pool of the process.

    Args:
        shares: Says if there is anybody to share memory with.
        pool: The pool.
        now: Clock of the looks, in seconds.
    """

    def __init__(
        self,
        shares: Callable[[], bool],
        pool: SharedPool = POOL_OF_PROCESS,
        now: Callable[[], float] = clocks.monotonic,
    ) -> None:
        self._shares, self._pool, self._now = shares, pool, now
        self._next = 0.0

    def filled(self, payload: bytes | Pieces) -> Any:
        """Return a copy of `payload` in shared memory, which Zenoh sends as it is; None for one to be put as it is."""
        return self._pool.filled(payload, self._look) if len(payload) >= SMALLEST_SHARED else None

    def _look(self) -> bool:
        now = self._now()
        if now < self._next:
            return False
        self._next = now + PERIOD
        return self._shares()
