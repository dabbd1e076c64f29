"""Heap tuning: keeps glibc from returning the memory of each large message to the system and faulting it in anew."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Mapping

LARGE = 64 * 1024
"""Payload size in bytes from which `keep` is called: two of them reach glibc's threshold for giving memory back."""

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
"""Names of the two settings in glibc's malloc.h."""

_MOST_MAPPED = 32 << 20
"""Size in bytes from which an allocation is still mapped on its own: the largest that glibc accepts."""

_MOST_KEPT = 64 << 20
"""Free memory in bytes that an arena keeps at its top: what ten images of 6 MB in a queue leave behind."""

_kept = False


def keep(environ: Mapping[str, str] = os.environ) -> None:
    """Let malloc keep freed memory for the next large message; once a process, at its first large message.

    glibc gives the pages of two or three freed messages back, and the system zeroes new ones for the next message:
    0.9 ms for each copy of 1 MB, 20 times the copy itself. Does nothing without glibc (musl, macOS, Windows), or where
    the user has set up the allocator in the environment.
    """
    global _kept
    if _kept:
        return
    _kept = True
    if _has_glibc() and not _is_set_up(environ):
        # A Python without ctypes or dlopen is as slow as before: no reason to lose the message at hand.
        with contextlib.suppress(ImportError, AttributeError, OSError):
            import ctypes  # 3 ms: only a process with large messages pays them

            mallopt = ctypes.CDLL(None).mallopt
            mallopt(_MMAP_THRESHOLD, _MOST_MAPPED)
            mallopt(_TRIM_THRESHOLD, _MOST_KEPT)


def _has_glibc() -> bool:
    confstr = getattr(os, "confstr", None)  # Windows has none
    try:
        return bool(confstr and confstr("CS_GNU_LIBC_VERSION"))
    except (ValueError, OSError):  # macOS and musl do not know the name
        return False


def _is_set_up(environ: Mapping[str, str]) -> bool:
    tuned = "glibc.malloc." in environ.get("GLIBC_TUNABLES", "")
    return tuned or any(name.startswith("MALLOC_") and name.endswith("_") for name in environ)
