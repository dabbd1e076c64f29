"""Cyclone DDS, of another vendor: its topics both ways, by itself and through the bridge."""

from __future__ import annotations

import contextlib

import pytest

from tests.dds.conftest import Lab, real
from tests.dds.peers import Peer, environment, meet

pytestmark = pytest.mark.processes

CASES = [
    ("text", "std_msgs/msg/String", 20, 0),
    ("twist", "geometry_msgs/msg/Twist", 20, 0),
    ("bytes", "std_msgs/msg/UInt8MultiArray", 4, 1_000_000),
]


@pytest.mark.parametrize("way", ["direct", "bridge"])
def test_topics_go_to_cyclone_and_back(lab: Lab, way: str) -> None:
    python = real("cyclone")
    with contextlib.ExitStack() as stack:
        if way == "bridge":
            stack.enter_context(lab.bridge())
        ours = stack.enter_context(lab.direct() if way == "direct" else lab.beside())
        theirs = stack.enter_context(
            Peer(python, "cyclone", environment(lab.domain), lab.folder, program="cyclone_peer.py")
        )
        ours.ready(), theirs.ready()
        for topic, type_name, count, size in CASES:
            ours.ask("subscription", topic=f"{topic}_back", type_name=type_name)
            ours.ask("publisher", topic=topic, type_name=type_name)
            meet(ours, ours, topic, f"{topic}_back")
            theirs.wait(f"{topic} hears")
            theirs.wait(f"{topic} is heard")
            ours.ask("stream", topic=topic, rate=50.0, count=count, size=size)
            came = ours.wait(f"{topic}_back", count)
            assert [each["number"] for each in came] == list(range(1, count + 1))
            assert all(each["right"] for each in came)
        ours.ask("subscription", topic="kept", type_name="std_msgs/msg/String", depth=1, latched=True, field="data")
        assert ours.wait("kept")[0]["value"] == "kept by Cyclone"
