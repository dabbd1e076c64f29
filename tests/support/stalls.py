"""Stall scenarios: one of three processes is paused, or loses its cable; measures the harm to the other two.

    python -m tests.support.stalls [--rounds 5] [--seconds 30]

plays each scene for so many rounds, with every order of start, and says what the two lost and how late they were. What
is asked: 1 % of the messages lost at most, none later than 0.3 s, and no `publish` that took longer than 0.2 s.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from functools import partial
from typing import Any, NamedTuple

from tests.support.domains import free_domain
from tests.support.obedient import line, start, tell

PATIENCE = 60.0
WATCHED = ("a", "b")
"""The two that go on; `c` is the one that stands still."""


class Harm(NamedTuple):
    """The worst that happened to one of the two that went on."""

    sent: int
    """Messages of the other one."""
    lost: int
    """Those of them that did not come."""
    told: int
    """Those that its KEEP_ALL subscription has counted as lost."""
    late: float
    """Seconds: the latest message, or the longest pause."""
    blocked: float
    """Seconds: the longest `publish`."""


class Pulses:
    """Processes of tests.support.pulse, by name, on a domain of their own; `prefixes` are put before their commands."""

    def __init__(self, stack: ExitStack, environ: dict[str, str], prefixes: dict[str, list[str]] | None = None) -> None:
        self._stack, self._prefixes = stack, prefixes or {}
        self._environ = os.environ | {"ROS_DOMAIN_ID": str(stack.enter_context(free_domain()))} | environ
        self.processes: dict[str, subprocess.Popen[str]] = {}

    def start(self, name: str, *options: str, others: Sequence[str] = ()) -> None:
        """Start one; it is ready when `ready` says so."""
        command = [sys.executable, "-m", "tests.support.pulse", name, *options, "--others", *others]
        self.processes[name] = start(self._stack, [*self._prefixes.get(name, []), *command], self._environ)

    def ready(self) -> None:
        """Wait until all know each other, then have them count."""
        for name in self.processes:
            assert self.line(name) == "ready"
        for name in self.processes:
            self.tell(name, "mark")

    def line(self, name: str) -> str:
        """The next line that one prints."""
        return line(self.processes[name])

    def tell(self, name: str, command: str) -> None:
        """Send one a line to obey."""
        tell(self.processes[name], command)

    def harm(self, names: Sequence[str] = WATCHED) -> dict[str, Harm]:
        """End these; returns what happened to each by the fault of what came between them."""
        for name in names:
            self.tell(name, "stop")
        time.sleep(1.0)  # what is under way arrives
        for name in names:
            self.tell(name, "report")
        reports = {name: json.loads(self.line(name)) for name in names}
        return {name: _harm(name, reports) for name in names}


def _harm(name: str, reports: dict[str, Any]) -> Harm:
    """Look at one through what those sent that went on; the worst counts."""
    harm = Harm(0, 0, 0, 0.0, reports[name]["blocked"])
    for other, heard in reports[name]["heard"].items():
        if other in WATCHED and other in reports:
            sent = reports[other]["sent"]
            late = max(harm.late, heard["latest"], heard["pause"])
            lost = max(harm.lost, sent - heard["count"])
            harm = Harm(max(harm.sent, sent), lost, max(harm.told, heard["told"]), late, harm.blocked)
    return harm


def play(
    order: str,
    fault: Callable[[Pulses], None],
    *options: str,
    names: Sequence[str] = WATCHED,
    environ: dict[str, str] | None = None,
    prefixes: dict[str, list[str]] | None = None,
) -> dict[str, Harm]:
    """Start the three in this order, let something happen to `c`; returns what it did to these."""
    with ExitStack() as stack:
        pulses = Pulses(stack, environ or {}, prefixes)
        for name in order:
            pulses.start(name, *options, others=[other for other in order if other != name])
        pulses.ready()
        time.sleep(1.0)  # so long all is well
        fault(pulses)
        return pulses.harm(names)


def freeze(seconds: float) -> Callable[[Pulses], None]:
    """Stop a process for so long, as Ctrl-Z does."""

    def stand_still(pulses: Pulses) -> None:
        if sys.platform == "win32":
            raise RuntimeError("Windows has no SIGSTOP: nothing can be stopped")
        pulses.processes["c"].send_signal(signal.SIGSTOP)
        time.sleep(seconds)
        pulses.processes["c"].send_signal(signal.SIGCONT)
        time.sleep(2.0)

    return stand_still


# Two machines


def no_hosts() -> str:
    """Why there can be no second machine here, or nothing if there can."""
    if not sys.platform.startswith("linux"):
        return "network namespaces are Linux's"
    if shutil.which("ip") is None:
        return "there is no `ip` (iproute2)"
    tried = subprocess.run(["unshare", "--net", "true"], capture_output=True, check=False)
    return "" if tried.returncode == 0 else "this user may make no network namespaces"


@contextlib.contextmanager
def two_hosts() -> Iterator[tuple[str, str]]:
    """Make two network namespaces that a cable joins; gives their names."""
    names = [f"robolink-{os.getpid()}-{side}" for side in "lr"]
    with ExitStack() as stack:
        for name in names:
            _ip("netns", "add", name)
            stack.callback(_ip, "netns", "delete", name)
            _ip("-netns", name, "link", "set", "lo", "up")
        _ip("link", "add", "cable", "netns", names[0], "type", "veth", "peer", "name", "cable", "netns", names[1])
        for number, name in enumerate(names):
            _ip("-netns", name, "address", "add", f"10.77.0.{number + 1}/24", "dev", "cable")
            plug_in(name)
        yield names[0], names[1]


@contextlib.contextmanager
def two_routed_hosts() -> Iterator[tuple[str, str]]:
    """Make two network namespaces, 10.77.0.1 and 10.78.0.1, between which a third one routes: no multicast passes."""
    with routed_hosts(2) as (here, there):
        yield here, there


@contextlib.contextmanager
def routed_hosts(number: int) -> Iterator[list[str]]:
    """Make so many network namespaces, 10.77.0.1, 10.78.0.1 and so on, between which one more routes."""
    names = [f"robolink-{os.getpid()}-{each}" for each in range(number)]
    between = f"robolink-{os.getpid()}-m"
    with ExitStack() as stack:
        for name in (*names, between):
            _ip("netns", "add", name)
            stack.callback(_ip, "netns", "delete", name)
            _ip("-netns", name, "link", "set", "lo", "up")
        for each, name in enumerate(names):
            link = f"cable{each}"
            _ip("link", "add", "cable", "netns", name, "type", "veth", "peer", "name", link, "netns", between)
            for host, device, last in ((name, "cable", 1), (between, link, 254)):
                _ip("-netns", host, "address", "add", f"10.{77 + each}.0.{last}/24", "dev", device)
                _ip("-netns", host, "link", "set", device, "up")
            _ip("-netns", name, "route", "add", "default", "via", f"10.{77 + each}.0.254")
        subprocess.run(
            ["ip", "netns", "exec", between, "sh", "-c", "echo 1 >/proc/sys/net/ipv4/ip_forward"], check=True
        )
        yield names


def plug_in(host: str) -> None:
    """Connect a host's end of the cable."""
    _ip("-netns", host, "link", "set", "cable", "up")
    _ip("-netns", host, "route", "replace", "224.0.0.0/4", "dev", "cable")


def pull_out(host: str) -> None:
    """Disconnect it."""
    _ip("-netns", host, "link", "set", "cable", "down")


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True)


def cut_the_cable(order: str, seconds: float, *options: str, names: Sequence[str] = WATCHED) -> dict[str, Harm]:
    """Have `c` on another machine, and its cable out for so long; returns what that did to these."""
    with two_hosts() as (here, there):

        def pull(pulses: Pulses) -> None:
            pull_out(here)
            time.sleep(seconds)
            plug_in(here)
            time.sleep(2.0)

        prefixes = {name: ["ip", "netns", "exec", there if name == "c" else here] for name in order}
        environ = {"ROBOLINK_NETWORK": "subnet"}
        return play(order, pull, *options, names=names, environ=environ, prefixes=prefixes)


# Latched messages


def join_late(size: int, *, shared_memory: bool) -> tuple[float, dict[str, Harm]]:
    """Have `c` subscribe late to a message of so many bytes; returns after how many seconds it came, and the harm."""
    override = {} if shared_memory else {"ZENOH_CONFIG_OVERRIDE": "transport/shared_memory/enabled=false"}
    with ExitStack() as stack:
        pulses = Pulses(stack, override)
        pulses.start("a", "--latched", str(size))
        pulses.start("b", others=["a"])
        pulses.start("c", others=["a"])
        pulses.ready()
        pulses.tell("c", "join")
        took = float(pulses.line("c"))
        time.sleep(1.0)
        return took, pulses.harm("abc")


def main() -> None:
    """Play all scenes, and say how they went."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=30.0)
    asked = parser.parse_args()
    for name, scene in _scenes(asked.seconds).items():
        for _ in range(asked.rounds):
            _say(name, scene())
    for size in (100_000, 1_000_000, 10_000_000):
        for shared_memory in (True, False):
            for _ in range(asked.rounds):
                took, harms = join_late(size, shared_memory=shared_memory)
                _say(f"{size:,} B latched{' (no shared memory)' * (not shared_memory)}: {took:.3f} s", harms)


def _scenes(seconds: float) -> dict[str, Callable[[], dict[str, Harm]]]:
    flood = ("--keep-all", "--rate", "500")
    scenes: dict[str, Callable[[], dict[str, Harm]]] = {
        "c frozen, 500 Hz KEEP_ALL": partial(play, "abc", freeze(seconds), *flood),
        "the same with 10 kB each": partial(play, "abc", freeze(seconds), *flood, "--bytes", "10000"),
    }
    for order in ("abc", "acb", "cab"):
        scenes[f"c frozen, started as {order}"] = partial(play, order, freeze(seconds))
        if not no_hosts():
            scenes[f"c's cable cut, started as {order}"] = partial(cut_the_cable, order, seconds)
    return scenes


def _say(name: str, harms: dict[str, Harm]) -> None:
    worst = Harm(*map(max, zip(*harms.values(), strict=True)))
    figures = f"lost {worst.lost:4} of {worst.sent:6}  late {worst.late:.3f} s  publish {worst.blocked:.3f} s"
    print(f"{name:45} {figures}", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
