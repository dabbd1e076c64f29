"""Participants of RTPS on two machines that a cable joins, and what leaves the first one by it.

    python -m tests.support.rtps_hosts [--seconds 60]

On the first one two participants talk, and a node with `--network dds`, and a bridge with a node behind it; one on the
other machine announces itself to the cable's multicast, which another program here has joined. What is requested:
nothing but the kernel's own frames leaves, and nobody knows the other machine's. It ends with 1 otherwise. Needs root.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections import Counter
from contextlib import ExitStack
from typing import Any

from robolink.rtps.reach import GROUP, multicast_port
from tests.support import stalls
from tests.support.frames import KERNEL
from tests.support.obedient import line, start, tell
from tests.support.rtps_end import DOMAIN
from tests.support.waits import wait_until

HERE, THERE = "10.77.0.1", "10.77.0.2"
GROUP_REPORTS = "IPv4, protocol 2, "
"""Kind of the frames (IGMP) by which a kernel says that a program has joined a group on an interface."""

# It joins the group on the cable, as a node with the range SUBNET does, and counts what comes there.
JOIN = f"""
import socket, sys
here, there = sys.argv[1:]
group = socket.socket(type=socket.SOCK_DGRAM)
group.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
group.bind(("{GROUP}", {multicast_port(DOMAIN)}))
group.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton("{GROUP}") + socket.inet_aton(here))
print("ready", flush=True)
while True:
    _, source = group.recvfrom(65536)
    if source[0] == there:
        print("heard", flush=True)
"""


class Hosts:
    """The two machines; programs run on either until the stack is left."""

    def __init__(self, stack: ExitStack, hosts: tuple[str, str] | None = None) -> None:
        self._stack = stack
        self.here, self.there = hosts or stack.enter_context(stalls.two_hosts())

    def program(self, host: str, *words: str) -> subprocess.Popen[str]:
        """Start a program of Python that prints `ready`."""
        process = self._start(host, *words)
        assert line(process) == "ready"
        return process

    def nodes_and_bridge(self, host: str) -> None:
        """Start a node that publishes with `--network dds`, and one on Zenoh beside `robolink bridge dds`."""
        domain = {"ROS_DOMAIN_ID": str(DOMAIN)}
        bridge = self._start(host, "-m", "robolink", "bridge", "dds", **domain)
        assert line(bridge).startswith("robolink bridge: DDS on this machine and Zenoh (localhost)")
        for name, environ in (("direct", {"ROBOLINK_NETWORK": "dds"}), ("bridged", {})):
            node = self._start(host, "-m", "tests.support.swarm", name, "--talk", "20", **domain, **environ)
            assert json.loads(line(node))["made"]

    def _start(self, host: str, *words: str, **environ: str) -> subprocess.Popen[str]:
        clean = {name: each for name, each in os.environ.items() if not name.startswith(("ROS_", "ROBOLINK"))}
        return start(self._stack, ["ip", "netns", "exec", host, sys.executable, *words], clean | environ)

    def end(self, host: str, name: str, *options: str) -> subprocess.Popen[str]:
        """Start a participant."""
        return self.program(host, "-m", "tests.support.rtps_end", name, *options)

    def member(self, here: str = HERE, there: str = THERE) -> subprocess.Popen[str]:
        """Start a program on the first machine that joins the group of announcements, on the interface with an address.

        It prints `heard` for whatever comes from the other machine's address.
        """
        return self.program(self.here, "-c", JOIN, here, there)

    def second_cable(self) -> tuple[str, str]:
        """Join the two by one more cable, `other`; return its addresses."""
        addresses = "10.79.0.1", "10.79.0.2"
        _ip("link", "add", "other", "netns", self.here, "type", "veth", "peer", "name", "other", "netns", self.there)
        for host, address in zip((self.here, self.there), addresses, strict=True):
            _ip("-netns", host, "address", "add", f"{address}/24", "dev", "other")
            _ip("-netns", host, "link", "set", "other", "up")
        return addresses

    def capture(self, host: str, interface: str = "cable") -> subprocess.Popen[str]:
        """Start to count what a machine sends by an interface."""
        return self.program(host, "-m", "tests.support.frames", interface, "--sent")


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True)


def report(process: subprocess.Popen[str], words: str = "") -> Any:
    """Return what a participant knows, or what was captured since the last time."""
    tell(process, words)
    return json.loads(line(process))


def knows(process: subprocess.Popen[str], *names: str) -> bool:
    """Return whether a participant knows these and no others."""
    return bool(report(process)["peers"] == sorted(names))


def watch(seconds: float, *, nodes: bool = False) -> tuple[Counter[str], list[dict[str, Any]]]:
    """Play the scene for so long; return the frames that left, and what the two know and heard."""
    with ExitStack() as stack:
        hosts = Hosts(stack)
        joined = hosts.member()
        capture = hosts.capture(hosts.here)
        two = [hosts.end(hosts.here, name) for name in ("one", "two")]
        wait_until(lambda: knows(two[0], "two") and knows(two[1], "one"), 10.0)
        if nodes:
            hosts.nodes_and_bridge(hosts.here)
            wait_until(lambda: knows(two[0], "two", "/", "/") and {*_STATES} <= {*report(two[0])["topics"]}, 20.0)
        hosts.end(hosts.there, "stranger", "--interface", "cable")
        assert line(joined) == "heard"  # so the stranger's announcements come to this machine, and into the group
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for each in two:
                report(each, "burst")
            time.sleep(min(1.0, seconds / 3))
        found = Counter(report(capture))
        subprocess.run(["ip", "netns", "exec", hosts.here, sys.executable, "-c", _SPEAK], check=True)
        wait_until(lambda: bool(set(report(capture)) - {KERNEL}), 5.0)  # what is sent on purpose is seen
        return Counter({kind: n for kind, n in found.items() if not kind.startswith(GROUP_REPORTS)}), [
            report(each) for each in two
        ]


_STATES = ("rt/direct/state", "rt/bridged/state")
_SPEAK = f"import socket; s = socket.socket(type=socket.SOCK_DGRAM); s.sendto(b'x', ('{THERE}', 9))"


def main() -> None:
    """Watch for so long."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=60.0)
    requested = parser.parse_args()
    if reason := stalls.no_hosts():
        sys.exit(reason)
    frames, known = watch(requested.seconds, nodes=True)
    print(f"in {requested.seconds:g} s left by the cable: {dict(frames)}; they know and heard: {known}")  # noqa: T201
    sys.exit(set(frames) > {KERNEL} or [each["peers"] for each in known] != [["/", "/", "two"], ["/", "/", "one"]])


if __name__ == "__main__":
    main()
