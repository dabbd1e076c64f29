"""What happens in a system, as small Structs for programs that want to know: `msgspec.json` writes each as an object.

The key `event` says which one it is; `at` is in seconds since 1970.
"""

from __future__ import annotations

from typing import TypeAlias

import msgspec

from robolink.supervisor.policy import State


class Status(msgspec.Struct, frozen=True):
    """How one process stands now."""

    name: str
    pid: int | None
    """The number of the process and of its process group while it runs."""
    state: State
    restarts: int
    """How often it was started again."""
    returncode: int | None
    """How it ended last: an exit code, or -N for signal N."""
    since: float
    """When it came into its state, in seconds since 1970."""


class Started(msgspec.Struct, frozen=True, tag_field="event", tag="started"):
    """A process runs, for the first time or again."""

    name: str
    pid: int
    restarts: int
    at: float


class Output(msgspec.Struct, frozen=True, tag_field="event", tag="output"):
    """A process printed a line."""

    name: str
    line: str
    at: float


class Exited(msgspec.Struct, frozen=True, tag_field="event", tag="exited"):
    """A process ended: with a return code as `Popen` has it, in words, and why if its output tells."""

    name: str
    pid: int
    returncode: int
    how: str
    cause: str
    at: float


class Restarting(msgspec.Struct, frozen=True, tag_field="event", tag="restarting"):
    """A process that ended will be started again after `delay` seconds."""

    name: str
    delay: float
    at: float


class Stopping(msgspec.Struct, frozen=True, tag_field="event", tag="stopping"):
    """Processes are asked to stop: `step` is interrupt, terminate or kill."""

    names: list[str]
    step: str
    at: float


class Said(msgspec.Struct, frozen=True, tag_field="event", tag="said"):
    """The launcher told the user something."""

    text: str
    at: float


class Ended(msgspec.Struct, frozen=True, tag_field="event", tag="ended"):
    """The whole system is over; `logs` is the folder with what was printed, if there is one."""

    code: int
    logs: str
    at: float


Event: TypeAlias = "Started | Output | Exited | Restarting | Stopping | Said | Ended"
