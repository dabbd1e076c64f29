"""Starts the two processes of a game, each on its own core, and reads their figures."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import socket
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

PACKAGE = Path(__file__).parent

SILENCE = 0.4
"""Seconds without a message after which a flood has passed."""

LONGEST = 60.0
"""Seconds after which a process is killed that has not ended its game."""

PIN = True
"""True to keep each end on its own core; else the system places them as it does in daily use."""

ALONE = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROBOLINK_WORKSPACE": ""}
"""Variables of all: nothing leaves this machine, and nobody's own message files are read."""

SHM_OFF = "transport/shared_memory/enabled=false"
CONFIG = "ROBOLINK_BENCH_CONFIG"
"""Variable with the settings of a bare session of Zenoh."""


class Contender(NamedTuple):
    """Somebody who plays: a module of this package, and its way of doing it."""

    name: str
    module: str
    variant: str = ""
    needs: str = ""
    """Distribution's module without which it is left out."""
    shared_memory: bool = True
    path: str = ""
    """Folder of another robolink, to measure two versions by turns."""
    python: str = sys.executable
    """Python by which it plays."""
    environ: tuple[tuple[str, str], ...] = ()
    """Variables of its own."""


class Flood(NamedTuple):
    """Figures of a flood."""

    rate: float
    """Messages received in a second, from the first to the last."""
    lost: float
    """Share of what was sent that did not come to the callback."""
    wrong: int
    """Messages that came out of order, twice or not as they were sent."""


class Alone(NamedTuple):
    """Figures of a process with one node."""

    seconds: float
    """From before its imports to when another process knew its node."""
    used: float
    """Processor time of its own until the node was made, in seconds."""
    memory: float | None
    """Megabytes when it idles."""


class GameError(Exception):
    """A process has ended without its figures."""


def round_trips(contender: Contender, kind: str, seconds: float, other: Contender | None = None) -> float:
    """Return the median of a game's round trips in microseconds; `other` answers, if it is not one more of the same."""
    with process(other or contender, "pong", kind, seconds, core=1) as pong:
        expect_ready(pong)
        with process(contender, "ping", kind, seconds, core=0) as ping:
            return float(statistics.median(answer(ping)))


def flood(contender: Contender, kind: str, seconds: float) -> Flood:
    """One process sends for so long as fast as it goes, and another counts."""
    with process(contender, "sink", kind, seconds, core=1) as sink:
        expect_ready(sink)
        with process(contender, "source", kind, seconds, core=0) as source:
            sent, before = answer(source), -1
            figures: list[Any] = [0, 0.0, 0]
            while figures[0] != before:
                time.sleep(SILENCE)
                before = figures[0]
                figures = ask(sink)
            return flooded(sent, figures)


def flooded(sent: int, figures: list[Any]) -> Flood:
    """Return a flood's figures from those of its sink."""
    count, took, wrong = figures
    return Flood((count - 1) / took if took else 0.0, 1 - count / sent, wrong)


def beat(contender: Contender, kind: str, seconds: float) -> float:
    """Return the share of a core that a process takes which sends a hundred messages a second to another."""
    with process(contender, "sink", kind, seconds, core=1) as sink:
        expect_ready(sink)
        with process(contender, "beat", kind, seconds, core=0) as beats:
            return float(answer(beats))


def crowd(contender: Contender, processes: int, each: int) -> float:
    """Return the seconds until the last of some processes that start at once knows all nodes of all."""
    everybody, begun = processes * each, time.monotonic()
    with contextlib.ExitStack() as stack:
        started = [
            stack.enter_context(
                process(contender._replace(variant=f"{number}-{each}-{everybody}"), "crowd", "twist", 0.0, core=-1)
            )
            for number in range(processes)
        ]
        return float(max(answer(one) for one in started) - begun)


def alone(contender: Contender, watcher: Contender, settle: float) -> Alone:
    """Start one node while another process watches; then it idles for so long before its memory is read."""
    with process(watcher, watcher.variant, "twist", 0.0, core=1) as watches:
        expect_ready(watches)
        command = [contender.python, str(PACKAGE / "alone.py"), contender.module]
        with (
            subprocess.Popen(
                on_core(command, 0), env=environment(contender, first=False), stdout=subprocess.PIPE, text=True
            ) as started,
            at_most(LONGEST, started),
        ):
            begun, used = answer(started)
            seen = answer(watches)
            time.sleep(settle)
            return Alone(seen - begun, used, proportional_memory(started.pid))


@contextlib.contextmanager
def at_most(seconds: float, started: subprocess.Popen[str]) -> Iterator[None]:
    """Kill a process when the block has been left, or after so long: then who waits for its words hears its end."""
    late = threading.Timer(seconds, started.kill)
    late.daemon = True
    late.start()
    try:
        yield
    finally:
        late.cancel()
        started.kill()


def on_core(command: list[str], core: int) -> list[str]:
    """Return a command that stays on one core, where that can be said."""
    return ["taskset", "-c", str(core), *command] if PIN and shutil.which("taskset") else command


def proportional_memory(pid: int) -> float | None:
    """Return the memory of a process in MB, what it shares with others divided among them (PSS); None but on Linux."""
    file = Path(f"/proc/{pid}/smaps_rollup")
    if not file.exists():
        return None
    lines = file.read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("Pss:")) / 1024


def inside(contender: Contender, role: str, kind: str, seconds: float) -> float:
    """Median of what one process does by itself, in microseconds."""
    with process(contender, role, kind, seconds, core=1) as alone:
        return float(statistics.median(answer(alone)))


@contextlib.contextmanager
def process(contender: Contender, role: str, kind: str, seconds: float, core: int) -> Iterator[subprocess.Popen[str]]:
    """Run one end until the block has been left."""
    with (
        subprocess.Popen(
            [contender.python, *words(contender, role, kind, seconds, core)],
            env=environment(contender, first=role not in ("ping", "source", "beat")),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        ) as started,
        at_most(LONGEST, started),
    ):
        yield started


def words(contender: Contender, role: str, kind: str, seconds: float, core: int) -> list[str]:
    """Return the arguments of Python for one end."""
    given = [str(PACKAGE), contender.module, role, kind, "--variant", contender.variant]
    return [
        *given,
        "--seconds",
        str(seconds),
        "--core",
        str(core if PIN else -1),
        "--size",
        str(prepared()["sizes"][kind]),
    ]


def environment(contender: Contender, first: bool) -> dict[str, str]:
    config = ("first" if first else "second") + ("" if contender.shared_memory else "-")
    made = {**os.environ, **ALONE, "ROS_DOMAIN_ID": str(prepared()["domain"]), CONFIG: prepared()[config]}
    if not contender.shared_memory:
        made["ZENOH_CONFIG_OVERRIDE"] = SHM_OFF
    if contender.path:
        made["PYTHONPATH"] = contender.path
    made.pop("PYTHONDONTWRITEBYTECODE", None)  # with it each start would compile all that it imports
    return made | dict(contender.environ)


@cache
def prepared() -> dict[str, Any]:
    """Return the run's domain, Zenoh's settings of a robolink session there, and the length of each message.

    Another process finds them. Here robolink is not imported: of what this process has loaded as well, less would count
    as another one's memory.
    """
    command = [sys.executable, str(PACKAGE), "preparing", "prepare", "twist"]
    found = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, timeout=LONGEST).stdout)
    mark = socket.socket(type=socket.SOCK_DGRAM)  # robolink's own mark of a domain that is taken, while this runs
    mark.bind(("127.0.0.1", found["mark"]))
    return dict(found, socket=mark)


def expect_ready(started: subprocess.Popen[str]) -> None:
    if answer(started) != "ready":
        raise GameError("it did not start")


def answer(started: subprocess.Popen[str]) -> Any:
    """Return the next line of a process."""
    assert started.stdout
    line = started.stdout.readline()
    if not line:
        raise GameError(f"process {started.pid} has ended without a word")
    return json.loads(line)


def ask(started: subprocess.Popen[str]) -> Any:
    """Ask a process for its figures now."""
    assert started.stdin
    started.stdin.write("\n")
    started.stdin.flush()
    return answer(started)
