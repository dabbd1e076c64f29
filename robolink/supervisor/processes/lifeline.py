"""Lifeline: an inherited pipe as liveness signal, by which a child notices that its parent is gone.

The parent holds the writing end of a pipe and never writes; its children read. However the parent dies, the
kernel closes its end, and the read returns. That works alike on Linux, macOS and Windows.
"""

from __future__ import annotations

import os
import signal
import stat
import sys
import threading
import time
from typing import Any

VARIABLE = "ROBOLINK_LIFELINE"


class Lifeline:
    """Parent's side of the pipe: pass `options()` to the `Popen` of every child."""

    def __init__(self) -> None:
        self.reading, self._writing = os.pipe()
        """File descriptor of the end that children read."""
        self.mark = os.urandom(8).hex()
        """Random mark in the environment of this parent's children; the guardian finds them by it."""

    def options(self) -> tuple[dict[str, str], dict[str, Any]]:
        """Return the environment variables of a child, and the keyword arguments for its `Popen`."""
        if sys.platform == "win32":
            import msvcrt
            import subprocess

            handle = msvcrt.get_osfhandle(self.reading)
            os.set_handle_inheritable(handle, True)
            startup = subprocess.STARTUPINFO(lpAttributeList={"handle_list": [handle]})
            options: dict[str, Any] = {"startupinfo": startup}
        else:
            handle = self.reading
            options = {"pass_fds": (handle,)}
        return {VARIABLE: f"{handle}:{self.mark}"}, options

    def close(self) -> None:
        """Close the pipe: children that still run take it as the parent's end."""
        os.close(self._writing)
        os.close(self.reading)


def watch_lifeline(patience: float = 2.0) -> bool:
    """Stop this process when its launcher is gone; return True if there is a launcher to watch.

    It then gets a SIGINT, for an orderly end, and `patience` seconds later it is killed with all of its
    process group. Call it once, in a program's main thread, early: a Ctrl-C that its launcher held back comes now.
    """
    variable = os.environ.pop(VARIABLE, "")
    if variable and sys.platform != "win32":
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    reading = _inherited(variable)
    if reading is None:
        return False
    threading.Thread(target=_watch, args=(reading, patience), name="lifeline", daemon=True).start()
    return True


def _inherited(variable: str) -> int | None:
    """Return the pipe's file descriptor from the variable, if it is still that pipe; else None."""
    try:
        reading = _descriptor(int(variable.partition(":")[0]))
        if not stat.S_ISFIFO(os.fstat(reading).st_mode):
            return None
        os.set_inheritable(reading, False)
    except (ValueError, OverflowError, OSError):
        return None
    return reading


def _descriptor(handle: int) -> int:
    if sys.platform == "win32":
        import msvcrt

        handle = msvcrt.open_osfhandle(handle, os.O_RDONLY)
    return handle


def _watch(reading: int, patience: float) -> None:
    try:
        while os.read(reading, 1):
            continue
    except OSError:  # Windows says "broken pipe" for the end
        pass
    _interrupt()
    time.sleep(patience)
    _kill_group()


def _interrupt() -> None:
    """Interrupt the main thread as Ctrl-C does, even while it waits."""
    if sys.platform == "win32":
        import _thread

        _thread.interrupt_main()
    else:
        main = threading.main_thread().ident
        assert main is not None
        signal.pthread_kill(main, signal.SIGINT)


def _kill_group() -> None:
    if sys.platform != "win32" and os.getpgrp() == os.getpid():
        os.killpg(os.getpid(), signal.SIGKILL)
    os._exit(1)
