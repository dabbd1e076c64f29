"""Whether the calling thread takes turns with those of other programs, and how it waits if it does."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robolink.oneprocess.parts import Runner
    from robolink.oneprocess.program import Program
    from robolink.timebase import TimeBase


def runner_of(program: Program | None) -> Runner | None:
    """Give the calling thread, if it runs this program's code in virtual time; None leaves it to Python."""
    turns = None if program is None else program.host.turns
    if turns is None:
        return None
    runner = turns.runner()
    return None if runner is None or runner.is_real or runner is turns.outside else runner


def wait_until(time: TimeBase, holds: Callable[[], bool], seconds: float | None) -> None:
    """Let the others go on until `holds()`, for so long at the most; None is for ever."""
    if seconds is not None and seconds <= 0:
        time.pass_on()
    else:
        time.wait_until(holds, None if seconds is None else time.steady() + math.ceil(seconds * 1e9))
