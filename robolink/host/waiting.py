"""Waits of Python's own functions in virtual time, for threads that take turns."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robolink.host.participants import ProgramLike, Runner
    from robolink.running.timebase import TimeBase


def runner_of(program: ProgramLike | None) -> Runner | None:
    """Return the calling thread, if it runs this program's code in virtual time; None leaves it to Python."""
    if program is None:
        return None
    scheduler = program.host.scheduler
    runner = scheduler.runner()
    return None if runner is None or runner.is_real or runner is scheduler.outside else runner


def wait_until(time: TimeBase, holds: Callable[[], bool], seconds: float | None) -> None:
    """Let the others go on until `holds()`, for so many seconds at most; None is for ever."""
    if seconds is not None and seconds <= 0:
        time.pass_on()
    else:
        time.wait_until(holds, None if seconds is None else time.steady() + math.ceil(seconds * 1e9))
