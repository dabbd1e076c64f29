"""What a fault has done in a run."""

from __future__ import annotations

from dataclasses import dataclass


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
