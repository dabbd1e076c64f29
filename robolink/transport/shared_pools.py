"""Bound on the shared memory of other sessions that a session holds, since Zenoh never lets go of it.

Zenoh keeps the pool of each publisher in another process that has sent a large message, locked and for the session's
life, also when that process has ended: 18 MB for each restart (Zenoh issue 2787). It cannot be told to release one. But
a link shares memory only if each end can open a small file of the other's when they meet; so a session that holds
enough removes its file. Links that are there go on as before; new ones use TCP.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from robolink.logging import get_logger
from robolink.system import clocks
from robolink.transport.shared_memory import FOLDER, LARGEST_SESSION_FILE, LEAST_FREE, POOL, SUFFIX, space

MOST_POOLS = 8
"""Number of pools in a session's hands, its own included, with which it takes no more."""

PERIOD = 1.0
"""Least time between two looks at what is held, in seconds."""

_DELETED = " (deleted)"
"""Suffix that Linux shows at the path of a file that is open but has been removed."""

_COARSE = 0.02
"""Greatest lag of a file's time behind the clock, in seconds."""


class Segment(NamedTuple):
    """A file of shared memory that this process has open."""

    path: str
    size: int
    changed: float
    """Time of its creation or last change of size, in seconds since the epoch."""


def held_segments() -> list[Segment]:
    """Return Zenoh's segments that this process has open, by file descriptor; none where the system does not tell."""
    found = dict[int, Segment]()
    folder = Path(FOLDER).resolve()  # on some systems it is a link to /run/shm
    if sys.platform == "linux":
        with suppress(OSError):
            for each in Path("/proc/self/fd").iterdir():
                with suppress(OSError):  # closed meanwhile
                    path = Path(str(each.readlink()).removesuffix(_DELETED))  # it is locked in memory all the same
                    if path.suffix == SUFFIX and path.parent == folder:
                        status = each.stat()
                        found[int(each.name)] = Segment(str(path), status.st_size, status.st_ctime)
    return [found[descriptor] for descriptor in sorted(found)]


def free_space() -> int:
    """Return the free space of /dev/shm in bytes; 0 if there is none."""
    return space()[1]


class PoolLimit:
    """Limit of the pools that one session takes, to be made as soon as the session is open.

    Args:
        opened: Time just before the session was opened, in seconds since the epoch.
        held: Returns the segments that this process has open, in the order in which it opened them.
        free: Returns the free space of /dev/shm, in bytes.
        remove: Removes the file of a path.
        now: Clock of the looks, in seconds.
    """

    def __init__(
        self,
        opened: float,
        held: Callable[[], Iterable[Segment]] = held_segments,
        free: Callable[[], int] = free_space,
        remove: Callable[[str], object] = os.unlink,
        now: Callable[[], float] = clocks.monotonic,
    ) -> None:
        self._held, self._free, self._remove, self._now = held, free, remove, now
        # Of those that are new, the first: files of peers that the session has met already are open, too, and where
        # many start at once they are as new, but a session opens its own before it meets anyone.
        new = (each.path for each in held() if each.size < LARGEST_SESSION_FILE and each.changed >= opened - _COARSE)
        self._own = next(new, "")
        self._next = 0.0 if self._own else float("inf")

    def look(self) -> None:
        """Take no new pools from now on if enough are held, or /dev/shm gets full; cheap, to be called often."""
        now = self._now()
        if now < self._next:
            return
        self._next = now + PERIOD
        pools = sum(each.size > POOL // 2 for each in self._held())
        if pools >= MOST_POOLS or self._free() < LEAST_FREE:
            self._next = float("inf")
            with suppress(OSError):
                self._remove(self._own)
            get_logger("robolink.transport").info(
                f"shared memory of {pools} processes is held, living and dead ones: large messages of processes that"
                " start from now on take the slower way, by TCP"
            )
