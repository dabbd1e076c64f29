"""Keeper of a program on Linux: it adopts all that the program has started, and ends it when the program ends.

Who has left its session, its parents and its environment is found nevertheless: an orphan is given to the nearest
process above that adopts (PR_SET_CHILD_SUBREAPER), which is this one. As a program it runs by its path, in a Python
that finds no package (`-I -S`), so all that it needs stands here.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import time
from pathlib import Path

PATIENCE = 2.0
"""Longest time in seconds in which it ends what is left: a program may start more and more."""
_ADOPT = 36


class _Ended(BaseException):
    """Somebody wants the end of the program."""


def keep(words: list[str]) -> int:
    """Run a program by its command line, `words`, to its end or until SIGTERM, and end all that it has started.

    Returns:
        Its exit code; 1 if a signal ended it.
    """
    import ctypes

    if sys.platform != "linux":
        return 1
    ctypes.CDLL(None).prctl(_ADOPT, ctypes.c_ulong(1), 0, 0, 0)
    signal.signal(signal.SIGTERM, _end)
    child = os.fork()
    if not child:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        os.execv(words[0], words)
    status = 1
    with contextlib.suppress(_Ended):
        status = os.waitpid(child, 0)[1]
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    _end_all()
    return os.WEXITSTATUS(status) if os.WIFEXITED(status) else 1


def _end(*_: object) -> None:
    raise _Ended


def _end_all() -> None:
    if sys.platform != "linux":
        return
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        for each in _descendants():
            with contextlib.suppress(OSError):
                os.kill(each, signal.SIGKILL)
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            return
        time.sleep(0.005)


def _descendants() -> list[int]:
    """Return the processes below this one."""
    below: dict[int, list[int]] = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError, IndexError, ValueError):
            parent = int(path.read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()[1])
            below.setdefault(parent, []).append(int(path.parent.name))
    found = list(below.get(os.getpid(), ()))
    for each in found:  # it grows meanwhile
        found += below.get(each, ())
    return found


if __name__ == "__main__":
    os._exit(keep(sys.argv[1:]))
