"""CPU affinity: binds a process to some of the machine's cores."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

from robolink.exceptions import RobolinkError

_MOST_CORES = 4096
"""Upper bound of the number of cores that Linux supports."""


class CoreError(RobolinkError, ValueError):
    """A core was named that this process cannot use; the text lists the usable ones."""


def usable_cores() -> list[int]:
    """Return the numbers of the cores to which a child process can be bound."""
    if sys.platform != "linux":
        return list(range(os.cpu_count() or 1))
    found: list[int] = []
    thread = threading.Thread(target=_look, args=(found,))
    thread.start()
    thread.join()
    return sorted(found)


def check_cores(cores: Sequence[int]) -> None:
    """Raise `CoreError` for a core that does not exist, or for an empty list."""
    usable = usable_cores()
    missing = [str(each) for each in sorted(set(cores)) if each not in usable]
    if missing:
        what = f"core {missing[0]} is" if len(missing) == 1 else f"cores {', '.join(missing)} are"
        raise CoreError(f"{what} not there: this machine offers {ranges(usable)}")
    if not cores:
        raise CoreError(f"no core is named: this machine offers {ranges(usable)}")


def set_affinity(pid: int, cores: Sequence[int]) -> str:
    """Bind a process, and all that it starts from now on, to these cores; return why that failed, or ''.

    macOS has no CPU affinity.
    """
    if sys.platform == "linux":
        why_not = _set_on_linux(pid, cores)
    elif sys.platform == "win32":
        why_not = _set_on_windows(pid, cores)
    else:
        why_not = "cpu: this system keeps no process on a core (macOS has no call for it); it runs on all of them"
    return why_not


def _look(found: list[int]) -> None:
    """Request all cores; the kernel grants those that exist, to this thread, which ends right after."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError):  # some containers forbid even to ask
            os.sched_setaffinity(0, range(_MOST_CORES))
        found.extend(os.sched_getaffinity(0))


def _set_on_linux(pid: int, cores: Sequence[int]) -> str:
    """Bind each thread: the call for a process only affects its first thread and what that starts afterwards."""
    if sys.platform == "linux":
        try:
            os.sched_setaffinity(pid, cores)
            for each in Path(f"/proc/{pid}/task").glob("[0-9]*"):
                os.sched_setaffinity(int(each.name), cores)
        except ProcessLookupError:  # it has ended, or a thread of it
            return ""
        except (OSError, ValueError, OverflowError) as error:
            return f"cpu: cannot keep it on {ranges(cores)}: {getattr(error, 'strerror', None) or error}"
    return ""


def _set_on_windows(pid: int, cores: Sequence[int]) -> str:
    """Bind its children too: the python.exe of a virtual environment starts the Python that does the work."""
    if sys.platform != "darwin":  # Linux has the call as well, for the tests
        import psutil

        try:
            process = psutil.Process(pid)
            for each in (process, *process.children(recursive=True)):
                each.cpu_affinity(list(cores))  # type: ignore[no-untyped-call, unused-ignore]
        except psutil.NoSuchProcess:
            return ""
        except (psutil.Error, OSError, ValueError) as error:
            return f"cpu: cannot keep it on {ranges(cores)}: {error}"
    return ""


def ranges(cores: Sequence[int]) -> str:
    """Format core numbers for people.

    >>> ranges([0, 1, 2, 3, 6])
    'cores 0-3, 6'
    """
    parts: list[list[int]] = []
    for each in sorted(set(cores)):
        if parts and each == parts[-1][-1] + 1:
            parts[-1].append(each)
        else:
            parts.append([each])
    shown = ", ".join(f"{each[0]}-{each[-1]}" if len(each) > 1 else str(each[0]) for each in parts)
    return f"core{'s' if len(cores) > 1 else ''} {shown}"
