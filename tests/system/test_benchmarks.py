"""Benchmark of messages: each row runs and hands in figures of every contender. How high they are is not tested."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "benchmarks" / "messaging.py"


@pytest.mark.processes
@pytest.mark.parametrize(
    ("row", "contenders"),
    [
        ("twist", ["bare", "spin", "once"]),
        ("1mb", ["bare", "same", "spin", "once"]),
        ("flood-scan", ["bare", "spin"]),
        ("inside", ["copy", "memory", "zenoh"]),
        ("call", ["querier", "future", "call"]),
    ],
)
def test_a_row_has_figures_of_all(row: str, contenders: list[str], tmp_path: Path) -> None:
    file = tmp_path / "figures.json"
    command = [sys.executable, str(SCRIPT), "--only", row, "--rounds", "1", "--seconds", "0.05", "--json", str(file)]
    subprocess.run(command, check=True, timeout=100)
    figures = json.loads(file.read_text(encoding="utf-8"))[row]
    assert list(figures) == contenders
    assert all(each["median"] > 0 for each in figures.values())
