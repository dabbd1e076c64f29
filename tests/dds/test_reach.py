"""How far `--network dds` reaches beside real nodes, on this machine and on another, by ROS 2's own variables."""

from __future__ import annotations

import json
import os
import time
from contextlib import ExitStack

import pytest

from tests.dds.conftest import PROGRAMS, real
from tests.dds.peers import PATIENCE
from tests.support import stalls
from tests.support.commands import ROBOLINK
from tests.support.obedient import line, start, tell

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are two hosts"),
]

HERE, THERE = "10.77.0.1", "10.77.0.2"
RANGE, PEERS = "ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS"
QUIET = 1.0
"""Seconds after the last was met in which nobody else must be."""

OURS = {
    "ours_unset": {},
    "ours_OFF": {RANGE: "OFF"},
    "ours_LOCALHOST": {RANGE: "LOCALHOST"},
    "ours_SUBNET": {RANGE: "SUBNET"},
    "ours_interface": {"ROBOLINK_DDS_INTERFACE": "cable"},
    "ours_peers": {RANGE: "LOCALHOST", PEERS: THERE},
}
THEIRS_HERE = {"here_OFF": {RANGE: "OFF"}, "here_LOCALHOST": {RANGE: "LOCALHOST"}, "here_SUBNET": {RANGE: "SUBNET"}}
THEIRS_THERE = {
    "there_OFF": {RANGE: "OFF"},
    "there_LOCALHOST": {RANGE: "LOCALHOST"},
    "there_SUBNET": {RANGE: "SUBNET"},
    "there_peers": {RANGE: "LOCALHOST", PEERS: HERE},
}
LOCAL = {"here_LOCALHOST", "here_SUBNET"}
NEAR = LOCAL | {"there_SUBNET", "there_peers"}
MET = {
    "ours_unset": LOCAL,
    "ours_OFF": set(),
    "ours_LOCALHOST": LOCAL,
    "ours_SUBNET": NEAR,
    "ours_interface": NEAR,
    "ours_peers": NEAR | {"there_LOCALHOST"},
}
"""Whom each of ours meets, and is met by. A real node with the range SUBNET, or with peers, meets the same."""


def environment(**own: str) -> dict[str, str]:
    """Return the environment of a process."""
    clean = {name: each for name, each in os.environ.items() if not name.startswith(("ROS_", "ROBOLINK"))}
    return clean | {"ROS_DOMAIN_ID": "94", "ROBOLINK_WORKSPACE": ""} | own


class Machine:
    """A process with nodes on a machine."""

    def __init__(
        self, stack: ExitStack, host: str, python: list[str], nodes: dict[str, dict[str, str]], network: str = "dds"
    ) -> None:
        command = ["ip", "netns", "exec", host, *python, str(PROGRAMS / "ranges.py"), json.dumps(nodes)]
        self._process = start(stack, command, environment(ROBOLINK_NETWORK=network))

    def ready(self) -> None:
        """Wait until its nodes are there."""
        assert line(self._process) == "ready"

    def sees(self) -> dict[str, set[str]]:
        """Return the nodes that each of its nodes sees."""
        tell(self._process, "")
        return {name: set(found) for name, found in json.loads(line(self._process)).items()}


@pytest.mark.parametrize("distribution", ["kilted", "jazzy"])
def test_each_range_meets_whom_it_should(distribution: str) -> None:
    theirs = real(distribution)
    with ExitStack() as stack:
        here, there = stack.enter_context(stalls.two_hosts())
        machines = [
            Machine(stack, here, theirs, THEIRS_HERE),
            Machine(stack, there, theirs, THEIRS_THERE),
            Machine(stack, here, [*ROBOLINK, "run"], OURS),
        ]
        for each in machines:
            each.ready()

        def seen() -> dict[str, set[str]]:
            """Return the nodes of the other kind that each sees."""
            every = {name: found for each in machines for name, found in each.sees().items()}
            return {
                name: {other for other in found if (other in MET) != (name in MET)} for name, found in every.items()
            }

        theirs_see = {name: {our for our, met in MET.items() if name in met} for name in (*THEIRS_HERE, *THEIRS_THERE)}
        expected = MET | theirs_see
        end = time.monotonic() + PATIENCE
        while seen() != expected and time.monotonic() < end:
            time.sleep(0.05)
        end = time.monotonic() + QUIET
        while time.monotonic() < end:
            assert seen() == expected
            time.sleep(QUIET / 4)


def test_a_bridge_on_an_interface_finds_static_peers_where_no_multicast_passes() -> None:
    with ExitStack() as stack:
        here, there = stack.enter_context(stalls.two_routed_hosts())
        places = {"at_here": here, "at_there": there}
        theirs = [Machine(stack, host, real("kilted"), {name: {}}) for name, host in places.items()]
        ours = Machine(stack, here, [*ROBOLINK, "run"], {"ours": {}}, network="localhost")
        bridge = ["ip", "netns", "exec", here, *ROBOLINK, "bridge", "dds", "--interface", "cable"]
        assert line(start(stack, bridge, environment(**{PEERS: "10.78.0.1"}))).startswith("robolink bridge")
        for each in (*theirs, ours):
            each.ready()

        def seen() -> set[str]:
            return {name for name in ours.sees()["ours"] if name.startswith("at_")}

        end = time.monotonic() + PATIENCE
        while seen() != set(places) and time.monotonic() < end:
            time.sleep(0.05)
        assert seen() == set(places)
