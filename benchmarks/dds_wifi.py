"""A robot and a laptop across Wi-Fi: the same rclpy programs over DDS, over Zenoh, and with both, by turns.

    python benchmarks/dds_wifi.py REAL                              # all contenders at 1 % and 3 % loss: half an hour
    python benchmarks/dds_wifi.py REAL --loss 1 --with real,bridge --only twist,scan --rounds 3

REAL is a Python with rclpy and Fast DDS, as benchmarks/peers.py --install installs one.
The network is tests/support/wireless.py: two network namespaces, 3 ms +- 2 ms, 30 Mbit/s each way, frames lost
evenly. Only inside of them do real nodes have their default range, SUBNET. Linux, root.

Contenders: `real` is DDS from end to end, `tuned` the same with what ROS 2's documentation says of lossy links (the
kernel's ipfrag_time and ipfrag_high_thresh), `ours` robolink with `--network dds` at both ends, `zenoh` robolink with
`--network lan`. In `bridge` the robot has real nodes on loopback and `robolink bridge dds --network lan`, the laptop
robolink. In `direct` the robot has real nodes as they are, the laptop robolink with `--network dds`; in `far-bridge`
the laptop has the bridge, which speaks DDS across the air, and robolink on `localhost`.

Rows: `twist` goes to the robot at 20 Hz, `scan` (8.7 kB) and `image` (300 kB, so 24 Mbit/s) come at 10 Hz, each
BEST_EFFORT and RELIABLE; `jpeg` is 40 kB; `both` is `twist` beside a RELIABLE `image`; `call` is a service of the
robot. `found` is the time from the start of the laptop's program, Python's imports apart, to the first message and the
first answer. A row says how many came of how many, how late from publish to callback, and what was on the air.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple, TypeAlias

sys.path.append(str(Path(__file__).resolve().parent.parent))

from benchmarks.messages.wifi_end import PROGRAM
from tests.support.wireless import INTERFACE, Air, Link, missing, wireless

DOMAIN = "97"
Figures: TypeAlias = "list[dict[str, Any]]"
PATIENCE = 20.0
LAST = 4.0
"""Seconds for which messages may still come after the last was sent."""


class Stream(NamedTuple):
    """Messages of one topic."""

    kind: str
    size: int
    rate: float
    reliable: bool
    to_robot: bool = False

    @property
    def words(self) -> dict[str, Any]:
        """Options of its two ends."""
        return {"kind": self.kind, "topic": f"/{self.kind}_{self.reliable}", "reliable": self.reliable}


TWIST = Stream("twist", 0, 20, True, to_robot=True)
IMAGE = Stream("image", 300_000, 10, True)
STREAMS = {
    "twist": [TWIST],
    "scan BEST_EFFORT": [Stream("scan", 1080, 10, False)],
    "scan RELIABLE": [Stream("scan", 1080, 10, True)],
    "image BEST_EFFORT": [IMAGE._replace(reliable=False)],
    "image RELIABLE": [IMAGE],
    "jpeg BEST_EFFORT": [Stream("image", 40_000, 10, False)],
    "jpeg RELIABLE": [Stream("image", 40_000, 10, True)],
    "both": [TWIST, IMAGE],
}


class Contender(NamedTuple):
    """Programs on the robot and on the laptop; a bridge is beside the program."""

    name: str
    robot: dict[str, str]
    laptop: dict[str, str]
    robot_is_real: bool = True
    laptop_is_real: bool = False
    bridge: str = ""
    """The machine that has one: 'robot' or 'laptop'."""
    bridge_words: tuple[str, ...] = ()
    bridge_environ: Mapping[str, str] = MappingProxyType({})
    is_tuned: bool = False
    """Both kernels have room for parts of datagrams, and forget them soon."""


LAN = {"ROBOLINK_NETWORK": "lan", "ROBOLINK_SHARED_MEMORY": "off"}
"""Without shared memory, which two namespaces of one machine have and two machines do not."""
SUBNET = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
DDS = {"ROBOLINK_NETWORK": "dds", **SUBNET}
TUNED = "echo 3 >/proc/sys/net/ipv4/ipfrag_time; echo 134217728 >/proc/sys/net/ipv4/ipfrag_high_thresh"
LOOPBACK = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
CONTENDERS = (
    Contender("real", SUBNET, SUBNET, laptop_is_real=True),
    Contender("tuned", SUBNET, SUBNET, laptop_is_real=True, is_tuned=True),
    Contender("ours", DDS, DDS, robot_is_real=False),
    Contender("zenoh", LAN, LAN, robot_is_real=False),
    Contender("bridge", LOOPBACK, LAN, bridge="robot", bridge_environ=LAN),
    Contender("direct", SUBNET, DDS),
    Contender("far-bridge", SUBNET, {}, bridge="laptop", bridge_words=("--interface", INTERFACE)),
)


class End:
    """The program on one machine, which obeys."""

    def __init__(self, stack: ExitStack, command: list[str], environ: dict[str, str]) -> None:
        self.begun = time.monotonic()
        pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        self._process = stack.enter_context(subprocess.Popen(command, env=environ, **pipes))
        stack.callback(self._process.kill)

    def tell(self, **words: Any) -> None:
        print(json.dumps(words), file=self._process.stdin, flush=True)

    def answer(self) -> Any:
        assert self._process.stdout
        text = self._process.stdout.readline()
        if not text:
            raise RuntimeError("an end is gone")
        return json.loads(text)

    def ask(self, **words: Any) -> Any:
        self.tell(**words)
        return self.answer()


class Game:
    """One contender across one network."""

    def __init__(self, stack: ExitStack, each: Contender, link: Link, real: str, program: str) -> None:
        self._stack, self._each, self._link, self._real, self._program = stack, each, link, real, program
        for machine in ("robot", "laptop") if each.is_tuned else ():
            subprocess.run([*self._on(machine), "sh", "-c", TUNED], check=True)
        if each.bridge:
            self._start_bridge()
        self.robot = self._start("robot")
        self.laptop: End

    def _environ(self, own: Mapping[str, str]) -> dict[str, str]:
        clean = {name: each for name, each in os.environ.items() if not name.startswith(("ROS_", "ZENOH_", "ROBOLINK"))}
        return {**clean, "ROS_DOMAIN_ID": DOMAIN, "ROBOLINK_WORKSPACE": "", **own}

    def _on(self, machine: str) -> list[str]:
        return ["ip", "netns", "exec", getattr(self._link, machine)]

    def _start_bridge(self) -> None:
        machine = self._each.bridge
        command = [*self._on(machine), sys.executable, "-m", "robolink", "bridge", "dds", *self._each.bridge_words]
        quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        process = self._stack.enter_context(
            subprocess.Popen(command, env=self._environ(self._each.bridge_environ), **quiet)
        )
        self._stack.callback(process.terminate)

    def _start(self, machine: str, stack: ExitStack | None = None) -> End:
        is_real = self._each.robot_is_real if machine == "robot" else self._each.laptop_is_real
        python = [self._real] if is_real else [sys.executable, "-m", "robolink", "run"]
        own = self._each.robot if machine == "robot" else self._each.laptop
        command = [*self._on(machine), *python, self._program, machine]
        return End(stack or self._stack, command, self._environ(own))

    def found(self) -> dict[str, float]:
        """Start the program on the laptop; returns after how many seconds it has heard, and has an answer."""
        with ExitStack() as stack:
            return self._meet(self._start("laptop", stack))

    def _meet(self, laptop: End) -> dict[str, float]:
        found: dict[str, float] = laptop.ask(do="meet", patience=PATIENCE)
        return found

    def start_laptop(self) -> None:
        """Start the program on the laptop, which stays."""
        self.laptop = self._start("laptop")
        self._meet(self.laptop)

    def streams(self, streams: Sequence[Stream], seconds: float) -> Figures:
        """Have these at the same time; returns the figures of each."""
        ends = [(self.laptop, self.robot) if each.to_robot else (self.robot, self.laptop) for each in streams]
        for each, (_, reader) in zip(streams, ends, strict=True):
            reader.ask(do="listen", **each.words)
        for each, (writer, _) in zip(streams, ends, strict=True):
            writer.ask(do="advertise", size=each.size, **each.words)
        time.sleep(2.0)  # both ends of all are known everywhere
        self._link.passed()
        begun = time.monotonic()
        for each, (writer, _) in zip(streams, ends, strict=True):
            writer.tell(do="publish", count=int(seconds * each.rate), rate=each.rate, **each.words)
        for writer, _ in ends:
            writer.answer()
        found = []
        for each, (writer, reader) in zip(streams, ends, strict=True):
            sent = int(seconds * each.rate)
            late = reader.ask(do="heard", last=sent - 1, patience=LAST, **each.words)
            writer.ask(do="retire", **each.words)
            found.append({"sent": sent, "got": len(late), "late": late})
        passed = self._link.passed()
        air = 8e-6 * passed.bytes / (time.monotonic() - begun)
        return [each | {"air": air} for each in found]

    def calls(self, count: int) -> dict[str, Any]:
        """Call the robot's service so often, one after the other."""
        late = self.laptop.ask(do="call", count=count, patience=5.0)
        return {"sent": count, "got": len(late), "late": late, "air": 0.0}


def play(each: Contender, row: str, air: Air, options: argparse.Namespace, program: str) -> dict[str, Figures]:
    """Have one contender play a row once, on a network of its own; returns figures by row."""
    # Its own: what a row has lost fills the kernel's memory for parts of datagrams for 30 s.
    with wireless(air) as link, ExitStack() as stack:
        game = Game(stack, each, link, options.real, program)
        if row == "found":
            return {row: [game.found() for _ in range(options.starts)]}
        game.start_laptop()
        if row == "call":
            return {row: [game.calls(options.calls)]}
        figures = game.streams(STREAMS[row], options.seconds)
        names = [row] if len(figures) == 1 else [f"{row}: {stream.kind}" for stream in STREAMS[row]]
        return {name: [figure] for name, figure in zip(names, figures, strict=True)}


def said(row: str, figures: Figures) -> str:
    """Return a row's figures of all rounds in words."""
    if row == "found":
        heard, answered = ([each[name] for each in figures] for name in ("heard", "answered"))
        return f"heard {_spread(heard)} s, answered {_spread(answered)} s"
    got, sent = (sum(each[name] for each in figures) for name in ("got", "sent"))
    late = sorted(1000 * each for figure in figures for each in figure["late"])
    ranks = [late[int(share * (len(late) - 1))] for share in (0.5, 0.95, 1.0)] if late else [0.0] * 3
    air = statistics.median(each["air"] for each in figures)
    times = "median {:.1f}, p95 {:.0f}, worst {:.0f} ms".format(*ranks)
    return f"{got}/{sent}, {times}" + (f", air {air:.2f} Mbit/s" if air else "")


def _spread(seconds: Sequence[float]) -> str:
    return f"{statistics.median(seconds):.2f} ({min(seconds):.2f}-{max(seconds):.2f})"


def options_of(words: Sequence[str]) -> argparse.Namespace:
    """Return the requested options."""
    rows = ("found", "call", *STREAMS)
    split: Callable[[str], list[str]] = lambda text: text.split(",")  # noqa: E731
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real")
    parser.add_argument("--loss", type=float, action="append", help="percent; may be given several times")
    parser.add_argument("--with", dest="names", type=split, default=[each.name for each in CONTENDERS])
    parser.add_argument(
        "--only", type=split, default=[], help=f"starts of rows, with commas between: {', '.join(rows)}"
    )
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=5.0, help="of each stream")
    parser.add_argument("--starts", type=int, default=3, help="of the laptop's program in a round, for `found`")
    parser.add_argument("--calls", type=int, default=50)
    parser.add_argument("--json", type=Path, help="file to which all figures are written as well")
    options = parser.parse_args(words)
    options.rows = [row for row in rows if not options.only or row.startswith(tuple(options.only))]
    return options


def main(words: Sequence[str]) -> None:
    """Measure."""
    options = options_of(words)
    if reason := missing():
        sys.exit(reason)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that the namespaces go
    players = [each for each in CONTENDERS if each.name in options.names]
    figures: dict[str, dict[str, dict[str, Figures]]] = {}
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, "end.py")
        program.write_text(PROGRAM, encoding="utf-8")
        turns = itertools.product(range(options.rounds), options.loss or (1.0, 3.0), options.rows, players)
        for round_, loss, row, each in turns:
            found = play(each, row, Air(loss=loss / 100, seed=round_), options, str(program))
            for name, rounds in found.items():
                figures.setdefault(f"{loss:g} %", {}).setdefault(name, {}).setdefault(each.name, []).extend(rounds)
                print(f"{loss:g} % {name:18} {each.name:10} {said(name, rounds)}", flush=True)
    for loss_, by_row in figures.items():
        print(f"\n{loss_} lost, {options.rounds} rounds by turns")
        for name, by_contender in by_row.items():
            for contender, rounds in by_contender.items():
                print(f"  {name:18} {contender:10} {said(name, rounds)}")
    if options.json:
        options.json.write_text(json.dumps(figures), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
