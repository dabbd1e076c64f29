"""A whole robot system in one process: a minute of its life in well under a second, twice the same byte for byte."""

from __future__ import annotations

import hashlib
from collections import Counter

import pytest

from robolink import Context, Parameter, VirtualTime, logging
from robolink.executors import SingleThreadedExecutor
from robolink.qos import QoSProfile
from robolink.transport import Outlet
from robolink.transport.memory import Bus, MemoryTransport
from tests.nodefiles import load_node_file
from tests.spins import spin_for


class Trace:
    """All that has been published, in its order: a digest, and how many samples each key had."""

    def __init__(self) -> None:
        self.digest, self.counts = hashlib.sha256(), Counter[str]()

    def note(self, key: str, payload: bytes, attachment: bytes) -> None:
        for part in (key.encode(), payload, attachment):
            self.digest.update(len(part).to_bytes(8, "little") + part)
        self.counts["/" + key.split("/")[1]] += 1


class TappedOutlet:
    """A publisher's way out, on which somebody listens."""

    def __init__(self, outlet: Outlet, key: str, trace: Trace) -> None:
        self.outlet, self.key, self.trace = outlet, key, trace
        self.close = outlet.close

    @property
    def matched(self) -> bool:
        return self.outlet.matched

    def put(self, payload: bytes, attachment: bytes) -> None:
        self.trace.note(self.key, payload, attachment)
        self.outlet.put(payload, attachment)


class TappedTransport(MemoryTransport):
    """A session on a bus of its own that notes what it publishes."""

    def __init__(self, trace: Trace) -> None:
        super().__init__(bus=Bus())
        self.trace = trace

    def advertise(self, key: str, qos: QoSProfile) -> Outlet:
        return TappedOutlet(super().advertise(key, qos), key, self.trace)


def live(seconds: float, speed: float) -> Trace:
    """Let a robot follow the walls of the cornered room; give all that was published."""
    trace = Trace()
    context = Context(transport=TappedTransport(trace), time=VirtualTime())
    context.init([])
    with context, SingleThreadedExecutor(context=context) as executor:
        world = [Parameter("world", value="corners")]
        goal = [Parameter("speed", value=speed)]
        executor.add_node(load_node_file("world").SimulatedWorld(context=context, parameter_overrides=world))
        executor.add_node(load_node_file("wall_follower").WallFollower(context=context, parameter_overrides=goal))
        spin_for(executor, seconds)
    return trace


@pytest.mark.timeout(30)
def test_a_minute_of_a_robots_life_is_the_same_twice_byte_for_byte(capfd: pytest.CaptureFixture[str]) -> None:
    logging.set_console_handler(None)
    first, again = live(60.0, speed=0.4), live(60.0, speed=0.4)
    assert first.digest.hexdigest() == again.digest.hexdigest()
    assert first.counts == again.counts
    assert [first.counts[topic] for topic in ("/scan", "/odom", "/tf")] == pytest.approx([600, 3000, 3000], abs=1)
    assert first.counts["/cmd_vel"] == first.counts["/scan"]
    assert first.counts["/rosout"] > 30
    assert capfd.readouterr() == ("", "")


def test_another_robot_leaves_another_trace() -> None:
    logging.set_console_handler(None)
    assert live(2.0, speed=0.4).digest.hexdigest() != live(2.0, speed=0.3).digest.hexdigest()
