"""Markers of simulated worlds for bags of virtual time, in which the worlds' nodes publish none.

Viewers of such a bag show floor, walls and things nevertheless, and runs and their hashes are the same with and without
a recording.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from typing import TYPE_CHECKING

from robolink.bag.topic import BagTopic, message_definition
from robolink.bag.writer import BagWriter
from robolink.interfaces.visualization_msgs.msg import MarkerArray
from robolink.message import encode, type_hash, type_name
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.simulate.nodes import worlds_of

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.world_node import Simulation
    from robolink.world_node.shapes import Scenery

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""Profile of the markers of a world, as its node has it."""

PERIOD = 10**8
"""Least time between two looks at what moves, in nanoseconds: that of the node in real time."""


class SceneryTrack:
    """Track of a bag with the markers of simulated worlds: floor and walls once, the rest when it has changed.

    Args:
        bag: The bag.
        begin: Time of its begin in nanoseconds, at which floors and walls are there.
        topics: Topics that it has; None: all.
    """

    def __init__(self, bag: BagWriter, begin: int, topics: Collection[str] | None = None) -> None:
        self._bag, self._begin, self._topics = bag, begin, topics
        self._worlds: dict[str, tuple[Simulation, Scenery]] = {}
        self._waiting: list[tuple[str, int, bytes]] = []
        self._numbers: dict[str, int] = {}
        self._counts: dict[str, int] = {}
        self._next = 0

    def look(self, nodes: Callable[[], Iterable[Node]], now: int) -> None:
        """Note what has changed in the worlds of some nodes, if it is time for that.

        Args:
            nodes: Function that returns the nodes.
            now: Time in nanoseconds.
        """
        if now < self._next:
            return
        self._next = now + PERIOD
        for node, simulation in worlds_of(nodes()):
            name = node.get_fully_qualified_name()
            scenery = self._scenery(name, simulation)
            if (objects := scenery.changed(simulation)) is not None:
                self._note(f"{name}/objects", now, objects)

    def _scenery(self, name: str, simulation: Simulation) -> Scenery:
        known, scenery = self._worlds.get(name, (None, None))
        if scenery is None or known is not simulation:  # the first time, or its node was started again
            from robolink.world_node.shapes import Scenery

            scenery = Scenery(simulation.description)
            self._worlds[name] = simulation, scenery
            self._note(f"{name}/floor", self._begin, scenery.floor())
            self._note(f"{name}/walls", self._begin, scenery.walls())
        return scenery

    def _note(self, topic: str, at: int, message: MarkerArray) -> None:
        if self._topics is None or topic in self._topics:
            self._waiting.append((topic, at, encode(message)))

    def write(self) -> None:
        """Write the messages that came since the last call. Raises OSError and McapError (a ValueError)."""
        waiting, self._waiting = self._waiting, []
        for topic, at, payload in waiting:
            if topic not in self._numbers:
                self._numbers[topic] = self._bag.add_topic(_described(topic))
            self._counts[topic] = self._counts.get(topic, 0) + 1
            self._bag.write(self._numbers[topic], at, at, self._counts[topic], payload)


def _described(name: str) -> BagTopic:
    cls = MarkerArray
    return BagTopic(name, type_name(cls), "cdr", type_hash(cls), (LATCHED,), message_definition(cls))
