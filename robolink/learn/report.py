"""Report of a check: sentences on what was looked at, and the mistake that ended it, if one did."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

Kind = Literal[
    "syntax", "exception", "elsewhere", "stuck", "stuck somewhere", "ended", "ended all", "file", "use", "check"
]


class Line(Struct, frozen=True):
    """Sentence of a check."""

    good: bool
    text: str


class Mistake(Struct, frozen=True):
    """Mistake that ended a check: its kind, its text, and the line of the student's file with its code."""

    kind: Kind
    text: str = ""
    line: int = 0
    code: str = ""


class Report(Struct, frozen=True):
    """Result of a check."""

    lines: list[Line] = []
    mistake: Mistake | None = None
    is_over: bool = False
    """True if the student's program had come to its end by itself."""
    printed: str = ""
    """Output of the program, cut to a length."""
    seconds: float = 0.0
    """Seconds that the check took."""

    @property
    def passed(self) -> bool:
        """True if all that was looked at is as it should be."""
        return self.mistake is None and bool(self.lines) and all(each.good for each in self.lines)
