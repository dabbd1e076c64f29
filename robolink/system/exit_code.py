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


def note(code: int) -> None:
    """Note that this process ends now, with this exit code."""
    _noted[:] = [code]


def noted() -> int | None:
    """Return the exit code with which this process ends; None while that is not certain."""
    return _noted[0] if _noted else None


def end_early() -> None:
    """Let the process end with the noted code before Python ends threads, but after all other exit handlers.

    Python flushes the standard streams between the two: the first of these flushes ends the process.
    """
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(AttributeError):  # None, or a stream that takes no attributes
            if not stream.closed:
                setattr(stream, "flush", functools.partial(_flush, stream.flush))  # noqa: B010 - a method, for types
                return
    _end()


def _flush(really: Callable[[], object]) -> None:
    try:
        really()
    finally:
        if sys.is_finalizing():
            _end()


def _end() -> None:
    """Write what Python's files still hold, as its end would do, and end the process."""
    for each in gc.get_objects():
        if issubclass(type(each), io.IOBase):
            with contextlib.suppress(Exception):  # closed, or its disk is full
                each.flush()
    os._exit(_noted[0])
