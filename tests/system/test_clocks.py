"""Python's clocks go in steps of 15.6 ms on Windows, before 3.13; nothing here goes by them."""

from __future__ import annotations

import ast
import re
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import robolink
from robolink.system import clocks

PACKAGE = Path(robolink.__file__).parent

COARSE = {"time", "time_ns", "monotonic", "monotonic_ns"}
"""Clocks of Python that have these steps; `perf_counter` has not."""

LIKELY = re.compile(r"\btime\b.*\b(time|monotonic)|\bdatetime\b.*\b(now|utcnow|today)\b")
"""What a source has that names such a clock: parsing all of them takes seconds."""

ALLOWED = {
    "system/clocks.py",  # it has what is finer, where there is
    "host/patches/clocks.py",  # it replaces them for programs in virtual time
    "supervisor/processes/guardian.py",  # it is a program of its own, and not on Windows
    "grading/keeper.py",  # the same
    "rtps/participant.py",  # it knows nothing of robolink, and samples of topics come with their time
}


@pytest.mark.parametrize("shown", [-1, -(10**18)])
def test_a_date_before_1970_is_1970(shown: int) -> None:
    dates = [shown]
    now = clocks.from_1970(lambda: dates[0])
    assert now() == 0
    dates[0] = 17  # somebody sets the clock
    assert now() == 17


def coarse_clocks(source: str) -> Iterator[int]:
    """Yield the lines that name such a clock."""
    if not LIKELY.search(source):
        return
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            if node.value.id == "time" and node.attr in COARSE:
                yield node.lineno
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Attribute):
            if node.value.attr == "datetime" and node.attr in ("now", "utcnow", "today"):
                yield node.lineno
        elif isinstance(node, ast.ImportFrom) and node.module == "time":
            yield from (node.lineno for each in node.names if each.name in COARSE)


def test_nothing_reads_a_coarse_clock() -> None:
    files = {each.relative_to(PACKAGE).as_posix(): each for each in PACKAGE.rglob("*.py")}
    found = [f"{name}:{line}" for name, file in files.items() for line in coarse_clocks(file.read_text("utf-8"))]
    assert {each.partition(":")[0] for each in found} <= ALLOWED, found


@pytest.mark.parametrize(
    "line",
    [
        "time.time()",
        "clock = time.monotonic",
        "time.time_ns()",
        "from time import monotonic_ns",
        "datetime.datetime.now()",
    ],
)
def test_a_coarse_clock_is_seen(line: str) -> None:
    assert list(coarse_clocks(line)) == [1]


def test_the_clocks_in_seconds_are_those_in_nanoseconds() -> None:
    assert clocks.monotonic() == pytest.approx(clocks.steady() / 1e9, abs=1.0)
    assert clocks.time_of_day() == pytest.approx(clocks.now() / 1e9, abs=1.0) == pytest.approx(time.time(), abs=1.0)
