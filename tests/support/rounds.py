"""Fault rounds of three machines under load: a node frozen, a machine gone, a router killed; counts what was lost.

    python -m tests.support.rounds [SCENE ...] [--rounds 20] [--seconds 3]

plays each scene for so many rounds, in network namespaces that a switch joins (Linux, root): topics of 100 Hz and a
camera, all of them RELIABLE, and services that are called all the time. It prints after how many seconds all heard all
again, how many messages did not come, and how many of these were counted: `silent` are those that were not, and what
came twice. It ends with 1 if a process ended or anything was lost in silence.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import math
import os
import select
import signal
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import partial
from typing import Any, NamedTuple

from robolink.qos import HistoryPolicy
from tests.support import stalls
from tests.support.domains import free_domain
from tests.support.obedient import line, start, tell
from tests.support.rounds_end import TOPICS

NAMES = ("robot", "laptop", "desk")
"""Processes, one on each machine; it is the robot that has the camera and the router, and to which things happen."""

BACK_WITHIN = 60.0
"""Longest time in seconds until all have to hear all again."""

READY_WITHIN = 60.0
UNDER_LOAD = 1.5
"""Time in seconds for which all is well before a fault, and after it."""

ROUTER = "from robolink.cli.main import main; main(['router', '--listen', 'lan'])"


class Round(NamedTuple):
    """Result of one round."""

    back: float
    """Seconds from the end of the fault until each had heard something new from each."""
    published: int
    """Messages that some subscription should have got."""
    dropped: int
    """Those of them that a subscription which keeps ten has not: while it stood still, more than ten came."""
    lost: int
    """Those of them that a KEEP_ALL subscription has not."""
    silent: int
    """Those of them that it has not counted, and those that came twice, or were counted though they came."""
    answered: int
    """Calls that were answered."""
    failed: int
    """Calls that ended with an error or a timeout."""
    longest: float
    """Longest `publish`, in seconds."""
    ended: int
    """Processes that ended by themselves, or with another exit code than 0."""


class System:
    """Three machines, a process on each."""

    def __init__(self, stack: ExitStack, networks: dict[str, str]) -> None:
        self._stack = stack
        self.hosts = dict(zip(NAMES, stack.enter_context(switched_hosts(len(NAMES))), strict=True))
        self._networks = networks
        clean = {key: each for key, each in os.environ.items() if not key.startswith(("ROS_", "ZENOH_", "ROBOLINK"))}
        self._environ = clean | {"ROS_DOMAIN_ID": str(stack.enter_context(free_domain()))}
        self.ends: dict[str, subprocess.Popen[str]] = {}
        self.router: subprocess.Popen[str] | None = None
        self._lives = dict.fromkeys(NAMES, 0)

    def begin(self, name: str) -> None:
        """Start the process of a machine; it is ready once it hears the others, which `await_lines` waits for."""
        options = ["--life", str(self._lives[name]), *(["--camera"] if name == NAMES[0] else [])]
        others = [each for each in NAMES if each != name]
        command = [sys.executable, "-m", "tests.support.rounds_end", name, *options, "--others", *others]
        environ = self._environ | {"ROBOLINK_NETWORK": self._networks[name]}
        self.ends[name] = start(self._stack, [*self._on(name), *command], environ)
        self._lives[name] += 1

    def begin_router(self) -> None:
        """Start the router on the robot; it listens."""
        self.router = start(self._stack, [*self._on(NAMES[0]), sys.executable, "-c", ROUTER], self._environ)
        await_line(self.router, "robolink router", READY_WITHIN)

    def all(self, word: str, answer: str = "") -> None:
        """Send all of them a command, and wait for the answers."""
        for each in self.ends.values():
            tell(each, word)
        if answer:
            self.await_lines(answer, BACK_WITHIN)

    def await_lines(self, text: str, within: float) -> None:
        """Wait until each has printed a line."""
        deadline = time.monotonic() + within
        for each in self.ends.values():
            await_line(each, text, max(0.0, deadline - time.monotonic()))

    def _on(self, name: str) -> list[str]:
        return ["ip", "netns", "exec", self.hosts[name]]


class LateError(Exception):
    """A process has not said in time what it was to say."""


def await_line(process: subprocess.Popen[str], text: str, within: float) -> None:
    """Wait until a process has printed a line that begins so; raises LateError if it does not, or has ended."""
    stream = process.stdout
    assert stream is not None
    if not select.select([stream], [], [], within)[0]:
        raise LateError(f"no '{text}' within {within:.0f} s")
    if not (found := stream.readline()).startswith(text):
        raise LateError(f"'{found}' instead of '{text}'")


@contextlib.contextmanager
def switched_hosts(count: int) -> Iterator[list[str]]:
    """Make so many network namespaces, 10.77.0.1 and so on, whose cables a switch joins; gives their names."""
    names = [f"robolink-{os.getpid()}-{number}" for number in range(1, count + 1)]
    switch = f"robolink-{os.getpid()}-switch"
    with ExitStack() as stack:
        for name in (switch, *names):
            _ip("netns", "add", name)
            stack.callback(_ip, "netns", "delete", name)
            _ip("-netns", name, "link", "set", "lo", "up")
        _ip("-netns", switch, "link", "add", "switch", "type", "bridge")
        _ip("-netns", switch, "link", "set", "switch", "up")
        for number, name in enumerate(names, 1):
            port = f"port{number}"
            _ip("link", "add", "cable", "netns", name, "type", "veth", "peer", "name", port, "netns", switch)
            _ip("-netns", switch, "link", "set", port, "master", "switch", "up")
            _ip("-netns", name, "address", "add", f"10.77.0.{number}/24", "dev", "cable")
            stalls.plug_in(name)
        yield names


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True)


def play(
    fault: Callable[[System, float], None],
    networks: dict[str, str],
    seconds: float,
    *,
    router: bool = False,
    under_load: float = UNDER_LOAD,
) -> Round:
    """Put three machines under load, let something happen for so long, and count."""
    with ExitStack() as stack:
        system = System(stack, networks)
        if router:
            system.begin_router()
        for name in NAMES:
            system.begin(name)
        system.await_lines("ready", READY_WITHIN)
        time.sleep(under_load)
        fault(system, seconds)
        over = time.monotonic()
        system.all("hear", "heard")
        back = time.monotonic() - over
        time.sleep(under_load)
        system.all("stop")
        last = {topic: number for each in system.ends.values() for topic, number in json.loads(line(each)).items()}
        system.all(f"await {json.dumps(last)}", "last")
        system.all("report")
        reports = {name: json.loads(line(each)) for name, each in system.ends.items()}
        system.all("end")
        codes = [each.wait(READY_WITHIN) for each in system.ends.values()]
        return _judged(reports, back, sum(code != 0 for code in codes))


def _judged(reports: dict[str, Any], back: float, ended: int) -> Round:
    published = silent = 0
    lost = {True: 0, False: 0}
    for name in reports:
        for topic, heard in reports[name]["heard"].items():
            sender, kind = topic.split("/")
            missing = 0
            for life, (first, last, came) in heard["lives"].items():
                is_alive = int(life) == reports[sender]["life"]
                last = reports[sender]["sent"][kind] - 1 if is_alive else last  # what a killed one sent is not known
                published += last - first + 1
                missing += last - first + 1 - came
            lost[TOPICS[kind].history is HistoryPolicy.KEEP_ALL] += missing
            silent += abs(missing - heard["announced"]) + heard["doubled"]
    calls = [each["calls"] for each in reports.values()]
    answered, failed = (sum(each[key] for each in calls) for key in ("answered", "failed"))
    longest = max(each["longest"] for each in reports.values())
    return Round(back, published, lost[False], lost[True], silent, answered, failed, longest, ended)


# Faults


def freeze(system: System, seconds: float) -> None:
    """Stop the robot's process, as Ctrl-Z and a debugger do."""
    if sys.platform == "win32":
        raise RuntimeError("Windows has no SIGSTOP: nothing can be stopped")
    system.ends[NAMES[0]].send_signal(signal.SIGSTOP)
    time.sleep(seconds)
    system.ends[NAMES[0]].send_signal(signal.SIGCONT)


def unplug(system: System, seconds: float) -> None:
    """Take the robot's cable out for some seconds."""
    stalls.pull_out(system.hosts[NAMES[0]])
    time.sleep(seconds)
    stalls.plug_in(system.hosts[NAMES[0]])


def crash(system: System, seconds: float) -> None:
    """Kill the robot's process, and start it again."""
    killed = system.ends.pop(NAMES[0])
    killed.kill()
    killed.wait()
    time.sleep(seconds)
    system.begin(NAMES[0])
    await_line(system.ends[NAMES[0]], "ready", READY_WITHIN)


def kill_router(system: System, seconds: float) -> None:
    """Kill the router, and start it again."""
    assert system.router is not None
    system.router.kill()
    system.router.wait()
    time.sleep(seconds)
    system.begin_router()


LAN = dict.fromkeys(NAMES, "lan")
THROUGH_ROUTER = dict.fromkeys(NAMES, "10.77.0.1:7447") | {NAMES[0]: "localhost"}


def scenes(seconds: float, under_load: float = UNDER_LOAD) -> dict[str, Callable[[], Round]]:
    """Return all scenes by name."""
    return {
        "frozen": partial(play, freeze, LAN, seconds, under_load=under_load),
        "unplugged": partial(play, unplug, LAN, seconds, under_load=under_load),
        "killed": partial(play, crash, LAN, seconds, under_load=under_load),
        "router": partial(play, kill_router, THROUGH_ROUTER, seconds, router=True, under_load=under_load),
    }


COLUMNS = {
    "rounds": 6,
    "ended": 6,
    "published": 10,
    "dropped": 8,
    "lost": 7,
    "silent": 7,
    "back": 7,
    "worst": 7,
    "answered": 9,
    "failed": 7,
    "publish": 8,
}
"""Columns of the table and their widths: sums of all rounds, median and worst `back`, and the longest publish."""


def summary(found: list[Round]) -> str:
    """Return the line of a scene."""
    backs = [each.back for each in found] or [math.nan]
    sums = {name: sum(getattr(each, name) for each in found) for name in Round._fields}
    longest = max((each.longest for each in found), default=math.nan)
    texts = {name: f"{value:,}" for name, value in sums.items() if name in COLUMNS} | {
        "rounds": str(len(found)),
        "back": f"{statistics.median(backs):.2f}",
        "worst": f"{max(backs):.2f}",
        "publish": f"{longest:.3f}",
    }
    return " ".join(f"{texts[name]:>{width}}" for name, width in COLUMNS.items())


def main() -> None:
    """Play scenes, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=", ".join(scenes(0)))
    parser.add_argument("--rounds", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=3.0)
    asked = parser.parse_args()
    if reason := stalls.no_hosts():
        sys.exit(reason)
    known, bad = scenes(asked.seconds), 0
    say = sys.stdout.write
    say(" " * 10 + " ".join(f"{head:>{width}}" for head, width in COLUMNS.items()) + "\n")
    for name in asked.scenes or known:
        found = []
        for _ in range(asked.rounds):
            try:
                found.append(known[name]())
            except LateError as error:
                bad += 1
                say(f"{name}: {error}\n")
            else:
                sys.stderr.write(f"  {found[-1]}\n")
        bad += sum(each.silent + each.ended for each in found)
        say(f"{name:10}{summary(found)}\n")
        sys.stdout.flush()
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
