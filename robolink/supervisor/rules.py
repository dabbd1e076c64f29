"""Restart rules of a process, with exponential backoff, and the classification of exit codes."""

from __future__ import annotations

import signal
import sys
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Literal, TypeAlias

RespawnWhen: TypeAlias = Literal["never", "on_failure", "always"]
OnExit: TypeAlias = Literal["shutdown", "ignore"]


NO_LIMIT = 10**9
"""Number of restarts, and of seconds, that stands for no limit."""


class Step(IntEnum):
    """Escalation steps of stopping a process."""

    INTERRUPT = 0
    TERMINATE = 1
    KILL = 2
    GIVE_UP = 3


@dataclass(frozen=True)
class Restarts:
    """Restart rule of a process that ends by itself: `when` says never, after any end, or after any but exit code 0.

    Exponential backoff: it waits `delay` seconds, twice as long each time (up to `delay_max`), until the process has
    once run for `within` seconds. After `most` restarts in the last `within` seconds it is given up.
    """

    when: RespawnWhen = "never"
    delay: float = 1.0
    delay_max: float = 30.0
    most: int = 5
    within: float = 60.0

    def wants(self, returncode: int) -> bool:
        """True if a process that ended with this `returncode`, as `Popen` has it, is to be restarted."""
        return self.when == "always" or (self.when == "on_failure" and returncode != 0)

    def pause(self, streak: int) -> float:
        """Return the backoff in seconds after `streak` restarts in a row that did not last."""
        longest = max(self.delay, self.delay_max)
        return min(longest, self.delay * 2.0 ** min(streak, 60))


@dataclass(frozen=True)
class Rules:
    """Rules of one process: `respawn` for restarts, `on_exit` for the meaning of its end for the system.

    One that is `held` starts only when it is released. `awaits` are the processes without which it will never be
    released; it may wait for other things besides.
    """

    respawn: Restarts = field(default_factory=Restarts)
    on_exit: OnExit = "shutdown"
    held: bool = False
    awaits: frozenset[str] = frozenset()


def exit_code(returncode: int) -> int:
    """Convert a `Popen` return code to a shell's exit code: 128 + N for a process killed by signal N."""
    return 128 - returncode if returncode < 0 else returncode


def described(returncode: int) -> str:
    """Describe a return code in words: `ended with exit code 3`, `was killed by SIGSEGV`."""
    if returncode == 0:
        return "has ended"
    if returncode in _WINDOWS_ENDS:
        return f"ended by {_WINDOWS_ENDS[returncode]} (0x{returncode:08X})"
    if returncode > 0:
        return f"ended with exit code {returncode}"
    try:
        return f"was killed by {signal.Signals(-returncode).name}"
    except ValueError:
        return f"was killed by signal {-returncode}"


_CONTROL_C_EXIT = 0xC000013A
_WINDOWS_ENDS = {
    0xC0000005: "an access violation",
    0xC000001D: "an illegal instruction",
    0xC0000094: "a division by zero",
    0xC00000FD: "a stack overflow",
    0xC0000135: "a DLL that was not found",
    _CONTROL_C_EXIT: "Ctrl-C",
    0xC0000374: "a damaged heap",
    0xC0000409: "a damaged stack, or abort()",
}
"""Names of the Windows return codes (NTSTATUS) that would be a signal elsewhere."""


def is_orderly(returncode: int, step: Step, cause: str = "") -> bool:
    """True if a process that had been asked to stop by `step` ended in an orderly way.

    An uncaught KeyboardInterrupt is orderly too, and so is a Python that is interrupted before its program began: it
    may turn that into any error.
    """
    obeyed = {0, 128 + signal.SIGINT, 128 + signal.SIGTERM}
    if sys.platform == "win32":
        obeyed |= {_CONTROL_C_EXIT, 1} if step >= Step.TERMINATE else {_CONTROL_C_EXIT}
    return exit_code(returncode) in obeyed or cause.startswith(("KeyboardInterrupt", "Fatal Python error: init_"))
