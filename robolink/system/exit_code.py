"""Exit code of this process, noted as soon as it is certain, since Python does not tell it to exit handlers."""

from __future__ import annotations

import contextlib
import functools
import gc
import io
import os
import sys
from collections.abc import Callable

_noted: list[int] = []
_written: list[bool] = []


def note(code: int) -> None:
    """Note that this process ends now, with this exit code."""
    _noted[:] = [code]


def noted() -> int | None:
    """Return the exit code with which this process ends; None while that is not certain."""
    return _noted[0] if _noted else None


def end_early() -> None:
    """Let the process end with the noted code before Python ends threads, but after all other exit handlers."""
    _at_last_flush(_end)


def write_files() -> None:
    """Let files that are open at the end be written: Python forgets them when an excepthook raises SystemExit."""
    _at_last_flush(_write)


def _at_last_flush(action: Callable[[], object]) -> None:
    """Call `action` when Python flushes the standard streams: after its exit handlers, and before it ends threads."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(AttributeError):  # None, or a stream that takes no attributes
            if not stream.closed:
                setattr(stream, "flush", functools.partial(_flush, stream.flush, action))  # noqa: B010 - a method
                return
    action()


def _flush(really: Callable[[], object], action: Callable[[], object]) -> None:
    try:
        really()
    finally:
        if sys.is_finalizing():
            action()


def _write() -> None:
    if _written:  # a stream that calls this may be one of them
        return
    _written.append(True)
    for each in gc.get_objects():
        if issubclass(type(each), io.IOBase):
            with contextlib.suppress(Exception):  # closed, or its disk is full
                each.flush()


def _end() -> None:
    _write()
    os._exit(_noted[0])
