"""Call sites: which code is a program's own, and at which line of it a thread is."""

from __future__ import annotations

import os
import sys
import sysconfig
from functools import cache
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from robolink.host.participants import Runner


@cache
def is_users(file: str) -> bool:
    """Return True if a file is a program's own: not Python's standard library, not robolink's."""
    if file.startswith("<"):
        return file == "<string>"
    path = str(Path(file).resolve())
    if path.startswith(_PACKAGE):
        return path.startswith(_NODES)
    return not path.startswith(_PYTHON) or "site-packages" in path


_PACKAGE = str(Path(__file__).resolve().parent.parent) + os.sep
_NODES = str(Path(_PACKAGE, "share", "nodes")) + os.sep
_PYTHON = str(Path(sysconfig.get_path("stdlib")).resolve()) + os.sep


def place_of(frame: FrameType | None) -> str:
    """Return the line of the user's code that has led to this frame, as ``file:line``; '' if none has."""
    while frame is not None:
        if is_users(frame.f_code.co_filename):
            return f"{frame.f_code.co_filename}:{frame.f_lineno}"
        frame = frame.f_back
    return ""


def frame_of(runner: Runner | None) -> FrameType | None:
    """Return the frame that a thread runs just now."""
    thread = None if runner is None else runner.thread
    return None if thread is None else sys._current_frames().get(thread.ident or 0)


def spot_of(runner: Runner | None) -> tuple[int, int]:
    """Return the instruction at which a thread is, to be compared."""
    frame = frame_of(runner)
    return (0, 0) if frame is None else (id(frame), frame.f_lasti)


def name_of(runner: Runner) -> str:
    """Return the name of the program whose code a thread runs."""
    return "the host" if runner.program is None else runner.program.name


def where_is(runner: Runner) -> str:
    """Return, for an error message, at which line of the program's own code a thread is."""
    return f"it is at {place_of(frame_of(runner)) or 'an unknown place'}"


def where_waits(runner: Runner) -> str:
    """Return, for an error message, which program waits at which line."""
    name = "somebody" if runner.program is None else runner.program.name
    return f"{name} at {place_of(frame_of(runner)) or 'an unknown place'}"


class RealTimeUse(NamedTuple):
    """A use of real time by a program: what it did, and where in its code (``file:line``)."""

    program: str
    what: str
    place: str


def note_use(program: Any, what: str, frame: FrameType) -> None:
    """Record a use of real time, at the line of the program's own code that led to this frame, if there is one."""
    if place := place_of(frame):  # else it was recorded where the thread was started
        program.host.note_real_time(program, what, place)
