"""What a fault has done in a run, or why it has done nothing."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import NamedTuple


@dataclass
class FaultReport:
    """A fault as its file spells it, and how many messages it met, lost, doubled and kept back."""

    fault: str
    met: int = 0
    lost: int = 0
    doubled: int = 0
    late: int = 0

    def __str__(self) -> str:
        """Give it as a line: what was done, of how many."""
        done = [f"{count} {what}" for what in ("lost", "doubled", "late") if (count := getattr(self, what))]
        return f"{self.fault}: {', '.join(done) or 'nothing'} of {self.met}"


class Why(Enum):
    """Why a fault has done nothing so far, the gravest first."""

    WRONG_NAME = auto()
    """Nothing was ever called as it says: most such names are misspelt."""
    IN_VAIN = auto()
    """What it names was there, and nothing came that it could strike."""
    WILD = auto()
    """Likewise, but it has wildcards, which may fit nothing."""
    TOO_EARLY = auto()
    """Its time has not come."""


class Unmet(NamedTuple):
    """A fault that has done nothing so far, as a line for people, and why."""

    text: str
    why: Why
