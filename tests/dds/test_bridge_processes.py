"""robolink bridge dds with robolink on both sides: starts in any order, ends, kills, restarts, and a second bridge."""

from __future__ import annotations

import contextlib
import signal
import sys
import time
from collections.abc import Iterator

import pytest

from tests.dds.conftest import Lab
from tests.dds.peers import Peer, until
from tests.support.commands import Command
from tests.support.ros2_peer import router
from tests.support.sdk_peer import Sdk

pytestmark = [pytest.mark.processes, pytest.mark.slow]

STRING, ADD = "std_msgs/msg/String", "example_interfaces/srv/AddTwoInts"
WITHIN = 3.0
"""Longest time in s until messages go both ways after the last part is there; some 0.3 s on a quiet machine."""
ENDS_WITHIN = 5.0
"""Seconds in which a bridge ends, and others know: what is not told lasts until its lease is over, 10 s and more."""


class Pair:
    """Robolink's on DDS and on Zenoh, with a bridge between them."""

    def __init__(self, lab: Lab) -> None:
        self.lab = lab
        self.parts: dict[str, Peer | Command] = {}
        self._stack = contextlib.ExitStack()
        self._serial = 0

    def start(self, *parts: str) -> None:
        for part in parts:
            if part == "bridge":
                self.parts[part] = bridge = self._stack.enter_context(self.lab.bridge())
                bridge.wait_for("robolink bridge:")
                continue
            peer = (self.lab.direct if part == "dds" else self.lab.beside)(part)
            self.parts[part] = self._stack.enter_context(peer).ready()
            other = {"dds": "zenoh", "zenoh": "dds"}[part]
            peer.ask("publisher", topic=f"of_{part}", type_name=STRING)
            peer.ask("subscription", topic=f"of_{other}", type_name=STRING)

    def peer(self, part: str) -> Peer:
        found = self.parts[part]
        assert isinstance(found, Peer)
        return found

    def exchanged(self, within: float = WITHIN) -> float:
        """Wait until messages that are sent from now on arrive on both sides; return how long that took, in s."""
        begun, came = time.monotonic(), set[str]()
        self._serial += 1000

        def both() -> bool:
            self._serial += 1
            for sender, receiver in (("dds", "zenoh"), ("zenoh", "dds")):
                self.peer(sender).ask("publish", topic=f"of_{sender}", first=self._serial)
                came.update(receiver for each in self.peer(receiver).events(f"of_{sender}") if each["at"] > begun)
            return len(came) == 2

        until(both, "messages both ways", within)
        return time.monotonic() - begun


@pytest.fixture
def pair(lab: Lab) -> Iterator[Pair]:
    made = Pair(lab)
    with made._stack:
        yield made


@pytest.mark.parametrize(
    "order", [("dds", "zenoh", "bridge"), ("bridge", "zenoh", "dds"), ("zenoh", "bridge", "dds")], ids="-".join
)
def test_whoever_starts_last_is_heard(pair: Pair, order: tuple[str, ...]) -> None:
    pair.start(*order)
    pair.exchanged()


@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGKILL")
def test_a_part_that_is_killed_is_back_once_it_starts_again(pair: Pair) -> None:
    pair.start("dds", "zenoh", "bridge")
    pair.exchanged()
    for part in ("dds", "bridge", "zenoh", "bridge"):
        pair.parts[part].kill()
        pair.start(part)
        pair.exchanged()
    # The participant of the bridge that was killed is there for another while, with the nodes of Zenoh.
    assert pair.peer("zenoh").ask("nodes") == ["/lab/dds", "/lab/zenoh"]


def test_a_second_bridge_refuses_and_the_first_goes_on(pair: Pair) -> None:
    """Commands say of the nodes of the other side that they are behind the bridge."""
    pair.start("bridge", "dds", "zenoh")
    with pair.lab.bridge() as second:
        assert second.end() == 1
        (line,) = second.errors
    assert "joins the same two networks, and all would come twice: this one ends" in line.text
    assert second.lines == []
    pair.exchanged()
    assert sum(each == "/lab/dds" for each in pair.peer("zenoh").ask("nodes")) == 1
    for way, name in (("bridge", "DDS"), ("direct", "Zenoh")):
        other = {"DDS": "dds", "Zenoh": "zenoh"}[name]
        with pair.lab.command(way, "node", "info", f"/lab/{other}") as info:
            info.wait_for(f"Network: {name}, through the bridge on ")
        with pair.lab.command(way, "topic", "info", "-v", f"/lab/of_{other}") as info:
            info.wait_for(f"Network: {name}, through the bridge on ")


def test_of_two_that_start_at_once_one_stays(lab: Lab) -> None:
    with lab.bridge() as one, lab.bridge() as other:
        both = (one, other)
        until(lambda: any(each.process.poll() is not None for each in both), "one of them has ended")
        (stays,) = (each for each in both if each.process.poll() is None)
        stays.wait_for("nodes: 0 on Zenoh, 0 on DDS")
        assert stays.process.poll() is None


def test_a_bridge_between_others_is_no_hindrance(pair: Pair) -> None:
    """Another Zenoh network and the same DDS: as two robots have it that share one of the two."""
    pair.start("bridge", "dds", "zenoh")
    with Command(pair.lab.domain, "bridge", "dds", "--network", "off") as other:
        other.wait_for("1 on DDS" if sys.platform == "win32" else "on DDS")
        pair.exchanged()
        assert other.process.poll() is None


@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGTERM")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_it_ends_quickly_and_takes_all_along(pair: Pair, number: signal.Signals) -> None:
    pair.start("dds", "zenoh", "bridge")
    pair.exchanged()
    bridge = pair.parts["bridge"]
    assert isinstance(bridge, Command)
    begin = time.monotonic()
    bridge.process.send_signal(number)
    assert bridge.end() == 0
    assert time.monotonic() - begin < ENDS_WITHIN
    assert bridge.lines[-1].text == "the bridge has ended"
    assert bridge.errors == []
    until(lambda: "/lab/zenoh" not in pair.peer("dds").ask("nodes"), "DDS has been told", ENDS_WITHIN)
    until(lambda: "/lab/dds" not in pair.peer("zenoh").ask("nodes"), "Zenoh knows", ENDS_WITHIN)


def test_a_peer_of_ros_2_on_zenoh_that_others_wrote_meets_dds(lab: Lab) -> None:
    """zenoh-ros2-sdk speaks as rmw_zenoh does, behind a router as its nodes are."""
    with (
        router() as port,
        Sdk(port, lab.domain) as sdk,
        Command(lab.domain, "bridge", "dds", "--network", f"127.0.0.1:{port}") as bridge,
        lab.direct("dds") as peer,
    ):
        bridge.wait_for("robolink bridge:")
        peer.ready()
        peer.ask("subscription", topic="/of_sdk", type_name=STRING, field="data")
        peer.ask("publisher", topic="/of_dds", type_name=STRING)
        sdk.ask("publisher", topic="/of_sdk", type_name=STRING, node="sdk_talker")
        sdk.ask("subscribe", topic="/of_dds", type_name=STRING, node="sdk_listener")
        sdk.ask("publish", topic="/of_sdk", values={"data": "hello"})
        assert peer.wait("/of_sdk")[0]["value"] == "hello"
        until(lambda: "/sdk_listener" in peer.ask("nodes"), "the graph")
        peer.ask("publish", topic="/of_dds", first=7)
        assert "7" in sdk.message("/of_dds")["data"]
        sdk.ask("serve", service="/of_sdk/add", node="sdk_server")
        peer.ask("client", name="/of_sdk/add", type_name=ADD)
        until(lambda: peer.ask("is_ready", name="/of_sdk/add"), "the SDK's service")
        answer = peer.ask("call", name="/of_sdk/add", type_name=ADD, values={"a": 40, "b": 2})
        assert answer == {"sum": 42}
