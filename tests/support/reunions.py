"""Reunion scenarios: a cable is cut, an address changes, a router restarts; measures how soon all is found again.

    python -m tests.support.reunions [SCENE ...] [--rounds 20] [--seconds 15] [--keys]

plays each scene for so many rounds at 100 Hz, with KEEP_ALL and with KEEP_LAST 10, and prints after how many seconds
both sides heard something new from each other, how many messages were lost, how many of these were counted, how many
came twice, whether the last ten of the cut and the latched message came, how late the latest was, and how late between
two that were not cut. With `--keys` each process is an enclave of its own that may do everything; nothing is sent again
then.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from robolink.security.keystore import Keystore
from tests.support import stalls
from tests.support.domains import free_domain
from tests.support.obedient import line, start, tell

SETTLES = 8.0
"""Longest time in seconds for which both sides are given to find each other again."""

ROUTER = """
import json, sys, zenoh
settings = {"mode": "router", "listen": {"endpoints": ["tcp/0.0.0.0:7447"]}, "timestamping": {"enabled": True}}
session = zenoh.open(zenoh.Config.from_json5(json.dumps(settings | {"scouting": {"multicast": {"enabled": False}}})))
print("ready", flush=True)
sys.stdin.read()
"""

Fault = Callable[[str, str], None]
"""Function of the names of both machines, which lets something happen to them."""


class Reunion(NamedTuple):
    """The worse of both directions."""

    back: float
    """Seconds from the end of the cut until something came that was sent after it; infinite if nothing did."""
    lost: int
    """Messages that never came."""
    told: int
    """Those that a process has counted: lost on the way, or dropped as more came at once than it keeps."""
    longest: float
    """Seconds: the longest `publish`."""
    latched: bool
    """True if the last latched message came on both sides."""
    last_ten: bool
    """True if the first that came afterwards was one of those that KEEP_LAST 10 keeps, or older, and all behind it."""
    late: float
    """Seconds: the longest way of a message that came."""
    beside: float
    """Seconds: the longest way of a message between two processes of the machine that was not cut."""
    twice: int = 0
    """Messages that came more than once."""

    def __str__(self) -> str:
        return (
            f"back after {self.back:5.2f} s  lost {self.lost:5} (counted {self.told:5})  twice {self.twice:3}"
            f"  last ten {_said(self.last_ten)}  latched {_said(self.latched)}  late {self.late:5.2f} s"
            f"  beside {self.beside:5.3f} s  publish {self.longest:5.3f} s"
        )


def _said(is_so: bool) -> str:
    return "yes" if is_so else "NO "


def play(
    fault: Fault,
    *options: str,
    network: str = "subnet",
    settles: float = SETTLES,
    before: Fault | None = None,
    beside: bool = False,
    keys: bool = False,
) -> Reunion:
    """Let two machines publish to each other and something happen; return how they met again.

    With `beside` there is a third process, on the second machine, which goes on with the one there.
    """
    with ExitStack() as stack:
        here, there = stack.enter_context(stalls.two_hosts())
        domain = stack.enter_context(free_domain())
        if before is not None:
            before(here, there)
        environ = _clean() | {"ROS_DOMAIN_ID": str(domain), "ROBOLINK_NETWORK": network}
        if keys:
            environ |= _secured(stack, domain, "abc")
        diaries = {}
        hosts = [("a", ["b"], here), ("b", ["a", "c"] if beside else ["a"], there), ("c", ["b"], there)]
        for name, others, host in hosts if beside else hosts[:2]:
            command = [
                "ip",
                "netns",
                "exec",
                host,
                sys.executable,
                "-m",
                "tests.support.diary",
                name,
                "--others",
                *others,
            ]
            own = {"ROS_SECURITY_ENCLAVE_OVERRIDE": f"/{name}"} if keys else {}
            diaries[name] = start(stack, [*command, *options], environ | own)
        for each in diaries.values():
            assert line(each) == "ready"
        begin = time.time()
        fault(here, there)
        ended = time.time()
        _settle(diaries, settles)
        reports, until = {}, time.time() - 1.0
        for name, each in diaries.items():
            tell(each, "report")
            reports[name] = json.loads(line(each))
        return _judge(reports, begin, ended, until)


def _secured(stack: ExitStack, domain: int, names: str) -> dict[str, str]:
    """Make a keystore with an enclave for each name; return the variables that switch security on."""
    store = Keystore(Path(stack.enter_context(tempfile.TemporaryDirectory())), domain)
    store.create()
    for name in names:
        store.create_enclave(f"/{name}")
    given = {"ENABLE": "true", "STRATEGY": "Enforce", "KEYSTORE": str(store.path)}
    return {f"ROS_SECURITY_{name}": value for name, value in given.items()}


def _settle(diaries: dict[str, subprocess.Popen[str]], longest: float) -> None:
    """Wait so long at most, until both sides have heard a hundred more messages and a latched one, and a while more."""
    deadline = time.monotonic() + longest
    for each in diaries.values():
        tell(each, f"hear {max(0.0, deadline - time.monotonic())}")
        assert line(each) == "heard"
    time.sleep(max(0.0, min(SETTLES, deadline - time.monotonic())))


def _judge(reports: dict[str, Any], begin: float, ended: float, until: float) -> Reunion:
    worst = Reunion(0.0, 0, 0, 0.0, True, True, 0.0, 0.0)
    for name, other in ("ab", "ba"):
        sent, heard = reports[other]["sent"], reports[name]["heard"]
        came = dict(heard[other])
        first = min(came)  # what was sent before the two had met is not lost
        wanted = [number for number, at in enumerate(sent) if number >= first and begin - 1.0 < at < until]
        news = [at for number, at in came.items() if number < len(sent) and sent[number] > ended]
        latched = max((number for number, _ in heard[f"{other}/latched"]), default=0)
        worst = Reunion(
            max(worst.back, min(news, default=float("inf")) - ended),
            max(worst.lost, sum(number not in came for number in wanted)),
            max(worst.told, reports[name]["told"]),
            max(worst.longest, reports[name]["longest"]),
            worst.latched and latched >= wanted[-1] // 100 * 100,
            worst.last_ten and _has_last(came, sent, ended),
            max(worst.late, _latest(came, sent, begin - 1.0)),
            worst.beside,
            max(worst.twice, len(heard[other]) - len(came)),
        )
    pairs = (("b", "c"), ("c", "b")) if "c" in reports else ()
    ways = [_latest(dict(reports[name]["heard"][other]), reports[other]["sent"], begin - 1.0) for name, other in pairs]
    return worst._replace(beside=max(ways, default=0.0))


def _has_last(came: dict[int, float], sent: list[float], ended: float) -> bool:
    """True if those came that a depth of ten held when the first news of after the cut came; one may be under way."""
    back = min((at for number, at in came.items() if number < len(sent) and sent[number] > ended), default=0.0)
    before = [number for number, at in enumerate(sent) if at < back]
    return len(before) >= 10 and all(number in came for number in before[-9:])


def _latest(came: dict[int, float], sent: list[float], begin: float) -> float:
    """Return the seconds of the longest way."""
    return max(
        (at - sent[number] for number, at in came.items() if number < len(sent) and sent[number] > begin), default=0.0
    )


def _clean() -> dict[str, str]:
    return {name: each for name, each in os.environ.items() if not name.startswith(("ROS_", "ZENOH_", "ROBOLINK"))}


def pull_out(seconds: float) -> Fault:
    """Pull the cable for so long: both sides see that the link is down."""

    def fault(here: str, there: str) -> None:
        stalls.pull_out(here)
        time.sleep(seconds)
        stalls.plug_in(here)

    return fault


def swallow(seconds: float) -> Fault:
    """Drop all packets between the two for so long, though both cables are in, as behind a switch that fails."""

    def fault(here: str, there: str) -> None:
        for host, peer in ((here, 2), (there, 1)):  # to nobody's address: the other machine's kernel drops them
            ip(host, "neigh", "replace", f"10.77.0.{peer}", "lladdr", "02:00:00:00:00:99", "dev", "cable")
        time.sleep(seconds)
        for host, peer in ((here, 2), (there, 1)):
            ip(host, "neigh", "delete", f"10.77.0.{peer}", "dev", "cable")

    return fault


def move(*, both: bool = False) -> Fault:
    """Change the address of one machine, or of both."""

    def fault(here: str, there: str) -> None:
        for host, old, new in ((here, 1, 11), (there, 2, 12))[: 2 if both else 1]:
            ip(host, "address", "delete", f"10.77.0.{old}/24", "dev", "cable")
            ip(host, "address", "add", f"10.77.0.{new}/24", "dev", "cable")
            stalls.plug_in(host)

    return fault


def play_router(seconds: float, *options: str) -> Reunion:
    """As `play`, with a router between the two machines, which is killed and comes again after so long."""
    with ExitStack() as stack:
        routers: list[subprocess.Popen[str]] = []

        def begin(here: str, there: str) -> None:
            command = ["ip", "netns", "exec", there, sys.executable, "-c", ROUTER]
            routers.append(start(stack, command, _clean()))
            assert line(routers[-1]) == "ready"

        def kill(here: str, there: str) -> None:
            routers[-1].kill()
            routers[-1].wait()
            time.sleep(seconds)
            begin(here, there)

        return play(kill, *options, network="tcp/10.77.0.2:7447", before=begin)


def ip(host: str, *words: str) -> None:
    """Run `ip` on a host."""
    subprocess.run(["ip", "-netns", host, *words], check=True)


def scenes(seconds: float, *, keys: bool = False) -> dict[str, Callable[[], Reunion]]:
    """All scenes by name: each cut with KEEP_ALL, and with KEEP_LAST 10; with keys, all but the router's."""
    cuts: dict[str, Callable[..., Reunion]] = {
        "cable": partial(play, pull_out(seconds), beside=True, keys=keys),
        "packets": partial(play, swallow(seconds), beside=True, keys=keys),
        "address": partial(play, move(), beside=True, keys=keys),
        "both-addresses": partial(play, move(both=True), beside=True, keys=keys),
        "router": partial(play_router, 2.0),
    }
    return {
        f"{name}{end}": partial(cut, *options)
        for name, cut in cuts.items()
        for end, options in (("", ["--keep-all"]), ("-last-10", list[str]()))
    }


def main() -> None:
    """Play scenes, and say how they went."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=", ".join(scenes(0)))
    parser.add_argument("--rounds", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=15.0)
    parser.add_argument("--keys", action="store_true")
    asked = parser.parse_args()
    known = scenes(asked.seconds, keys=asked.keys)
    for name in asked.scenes or known:
        for _ in range(asked.rounds):
            print(f"{name:22} {known[name]()}", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
