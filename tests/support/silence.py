"""Silence of the default network: counts the frames between two machines on which robolink is used with its defaults.

    python -m tests.support.silence [--seconds 60]

On both machines, network namespaces that a cable joins: a `robolink router` that listens on loopback, nodes that
publish, a launch, and again and again `robolink network`, `doctor` and `topic list`. What is asked: no frame but the
kernel's own. It ends with 1 if there was any. Needs root.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from contextlib import ExitStack
from pathlib import Path

from tests.support import stalls
from tests.support.domains import free_domain
from tests.support.frames import KERNEL
from tests.support.obedient import line, start, tell
from tests.support.stalls import PATIENCE

COMMANDS = (("topic", "list"), ("network",), ("doctor",))

LAUNCH = """
nodes:
  - {{run: [{python}, -m, tests.support.swarm, launched_a, --talk, 20], name: a}}
  - {{run: [{python}, -m, tests.support.swarm, launched_b, --talk, 20], name: b}}
"""

SPEAK = "import socket; s = socket.socket(type=socket.SOCK_DGRAM); s.sendto(b'x', ('10.77.0.2', 9))"


class Neighbours:
    """Two machines that a cable joins, on which robolink is used with its defaults."""

    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self.hosts = stack.enter_context(stalls.two_hosts())
        self._domain = stack.enter_context(free_domain())
        frames = [sys.executable, "-m", "tests.support.frames", "cable"]
        self._frames = start(stack, self._on(self.hosts[0], frames), self._environ())
        assert line(self._frames) == "ready"

    def frames(self) -> Counter[str]:
        """Return the frames that have passed the cable since the last time, by their kind."""
        tell(self._frames, "")
        return Counter(json.loads(line(self._frames)))

    def start_router(self, host: str, *options: str) -> None:
        """Start a router, which listens on loopback unless the options say more."""
        process = start(self._stack, self._on(host, [*_ROBOLINK, "router", *options]), self._environ())
        assert line(process).startswith("robolink router")

    def start_nodes(self, host: str, *names: str) -> None:
        """Start a process with nodes that publish."""
        process = start(self._stack, self._on(host, [*_SWARM, *names, "--talk", "20"]), self._environ())
        assert json.loads(line(process))["made"]

    def launch(self, host: str, folder: Path) -> None:
        """Start a launch of two nodes, and wait until they are there."""
        file = folder / "silence.yaml"
        file.write_text(LAUNCH.format(python=sys.executable))
        launch = start(self._stack, self._on(host, [*_ROBOLINK, "launch", os.fspath(file)]), self._environ())
        deadline = time.monotonic() + PATIENCE
        while not {"/launched_a", "/launched_b"} <= set(self.run(host, "node", "list").split()):
            assert launch.poll() is None, "the launch has ended"
            assert time.monotonic() < deadline, "the launch has no nodes"

    def run(self, host: str, *words: str) -> str:
        """Run a command of robolink until it ends; returns what it prints."""
        whole = self._on(host, [*_ROBOLINK, *words])
        done = subprocess.run(
            whole, env=self._environ(), capture_output=True, text=True, check=False, timeout=PATIENCE, cwd=_ROOT
        )
        return done.stdout

    def speak(self) -> None:
        """Send one packet from the first machine to the second, to see that it is counted."""
        subprocess.run(self._on(self.hosts[0], [sys.executable, "-c", SPEAK]), check=True)

    def _on(self, host: str, words: list[str]) -> list[str]:
        return ["ip", "netns", "exec", host, *words]

    def _environ(self) -> dict[str, str]:
        clean = {name: each for name, each in os.environ.items() if not name.startswith(("ROS_", "ZENOH_", "ROBOLINK"))}
        return clean | {"ROS_DOMAIN_ID": str(self._domain)}


_ROBOLINK = [sys.executable, "-m", "robolink"]
_SWARM = [sys.executable, "-m", "tests.support.swarm"]
_ROOT = Path(__file__).parents[2]


def main() -> None:
    """Listen for so long."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=60.0)
    asked = parser.parse_args()
    if reason := stalls.no_hosts():
        sys.exit(reason)
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        pair, begin = Neighbours(stack), time.monotonic()
        for host in pair.hosts:
            pair.start_router(host)
            pair.start_nodes(host, "talker", "listener")
            pair.launch(host, folder)
        ready = time.monotonic()
        commands = 0
        while time.monotonic() < ready + asked.seconds:
            for host in pair.hosts:
                for words in COMMANDS:
                    pair.run(host, *words)
                    commands += 1
        found, took = pair.frames(), time.monotonic() - begin
        pair.speak()
        is_heard = bool(pair.frames() - Counter({KERNEL: 10_000}))
    ours = {kind: count for kind, count in found.items() if kind != KERNEL}
    say(f"{took:.0f} s, {commands} commands: {found[KERNEL]} frames of the kernel's own, others: {ours or 'none'}")
    say(f"one packet that is sent on purpose is {'counted' if is_heard else 'NOT counted'}")
    sys.exit(bool(ours) or not is_heard)


def say(text: str) -> None:
    """Print a line."""
    print(text, flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
