"""What starts, dies and comes back beside a real ROS 2 over DDS, and how long that takes."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Sequence

import pytest

from tests.dds.conftest import Lab, real
from tests.dds.peers import Peer, until
from tests.support.commands import Command

pytestmark = pytest.mark.processes

EXCHANGED_WITHIN = 2.5
"""How long after the last one is ready, in s; 1.5 s on a quiet machine. One heartbeat of Fast DDS would be three."""

STRING = "std_msgs/msg/String"


class Stage:
    """Parts of a system by their names, each started when the test says so."""

    def __init__(self, lab: Lab, distribution: str, way: str) -> None:
        self.lab, self.distribution, self.way = lab, distribution, way
        self.parts: dict[str, Peer | Command] = {}
        self._stack = contextlib.ExitStack()
        self._serial = 0

    def start(self, part: str) -> None:
        makers: dict[str, Callable[[], Peer | Command]] = {
            "real": lambda: self.lab.real(self.distribution),
            "ours": self.lab.direct if self.way == "direct" else self.lab.beside,
            "bridge": self.lab.bridge,
        }
        made: Peer | Command = makers[part]()
        self._stack.callback(made.__exit__, None, None, None)
        self.parts[part] = made
        if isinstance(made, Peer):
            made.ready()
            other = "ours" if part == "real" else "real"
            made.ask("publisher", topic=f"of_{part}", type_name=STRING)
            made.ask("subscription", topic=f"of_{other}", type_name=STRING)
        else:
            made.wait_for("")

    def kill(self, part: str) -> None:
        self.parts[part].kill()

    def peer(self, part: str) -> Peer:
        found = self.parts[part]
        assert isinstance(found, Peer)
        return found

    def exchanged(self, within: float) -> float:
        """Wait until messages arrive on both sides that are sent from now on; return how long that takes, in s."""
        begun = time.monotonic()
        self._serial += 1000

        def both() -> bool:
            self._serial += 1
            came = []
            for sender, receiver in (("real", "ours"), ("ours", "real")):
                self.peer(sender).ask("publish", topic=f"of_{sender}", first=self._serial)
                came.append(any(each["at"] > begun for each in self.peer(receiver).events(f"of_{sender}")))
            return all(came)

        until(both, "messages both ways", within)
        return time.monotonic() - begun

    def __enter__(self) -> Stage:
        return self

    def __exit__(self, *exception: object) -> None:
        self._stack.close()


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
