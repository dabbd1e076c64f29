"""The benchmark of record: robolink beside every peer that is installed, by turns, into one file and the pages' tables.

    python benchmarks/peers.py --install          # all rows beside all peers, which it installs first: some 12 minutes
    python benchmarks/peers.py                    # beside those that are installed where this Python is: bare Zenoh
    python benchmarks/peers.py --only twist --only start --rounds 3 --build ../other/.venv/bin/python
    python benchmarks/peers.py --quick            # whether all of it runs
    python benchmarks/peers.py --write            # the pages again, from the file

A whole run writes benchmarks/record.json, and from it the tables of README.md, README.pt-BR.md, of
docs/reference/performance.md and of benchmarks/notes/record.md; with --only or --quick it writes build/record.json
alone (--json names another file). The file is written after each row; a player that fails twice is out of that row; the
reasons are in the file.

Each end of a conversation has a core of its own where there are two, all goes over loopback in a domain that nobody
else uses, and players take turns within a row: figures of one machine at one moment mean little, ratios of medians
carry over. Close other programs first. What each row is says benchmarks/record/rows.py.

--real is a Python with a real rclpy, --peers one with zenoh-ros2-sdk, dora, pyzmq and msgspec, --build one with another
build of robolink, each an environment of its own.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT))

from benchmarks.messages.running import GameError  # noqa: E402
from benchmarks.record import pages  # noqa: E402
from benchmarks.record.machine import machine  # noqa: E402
from benchmarks.record.players import Field, field  # noqa: E402
from benchmarks.record.rows import GAMES, Game, Options, Turn  # noqa: E402

RECORD, SCRATCH = ROOT / "benchmarks" / "record.json", ROOT / "build" / "record.json"
PACKAGES = ("zenoh-ros2-sdk==0.1.8", "dora-rs==1.1.0", "dora-rs-cli==1.1.0", "pyzmq==27.3.0", "msgspec")
"""Peers that --install installs into an environment of their own."""


class Record:
    """The file: figures of each row, by player and round."""

    def __init__(self, file: Path, there: Field, keep: bool) -> None:
        self._file = file
        old = json.loads(file.read_text(encoding="utf-8")) if keep and file.exists() else {}
        self.found: dict[str, Any] = {"rows": {}, "failed": {}, "seconds": {}} | old
        self.found |= {"date": time.strftime("%Y-%m-%d"), "machine": machine()}
        self.found |= {"versions": there.versions, "missing": there.missing}

    def forget(self, game: Game) -> None:
        """Drop the figures of earlier runs."""
        rows: dict[str, Any] = self.found["rows"]
        for row in [row for row in rows if row.split("/")[0] in game.rows]:
            del rows[row]
        self.found["failed"].pop(game.name, None)

    def add(self, player: str, figures: dict[str, float]) -> None:
        for row, figure in figures.items():
            self.found["rows"].setdefault(row, {}).setdefault(player, []).append(float(f"{figure:.5g}"))

    def fail(self, game: Game, player: str, reason: str) -> None:
        self.found["failed"].setdefault(game.name, {})[player] = reason

    def write(self) -> None:
        rows = self.found["rows"]
        self.found["medians"] = {
            row: {player: statistics.median(figures) for player, figures in rows[row].items()} for row in rows
        }
        self._file.parent.mkdir(parents=True, exist_ok=True)
        self._file.write_text(json.dumps(self.found, indent=1) + "\n", encoding="utf-8")


def measure(game: Game, there: Field, record: Record, rounds: int, options: Options) -> None:
    """Play a game by turns; who fails twice is out of it, since once may be the machine's doing."""
    failures: Counter[str] = Counter()
    begun = time.monotonic()
    for _ in range(rounds):
        for name in game.players:
            player = there.players.get(name)
            if player is None or failures[name] > 1:
                continue
            try:
                if game.needs and game.needs not in there.players:
                    raise GameError(f"needs {game.needs}")
                record.add(name, game.play(Turn(game.name, player, there.players, options)))
                record.write()
            except (GameError, OSError, ValueError, subprocess.SubprocessError) as error:
                failures[name] += 1
                record.fail(game, name, f"{type(error).__name__}: {error}")
                print(f"  {name}: {error}", flush=True)
    record.found["seconds"][game.name] = round(time.monotonic() - begun, 1)
    record.write()
    print(pages.lines(record.found, game.rows), flush=True)


def pythons(requested: argparse.Namespace) -> dict[str, str | None]:
    """Return the Pythons of the players, installed if that is requested."""
    given = {"build": requested.build, "real": requested.real, "peers": requested.peers}
    if requested.install:
        from tests.judge.wheels import KILTED, Distribution, NoWheelsError, interpreter

        peers = Distribution("peers", PACKAGES, "import zenoh_ros2_sdk, dora, zmq")
        for option, distribution in (("real", KILTED), ("peers", peers)):
            try:
                given[option] = given[option] or interpreter(distribution=distribution)[0]
            except NoWheelsError as reason:
                print(f"{distribution.name} cannot be installed: {reason}")
    return given


def options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", action="append", choices=[each.name for each in GAMES], help="a row, or several")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--quick", action="store_true", help="one short round")
    parser.add_argument("--install", action="store_true", help="install the peers, in the temporary folder")
    for name in ("real", "peers", "build"):
        parser.add_argument(f"--{name}", metavar="PYTHON")
    parser.add_argument("--json", type=Path, help="the file")
    parser.add_argument("--append", action="store_true", help="add the rounds to those of the file")
    parser.add_argument("--write", action="store_true", help="write the pages from the file, without measuring")
    return parser.parse_args(arguments)


def main(arguments: Sequence[str]) -> int:
    requested = options(arguments)
    whole = not requested.only and not requested.quick
    file = requested.json or (RECORD if whole else SCRATCH)
    if not requested.write:
        there = field(pythons(requested))
        for name, reason in there.missing.items():
            print(f"without {name}: {reason}")
        record = Record(file, there, keep=bool(requested.only) or requested.append)
        games = [each for each in GAMES if not requested.only or each.name in requested.only]
        for game in games:
            if not requested.append:
                record.forget(game)
            measure(game, there, record, 1 if requested.quick else requested.rounds, Options(requested.quick))
    if requested.write or file == RECORD:
        pages.write(ROOT, json.loads(file.read_text(encoding="utf-8")))
    return 0


if __name__ == "__main__":
    os.environ.pop("ROBOLINK_NETWORK", None)
    sys.exit(main(sys.argv[1:]))
