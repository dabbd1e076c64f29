"""Reports of faults: their effects in a run, or the reason why they had none."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import NamedTuple


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
