"""Starts the two processes of a game, each on its own core, and reads their figures."""

from __future__ import annotations

import contextlib
import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from robolink.transport.port_sharing import free_domain

PACKAGE = Path(__file__).parent
_RESERVED = contextlib.ExitStack()
DOMAIN = _RESERVED.enter_context(free_domain())
"""Domain of this run alone, reserved while it lasts, so that two runs on one machine do not hear each other."""

SILENCE = 0.4
"""Seconds without a message after which a flood has passed."""

PIN = True
"""True to keep each end on its own core; else the system places them as it does in daily use."""

SHM_OFF = "transport/shared_memory/enabled=false"


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


class Flood(NamedTuple):
    """Figures of a flood."""

    rate: float
    """Messages received in a second, from the first to the last."""
    lost: float
    """Share of what was sent that did not come to the callback."""


class GameError(Exception):
    """A process has ended without its figures."""


def round_trips(contender: Contender, kind: str, seconds: float) -> float:
    """Median of a game's round trips in microseconds, between two fresh processes."""
    with process(contender, "pong", kind, seconds, core=1) as pong:
        expect_ready(pong)
        with process(contender, "ping", kind, seconds, core=0) as ping:
            return float(statistics.median(answer(ping)))


def flood(contender: Contender, kind: str, seconds: float) -> Flood:
    """One process sends for so long as fast as it goes, and another counts."""
    with process(contender, "sink", kind, seconds, core=1) as sink:
        expect_ready(sink)
        with process(contender, "source", kind, seconds, core=0) as source:
            sent, before, count, took = answer(source), -1, 0, 0.0
            while count != before:
                time.sleep(SILENCE)
                before = count
                count, took = ask(sink)
            return Flood((count - 1) / took if took else 0.0, 1 - count / sent)


def inside(contender: Contender, role: str, kind: str, seconds: float) -> float:
    """Median of what one process does by itself, in microseconds."""
    with process(contender, role, kind, seconds, core=1) as alone:
        return float(statistics.median(answer(alone)))


@contextlib.contextmanager
def process(contender: Contender, role: str, kind: str, seconds: float, core: int) -> Iterator[subprocess.Popen[str]]:
    """Run one end until the block has been left."""
    command = [sys.executable, str(PACKAGE), contender.module, role, kind]
    command += ["--seconds", str(seconds), "--core", str(core if PIN else -1), "--size", str(sizes()[kind])]
    with subprocess.Popen(
        [*command, "--variant", contender.variant],
        env=environment(contender, first=role in ("pong", "sink")),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as started:
        try:
            yield started
        finally:
            started.kill()


def environment(contender: Contender, first: bool) -> dict[str, str]:
    from benchmarks.messages.bare import CONFIG

    made = {**os.environ, "ROS_DOMAIN_ID": str(DOMAIN), CONFIG: bare_config(first, contender.shared_memory)}
    if not contender.shared_memory:
        made["ZENOH_CONFIG_OVERRIDE"] = SHM_OFF
    if contender.path:
        made["PYTHONPATH"] = contender.path
    return made


@cache
def bare_config(first: bool, shared_memory: bool) -> str:
    """Zenoh's settings of a robolink session, as JSON: a bare program of Zenoh plays under the same conditions."""
    from robolink.transport.network import load

    environ = dict(os.environ) if shared_memory else {**os.environ, "ZENOH_CONFIG_OVERRIDE": SHM_OFF}
    return str(load(None, DOMAIN, environ, holds_port=first))


@cache
def sizes() -> dict[str, int]:
    """Length of each message on the wire, in bytes."""
    from benchmarks.messages.samples import KINDS, sample
    from robolink.message import encode

    return {kind: len(encode(sample(kind))) for kind in KINDS}


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
