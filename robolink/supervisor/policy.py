"""Decide what to do when a process ends, the user interrupts or time passes: events in, actions out."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from typing import TypeAlias


class Step(IntEnum):
    """How hard a process is asked to stop."""

    INTERRUPT = 0
    TERMINATE = 1
    KILL = 2
    GIVE_UP = 3


_ECHO = 0.2
"""Seconds in which a second interrupt is the first one again: a terminal and a wrapper may both deliver it."""


@dataclass(frozen=True)
class Ask:
    """Ask the process called `name` to stop."""

    name: str
    step: Step


@dataclass(frozen=True)
class Say:
    """Tell the user."""

    text: str


Action: TypeAlias = "Ask | Say"


class Policy:
    """Ends the system with the first process that ends, harder after each `patience` seconds.

    `ends` is when the system ends by itself. Times are seconds of any one clock; there are no processes here.
    """

    def __init__(self, names: Iterable[str], *, ends: float | None = None, patience: float = 5.0) -> None:
        self.alive = list(names)
        self.step: Step | None = None
        self.deadline = ends
        self._patience = patience
        self._code: int | None = None
        self._is_requested = False
        self._asked = 0.0

    @property
    def is_over(self) -> bool:
        """Whether nothing is left to wait for."""
        return not self.alive or self.step is Step.GIVE_UP

    @property
    def code(self) -> int:
        """The system's exit code: that of the process that ended it, or 0 after an orderly stop on request."""
        return self._code or 0

    def exited(self, name: str, returncode: int, now: float) -> list[Action]:
        """A process ended, with a return code as `Popen` has it: negative for a signal."""
        self.alive.remove(name)
        if self.step is None:
            self._code = exit_code(returncode)
            return [Say(f"{name} {described(returncode)}"), *self._harder(now)]
        if self._is_requested and not is_orderly(returncode, self.step):
            self._code = self._code or exit_code(returncode)
            return [Say(f"{name} {described(returncode)}")]
        return []

    def interrupted(self, now: float, *, in_hurry: bool = True) -> list[Action]:
        """The user wants an end, or, when it is on its way already and they are in a hurry, a quicker one."""
        if self.step is not None:
            is_echo = now - self._asked < _ECHO
            return self._harder(now) if in_hurry and not is_echo else []
        self._is_requested = True
        return [Say("stopping (Ctrl-C again to hurry)"), *self._harder(now)]

    def woken(self, now: float) -> list[Action]:
        """Time passed."""
        if self.deadline is None or now < self.deadline or self.is_over:
            return []
        if self.step is None:
            self._is_requested = True
            return self._harder(now)
        late = f"still running after {self._patience:g} s: {', '.join(self.alive)}"
        return [Say(late), *self._harder(now)]

    def _harder(self, now: float) -> list[Action]:
        self.step = Step.INTERRUPT if self.step is None else Step(min(self.step + 1, Step.GIVE_UP))
        self.deadline, self._asked = now + self._patience, now
        if self.step is Step.GIVE_UP:
            self._code = self._code or exit_code(-9)
            return []
        return [Ask(name, self.step) for name in self.alive]


def exit_code(returncode: int) -> int:
    """Give a return code as shells count: 128 + N for a process killed by signal N."""
    return 128 - returncode if returncode < 0 else returncode


def described(returncode: int) -> str:
    """Say how a process ended: `ended with exit code 3`, `was killed by SIGSEGV`."""
    if returncode == 0:
        return "has ended"
    if returncode > 0:
        return f"ended with exit code {returncode}"
    try:
        return f"was killed by {signal.Signals(-returncode).name}"
    except ValueError:
        return f"was killed by signal {-returncode}"


_CONTROL_C_EXIT = 0xC000013A
"""What Windows says of a process that Ctrl-C or Ctrl-Break ended."""


def is_orderly(returncode: int, step: Step) -> bool:
    """Whether a process that had been asked to stop ended as one that obeys."""
    obeyed = {0, 128 + signal.SIGINT, 128 + signal.SIGTERM}
    if sys.platform == "win32":
        obeyed |= {_CONTROL_C_EXIT, 1} if step >= Step.TERMINATE else {_CONTROL_C_EXIT}
    return exit_code(returncode) in obeyed
