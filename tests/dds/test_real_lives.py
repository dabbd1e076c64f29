"""What starts, dies and comes back beside a real ROS 2 over DDS, and how long that takes."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence

import pytest

from tests.dds.conftest import Lab, real
from tests.dds.peers import Peer, until
from tests.dds.stage import Stage

pytestmark = pytest.mark.processes

EXCHANGED_WITHIN = 2.5
"""How long after the last one is ready, in s; 1.5 s on a quiet machine. One heartbeat of Fast DDS would be three."""

ORDERS = [
    ("kilted", "direct", ("ours", "real")),
    ("jazzy", "direct", ("real", "ours")),
    ("kilted", "bridge", ("real", "ours", "bridge")),
    ("jazzy", "bridge", ("bridge", "ours", "real")),
    ("kilted", "bridge", ("ours", "bridge", "real")),
]


@pytest.mark.parametrize(
    ("distribution", "way", "order"), ORDERS, ids=lambda value: value if isinstance(value, str) else "-".join(value)
)
def test_whoever_starts_last_is_heard_soon(lab: Lab, distribution: str, way: str, order: Sequence[str]) -> None:
    real(distribution)
    with Stage(lab, distribution, way) as stage:
        for part in order:
            stage.start(part)
        stage.exchanged(EXCHANGED_WITHIN)


PARTS = [("direct", "real"), ("direct", "ours"), ("bridge", "real"), ("bridge", "ours"), ("bridge", "bridge")]


@pytest.mark.parametrize(("way", "part"), PARTS, ids=lambda value: value)
def test_a_part_that_is_killed_and_started_again_is_back(lab: Lab, way: str, part: str) -> None:
    real("kilted")
    with Stage(lab, "kilted", way) as stage:
        for each in ("real", "bridge", "ours") if way == "bridge" else ("real", "ours"):
            stage.start(each)
        stage.exchanged(EXCHANGED_WITHIN)
        stage.kill(part)
        stage.start(part)
        stage.exchanged(EXCHANGED_WITHIN)


@pytest.mark.parametrize("way", ["direct", "bridge"])
def test_two_hundred_endpoints_of_ten_nodes_are_known_soon(lab: Lab, way: str) -> None:
    real("kilted")
    expected = {f"/crowd/c{node}_{topic}" for node in range(10) for topic in range(10)}

    def knows(peer: Peer) -> bool:
        found = peer.ask("nodes")
        return len([each for each in found if each.startswith("/crowd/")]) == 10 and expected <= set(peer.ask("topics"))

    with contextlib.ExitStack() as stack:
        crowd = stack.enter_context(lab.real("kilted"))
        if way == "bridge":
            stack.enter_context(lab.bridge())
        start = lab.direct if way == "direct" else lab.beside
        ours = stack.enter_context(start())
        crowd.ready(), ours.ready()
        crowd.ask("crowd", nodes=10, topics=10, prefix="c")
        until(lambda: knows(ours), "all are known by who was there before", 4.0)
        late = stack.enter_context(start("late")).ready()
        until(lambda: knows(late), "all are known by who comes later", 4.0)
        for topic in sorted(expected)[::10]:
            ends = late.ask("endpoints", topic=topic)
            assert [len(each) for each in ends] == [1, 1]
