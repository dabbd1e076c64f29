"""Comparison of two transcripts: the lines that differ, and those that differ only in an error's text."""

from __future__ import annotations

import ast
import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass

_RAISES = re.compile(r": raises (?P<name>\w+)(?:\((?P<bases>[\w,]*)\))?(?::|$)")
_LOGGED = re.compile(r"\[(WARN|ERROR|FATAL)\] \[<time>\] \[[\w.]+\]: ")
_REASON = re.compile(r"""(False, |reason=)("[^"]*"|'[^']*')""")


@dataclass(frozen=True)
class Difference:
    """A line that the real rclpy prints, robolink's in its place, or either alone."""

    label: str
    real: str | None
    ours: str | None

    def __str__(self) -> str:
        return "\n".join(
            f"    {sign} {line}" for sign, line in (("-", self.real), ("+", self.ours)) if line is not None
        )


@dataclass(frozen=True)
class Comparison:
    """The differences of two transcripts, and how many lines the real one has and differ in a text alone."""

    lines: int
    texts: int
    differences: list[Difference]

    @property
    def differing(self) -> int:
        """The count of the real one's lines that are not printed here, or of lines that only robolink prints."""
        missing = sum(each.real is not None for each in self.differences)
        return missing or len(self.differences)


def label(line: str) -> str:
    """Return the label of a line: ``name`` of ``name: 'n'``, all but the message of a log line."""
    return line.strip().partition(": ")[0]


def compare(real: str, ours: str, unsteady: Iterable[str] = ()) -> Comparison:
    """Compare two transcripts but for the lines whose labels are not steady in the real one."""
    left_out = {label(line) for line in unsteady}
    a, b = ([line for line in text.splitlines() if label(line) not in left_out] for text in (real, ours))
    missing, more = _changes(a, b)
    texts, differences = 0, []
    for line in missing:
        partner = _partner(line, more)
        if partner is not None:
            more.remove(partner)
            if _same_but_for_text(line, partner):
                texts += 1
                continue
        differences.append(Difference(label(line), line, partner))
    differences += [Difference(label(line), None, line) for line in more]
    return Comparison(sum(not line.startswith(("--- stdout", "--- stderr")) for line in a), texts, differences)


def unsteady(first: str, others: Iterable[str]) -> list[str]:
    """Return the lines of several transcripts of one program that are not in all of them."""
    found: list[str] = []
    for other in others:
        for lines in _changes(first.splitlines(), other.splitlines()):
            found += [line for line in lines if line not in found]
    return found


def _changes(a: list[str], b: list[str]) -> tuple[list[str], list[str]]:
    matcher = difflib.SequenceMatcher(None, a, b, autojunk=False)
    changed = [codes for codes in matcher.get_opcodes() if codes[0] != "equal"]
    return [line for code in changed for line in a[code[1] : code[2]]], [
        line for code in changed for line in b[code[3] : code[4]]
    ]


def _partner(line: str, others: list[str]) -> str | None:
    """Return the line of the same label: one that differs in its text alone first."""
    same = [other for other in others if label(other) == label(line)]
    return next((other for other in same if _same_but_for_text(line, other)), same[0] if same else None)


def _same_but_for_text(real: str, ours: str) -> bool:
    if real == ours:
        return False  # it is printed at another place
    if _LOGGED.match(real):
        return True  # the same severity and logger: the label has both
    if _REASON.sub(r"\1...", real) == _REASON.sub(r"\1...", ours):
        return True
    if "attr" in label(real) and real.endswith("]"):
        return _names(real) <= _names(ours)
    return (errors := _errors(real)) is not None and errors <= (_errors(ours) or set())


def _errors(line: str) -> set[str] | None:
    """Return the classes by which the error of a line is caught: its own name, and those of its bases."""
    found = _RAISES.search(line)
    return None if found is None else {found["name"], *filter(None, (found["bases"] or "").split(","))}


def _names(line: str) -> set[str]:
    return set(ast.literal_eval(line.partition(": ")[2]))
