"""Bag source: the topics of a recorded bag, played at any speed, paused and sought by clients."""

from __future__ import annotations

import struct
from collections.abc import Container, Iterable
from typing import Any

from robolink.bag.playing.playback import Playback, Playlist
from robolink.bag.playing.publishers import is_latched
from robolink.bag.playing.settings import PlaySettings
from robolink.bag.reader import Bag
from robolink.bag.selection import EVERYTHING
from robolink.bag.topic import BagMessage, BagTopic, message_definition
from robolink.exceptions import RobolinkError
from robolink.interfaces import find_announced
from robolink.system import clocks
from robolink.view.channels import Audience, Channel, Retained, ServiceEntry
from robolink.view.protocol import answers
from robolink.view.protocol.answers import ENDED, PAUSED, PLAYING, WARNING
from robolink.view.protocol.requests import PlaybackControl

BUDGET = 20_000_000
"""Longest time that one sweep reads, in ns; a bag that is played faster than that is played slower."""

LONGEST_STEP = 250_000_000
"""Longest time that playback goes on at once, in ns: after a pause of the process it does not jump."""

LOOK_BACK = 5 * 10**9
"""Time before the sought moment, in ns of the bag, in which the last message of each topic is looked for."""

_TF = "tf2_msgs/msg/TFMessage"
_NO_SENDER = bytes(33)


class Scenes(Playlist):
    """Playlist that begins at any moment with what a page would show then: the last message of every topic.

    Args:
        bag: The bag.
        left_out: Names of topics that are left out.
    """

    def __init__(self, bag: Bag, left_out: Iterable[str]) -> None:
        super().__init__([bag], EVERYTHING._replace(exclude_topics=tuple(left_out)))
        self._bag = bag
        self.requested: set[str] = set()
        """Names of the topics that somebody looks at."""

    def latched(self, before: int, names: Container[str] | None = None) -> list[BagMessage]:
        """Return the messages that latched topics retain at a time, of others the last, that of this very time too."""
        requested = self.requested if names is None else names
        found = super().latched(before + 1, requested) + self._last(before + 1, requested)
        return sorted(found, key=lambda each: each.log_time)

    def _last(self, before: int, names: Container[str]) -> list[BagMessage]:
        """Return the last message of each topic that is not latched, oldest first; of transforms, all of LOOK_BACK."""
        left = {name for name, each in self.topics.items() if name in names and not is_latched(each)}
        found: list[BagMessage] = []
        for each in self._bag.messages(left, before - LOOK_BACK, before, reverse=True) if left else ():
            if each.topic in left:
                found.append(each._replace(data=bytes(each.data)))
                left -= {each.topic} if self.topics[each.topic].type_name != _TF else set()
            if not left:
                break
        return found[::-1]


class BagSource:
    """Topics of a bag, for a server that shows it.

    Its playback goes by a clock of its own, which a sweep sets forward. That stands still while reading is late.

    Args:
        bag: The open bag.
    """

    def __init__(self, bag: Bag) -> None:
        self.bag = bag
        self.services: dict[int, ServiceEntry] = {}
        self.channels: dict[int, Channel] = {}
        self._mixed = _mixed(bag.topics)
        self._scenes = Scenes(bag, self._mixed)
        self._without_schema: list[str] = []
        self._by_name: dict[str, Channel] = {}
        for topic in self._scenes.topics.values():
            self._add(topic)
        self._then, self._clock, self._is_late = clocks.steady(), 0, False
        self._playback = Playback(self._scenes, self._deliver, lambda: self._clock, PlaySettings(start_paused=True))
        self._playback.begin()
        self._begun = False

    def _add(self, topic: BagTopic) -> None:
        schema = _schema(topic)
        if schema is None or topic.serialization_format != "cdr":
            self._without_schema.append(topic.name)
            return
        channel = Channel(len(self.channels) + 1, topic.name, topic.type_name, schema, topic.type_hash)
        channel.latched = is_latched(topic)
        self.channels[channel.id] = self._by_name[topic.name] = channel

    def begin(self, audience: Audience) -> None:
        """Warn of what cannot be shown."""
        self._audience = audience
        for index, each in enumerate(self.bag.problems):
            audience.tell(WARNING, each, f"bag {index}")
        if self._without_schema:
            names = ", ".join(self._without_schema)
            audience.tell(WARNING, f"without a definition of their type, not shown: {names}", "bag types")
        if self._mixed:
            audience.tell(WARNING, f"of several types, not shown: {', '.join(self._mixed)}", "bag mixed types")

    # Messages

    def listen(self, channel: Channel) -> None:
        """Begin to read a topic; the first one begins to play."""
        self._scenes.requested.add(channel.topic)
        if not self._begun:
            self._begun = True
            self._playback.resume()
            self._audience.playback_changed(did_seek=False)

    def leave(self, channel: Channel) -> None:
        """Read it no longer."""
        self._scenes.requested.discard(channel.topic)

    def retained(self, channel: Channel) -> list[Retained]:
        """Return the messages of a late subscriber: the last one of a topic, of a latched one those that it retains."""
        if not self._begun:
            return []
        return [_retained(channel, each) for each in self._scenes.latched(self._playback.time, {channel.topic})]

    def sweep(self) -> None:
        """Play on, as far as time has gone on."""
        moment = clocks.steady()
        spent, self._then = min(moment - self._then, LONGEST_STEP), moment
        if self._state() != PLAYING:
            return
        self._clock += 0 if self._is_late else spent
        self._is_late = not self._play(moment + BUDGET)
        self._audience.time_is(self._playback.time)
        if self._state() == ENDED:
            self._audience.playback_changed(did_seek=False)

    def now(self) -> int:
        """Return the time in the bag, in ns since the epoch."""
        return self._playback.time

    def _state(self) -> int:
        return ENDED if self._playback.is_over else PAUSED if self._playback.is_paused else PLAYING

    def _play(self, deadline: int) -> bool:
        """Deliver what is due; return whether that was done by the deadline."""
        while True:
            due = self._playback.advance()
            if due is None or due > self._clock:
                return True
            if clocks.steady() > deadline:
                return False

    def _deliver(self, message: BagMessage, at: int) -> None:
        channel = self._by_name.get(message.topic)
        if channel is not None and message.topic in self._scenes.requested:
            channel.deliver(*_retained(channel, message))

    # Playback

    def control(self, request: PlaybackControl) -> bool:
        """Obey a client; returns True if the time jumped. Playing at the end begins again.

        Raises PlayError (a ValueError) for a speed that is out of range.
        """
        playback, target = self._playback, request.seek
        playback.set_rate(request.speed)
        self._begun = True
        if target is None and request.play and playback.is_over:
            target = playback.start_time
        if request.play:
            playback.resume()
        else:
            playback.pause()
        if target is None:
            return False
        playback.seek(max(playback.start_time, min(target, playback.end_time)))
        self._audience.time_is(playback.time)
        return True

    def playback_state(self, *, did_seek: bool, request_id: str = "") -> bytes:
        """Return the state of playback, as clients are told it."""
        playback = self._playback
        return answers.playback_state(self._state(), playback.time, playback.rate, did_seek, request_id)

    # What is offered

    def ends(self, channel: Channel) -> tuple[int, int]:
        """Return no publishers and no subscriptions: a bag has none."""
        return 0, 0

    def capabilities(self) -> list[str]:
        """Return the server's capabilities, in Foxglove's words."""
        return ["playbackControl", "time"]

    def information(self) -> dict[str, Any]:
        """Return fields of `serverInfo`."""
        return {
            "robolink": {"bag": str(self.bag.path), "domain": None},
            "dataStartTime": _stamp(self.bag.start_time),
            "dataEndTime": _stamp(self.bag.end_time),
        }

    def close(self) -> None:
        """Close the bag."""
        self._playback.stop()
        self.bag.close()


def _mixed(topics: Iterable[BagTopic]) -> list[str]:
    """Return the names of the topics that have several types: it is not known which message has which."""
    first: dict[str, BagTopic] = {}
    return sorted({each.name for each in topics if each.difference(first.setdefault(each.name, each))})


def _schema(topic: BagTopic) -> str | None:
    """Return the definition of a topic's type: the bag's, else that of an installed type; None if there is none."""
    if topic.message_definition and topic.definition_encoding == "ros2msg":
        return topic.message_definition
    try:
        return message_definition(find_announced(topic.type_name))
    except (RobolinkError, AttributeError):
        return None


def _retained(channel: Channel, message: BagMessage) -> Retained:
    payload = bytes(message.data)
    sender = _tf_sender(payload) if channel.type_name == _TF else _NO_SENDER
    return Retained(message.log_time, payload, sender)


def _tf_sender(payload: bytes) -> bytes:
    """Return a stand-in for the publisher of transforms, by their first frames: a bag does not tell it."""
    try:
        order = "<I" if payload[1] & 1 else ">I"
        frame = 20 + struct.unpack_from(order, payload, 16)[0]
        child = frame + -frame % 4
        name = payload[child + 4 : child + 4 + struct.unpack_from(order, payload, child)[0]]
    except (struct.error, IndexError):
        return _NO_SENDER
    return bytes(17) + name[-16:].rjust(16, b"\0")


def _stamp(moment: int) -> dict[str, int]:
    seconds, nanoseconds = divmod(moment, 10**9)
    return {"sec": seconds, "nsec": nanoseconds}
