"""Benchmarks of messages: each row runs and hands in figures of every player. How high they are is not tested."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
SCRIPT = BENCHMARKS / "messaging.py"


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


@pytest.mark.processes
@pytest.mark.parametrize(
    ("game", "players"),
    [
        ("twist", ["robolink", "build", "bare"]),
        ("flood-10", ["robolink", "build"]),
        ("beat", ["robolink", "build", "bare"]),
        ("start", ["robolink", "build", "bare"]),
        ("follow", ["robolink", "build"]),
        ("fifty", ["robolink", "build"]),
    ],
)
def test_a_row_of_record_has_figures_of_all_who_are_there(game: str, players: list[str], tmp_path: Path) -> None:
    file = tmp_path / "record.json"
    command = [sys.executable, str(BENCHMARKS / "peers.py"), "--quick", "--json", str(file), "--build", sys.executable]
    subprocess.run([*command, "--only", game, "--peers", "none"], check=True, timeout=100)
    found = json.loads(file.read_text(encoding="utf-8"))
    assert list(found["rows"][game]) == players
    assert all(figure > 0 for figure in found["medians"][game].values())
    assert found["failed"] == {}
    assert set(found["missing"]) == {"rclpy", "sdk", "dora", "zeromq"}
