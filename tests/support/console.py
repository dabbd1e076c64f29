"""Comparison of a command's output with what a page shows: wildcards, and numbers that each run has anew."""

from __future__ import annotations

import re
from collections.abc import Sequence

STAMP = re.compile(r"\\\[\d+\\\.\d+\\\]")
"""A log line's time stamp, in a pattern whose characters are escaped."""
COLUMNS = re.compile(r" *\d+\.\d s  (?P<severity>[A-Z ]{5}) (?P<name>\S+) +(?P<text>.*)")
"""Line of a launch as a terminal has it; a pipe has its parts in brackets."""
PACE = re.compile(r"in\\ [\d\\.]+\\ s,\\ \d+\\ times")
"""How fast a simulation was."""
DECIMAL = re.compile(r"(?<![\w.])\d+\\\.\d+")


def pattern_of(line: str, exact: bool) -> str:
    """Return the regular expression of a shown line: `...` stands for anything, and a time stamp for any other.

    A page shows what a launch writes to a terminal, and the output that is compared comes through a pipe.

    Args:
        line: What the page shows.
        exact: False if any number with a point may stand where the page has one: a robot in real time is elsewhere.
    """
    if (columns := COLUMNS.fullmatch(line)) is not None:
        severity, name, text = columns.groups()
        is_logged = severity.strip() and name != "launch"
        log = f"[{severity.strip()}] [1.5] [{name.replace('/', '.')}]: " if is_logged else ""
        line = f"[{name}] {log}{text}"
    escaped = re.escape(line.rstrip()).replace(r"\.\.\.", ".*")
    escaped = PACE.sub(r"in \\d+\\.\\d+ s, \\d+ times", escaped)
    escaped = STAMP.sub(r"\\[\\d+\\.\\d+\\]", escaped)
    return escaped if exact else DECIMAL.sub(r"\\d+\\.\\d+(?:e-?\\d+)?", escaped)


def stripped(lines: Sequence[str]) -> list[str]:
    """Return lines without the empty ones at the end."""
    return "\n".join(lines).rstrip("\n").split("\n")


def fits(shown: Sequence[str], lines: Sequence[str], *, exact: bool = True, whole: bool = True) -> bool:
    """Return True if an output is what a page shows; a line of `...` alone stands for any lines, even none.

    Args:
        shown: Lines of the page.
        lines: Lines of the output.
        exact: See `pattern_of`.
        whole: False if more may come before and after, as while a command runs.
    """
    wanted = ["..."] * (not whole) + stripped(shown) + ["..."] * (not whole)
    lines = stripped(lines)
    reached = {0}
    for line in wanted:
        if line.strip() == "...":
            reached = set(range(min(reached), len(lines) + 1))
            continue
        pattern = re.compile(pattern_of(line, exact))
        reached = {at + 1 for at in reached if at < len(lines) and pattern.fullmatch(lines[at].rstrip())}
        if not reached:
            return False
    return len(lines) in reached
