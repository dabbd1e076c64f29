"""Time to encode and to decode a message: robolink's CDR, msgspec's MessagePack and rosbags' CDR in one process."""

from __future__ import annotations

import timeit
from collections.abc import Callable
from typing import Any

import msgspec

import robolink.compat  # noqa: F401 - the samples are made of ROS 2's names
from benchmarks.messages.plain import plain
from benchmarks.messages.samples import message_type, sample
from robolink.message import decoder, encode, encoder


def microseconds(function: Callable[[Any], Any], argument: Any, number: int = 20000) -> float:
    """The best of five: what is slower was disturbed."""
    return min(timeit.repeat(lambda: function(argument), number=number, repeat=5)) / number * 1e6


def codec(kind: str) -> dict[str, tuple[float, float]]:
    """Microseconds out and in, for robolink, msgspec and rosbags."""
    from rosbags.typesys import Stores, get_typestore

    message, cls, other = sample(kind), message_type(kind), plain(kind)
    data = encode(message)
    packer, unpacker = msgspec.msgpack.Encoder(), msgspec.msgpack.Decoder(type(other))
    store = get_typestore(Stores.ROS2_JAZZY)
    ros_type = cls.__ros_type__
    ros_message = store.deserialize_cdr(data, ros_type)
    return {
        "robolink": (microseconds(encoder(cls), message), microseconds(decoder(cls), data)),
        "msgspec": (microseconds(packer.encode, other), microseconds(unpacker.decode, packer.encode(other))),
        "rosbags": (
            microseconds(lambda each: store.serialize_cdr(each, ros_type), ros_message, 5000),
            microseconds(lambda each: store.deserialize_cdr(each, ros_type), data, 5000),
        ),
    }
