"""Messages that clients publish, with the stop of what they drive, and their calls of services."""

from __future__ import annotations

import asyncio
import copy
from typing import Any

import msgspec

from robolink.control.stop_lock import TOPIC
from robolink.exceptions import RobolinkError
from robolink.interfaces import find
from robolink.message import Service, decode, encode, from_builtins, to_builtins
from robolink.system.terminal import shown
from robolink.view.protocol import answers
from robolink.view.protocol.answers import ENCODINGS
from robolink.view.protocol.requests import ClientChannel, ProtocolError, ServiceCall
from robolink.view.server.outbox import Listener
from robolink.view.server.stopping import DRIVEN, Stopping
from robolink.view.sources.live import LiveSource

STOP_AFTER = 1.0
"""Seconds after which what a client drives stops, if it hears nothing more of it and the client has not said how long.

A page that freezes keeps its connection for a quarter of a minute.
"""

MOST_CHANNELS = 500
"""Upper bound of the channels that one client may publish on."""

ANSWER_WITHIN = 300.0
"""Longest wait for an answer, in seconds."""

RESULT_WITHIN = 24 * 3600.0
"""Longest wait for the result of an action, which comes when its goal has ended."""

MOST_CALLS = 100
"""Calls of one client that may be under way."""


class _Outgoing:
    """One channel of a client."""

    def __init__(self, system: LiveSource, stopping: Stopping, request: ClientChannel) -> None:
        self.cls = _class_of(system, request.schema_name)
        self.encoding, self.stop_after = request.encoding, request.stop_after
        self.publisher = system.node.create_publisher(self.cls, request.topic, 10)
        self.drives = self.cls.__ros_type__ in DRIVEN
        self.moving: Any = None
        """Last message, if it moves something."""
        self.stops_at = 0.0
        self._system, self._stopping, self._reported = system, stopping, False

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
        """Return whether STOP keeps this from moving anything; raises ProtocolError the first time."""
        is_held = self._stopping.held
        reported, self._reported = self._reported, is_held
        if is_held and not reported:
            self.stop()
            raise ProtocolError(f"STOP holds ({TOPIC})")
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
            self._system.node.destroy_publisher(self.publisher)


class Publishing:
    """Channels that one client publishes on.

    Args:
        system: System that it publishes to.
        stopping: STOP of that system, while which nothing is moved.
    """

    def __init__(self, system: LiveSource, stopping: Stopping) -> None:
        self._system, self._stopping = system, stopping
        self._channels: dict[int, _Outgoing] = {}

    def advertise(self, request: ClientChannel) -> None:
        """Begin a channel. Raises RobolinkError with the reason if it cannot be."""
        if request.id in self._channels:
            raise ProtocolError(f"advertise: channel {request.id} is there already")
        if len(self._channels) >= MOST_CHANNELS:
            raise ProtocolError(f"advertise: more than {MOST_CHANNELS} channels of one client")
        if request.encoding not in ENCODINGS:
            expected = " or ".join(ENCODINGS)
            raise ProtocolError(f"advertise {request.topic}: encoding {request.encoding!r}; expected {expected}")
        self._channels[request.id] = _Outgoing(self._system, self._stopping, request)

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


class Calling:
    """Calls of one client.

    Args:
        client: Client that is answered.
        system: System whose services it calls.
    """

    def __init__(self, client: Listener, system: LiveSource) -> None:
        self._client, self._system = client, system
        self._tasks: set[asyncio.Task[None]] = set()

    def begin(self, call: ServiceCall) -> None:
        """Call a service, and answer the client later."""
        if len(self._tasks) >= MOST_CALLS:
            self._refuse(call, f"more than {MOST_CALLS} calls are under way")
            return
        task = asyncio.get_running_loop().create_task(self._call(call))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _call(self, call: ServiceCall) -> None:
        try:
            body = await self._answer(call)
        except RobolinkError as error:
            self._refuse(call, str(error))
        except Exception as error:  # noqa: BLE001 - no call may end the server
            self._refuse(call, f"the call failed: {error!r}")
        else:
            self._client.send(answers.service_response(call.service_id, call.call_id, call.encoding, body))

    async def _answer(self, call: ServiceCall) -> bytes:
        entry = self._system.services.get(call.service_id)
        cls = self._system.service_class(call.service_id)
        if entry is None or cls is None:
            raise ProtocolError(f"there is no service {call.service_id}")
        request = _request(cls, call, entry.name)
        is_result = entry.name.endswith("/_action/get_result")
        within = RESULT_WITHIN if is_result else ANSWER_WITHIN
        response = await self._system.caller.call(entry.name, cls, request, within)
        if call.encoding == "cdr":
            return response
        return msgspec.json.encode(to_builtins(decode(cls.Response, response)))

    def _refuse(self, call: ServiceCall, why: str) -> None:
        text = shown(why, 1000)
        self._client.say(answers.service_call_failure(call.service_id, call.call_id, text))

    def close(self) -> None:
        """Abandon all calls."""
        for each in list(self._tasks):
            each.cancel()


def _request(cls: type[Service], call: ServiceCall, name: str) -> bytes:
    """Return the serialized request; raises RobolinkError for what is not a request of the type."""
    made: Any = cls.Request
    try:
        if call.encoding == "json":
            return encode(from_builtins(made, json_of(call.payload, name) if call.payload else {}))
        decode(made, call.payload)
    except RobolinkError as error:
        raise ProtocolError(f"service {name}: not called: {error}") from None
    return call.payload
