"""Benchmarks of messages: each row runs and hands in figures of every player. How high they are is not tested."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.messages.running import Contender, GameError
from benchmarks.peers import Record, measure
from benchmarks.record.players import Field, Player
from benchmarks.record.rows import Figures, Game, Options, Turn

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


def test_a_player_that_fails_once_goes_on_and_one_that_fails_twice_is_out(tmp_path: Path) -> None:
    turns: list[str] = []

    def play(turn: Turn) -> Figures:
        turns.append(turn.player.name)
        if turn.player.name == "bad" or (turns.count("robolink") == 1 and turn.player.name == "robolink"):
            raise GameError("it did not start")
        return {"twist": 5.0}

    players = {name: Player(name, name, Contender(name, "nodes"), ()) for name in ("robolink", "bad")}
    there = Field(players, {}, {"bare": "not there"})
    record = Record(tmp_path / "record.json", there, keep=False)
    measure(Game("twist", ("robolink", "bad", "bare"), play), there, record, 4, Options())
    found = json.loads((tmp_path / "record.json").read_text(encoding="utf-8"))
    assert turns == ["robolink", "bad", "robolink", "bad", "robolink", "robolink"]
    assert found["rows"] == {"twist": {"robolink": [5.0, 5.0, 5.0]}}
    assert found["failed"] == {"twist": dict.fromkeys(("robolink", "bad"), "GameError: it did not start")}
    assert found["missing"] == {"bare": "not there"}
