"""Events of a supervisor, as Structs for other programs: `msgspec.json` encodes each as an object.

The key `event` has its name; `at` is in seconds since 1970.
"""

from __future__ import annotations

from typing import TypeAlias

import msgspec

from robolink.supervisor.policy import State


class Status(msgspec.Struct, frozen=True):
    """Current `state` of the process called `name`."""

    name: str
    pid: int | None
    """Id of the process and of its process group while it runs."""
    state: State
    restarts: int
    """Number of restarts."""
    returncode: int | None
    """Last return code: an exit code, or -N for signal N; None before the first end."""
    since: float
    """Time at which it came into its state, in seconds since 1970."""


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
    """The launcher printed a line of its own."""

    text: str
    at: float


class Ended(msgspec.Struct, frozen=True, tag_field="event", tag="ended"):
    """The whole system has ended; `logs` is the folder of its log files, if there is one."""

    code: int
    logs: str
    at: float


Event: TypeAlias = "Started | Output | Exited | Restarting | Stopping | Said | Ended"
