"""Overload: what a slow subscriber, a flood and thirty lidars do to /cmd_vel, /clock, services and a heartbeat.

    python -m tests.support.overload                   # all scenes, in a minute and a half
    python -m tests.support.overload router --seconds 10

Latencies are in milliseconds, from `publish` to the callback, or from call to answer.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

from tests.support.domains import free_domain
from tests.support.ports import free_port

Wish = dict[str, Any]
Process = list[list[Wish]]
"""Sessions of a process, each with what its node does."""


def sends(name: str, kind: str, rate: float, **more: Any) -> Wish:
    return {"does": "sends", "name": name, "type": kind, "rate": rate} | more


def hears(name: str, kind: str, **more: Any) -> Wish:
    return {"does": "hears", "name": name, "type": kind} | more


CALLS: Wish = {"does": "calls", "name": "/ask", "rate": 10}
SERVES: Wish = {"does": "serves", "name": "/ask"}
STEADY = [sends("/heartbeat", "Twist", 20), sends("/clock", "Clock", 100), CALLS]
HEARD = [hears("/heartbeat", "Twist"), hears("/clock", "Clock"), SERVES]
SMALL = sends("/flood", "Twist", 0)
LARGE = sends("/flood", "Image", 0, size=1_000_000)


def slow_beside_quick() -> list[Process]:
    """Return a topic of 1 kHz, a subscriber that takes 10 ms for each, and one that takes nothing."""
    fast = sends("/fast", "Twist", 1000, ears=2)
    slow = [hears("/fast", "Twist", takes=0.01, label="/fast (slow)")]
    quick = [hears("/fast", "Twist", label="/fast (quick)"), hears("/heartbeat", "Twist")]
    return [[[fast, sends("/heartbeat", "Twist", 20)]], [slow], [quick]]


def slow_within() -> list[Process]:
    """Return the same with all subscriptions in one node, which one thread spins."""
    fast = sends("/fast", "Twist", 1000)
    slow = hears("/fast", "Twist", takes=0.01, label="/fast (slow)")
    return [[[fast, *STEADY]], [[slow, *HEARD]]]


def flood(kind: Wish) -> dict[str, list[Process]]:
    """Return a flood beside what must be on time: in one process, from another process, in three processes."""
    heard = hears("/flood", kind["type"])
    return {
        "one process": [[[kind, *STEADY, heard, *HEARD]]],
        "one sender": [[[kind, *STEADY]], [[heard, *HEARD]]],
        "three processes": [[[kind]], [STEADY], [[heard, *HEARD]]],
        "another reader": [[[kind]], [[heard]], [STEADY], [HEARD]],
    }


def lidars() -> list[Process]:
    """Return thirty lidars in thirty sessions, two readers of all of them, and /cmd_vel across."""
    names = [f"/student{number}/scan" for number in range(30)]
    students = [[sends(each, "LaserScan", 10, size=360, ears=2)] for each in names]
    readers: list[Process] = [[[hears(each, "LaserScan", label="scans") for each in names]] for _ in range(2)]
    return [*(students[part::3] for part in range(3)), *readers, [STEADY_CMD], [HEARD_CMD]]


STEADY_CMD = [sends("/cmd_vel", "Twist", 20), sends("/clock", "Clock", 100), CALLS]
HEARD_CMD = [hears("/cmd_vel", "Twist"), hears("/clock", "Clock"), SERVES]


def scenes() -> Iterator[tuple[str, list[Process], bool]]:
    """Yield each scene: its name, its processes, and True if they are clients of a router."""
    yield "slow subscriber, another process", slow_beside_quick(), False
    yield "slow subscriber, same node", slow_within(), False
    for what, kind in (("small", SMALL), ("1 MB", LARGE)):
        for where, processes in flood(kind).items():
            yield f"flood of {what} messages, {where}", processes, False
        yield f"flood of {what} messages, three processes, router", flood(kind)["three processes"], True
        yield f"flood of {what} messages, another reader, router", flood(kind)["another reader"], True
    yield "thirty lidars, router", lidars(), True


def play(processes: list[Process], seconds: float, *, router: bool) -> list[Wish]:
    """Run a scene for so long on a domain of its own; return the reports of all parts."""
    with ExitStack() as stack:
        environ = {
            **os.environ,
            "ROS_DOMAIN_ID": str(stack.enter_context(free_domain())),
            "ROBOLINK_TRANSPORT": "zenoh://",
        }
        if router:
            address = f"127.0.0.1:{free_port()}"
            code = f"from robolink.cli.main import main; main(['router', '--listen', '{address}'])"
            assert _start(stack, environ, "-c", code).stdout.readline()
            environ["ROBOLINK_NETWORK"] = address
        heads = [_start(stack, environ, "-m", "tests.support.overload_part", json.dumps(each)) for each in processes]
        for each in heads:
            assert each.stdout.readline() == "ready\n"
        for each in heads:
            print(seconds, file=each.stdin, flush=True)
        return [report for each in heads for report in json.loads(each.stdout.readline())]


def _start(stack: ExitStack, environ: dict[str, str], *words: str) -> Any:
    pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    child = stack.enter_context(subprocess.Popen([sys.executable, *words], env=environ, **pipes))
    stack.callback(child.kill)
    return child


def lines(reports: list[Wish]) -> Iterator[str]:
    """Yield a line for each topic or service that has latencies; several subscriptions of one label in one line."""
    found: dict[str, list[Wish]] = {}
    for each in reports:
        if each["does"] != "serves" and ("got" in each or each["does"] == "hears"):
            found.setdefault(each["name"], []).append(each)
    sent = {each["name"]: each["count"] for each in reports if each["does"] == "sends"}
    for name, of_name in found.items():
        got = sum(each.get("got", 0) for each in of_name)
        p50, p95, most = (max(each.get(key, 0.0) for each in of_name) for key in ("p50", "p95", "max"))
        lost = sum(each.get("dropped", 0) + each.get("lost", 0) for each in of_name)
        times = f"p50 {p50:7.1f}  p95 {p95:7.1f}  max {most:7.1f}"
        among = f" of {sent[name.partition(' ')[0]]}" if name.partition(" ")[0] in sent else ""
        yield f"  {name:14} {times}  got {got}{among}{f', counted as lost {lost}' if lost else ''}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("words", nargs="*", help="of the scenes' names; all scenes if none")
    parser.add_argument("--seconds", type=float, default=4.0)
    asked = parser.parse_args()
    for name, processes, router in scenes():
        if all(each in name for each in asked.words):
            reports = play(processes, asked.seconds, router=router)
            sys.stdout.write("\n".join([name, *lines(reports), ""]))
            sys.stdout.flush()


if __name__ == "__main__":
    main()
