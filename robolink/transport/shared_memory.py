"""Policy for Zenoh's implicit shared memory: where it is safe to use, from limits of the process and of the machine.

Zenoh copies a large payload into a pool of 16 MB in /dev/shm, which sender and receiver lock in memory, and sends a
reference. Where a receiver may not lock so much, messages vanish without a word; where /dev/shm is full, any program
that uses it may die of SIGBUS. So a session offers and accepts it only where there is room. If either end does not,
the two use the network's stack, as between machines.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from typing import NamedTuple

from robolink.exceptions import TransportError
from robolink.logging import get_logger
from robolink.system import clocks
from robolink.system.terminal import shown

VARIABLE = "ROBOLINK_SHARED_MEMORY"
"""Environment variable by which the user decides instead of the limits."""
CHOICES = ("auto", "on", "off")
"""Its values."""

SMALLEST_SHARED = 128 * 1024
"""Payload size in bytes from which shared memory is used: below it saves less than a tenth of a round trip, and a
publisher that never needs a pool makes none. With it 256 kB take half of the time by bare Zenoh, and 1 MB a fifth."""

MESSAGES = ("put",)
"""Kinds of messages that use it. Not queries and replies: one that a busy receiver takes 0.1 s late is dropped in
silence, and its client would wait for ever."""

POOL = 18 * 2**20
"""Size of a session's pool and its bookkeeping in bytes, locked by the publisher and by each of its subscribers."""

LEAST_LOCKABLE = 512 * 2**20
"""Least limit of locked memory (RLIMIT_MEMLOCK), in bytes: a subscriber locks the pool of each publisher."""

LEAST_FREE = 128 * 2**20
"""Least free space of /dev/shm in bytes, besides a pool for each session that may still make one."""

FOLDER = "/dev/shm"
"""Folder of POSIX shared memory."""
SUFFIX = ".zenoh"
"""Ending of the files that Zenoh has there."""

_CAN_LOCK_ANYTHING = 1 << 14
"""Bit of CAP_IPC_LOCK among Linux's capabilities."""

LARGEST_SESSION_FILE = 64 * 1024
"""Upper bound in bytes of the file that each session has in /dev/shm from its start on; pools are larger."""


class Machine(NamedTuple):
    """Limits of a process and of its machine, by which it is decided if shared memory is safe."""

    platform: str = "linux"
    lockable: int | None = None
    """Bytes of memory that the process may lock; None for any number."""
    total: int = 0
    """Size of /dev/shm, in bytes; 0 if it is missing or not writable."""
    free: int = 0
    """Free space of /dev/shm, in bytes."""
    sessions: int = 0
    """Sessions on this machine that use shared memory: each may still make a pool."""


class Decision(NamedTuple):
    """Use of shared memory by the sessions of a process."""

    on: bool
    reason: str
    """Reason, in words that follow "on: " or "off: "."""
    remedy: str = ""
    """Advice for the user; empty if there is none."""
    forced: bool = False
    """True if the user decided, and not the limits."""


def decide(machine: Machine) -> Decision:
    """Return whether shared memory is safe with these limits.

    Only Linux: elsewhere nobody has measured it, and macOS' POSIX shared memory has no folder whose space one can see.
    """
    if machine.platform != "linux":
        return Decision(False, "it is used on Linux only")
    if not machine.total:
        return Decision(False, f"there is no {FOLDER} to write to")
    if machine.lockable is not None and machine.lockable < LEAST_LOCKABLE:
        remedy = f"ulimit -l {LEAST_LOCKABLE // 1024}, or `docker run --ulimit memlock=-1`"
        lockable = f"this process may lock {_mb(machine.lockable)} of memory"
        return Decision(False, f"{lockable}, and {_mb(LEAST_LOCKABLE)} are needed", remedy)
    needed = LEAST_FREE + machine.sessions * POOL
    if machine.free < needed:
        others = f" beside {machine.sessions} sessions" if machine.sessions else ""
        reason = f"{_mb(machine.free)} of {FOLDER} are free, and {_mb(needed)} are needed{others}"
        return Decision(False, reason, f"`docker run --shm-size={_mb(needed * 2, unit='m')}`, or mount a larger one")
    lockable = "without limit" if machine.lockable is None else _mb(machine.lockable)
    return Decision(True, f"{_mb(machine.free)} of {FOLDER} are free, lockable: {lockable}")


def decision(environ: Mapping[str, str], machine: Machine | None = None, mode: str = "peer") -> Decision:
    """Return the decision of ROBOLINK_SHARED_MEMORY, or else that of the limits, those of this process by default.

    A session whose `mode` is `client` meets a router alone, and it is the router's limits that would count: one that
    may lock but 8 MB lost 39 of 40 messages in silence. Those are not known, so it is off then.

    Raises TransportError for another value than those of CHOICES.
    """
    choice = environ.get(VARIABLE, "") or "auto"
    if choice not in CHOICES:
        raise TransportError(f"{VARIABLE} must be one of {', '.join(CHOICES)}, got '{shown(choice, 40)}'")
    found = decide(machine or this_machine())
    if found.on and mode == "client":
        found = Decision(False, "a router passes all messages on, and whether it has room is not known")
    if choice == "auto":
        return found
    doubt = f", although {found.reason}" if choice == "on" and not found.on else ""
    return Decision(choice == "on", f"{VARIABLE}={choice}{doubt}", found.remedy if doubt else "", forced=True)


def this_machine() -> Machine:
    """Return the limits of this process."""
    if sys.platform != "linux":
        return Machine(sys.platform)
    try:
        with os.scandir(FOLDER) as files:
            sessions = sum(each.name.endswith(SUFFIX) and _is_of_session(each) for each in files)
    except OSError:
        return Machine(lockable=_lockable())
    size, free = space()
    return Machine("linux", _lockable(), size if os.access(FOLDER, os.W_OK) else 0, free, sessions)


def space() -> tuple[int, int]:
    """Return the size of /dev/shm and its free space, in bytes; zeros if there is none."""
    if sys.platform == "win32":
        return 0, 0
    try:
        found = os.statvfs(FOLDER)
    except OSError:
        return 0, 0
    return found.f_blocks * found.f_frsize, found.f_bavail * found.f_frsize


def _is_of_session(file: os.DirEntry[str]) -> bool:
    try:
        return file.stat().st_size <= LARGEST_SESSION_FILE
    except OSError:  # gone meanwhile
        return False


def _lockable() -> int | None:
    """Return the number of bytes that this process may lock; None for any number."""
    if sys.platform == "win32":
        return None
    import resource

    limit = resource.getrlimit(resource.RLIMIT_MEMLOCK)[0]
    return None if limit == resource.RLIM_INFINITY or _may_lock_anything() else limit


def _may_lock_anything() -> bool:
    """True if the process has the capability CAP_IPC_LOCK, as root outside containers has."""
    try:
        with open("/proc/self/status", encoding="ascii", errors="replace") as status:  # noqa: PTH123
            held = next((line.split()[1] for line in status if line.startswith("CapEff:")), "0")
    except OSError:
        return False
    return bool(int(held, 16) & _CAN_LOCK_ANYTHING)


def _mb(size: int, unit: str = " MB") -> str:
    return f"{size // 2**20}{unit}"


MOST_POOLS = 8
"""Number of pools in a session's hands, its own included, with which it takes no more."""

PERIOD = 1.0
"""Least time between two looks at what is held, in seconds."""

_DELETED = " (deleted)"
"""Suffix that Linux shows at the path of a file that is open but has been removed."""

_DESCRIPTORS = "/proc/self/fd"

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
    folder = os.path.realpath(FOLDER)  # on some systems it is a link to /run/shm
    if sys.platform == "linux":
        with suppress(OSError):
            for name in os.listdir(_DESCRIPTORS):  # noqa: PTH208 - pathlib takes a node's start 3 ms
                with suppress(OSError):  # closed meanwhile
                    descriptor = f"{_DESCRIPTORS}/{name}"
                    path = os.readlink(descriptor).removesuffix(_DELETED)  # noqa: PTH115 - it is locked in memory all the same
                    if path.endswith(SUFFIX) and path.rpartition("/")[0] == folder:
                        status = os.stat(descriptor)  # noqa: PTH116
                        found[int(name)] = Segment(path, status.st_size, status.st_ctime)
    return [found[descriptor] for descriptor in sorted(found)]


def free_space() -> int:
    """Return the free space of /dev/shm in bytes; 0 if there is none."""
    return space()[1]


class PoolLimit:
    """Limit of the pools that one session takes, to be made as soon as the session is open.

    Zenoh keeps the pool of each publisher in another process that has sent a large message, locked and for the
    session's life, also when that process has ended: 18 MB for each restart (Zenoh issue 2787). It cannot be told to
    release one. But a link shares memory only if each end can open a small file of the other's when they meet; so a
    session that holds enough removes its file. Links that are there go on as before; new ones use TCP.

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

    def shares(self) -> bool:
        """Return whether the session has a link through which memory is shared: it holds the other's small file."""
        others = (each for each in self._held() if each.size < LARGEST_SESSION_FILE and each.path != self._own)
        return bool(self._own) and any(others)

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
                f"{pools} pools of shared memory are held, of living and dead processes: large messages of processes"
                " that start from now on take the slower way, by TCP"
            )
