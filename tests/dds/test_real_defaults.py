"""A real ROS 2 with its defaults, which look for others on every interface, in a machine of its own with a cable."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.dds.conftest import real
from tests.dds.peers import Peer, environment, meet
from tests.support import stalls
from tests.support.commands import ROBOLINK, Command

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are two hosts"),
]

STRING, IMAGE = "std_msgs/msg/String", "sensor_msgs/msg/Image"
DOMAIN = 0


@pytest.fixture
def inside() -> Iterator[tuple[str, ...]]:
    """What a command begins with that runs on a machine with loopback and a cable, where nobody else is."""
    with stalls.two_hosts() as (here, _):
        yield ("ip", "netns", "exec", here)


@pytest.mark.parametrize("way", ["direct", "bridge"])
@pytest.mark.parametrize("distribution", ["kilted", "jazzy"])
def test_a_real_node_with_its_defaults_is_met(
    inside: tuple[str, ...], programs: Path, distribution: str, way: str
) -> None:
    python = real(distribution)
    plain = environment(DOMAIN)
    del plain["ROS_AUTOMATIC_DISCOVERY_RANGE"], plain["ROS_DOMAIN_ID"]
    ours_environ = plain | ({"ROBOLINK_NETWORK": "dds"} if way == "direct" else {})
    with contextlib.ExitStack() as stack:
        theirs = stack.enter_context(Peer([*inside, *python], "real", plain, programs))
        if way == "bridge":
            stack.enter_context(Command(DOMAIN, "bridge", "dds", program=(*inside, *ROBOLINK), folder=programs))
        ours = stack.enter_context(Peer([*inside, *ROBOLINK, "run"], "ours", ours_environ, programs))
        theirs.ready(), ours.ready()
        for topic, type_name, count, size in (("said", STRING, 10, 0), ("seen", IMAGE, 3, 1_000_000)):
            for sender, receiver in ((theirs, ours), (ours, theirs)):
                own = f"{topic}_of_{sender.name}"
                sender.ask("publisher", topic=own, type_name=type_name)
                receiver.ask("subscription", topic=own, type_name=type_name)
                meet(sender, receiver, own)
                sender.ask("stream", topic=own, rate=30.0, count=count, size=size)
                came = receiver.wait(own, count)
                assert [(each["number"], each["right"]) for each in came] == [(n, True) for n in range(1, count + 1)]
