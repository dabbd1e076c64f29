"""CDR codec: for each message type, generated code that packs and unpacks it.

The wire is XCDR1 as ROS 2 has it: four bytes of encapsulation header, then each primitive aligned to its own size,
counted from the byte after the header. Neighbouring primitives are packed by one `struct.Struct`. Behind a string or
a sequence the alignment is only known at run time, so there is one such Struct for each of the eight phases.

What a type needs is read, and bytes behind it are ignored, as every reader of ROS 2 does: its own writers leave there
what their estimate of the size was too much (a JointState has 8 bytes more, a ParameterEvent up to 88).
"""

from __future__ import annotations

import functools
import struct
from collections.abc import Callable, Sequence
from typing import Any

from robolink.exceptions import DecodeError, EncodeError, MessageError
from robolink.message.annotations import once_per_type
from robolink.message.base import Message, message_type
from robolink.message.cdr_reader import ReaderSource
from robolink.message.cdr_writer import WriterSource
from robolink.message.convert import explain

LITTLE, BIG = b"\x00\x01\x00\x00", b"\x00\x00"


@once_per_type
def encoder(cls: type[Message]) -> Callable[[Any], bytes]:
    """Return the function that encodes a message of the class `cls` as bytes.

    It raises EncodeError, whose text names the field, for a value that does not fit.
    """
    return _writer(cls, WriterSource(message_type(cls)))


@once_per_type
def buffers_encoder(cls: type[Message]) -> Callable[[Any], Sequence[Any]]:
    """Return the function that encodes a message of the class `cls` as buffers in a row: its arrays as they are.

    Together they are what `encoder` makes of the message. It raises EncodeError as that does.
    """
    return _writer(cls, WriterSource(message_type(cls), apart=True))


def _writer(cls: type[Message], source: WriterSource) -> Callable[[Any], Any]:
    text = source.text()
    names = {**source.constants, "HEAD": LITTLE, "fail": functools.partial(_encode_error, cls)}
    return _compile(text, names, f"<encode {cls.__ros_type__}>")


@once_per_type
def decoder(cls: type[Message]) -> Callable[[bytes], Any]:
    """Return the function that decodes bytes into a message of the class `cls`. It raises DecodeError only."""
    return _reader(message_type(cls), "<", functools.partial(_decode_other, cls))


@once_per_type
def _big_endian_decoder(cls: type[Message]) -> Callable[[bytes], Any]:
    return _reader(cls, ">", functools.partial(_no_header, cls))


def _reader(cls: type[Message], order: str, other: Callable[[bytes], Any]) -> Callable[[bytes], Any]:
    source = ReaderSource(cls, order)
    names = {
        **source.constants,
        "other": other,
        "fail": functools.partial(_decode_error, cls),
    }
    return _compile(source.text(), names, f"<decode {cls.__ros_type__} {order}>")


def _decode_other(cls: type[Message], data: bytes) -> Any:
    return _big_endian_decoder(cls)(data) if data[:2] == BIG else _no_header(cls, data)


def _no_header(cls: type[Message], data: bytes) -> Any:
    raise MessageError(f"no CDR encapsulation header (00 01 00 00), found {data[:4].hex(' ')}")


def _compile(text: str, names: dict[str, Any], name: str) -> Callable[[Any], Any]:
    exec(compile(text, name, "exec"), names)  # noqa: S102 - our own text, made of type descriptions checked before
    made: Callable[[Any], Any] = names["run"]
    return made


def encode(message: Message) -> bytes:
    """Encode `message` as CDR, little-endian with its header. Raises EncodeError that names the wrong field."""
    return encoder(type(message))(message)


def decode(cls: type[Message], data: bytes) -> Any:
    """Decode `data`, CDR in either byte order, into a message of `cls`. Raises DecodeError, and nothing else."""
    return decoder(cls)(bytes(data))


def _encode_error(cls: type[Message], message: Any, error: Exception) -> EncodeError:
    if not isinstance(error, (struct.error, TypeError, ValueError, AttributeError, OverflowError)):
        return EncodeError(f"{cls.__ros_type__}: {error!r}")
    return EncodeError(explain(cls, message) or f"{cls.__ros_type__}: {error}")


def _decode_error(cls: type[Message], data: bytes, error: Exception) -> DecodeError:
    if isinstance(error, DecodeError):
        return error
    if isinstance(error, MessageError) and not isinstance(error, EncodeError):
        return DecodeError(f"{cls.__ros_type__}: {error} ({len(data)} bytes)")
    return DecodeError(f"{cls.__ros_type__}: {len(data)} bytes end in the middle of a field")
