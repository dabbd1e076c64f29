"""Decoder of clients' messages: JSON operations by their `op`, binary ones by their first byte."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from typing import Annotated, Any, Literal, NamedTuple, get_args

import msgspec

from robolink.exceptions import RobolinkError, nearest
from robolink.view.protocol.answers import ENCODINGS

U32 = Annotated[int, msgspec.Meta(ge=0, le=0xFFFF_FFFF)]
Name = Annotated[str, msgspec.Meta(max_length=1000)]
LearnCommand = Literal["show", "check", "hint", "reset", "language"]
"""Request about an exercise: `show` only looks, the others change something."""
Rate = Annotated[float, msgspec.Meta(ge=0, le=1e6)]
LONGEST_LIST = 5_000
"""Upper bound of the entries of one operation."""

LONGEST_TEXT = 1_000_000
"""Upper bound of the letters of one operation in JSON: reading 16 MB of it takes as long as a robot may drive on."""


class ProtocolError(RobolinkError, ValueError):
    """A client's message is none of the protocol's; the text is fit for its status."""


class _Op(msgspec.Struct, rename="camel", tag_field="op"):
    pass


class SubscriptionRequest(msgspec.Struct, rename="camel"):
    """Subscription that a client asks for: its own number, the channel, and the rate in Hz (0: every message)."""

    id: U32
    channel_id: U32
    rate: Rate = 0.0


class Subscribe(_Op, tag="subscribe"):
    """Request to receive channels."""

    subscriptions: Annotated[list[SubscriptionRequest], msgspec.Meta(max_length=LONGEST_LIST)]


class Unsubscribe(_Op, tag="unsubscribe"):
    """Request to receive them no longer."""

    subscription_ids: Annotated[list[U32], msgspec.Meta(max_length=LONGEST_LIST)]


class ClientChannel(msgspec.Struct, rename="camel"):
    """Channel that a client wants to publish on.

    After `stop_after` seconds without a message, something that drives gets zeros; None is the server's STOP_AFTER.
    """

    id: U32
    topic: Name
    encoding: Name
    schema_name: Name
    stop_after: Annotated[float, msgspec.Meta(gt=0, le=3600)] | None = None


class Advertise(_Op, tag="advertise"):
    """Request to publish."""

    channels: Annotated[list[ClientChannel], msgspec.Meta(max_length=LONGEST_LIST)]


class Unadvertise(_Op, tag="unadvertise"):
    """Request to publish no longer."""

    channel_ids: Annotated[list[U32], msgspec.Meta(max_length=LONGEST_LIST)]


class ParameterRequest(msgspec.Struct):
    """Parameter that a client sets; without a value it is deleted."""

    name: Name
    value: Any = None
    type: str | None = None


class GetParameters(_Op, tag="getParameters"):
    """Request for parameters, of all nodes if none is named."""

    parameter_names: Annotated[list[Name], msgspec.Meta(max_length=LONGEST_LIST)] = []
    id: Name | None = None


class SetParameters(_Op, tag="setParameters"):
    """Request to change parameters."""

    parameters: Annotated[list[ParameterRequest], msgspec.Meta(max_length=LONGEST_LIST)]
    id: Name | None = None


class SubscribeParameterUpdates(_Op, tag="subscribeParameterUpdates"):
    """Request to be told of changed parameters; all if none is named."""

    parameter_names: Annotated[list[Name], msgspec.Meta(max_length=LONGEST_LIST)] = []


class UnsubscribeParameterUpdates(_Op, tag="unsubscribeParameterUpdates"):
    """Request to be told of them no longer; of none if none is named."""

    parameter_names: Annotated[list[Name], msgspec.Meta(max_length=LONGEST_LIST)] = []


class SubscribeConnectionGraph(_Op, tag="subscribeConnectionGraph"):
    """Request for the graph, and its changes."""


class UnsubscribeConnectionGraph(_Op, tag="unsubscribeConnectionGraph"):
    """Request for no more of the graph."""


class FetchAsset(_Op, tag="fetchAsset"):
    """Request for a file, which this server refuses."""

    uri: str
    request_id: U32


class SubscribeStatistics(_Op, tag="subscribeStatistics"):
    """Request for statistics once a second (robolink.v1)."""


class UnsubscribeStatistics(_Op, tag="unsubscribeStatistics"):
    """Request for no more statistics (robolink.v1)."""


class Record(_Op, tag="record"):
    """Request to begin or end a recording (robolink.v1)."""

    command: str
    path: Name | None = None


class Stop(_Op, tag="stop"):
    """Request to press STOP, or with `held` false to release it (robolink.v1)."""

    held: bool


class Learn(_Op, tag="learn"):
    """Request of the panel of exercises: to show, check or reset one, for a hint, or for a language (robolink.v1)."""

    command: LearnCommand
    name: Name = ""


JsonOp = (
    Subscribe
    | Unsubscribe
    | Advertise
    | Unadvertise
    | GetParameters
    | SetParameters
    | SubscribeParameterUpdates
    | UnsubscribeParameterUpdates
    | SubscribeConnectionGraph
    | UnsubscribeConnectionGraph
    | FetchAsset
    | SubscribeStatistics
    | UnsubscribeStatistics
    | Record
    | Stop
    | Learn
)


class MessageData(NamedTuple):
    """Message that a client publishes on one of its channels."""

    channel_id: int
    payload: bytes


class ServiceCall(NamedTuple):
    """Call of a service, with the client's number for it."""

    service_id: int
    call_id: int
    encoding: str
    payload: bytes


class PlaybackControl(NamedTuple):
    """Command to the playback of a bag."""

    play: bool
    speed: float
    seek: int | None
    """Time to go to, in ns; None stays where it is."""
    request_id: str


class Acknowledge(NamedTuple):
    """Acknowledgement of one batch (robolink.v1)."""


Request = JsonOp | MessageData | ServiceCall | PlaybackControl | Acknowledge

_OP_NAMES = [each.__struct_config__.tag for each in get_args(JsonOp)]
_json = msgspec.json.Decoder(JsonOp)
_u32 = struct.Struct("<I")
_call = struct.Struct("<III")
_playback = struct.Struct("<BfBQI")
MOST_SPEED = 1000.0
"""Upper bound of the speed of playback."""
_ACKNOWLEDGE = Acknowledge()


def decode(raw: str | bytes) -> Request:
    """Decode a client's message; raises ProtocolError, in one line, for anything but the protocol's."""
    if isinstance(raw, str):
        return _decode_json(raw)
    if not raw:
        raise ProtocolError("an empty binary message; expected an operation in its first byte")
    read = _BINARY.get(raw[0])
    if read is None:
        raise ProtocolError(f"no binary operation {raw[0]}; there are {', '.join(map(str, _BINARY))}")
    try:
        return read(raw)
    except (struct.error, UnicodeDecodeError):
        raise ProtocolError(f"binary operation {raw[0]}: {len(raw)} bytes are not all of it, or no text") from None


def _decode_json(raw: str) -> Request:
    if len(raw) > LONGEST_TEXT:
        raise ProtocolError(f"a JSON message of {len(raw)} letters; expected at most {LONGEST_TEXT}")
    try:
        decoded: Request = _json.decode(raw)
    except RecursionError:
        raise ProtocolError("a JSON message is nested too deeply") from None
    except msgspec.ValidationError as error:
        raise ProtocolError(_why(raw, error)) from None
    except (msgspec.DecodeError, UnicodeEncodeError) as error:
        raise ProtocolError(f"a message that is not JSON: {error}") from None
    return decoded


def _why(raw: str, error: msgspec.ValidationError) -> str:
    try:
        op = msgspec.json.decode(raw)["op"]
    except msgspec.DecodeError as broken:  # behind the first wrong value
        return f"a message that is not JSON: {broken}"
    except (TypeError, KeyError, RecursionError):
        return "a JSON message without 'op'"
    if op not in _OP_NAMES:
        return f"no operation {str(op)[:60]!r}{nearest(str(op)[:60], _OP_NAMES)}"
    return f"{op}: {error}"


def _message_data(raw: bytes) -> MessageData:
    return MessageData(_u32.unpack_from(raw, 1)[0], raw[5:])


def _service_call(raw: bytes) -> ServiceCall:
    service_id, call_id, length = _call.unpack_from(raw, 1)
    encoding = raw[13 : 13 + length].decode()
    if encoding not in ENCODINGS:
        raise ProtocolError(f"a service call in {encoding[:40]!r}; expected {' or '.join(ENCODINGS)}")
    return ServiceCall(service_id, call_id, encoding, raw[13 + length :])


def _playback_control(raw: bytes) -> PlaybackControl:
    command, speed, had_seek, seek, length = _playback.unpack_from(raw, 1)
    if command > 1:
        raise ProtocolError(f"playback: no command {command}; there are 0 (play) and 1 (pause)")
    if not (math.isfinite(speed) and 0 < speed <= MOST_SPEED):
        raise ProtocolError(f"playback: expected a speed above 0 and up to {MOST_SPEED:g}, got {speed:g}")
    begin = 1 + _playback.size
    if len(raw) < begin + length:
        raise ProtocolError(f"playback: a request id of {length} bytes, of which {len(raw) - begin} are there")
    return PlaybackControl(command == 0, speed, seek if had_seek else None, raw[begin : begin + length].decode())


_BINARY: dict[int, Callable[[bytes], Request]] = {
    0x01: _message_data,
    0x02: _service_call,
    0x03: _playback_control,
    0x80: lambda _: _ACKNOWLEDGE,
}
