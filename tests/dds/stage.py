"""Parts of a system with a real ROS 2 on DDS, started in any order: how soon messages go both ways.

    python -m tests.dds.stage [--count 20] [--killed] [--ways direct bridge] [--distributions kilted jazzy]

It prints the seconds from the moment when the last part is ready; with --killed, after each part was killed and started
again. It ends with 1 if any took longer than it should.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from tests.dds.conftest import PROGRAMS, Lab
from tests.dds.peers import Peer, until
from tests.support.commands import Command
from tests.support.domains import free_dds_domain

STRING = "std_msgs/msg/String"
EXCHANGED_WITHIN, BACK_WITHIN = 1.5, 2.0
"""Limits on a quiet machine, in s."""


class Stage:
    """Parts of a system by their names, each started when the test says so."""

    def __init__(self, lab: Lab, distribution: str, way: str) -> None:
        self.lab, self.distribution, self.way = lab, distribution, way
        self.parts: dict[str, Peer | Command] = {}
        self._stack = contextlib.ExitStack()
        self._serial = 0

    def start(self, part: str) -> None:
        makers: dict[str, Callable[[], Peer | Command]] = {
            "real": lambda: self.lab.real(self.distribution),
            "ours": self.lab.direct if self.way == "direct" else self.lab.beside,
            "bridge": self.lab.bridge,
        }
        made: Peer | Command = makers[part]()
        self._stack.callback(made.__exit__, None, None, None)
        self.parts[part] = made
        if isinstance(made, Peer):
            made.ready()
            other = "ours" if part == "real" else "real"
            made.ask("publisher", topic=f"of_{part}", type_name=STRING)
            made.ask("subscription", topic=f"of_{other}", type_name=STRING)
        else:
            made.wait_for("")

    def kill(self, part: str) -> None:
        self.parts[part].kill()

    def peer(self, part: str) -> Peer:
        found = self.parts[part]
        assert isinstance(found, Peer)
        return found

    def exchanged(self, within: float) -> float:
        """Wait until messages arrive on both sides that are sent from now on; return how long that takes, in s."""
        begun = time.monotonic()
        self._serial += 1000

        def both() -> bool:
            self._serial += 1
            came = []
            for sender, receiver in (("real", "ours"), ("ours", "real")):
                self.peer(sender).ask("publish", topic=f"of_{sender}", first=self._serial)
                came.append(any(each["at"] > begun for each in self.peer(receiver).events(f"of_{sender}")))
            return all(came)

        until(both, "messages both ways", within)
        return time.monotonic() - begun

    def __enter__(self) -> Stage:
        return self

    def __exit__(self, *exception: object) -> None:
        self._stack.close()


def scenes(ways: Sequence[str], killed: bool) -> Iterator[tuple[str, Sequence[str], str]]:
    """Yield each way with each order of its parts; or with each part that is killed."""
    for way in ways:
        parts = ("real", "ours") if way == "direct" else ("real", "bridge", "ours")
        if killed:
            yield from ((way, parts, part) for part in parts)
        else:
            yield from ((way, order, "") for order in itertools.permutations(parts))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--killed", action="store_true")
    parser.add_argument("--ways", nargs="+", default=["direct", "bridge"])
    parser.add_argument("--distributions", nargs="+", default=["kilted", "jazzy"])
    requested = parser.parse_args()
    limit, late = BACK_WITHIN if requested.killed else EXCHANGED_WITHIN, 0
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(PROGRAMS, folder, dirs_exist_ok=True)
        for distribution in requested.distributions:
            for way, order, part in scenes(requested.ways, requested.killed):
                took = [once(Path(folder), distribution, way, order, part) for _ in range(requested.count)]
                late += sum(each > limit for each in took)
                what = f"{part} killed and started again" if part else " then ".join(order)
                figures = " ".join(f"{each:.2f}" for each in sorted(took))
                sys.stdout.write(f"{distribution}, {way}, {what}: {figures}\n")
                sys.stdout.flush()
    sys.exit(bool(late))


def once(folder: Path, distribution: str, way: str, order: Sequence[str], part: str) -> float:
    """Start all parts, and kill one and start it again; return how long it took from then on, in s."""
    with free_dds_domain() as domain, Stage(Lab(domain, folder), distribution, way) as stage:
        for each in order:
            stage.start(each)
        took = stage.exchanged(20.0)
        if not part:
            return took
        stage.kill(part)
        stage.start(part)
        return stage.exchanged(20.0)


if __name__ == "__main__":
    main()
