"""Background writer queue: delivers items in order on a thread of its own, so that a slow reader blocks nobody."""

from __future__ import annotations

import errno
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from robolink.system import waits

MOST_WAITING = 512_000
"""Capacity of the queue in bytes, plus one item; then the process that prints blocks (backpressure)."""
_NO_ROOM = {errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)}
"""Error numbers of a full disk, a file size limit, and an exceeded quota."""

ThingT = TypeVar("ThingT")


@dataclass(frozen=True)
class Troubles:
    """Error callbacks, each called once with the reason, on the queue's thread.

    `broken`: nothing can be delivered any more, as to a closed pipe. `lost`: there is no room, as on a full disk; the
    next items are tried again.
    """

    broken: Callable[[str], object] = lambda reason: None
    lost: Callable[[str], object] = lambda reason: None


@dataclass(frozen=True)
class _Parcel(Generic[ThingT]):
    thing: ThingT
    size: int
    is_own: bool


class BackgroundQueue(Generic[ThingT]):
    """Queue whose thread calls `deliver`, with at most `at_once` items; it may raise OSError and ValueError."""

    def __init__(
        self, deliver: Callable[[list[ThingT]], object], troubles: Troubles, *, name: str, at_once: int = 1000
    ) -> None:
        self._deliver = deliver
        self._troubles = troubles
        self._at_once = at_once
        self._parcels: deque[_Parcel[ThingT]] = deque()
        self._size = {False: 0, True: 0}
        self._changed = threading.Condition()
        self._is_closed = self._is_broken = self._has_lost = False
        self._thread = threading.Thread(target=self._work, name=name, daemon=True)
        self._thread.start()

    @property
    def waiting(self) -> int:
        """Number of bytes that are not delivered yet."""
        return sum(self._size.values())

    def put(self, thing: ThingT, size: int) -> None:
        """Enqueue an item of a process, `size` in bytes; blocks while the queue is full."""
        with self._changed:
            self._changed.wait_for(lambda: self._is_closed or self._size[False] < MOST_WAITING)
            self._add(_Parcel(thing, size, False))

    def put_own(self, thing: ThingT, size: int) -> None:
        """Enqueue an item of the launcher's own; never blocks: it is dropped while as many bytes of these wait."""
        with self._changed:
            if self._size[True] < MOST_WAITING:
                self._add(_Parcel(thing, size, True))

    def close(self, timeout: float) -> None:
        """Deliver what waits, for at most `timeout` seconds; later items are dropped."""
        self._end()
        waits.join(self._thread, timeout)

    def _end(self) -> None:
        with self._changed:
            self._is_closed = True
            self._changed.notify_all()

    def _add(self, parcel: _Parcel[ThingT]) -> None:
        if not self._is_closed:
            self._parcels.append(parcel)
            self._size[parcel.is_own] += parcel.size
            self._changed.notify_all()

    def _work(self) -> None:
        try:
            while taken := self._take():
                self._try(taken)
                with self._changed:
                    for each in taken:
                        self._size[each.is_own] -= each.size
                    self._changed.notify_all()
        finally:
            self._end()  # whatever happened: nobody waits for a queue whose thread is gone

    def _take(self) -> list[_Parcel[ThingT]]:
        """Return the next items, none at the end; they count as waiting until they are delivered."""
        with self._changed:
            self._changed.wait_for(lambda: self._is_closed or self._parcels)
            return [self._parcels.popleft() for _ in range(min(self._at_once, len(self._parcels)))]

    def _try(self, taken: list[_Parcel[ThingT]]) -> None:
        if self._is_broken:
            return
        try:
            self._deliver([each.thing for each in taken])
        except (OSError, ValueError) as error:  # a closed pipe, a full disk; a closed file
            self._failed(error)

    def _failed(self, error: OSError | ValueError) -> None:
        reason = str(error) or type(error).__name__
        if isinstance(error, OSError) and error.errno in _NO_ROOM:
            if not self._has_lost:
                self._has_lost = True
                self._troubles.lost(reason)
        else:
            self._is_broken = True
            self._troubles.broken(reason)
