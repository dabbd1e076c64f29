"""Publishing by clients: their channels, and the zeros that stop a robot whose driver has gone or stalls."""

from __future__ import annotations

import copy
from typing import Any

import msgspec

from robolink.exceptions import RobolinkError
from robolink.interfaces import find
from robolink.message import decode, encode, from_builtins
from robolink.view.protocol.answers import ENCODINGS
from robolink.view.protocol.requests import ClientChannel, ProtocolError
from robolink.view.sources.live import LiveSource

STOP_AFTER = 1.0
"""Seconds after which what a client drives stops, if it hears nothing more of it and the client has not said how long.

A page that freezes keeps its connection for a quarter of a minute.
"""

MOST_CHANNELS = 500
"""Upper bound of the channels that one client may publish on."""

DRIVEN = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
"""Types of messages that set robots in motion."""


class _Outgoing:
    """One channel of a client."""

    def __init__(self, system: LiveSource, wish: ClientChannel) -> None:
        self.cls = _class_of(system, wish.schema_name)
        self.encoding, self.stop_after = wish.encoding, wish.stop_after
        self.publisher = system.node.create_publisher(self.cls, wish.topic, 10)
        self.drives = self.cls.__ros_type__ in DRIVEN
        self.moving: Any = None
        """Last message, if it moves something."""
        self.stops_at = 0.0
        self._system, self._holds, self._told = system, wish.hold, False
        if self._holds:
            system.held[self.publisher.topic] += 1

    def publish(self, payload: bytes, now: float) -> None:
        """Publish what a client sent. Raises RobolinkError if it is not a message of the type."""
        if self.encoding == "json":
            message = from_builtins(self.cls, json_of(payload, self.publisher.topic))
            payload = encode(message)
        else:
            message = decode(self.cls, payload)  # nonsense is refused here, not by every robot
        if self.drives and moves(message) and self._is_held():
            return
        self.publisher.publish(payload)
        if self.drives:
            self.moving = message if moves(message) else None
            self.stops_at = now + (self.stop_after or STOP_AFTER)

    def _is_held(self) -> bool:
        """Return whether an emergency stop keeps this from moving anything; raises ProtocolError the first time."""
        is_held = self._system.held[self.publisher.topic] > 0
        told, self._told = self._told, is_held
        if is_held and not told:
            self.stop()
            raise ProtocolError("an emergency stop of a page holds it at zero")
        return is_held

    def stop(self) -> None:
        """Publish zeros if something moves."""
        if self.moving is not None:
            moving, self.moving = self.moving, None
            self.publisher.publish(stop_of(moving, self._system.time()))

    def close(self) -> None:
        """Stop, and end the publisher."""
        try:
            self.stop()
        finally:
            if self._holds:
                self._holds = False
                self._system.held[self.publisher.topic] -= 1
            self._system.node.destroy_publisher(self.publisher)


class Publishing:
    """Channels that one client publishes on.

    Args:
        system: System that it publishes to.
    """

    def __init__(self, system: LiveSource) -> None:
        self._system = system
        self._channels: dict[int, _Outgoing] = {}

    def advertise(self, wish: ClientChannel) -> None:
        """Begin a channel. Raises RobolinkError with the reason if it cannot be."""
        if wish.id in self._channels:
            raise ProtocolError(f"advertise: channel {wish.id} is there already")
        if len(self._channels) >= MOST_CHANNELS:
            raise ProtocolError(f"advertise: more than {MOST_CHANNELS} channels of one client")
        if wish.encoding not in ENCODINGS:
            expected = " or ".join(ENCODINGS)
            raise ProtocolError(f"advertise {wish.topic}: encoding {wish.encoding!r}; expected {expected}")
        self._channels[wish.id] = _Outgoing(self._system, wish)

    def unadvertise(self, number: int) -> None:
        """End a channel; what it drives stops."""
        channel = self._channels.pop(number, None)
        if channel is None:
            raise ProtocolError(f"unadvertise: there is no channel {number}")
        channel.close()

    def publish(self, number: int, payload: bytes, now: float) -> None:
        """Publish a message on a channel; `now` in seconds of a steady clock."""
        channel = self._channels.get(number)
        if channel is None:
            raise ProtocolError(f"a message on channel {number}, which was not advertised")
        try:
            channel.publish(payload, now)
        except RobolinkError as error:
            raise ProtocolError(f"{channel.publisher.topic}: not published: {error}") from None

    def tick(self, now: float) -> None:
        """Stop what a stalled client drives."""
        for each in self._channels.values():
            if each.moving is not None and now >= each.stops_at:
                each.stop()

    def close(self) -> None:
        """End all channels; what they drive stops first."""
        channels = list(self._channels.values())
        self._channels.clear()
        for each in channels:
            each.stop()
        for each in channels:
            each.close()


def json_of(payload: bytes, what: str) -> Any:
    """Return a payload in JSON as data; raises ProtocolError for what is none."""
    try:
        return msgspec.json.decode(payload)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ProtocolError(f"{what}: a message that is not JSON: {error}") from None


def _class_of(system: LiveSource, name: str) -> type[Any]:
    known = system.types.named(name)
    return find(name) if known is None else known


def moves(message: Any) -> bool:
    """True if a Twist or TwistStamped is not all zeros."""
    twist = getattr(message, "twist", message)
    return any((*_numbers(twist.linear), *_numbers(twist.angular)))


def stop_of(message: Any, now: int) -> Any:
    """Return the message of zeros for whatever the given one moves.

    Args:
        message: Twist or TwistStamped that was sent last.
        now: Time for its header, in ns.
    """
    stopped = type(message)()
    if hasattr(message, "header"):
        stopped.header = copy.deepcopy(message.header)
        stopped.header.stamp.sec, stopped.header.stamp.nanosec = divmod(now, 10**9)
    return stopped


def _numbers(vector: Any) -> tuple[float, float, float]:
    return vector.x, vector.y, vector.z
