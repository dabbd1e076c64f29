"""The table of differences in docs/reference/rclpy.md: lines that may differ from the real rclpy, and why."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from tests.judge.comparison import Difference

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "rclpy.md"
REASONS = ("By design", "The real one is worse", "Not yet")

_TABLE = re.compile(r"<!-- differences: from here on -->(.*)<!-- differences: to here -->", re.DOTALL)
_CELL = re.compile(r"(?<!\\)\|")


@dataclass(frozen=True)
class Row:
    """A row: a program, the labels of its lines that differ (``*`` stands for anything), and the reason."""

    program: str
    labels: tuple[str, ...]
    reason: str

    def unused(self, differences: list[Difference]) -> list[str]:
        """Return the labels of which no difference is left."""
        return [label for label in self.labels if not any(_fits(label, each.label) for each in differences)]

    def covers(self, difference: Difference) -> bool:
        return any(_fits(label, difference.label) for label in self.labels)


def rows(page: Path = PAGE) -> list[Row]:
    """Return the rows of the table.

    Raises:
        ValueError: A row is not three cells, has no labels in backticks, or its reason begins with no known words.
    """
    found = _TABLE.search(page.read_text(encoding="utf-8"))
    if found is None:
        raise ValueError(f"{page} has no table of differences")
    return [_row(line) for line in found[1].strip().splitlines()[2:]]


def _row(line: str) -> Row:
    cells = [cell.strip().replace("\\|", "|") for cell in _CELL.split(line.strip().strip("|"))]
    if len(cells) != 3:
        raise ValueError(f"a row of the table of differences has {len(cells)} cells, not 3: {line}")
    labels = tuple(re.findall(r"`([^`]+)`", cells[1]))
    if not labels or not cells[2].startswith(tuple(f"**{reason}**" for reason in REASONS)):
        raise ValueError(f"a row names lines in `backticks`, and begins its reason with one of {REASONS}: {line}")
    return Row(cells[0].strip("`"), labels, cells[2])


def _fits(pattern: str, text: str) -> bool:
    return re.fullmatch(re.escape(pattern).replace(r"\*", ".*"), text) is not None
