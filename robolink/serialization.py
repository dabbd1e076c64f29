"""Serialization of messages to bytes (CDR), as they are on the wire and in bags."""

from __future__ import annotations

from typing import cast

from robolink.message import Message, decode, encode
from robolink.type_support import MsgT, check_is_valid_msg_type


def serialize_message(message: Message) -> bytes:
    """Return `message` as CDR bytes. Raises EncodeError (a TypeError) that names the field which does not fit."""
    check_is_valid_msg_type(type(message))
    return encode(message)


def deserialize_message(serialized_message: bytes, message_type: type[MsgT]) -> MsgT:
    """Return the message of a type that CDR bytes contain.

    Args:
        serialized_message: Bytes, with the header of 4 bytes.
        message_type: Message class.

    Raises:
        DecodeError: (a ValueError) if the bytes are not a message of this type.
    """
    check_is_valid_msg_type(message_type)
    return cast(MsgT, decode(message_type, serialized_message))
