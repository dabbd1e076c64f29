"""Faults of messages, connections, nodes and clocks: as a file describes them, their patterns, and their reports."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import Enum, auto
from functools import lru_cache
from typing import Annotated, NamedTuple, TypeAlias

import msgspec

from robolink.constants import MOST_SEED

MOST = 1e9
"""Upper bound of times in s, and of lengths of bursts in messages: about thirty years."""

MOST_DRIFT = 0.1
"""Upper bound of a clock's drift in s per s; a cheap crystal has 0.0001."""

Seed = Annotated[int, msgspec.Meta(ge=0, le=MOST_SEED)]
Share = Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]
Seconds = Annotated[float, msgspec.Meta(ge=0.0, le=MOST)]
Names: TypeAlias = str | list[str]
"""One name or several; `*` stands for any letters of one token of a name, `**` for any number of tokens."""


class MessageFault(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Loss, delay or duplication of the messages of some topics, or of the calls of some services, between two nodes.

    `topic` or `service` name them, `from` (here `from_`) and `to` the nodes; without any of them all are meant. A
    call has two directions: its request goes from the client to the server, its response back. `loss` and
    `duplication` are probabilities from 0 to 1, `latency` and `jitter` seconds. With `burst`, losses come in runs of
    so many messages on average. Messages keep their order unless `reorder`. The fault holds from `after` until
    `until`, seconds of the run.
    """

    topic: Names = []
    service: Names = []
    from_: Names = msgspec.field(default_factory=list, name="from")
    to: Names = []
    loss: Share = 0.0
    burst: Annotated[float, msgspec.Meta(ge=1.0, le=MOST)] | None = None
    duplication: Share = 0.0
    latency: Seconds = 0.0
    jitter: Seconds = 0.0
    reorder: bool = False
    after: Seconds = 0.0
    until: Seconds | None = None


class Partition(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Partition of the network: nodes of different groups do not reach each other from `after` until `until`.

    The groups are `between`, lists of nodes; times are seconds of the run, and None is its end.

    A node belongs to the first group that names it; nodes that no group names reach everybody.
    """

    between: list[Names]
    after: Seconds = 0.0
    until: Seconds | None = None


class Crash(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Crash of `node`: its process is killed at `at` seconds of the run, and started again `restart_after` s later.

    Without `restart_after` the launch file's rules apply: `respawn` and `on_exit`.
    """

    node: str
    at: Seconds
    restart_after: Seconds | None = None


class ClockFault(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Wrong clock of `node`: `offset` seconds ahead (behind, if negative), and gaining `drift` seconds per second."""

    node: Names
    offset: Annotated[float, msgspec.Meta(ge=-MOST, le=MOST)] = 0.0
    drift: Annotated[float, msgspec.Meta(ge=-MOST_DRIFT, le=MOST_DRIFT)] = 0.0


class FaultsDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """All faults of a run.

    Args:
        description: Text for people.
        seed: Seed of their random numbers, unless the run itself is given one.
        messages: Losses, delays and duplications of messages.
        partitions: Partitions of the network.
        crashes: Crashes of nodes.
        clocks: Wrong clocks of nodes.
    """

    description: str = ""
    seed: Seed | None = None
    messages: list[MessageFault] = []
    partitions: list[Partition] = []
    crashes: list[Crash] = []
    clocks: list[ClockFault] = []


@dataclass
class FaultReport:
    """Counts of a `fault`, spelled as in its file: messages that it `met`, and those `lost`, `doubled` or `late`."""

    fault: str
    met: int = 0
    lost: int = 0
    doubled: int = 0
    late: int = 0

    def __str__(self) -> str:
        """Return the effects and the number of messages as a line."""
        done = [f"{count} {what}" for what in ("lost", "doubled", "late") if (count := getattr(self, what))]
        return f"{self.fault}: {', '.join(done) or 'nothing'} of {self.met}"


class Why(Enum):
    """Reasons why a fault had no effect so far, the gravest first."""

    WRONG_NAME = auto()
    """Nothing ever had this name: most such names are misspelt."""
    IN_VAIN = auto()
    """The named things existed, and no message came that it could concern."""
    WILD = auto()
    """Like IN_VAIN, but it has wildcards, which may match nothing."""
    TOO_EARLY = auto()
    """The run ended before its time."""


class Unmet(NamedTuple):
    """A fault that had no effect so far: `text`, a line for people, and `why`, the reason."""

    text: str
    why: Why


_ALLOWED = re.compile(r"/?[A-Za-z0-9_*]+(?:/[A-Za-z0-9_*]+)*", re.ASCII)
_PARTS = re.compile(r"(\*\*/|/\*\*|\*\*|\*)")
_WILD = {"**/": "(?:[^/]+/)*", "/**": "(?:/[^/]+)*", "**": ".*", "*": "[^/]*"}


def listed(names: str | Sequence[str]) -> tuple[str, ...]:
    """Return one name, or several, as a tuple."""
    return (names,) if isinstance(names, str) else tuple(names)


def mistake_in(pattern: str) -> str | None:
    """Return the error of a name; None if there is none."""
    if _ALLOWED.fullmatch(pattern) is None:
        return f"'{pattern}' is not a name: it has a-z, A-Z, digits, _ and /, and * or ** for what may stand there"
    return None


def is_pattern(name: str) -> bool:
    """True if a name has wildcards."""
    return "*" in name


def exact(names: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names without wildcards."""
    return tuple(each for each in listed(names) if not is_pattern(each))


def has_pattern(names: str | Sequence[str]) -> bool:
    """True if some of the names have wildcards."""
    return any(map(is_pattern, listed(names)))


@lru_cache(maxsize=256)
def matcher(patterns: tuple[str, ...]) -> Callable[[str], bool]:
    """Return a function from a name to a bool: True if the name matches a pattern, or if there are no patterns.

    The slash in front does not matter. `*` stands for any letters of one token, `**` for any tokens.

    >>> matcher(("/robot*/scan", "**/odom"))("/robot1/scan")
    True
    """
    if not patterns:
        return lambda name: True
    regex = re.compile("|".join(_regex(each.lstrip("/")) for each in patterns))
    return lambda name: regex.fullmatch(name.lstrip("/")) is not None


def fits_any(patterns: tuple[str, ...], names: Iterable[str]) -> bool:
    """True if one of the names matches one of the patterns; False if there are no patterns."""
    return bool(patterns) and any(map(matcher(patterns), names))


def _regex(pattern: str) -> str:
    return "".join(_WILD.get(part) or re.escape(part) for part in _PARTS.split(pattern))
