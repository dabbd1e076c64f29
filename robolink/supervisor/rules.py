"""What shall become of a process that ends, and what an end is called."""

from __future__ import annotations

import signal
import sys
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Literal, TypeAlias

RespawnWhen: TypeAlias = Literal["never", "on_failure", "always"]
OnExit: TypeAlias = Literal["shutdown", "ignore"]


class Step(IntEnum):
    """How hard a process is asked to stop."""

    INTERRUPT = 0
    TERMINATE = 1
    KILL = 2
    GIVE_UP = 3


@dataclass(frozen=True)
class Restarts:
    """Whether a process that ends by itself is started again: after any end, or any but exit code 0.

    It waits `delay` seconds, twice as long each time (up to `delay_max`), until it has once run for `within`
    seconds. With `most` new starts in the last `within` seconds it is given up.
    """

    when: RespawnWhen = "never"
    delay: float = 1.0
    delay_max: float = 30.0
    most: int = 5
    within: float = 60.0

    def wants(self, returncode: int) -> bool:
        """Whether an end with this return code is one to start again after."""
        return self.when == "always" or (self.when == "on_failure" and returncode != 0)

    def pause(self, streak: int) -> float:
        """Give the seconds to wait when `streak` new starts in a row have led to nothing."""
        longest = max(self.delay, self.delay_max)
        return min(longest, self.delay * 2.0 ** min(streak, 60))


@dataclass(frozen=True)
class Rules:
    """What a launcher does about one process; `held`: it starts only when it is released.

    `awaits` are the processes without which it never will be; it may wait for other things besides.
    """

    respawn: Restarts = field(default_factory=Restarts)
    on_exit: OnExit = "shutdown"
    held: bool = False
    awaits: frozenset[str] = frozenset()


def exit_code(returncode: int) -> int:
    """Give a return code as shells count: 128 + N for a process killed by signal N."""
    return 128 - returncode if returncode < 0 else returncode


def described(returncode: int) -> str:
    """Say how a process ended: `ended with exit code 3`, `was killed by SIGSEGV`."""
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
"""Return codes of Windows (NTSTATUS) that stand for what would be a signal elsewhere."""


def is_orderly(returncode: int, step: Step, cause: str = "") -> bool:
    """Whether a process that had been asked to stop, as hard as `step`, ended as one that obeys.

    One that lets a KeyboardInterrupt pass does so too, and a Python that is interrupted before it has begun: it may
    make any error of that.
    """
    obeyed = {0, 128 + signal.SIGINT, 128 + signal.SIGTERM}
    if sys.platform == "win32":
        obeyed |= {_CONTROL_C_EXIT, 1} if step >= Step.TERMINATE else {_CONTROL_C_EXIT}
    return exit_code(returncode) in obeyed or cause.startswith(("KeyboardInterrupt", "Fatal Python error: init_"))
