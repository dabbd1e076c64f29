"""Peers that send what cannot be read, or answer with it: one clear error or warning, and all goes on."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import pytest

from robolink.exceptions import ServiceError
from robolink.impl.log_output import Record
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.std_msgs.msg import String
from tests.support.interop import PATIENCE, Robot, until
from tests.support.ros2_peer import (
    ADD_TWO_INTS,
    STRING,
    Peer,
    PeerQuery,
    packed_ints,
    packed_string,
)
from tests.system.interop_wire.calls import add, replies_to, serve_sums, sum_of, until_heard

pytestmark = pytest.mark.processes

WRONG_ATTACHMENTS = [None, b"", bytes(32), bytes(33), bytes(34), b"\1" * 16 + b"\x0f" + bytes(16)]


def warnings(lines: list[Record]) -> list[str]:
    return [each.message for each in lines if each.severity >= 30]


@pytest.mark.parametrize(
    "wrong",
    [
        *[(packed_string("wrong"), attachment) for attachment in WRONG_ATTACHMENTS],
        *[
            (payload, "right")
            for payload in (b"", b"\0\1\0\0", packed_string("wrong")[:-3], b"\0\1\0\0\xff\xff\xff\x7fx")
        ],
    ],
)
def test_a_bad_sample(node: Robot, peer: Peer, log_lines: list[Record], wrong: tuple[bytes, Any]) -> None:
    payload, attachment = wrong
    got: list[str] = []
    subscription = node.create_subscription(String, "chatter", lambda message: got.append(message.data), 10)
    mouth = peer.node("stranger").publisher("/chatter", STRING)
    until_heard(node, lambda: mouth.put(packed_string("good")), got)
    for _ in range(3):
        if attachment == "right":
            mouth.put(payload)
        else:
            mouth.entity.put(payload, attachment=attachment)
    mouth.put(packed_string("last"))
    node.spin_until(lambda: got[-1] == "last")
    assert set(got) == {"good", "last"}
    assert subscription.malformed == 3
    (warning,) = warnings(log_lines)
    assert "/chatter" in warning


@pytest.mark.parametrize("attachment", WRONG_ATTACHMENTS[1:])
def test_a_bad_request(node: Robot, peer: Peer, log_lines: list[Record], attachment: bytes) -> None:
    service, _ = serve_sums(node)
    client = peer.node("stranger").client("/add", ADD_TWO_INTS)
    replies_to(client, node, packed_ints(1, 2))
    for _ in range(2):
        assert node.while_spinning(lambda: client.call(packed_ints(1, 2), attachment)) == []
    assert node.while_spinning(lambda: client.call(b"\0\1\0\0short")) == []
    (reply,) = node.while_spinning(lambda: client.call(packed_ints(1, 2)))
    assert reply.payload == packed_ints(3)
    assert service.malformed == 3
    assert len(warnings(log_lines)) == 1


def reply_nothing(query: PeerQuery) -> None:
    pass


def reply_bare(query: PeerQuery) -> None:
    query.raw.reply(query.key, packed_ints(3))


def reply_short_attachment(query: PeerQuery) -> None:
    query.raw.reply(query.key, packed_ints(3), attachment=bytes(32))


def reply_truncated(query: PeerQuery) -> None:
    query.reply(packed_ints(3)[:-1])


def reply_error(query: PeerQuery) -> None:
    query.raw.reply_err(b"out of order")


@pytest.mark.parametrize(
    ("answer", "error"),
    [
        (reply_nothing, "nobody serves it, or the server went away"),
        (reply_bare, "33 bytes, got 0"),
        (reply_short_attachment, "33 bytes, got 32"),
        (reply_truncated, "cannot be read"),
        (reply_error, "out of order"),
    ],
)
def test_a_bad_answer(node: Robot, peer: Peer, answer: Callable[[PeerQuery], None], error: str) -> None:
    how: list[Callable[[PeerQuery], None]] = [add]
    peer.node("adder").service("/add", ADD_TWO_INTS, lambda query: how[-1](query))
    client = node.create_client(AddTwoInts, "add")
    assert sum_of(client, 1, 2) == 3
    how.append(answer)
    with pytest.raises(ServiceError, match=error):
        client.try_call(AddTwoInts.Request(a=1, b=2), timeout_sec=PATIENCE)
    how.append(add)
    assert client.call(AddTwoInts.Request(a=1, b=2), timeout_sec=PATIENCE).sum == 3


def test_bad_tokens(node: Robot, peer: Peer, log_lines: list[Record]) -> None:
    """Zenoh carries keys of up to 64 KB; a session of Zenoh 1.10 that announces one near that falls silent itself."""
    place = f"@ros2_lv/{peer.domain}/{peer.zid}"
    for text in (
        f"{place}/x",
        f"{place}/0/0/NN/%/%/na me",
        f"{place}/0/0/XX/%/%/node",
        f"@ros2_lv/{peer.domain}/XYZ/0/1/NN/%/%/node",
        f"{place}/0/1/MP/%/%/node/%chatter/String/RIHS01_0/::,10:,:,:,,",
        f"{place}/0/1/MP/%/%/node/%chatter/{STRING.dds_name}/{STRING.hash}/:::::",
        f"{place}/0/1/MP/%/%/node/%{'a' * 30_000}/{STRING.dds_name}/{STRING.hash}/::,10:,:,:,,",
        f"{place}/0/0/NN/%/%/\x1b[31mred",
    ):
        peer.announce(text)
    peer.node("good")
    until(lambda: "good" in node.get_node_names())
    assert set(node.get_node_names()) == {"good", "robot"}
    assert ("/chatter", ["std_msgs/msg/String"]) not in node.get_topic_names_and_types()
    (warning,) = warnings(log_lines)
    assert "announces what cannot be read" in warning
    assert len(warning) < 500


def test_random_bytes(node: Robot, peer: Peer, log_lines: list[Record]) -> None:
    """Samples, attachments, requests and replies of nothing but noise."""
    got: list[str] = []
    node.create_subscription(String, "chatter", lambda message: got.append(message.data), 10)
    stranger = peer.node("stranger")
    mouth = stranger.publisher("/chatter", STRING)
    until_heard(node, lambda: mouth.put(packed_string("good")), got)
    for length in range(0, 300, 7):
        mouth.entity.put(os.urandom(length), attachment=os.urandom(33))
        mouth.put(b"\0\1\0\0" + os.urandom(length))
    mouth.put(packed_string("last"))
    node.spin_until(lambda: got[-1] == "last")
    assert len(warnings(log_lines)) <= 1
