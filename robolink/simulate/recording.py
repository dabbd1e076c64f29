"""Recording of a simulated run into a bag: all that is published, in its order, in virtual time.

It taps publishers and subscribes to nothing, so that a run is the same with and without it. What differs between
machines and Pythons is left out, as it is of the run's hash: the same seed gives the same bytes. Added are the markers
of simulated worlds, which their nodes publish in real time only: viewers of the bag show walls and shapes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.bag.topic import BagTopic, message_definition
from robolink.bag.writer import BagWriter
from robolink.exceptions import NotFoundError, RobolinkError
from robolink.host.trace import ROSOUT, TRACEBACK
from robolink.interfaces import find_announced
from robolink.interfaces.rcl_interfaces.msg import Log
from robolink.message import decoder, encode
from robolink.qos import QoSProfile
from robolink.simulate.scenery import SceneryTrack
from robolink.system.processes import ROS_DISTRO
from robolink.transport.base import NumberingOutlet
from robolink.wire import NO_HASH, DataKey, parse_key, unpack_attachment

if TYPE_CHECKING:
    from robolink.node import Node

MOST_WAITING = 2**24
"""Size in bytes of what is published from which on it is written at once, and not after this part of the run."""


class SimulatedRecording:
    """Bag of what the programs of a host publish.

    Args:
        path: Folder of the bag, which must not be there yet.
        now: Function that returns the time of the host, in ns.

    Raises:
        BagError: (a ValueError) if the folder is there.
        OSError: if the bag cannot be written.
    """

    def __init__(self, path: str | Path, now: Callable[[], int]) -> None:
        self.nodes: Callable[[], Iterable[Node]] = tuple
        """Function that returns the nodes, whose publishers know types that are not installed."""
        self._bag = BagWriter(path, ros_distro=ROS_DISTRO)
        self._now = now
        self._topics: dict[str, _Topic] = {}
        self._waiting: list[tuple[_Topic, int, bytes, bytes]] = []
        self._size = 0
        self._scenery = SceneryTrack(self._bag, now())
        self._error: Exception | None = None
        self._closed = False

    def tapped(self, key: str, qos: QoSProfile, outlet: NumberingOutlet) -> NumberingOutlet:
        """Return the outlet of a publisher of this key and profile: it notes what is sent, and sends it by `outlet`."""
        parsed = parse_key(key)
        topic = self._topics.setdefault(parsed.name, _Topic(parsed))
        topic.profiles.append(qos)
        return _TappedOutlet(outlet, lambda payload, sent: self._note(topic, payload, sent))

    def _note(self, topic: _Topic, payload: bytes, attachment: bytes) -> None:
        if self._closed:
            return
        now = self._now()
        self._waiting.append((topic, now, payload, attachment))
        self._scenery.look(self.nodes, now)
        self._size += len(payload)
        if self._size > MOST_WAITING:
            try:
                self.write()
            except (OSError, RobolinkError) as error:  # no error of the program that just publishes
                self._error = error

    def write(self) -> None:
        """Write the messages that were published since the last call. Raises OSError and McapError (a ValueError)."""
        waiting, self._waiting, self._size = self._waiting, [], 0
        if self._error is not None:
            raise self._error
        for topic in self._topics.values():  # in the order in which they were advertised
            if topic.number < 0:
                topic.number = self._bag.add_topic(self._described(topic))
        for topic, at, payload, attachment in waiting:
            sender = unpack_attachment(attachment)
            data = _steadied(payload) if topic.key.name == ROSOUT else payload
            self._bag.write(topic.number, at, sender.timestamp, sender.sequence, data)
        self._scenery.write()

    def close(self) -> None:
        """Write the rest and close the bag; nothing is noted any more. Raises OSError and McapError (a ValueError).

        Safe to call twice.
        """
        if not self._closed:
            self._closed = True
            try:
                self.write()
            finally:
                self._bag.close()

    def _described(self, topic: _Topic) -> BagTopic:
        name, type_name, type_hash = topic.key.name, topic.key.type_name, topic.key.type_hash
        cls = self._class_of(topic)
        text = "" if cls is None else message_definition(cls)
        stated = "" if type_hash == NO_HASH else type_hash
        return BagTopic(name, type_name, "cdr", stated, tuple(topic.profiles), text)

    def _class_of(self, topic: _Topic) -> type[Any] | None:
        for node in self.nodes():
            for publisher in node.publishers:
                if publisher.topic_name == topic.key.name:
                    return publisher.msg_type
        try:
            return find_announced(topic.key.type_name)
        except (NotFoundError, RobolinkError):
            return None


class _Topic:
    def __init__(self, key: DataKey) -> None:
        self.key, self.number = key, -1
        self.profiles: list[QoSProfile] = []


class _TappedOutlet:
    """Outlet of a publisher that notes what it sends."""

    def __init__(self, outlet: NumberingOutlet, note: Callable[[bytes, bytes], None]) -> None:
        self._outlet, self._note = outlet, note
        self._send, self.close = outlet.put_numbered, outlet.close

    def put(self, payload: bytes, attachment: bytes) -> None:
        """Send, and note it."""
        self.put_numbered(payload, lambda: attachment)

    def put_numbered(self, payload: bytes, attachment: Callable[[], bytes]) -> bytes:
        """Send, and note it."""
        sent = self._send(payload, attachment)
        self._note(payload, sent)
        return sent

    @property
    def matched(self) -> bool:
        """True if anybody subscribes."""
        return self._outlet.matched


_decode = decoder(Log)


def _steadied(payload: bytes) -> bytes:
    """Return a line of the log without its place in a file and without a traceback."""
    line = _decode(payload)
    line.file, line.function, line.line = "", "", 0
    line.msg = line.msg.partition(TRACEBACK)[0].rstrip("\n") if TRACEBACK in line.msg else line.msg
    return encode(line)
