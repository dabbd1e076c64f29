"""Record of what hosted programs do by the computer's own time: `time.sleep`, threads, processes, event loops."""

from __future__ import annotations

from types import FrameType
from typing import Any, NamedTuple

from robolink.host.call_sites import place_of


class RealTimeUse(NamedTuple):
    """A use of real time by a program: what it did, and where in its code (``file:line``)."""

    program: str
    what: str
    place: str


def note_use(program: Any, what: str, frame: FrameType) -> None:
    """Record a use of real time, at the line of the program's own code that led to this frame, if there is one."""
    if place := place_of(frame):  # else it was recorded where the thread was started
        program.host.note_real_time(program, what, place)
