"""Director of a system: adds and ends processes while it runs; events in, requests out.

It knows no processes and no clock, as the policy does: real processes and programs in virtual time have the same one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, Protocol, TypeAlias, TypeVar

from robolink.supervisor.policy import Severity

T = TypeVar("T")


@dataclass(frozen=True)
class Add(Generic[T]):
    """Request: add a process to the system and start it."""

    process: T


@dataclass(frozen=True)
class Stop:
    """Request: stop the process `name` in order; the others go on.

    One that `is_interrupted` has been sent a SIGINT already, by somebody else: it gets the next step if that was not
    enough.
    """

    name: str
    is_interrupted: bool = False


@dataclass(frozen=True)
class Signal:
    """Request: send a signal to the process `name`."""

    name: str
    number: int


@dataclass(frozen=True)
class Tell:
    """Request: print a line of a severity to the user."""

    text: str
    severity: Severity = "INFO"


@dataclass(frozen=True)
class End:
    """Request: end the whole system with this exit code; `reason` is for the user."""

    reason: str
    code: int = 0


Request: TypeAlias = "Add[T] | Stop | Signal | Tell | End"


class Director(Protocol[T]):
    """Decisions about a system that runs. All times are seconds of any one clock, all calls come from one thread."""

    @property
    def hears_lines(self) -> bool:
        """True if it wants the lines of the processes."""

    @property
    def deadline(self) -> float | None:
        """Time at which `woken` is to be called; None if nothing is planned. While there is one, a system goes on."""

    def begin(self, now: float) -> Sequence[Request[T]]:
        """Handle the begin of the system, before its processes are started."""

    def started(self, name: str, pid: int, now: float) -> Sequence[Request[T]]:
        """Handle that a process runs, for the first time or again."""

    def exited(self, name: str, returncode: int, now: float) -> Sequence[Request[T]]:
        """Handle that a process has ended, with a return code as `Popen` has it; it may be started again."""

    def left_out(self, name: str, now: float) -> Sequence[Request[T]]:
        """Handle that a process is not started, since it cannot run here."""

    def line(self, name: str, line: bytes, now: float, fd: int | None = None) -> Sequence[Request[T]]:
        """Handle a line of a process's output; a piece of its output (1) or errors (2), where these are apart: `fd`."""

    def stopping(self, now: float) -> Sequence[Request[T]]:
        """Handle that the whole system is about to end."""

    def woken(self, now: float) -> Sequence[Request[T]]:
        """Handle that time has passed, up to the deadline or beyond."""
