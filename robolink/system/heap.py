"""Heap tuning: glibc keeps the memory of large messages for the next one, and gives that of huge ones back later."""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Mapping

LARGE = 64 * 1024
"""Payload size in bytes from which `keep` is called: two of them reach glibc's threshold for giving memory back."""

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
"""Names of the two settings in glibc's malloc.h."""

_MOST_MAPPED = 32 << 20
"""Size in bytes from which an allocation is still mapped on its own: the largest that glibc accepts."""

_MOST_RETAINED = 64 << 20
"""Free memory in bytes that an arena keeps at its top: what ten images of 6 MB in a queue leave behind."""

HUGE = _MOST_MAPPED
"""Payload size in bytes from which memory is given back once no such message has come for a while."""

PAUSES = (1.0, 10.0)
"""Seconds without a huge message after which memory is given back, and again: one may have waited in a queue."""

_is_set = False
_huge = threading.Event()
"""Set when a huge message has come."""
_giver: threading.Thread | None = None


def note(size: int) -> None:
    """Note that a message of at least LARGE bytes comes or goes: the heap is set up for such ones."""
    keep()
    if size >= HUGE:
        _huge.set()
        _begin_to_give()


def _begin_to_give() -> None:
    """Start the thread that gives memory back, unless it runs, or there is nothing to give to (not glibc)."""
    global _giver
    if _giver is None and _has_glibc():
        _giver = threading.Thread(target=_give_for_ever, name="robolink heap", daemon=True)
        _giver.start()


def _give_for_ever() -> None:
    while True:
        _huge.wait()
        give_back()


def give_back() -> None:
    """Return freed memory to the system once no huge message has come for the first of PAUSES, and after the second.

    What Zenoh puts a huge message together from lies in the arenas of several threads, and glibc never trims these by
    itself: half a gigabyte stayed with a process for good.
    """
    for pause in PAUSES:
        while True:
            _huge.clear()
            if not _huge.wait(pause):
                break
        _trim()


def _trim() -> None:
    with contextlib.suppress(ImportError, AttributeError, OSError):
        import ctypes

        ctypes.CDLL(None).malloc_trim(0)


def keep(environ: Mapping[str, str] = os.environ) -> None:
    """Let malloc keep freed memory for the next large message; once a process, at its first large message.

    glibc gives the pages of two or three freed messages back, and the system zeroes new ones for the next message:
    0.9 ms for each copy of 1 MB, 20 times the copy itself. Does nothing without glibc (musl, macOS, Windows), or where
    the user has set up the allocator in the environment.
    """
    global _is_set
    if _is_set:
        return
    _is_set = True
    if _has_glibc() and not _is_set_up(environ):
        # A Python without ctypes or dlopen is as slow as before: no reason to lose the message at hand.
        with contextlib.suppress(ImportError, AttributeError, OSError):
            import ctypes  # 3 ms: only a process with large messages pays them

            mallopt = ctypes.CDLL(None).mallopt
            mallopt(_MMAP_THRESHOLD, _MOST_MAPPED)
            mallopt(_TRIM_THRESHOLD, _MOST_RETAINED)


def _has_glibc() -> bool:
    confstr = getattr(os, "confstr", None)  # Windows has none
    try:
        return bool(confstr and confstr("CS_GNU_LIBC_VERSION"))
    except (ValueError, OSError):  # macOS and musl do not know the name
        return False


def _is_set_up(environ: Mapping[str, str]) -> bool:
    tuned = "glibc.malloc." in environ.get("GLIBC_TUNABLES", "")
    return tuned or any(name.startswith("MALLOC_") and name.endswith("_") for name in environ)
