"""ros_discovery_info: read and written as ROS 2 has it, in both byte orders, with ids of 16 and of 24 bytes."""

from __future__ import annotations

import contextlib
import struct
from collections.abc import Iterable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.dds.entities import NodeEntities, ParticipantEntities, decode, encode
from robolink.exceptions import WireError
from robolink.interfaces.rmw_dds_common.msg import Gid, ParticipantEntitiesInfo
from robolink.serialization import deserialize_message, serialize_message

guids = st.binary(min_size=16, max_size=16)
names = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=20)
nodes = st.builds(
    NodeEntities, names, names, st.lists(guids, max_size=3).map(tuple), st.lists(guids, max_size=3).map(tuple)
)
messages = st.builds(ParticipantEntities, guids, st.lists(nodes, max_size=3).map(tuple))

A, B, C = bytes([1]) * 16, bytes([2]) * 16, bytes([3]) * 16
EXAMPLE = ParticipantEntities(A, (NodeEntities("/", "talker", (B,), (B, C)), NodeEntities("/arm", "x", (), ())))


@given(messages)
def test_it_is_what_the_message_type_says(entities: ParticipantEntities) -> None:
    message = deserialize_message(encode(entities), ParticipantEntitiesInfo)
    assert bytes(message.gid.data) == entities.guid
    read = [
        NodeEntities(each.node_namespace, each.node_name, _ids(each.reader_gid_seq), _ids(each.writer_gid_seq))
        for each in message.node_entities_info_seq
    ]
    assert read == [*entities.nodes]
    assert decode(serialize_message(message)) == entities


def _ids(gids: Iterable[Gid]) -> tuple[bytes, ...]:
    return tuple(bytes(each.data) for each in gids)


@given(messages, st.sampled_from([16, 24]), st.sampled_from("<>"), st.integers(0, 3))
def test_both_lengths_of_ids_and_both_byte_orders_are_read(
    entities: ParticipantEntities, id_bytes: int, order: str, padding: int
) -> None:
    assert decode(_encoded(entities, id_bytes, order) + bytes(padding)) == entities


def _encoded(entities: ParticipantEntities, id_bytes: int, order: str) -> bytes:
    """A message as others send it, written out by itself."""
    body = entities.guid.ljust(id_bytes, b"\0")

    def number(value: int) -> bytes:
        return bytes(-len(body) % 4) + struct.pack(f"{order}I", value)

    body += number(len(entities.nodes))
    for node in entities.nodes:
        for text in (node.namespace, node.name):
            body += number(len(text.encode()) + 1)
            body += text.encode() + b"\0"
        for ids in (node.readers, node.writers):
            body += number(len(ids))
            body += b"".join(each.ljust(id_bytes, b"\0") for each in ids)
    return (b"\0\1" if order == "<" else b"\0\0") + b"\0\0" + body


@given(st.binary(max_size=300))
def test_nonsense_is_refused(payload: bytes) -> None:
    for raw in (payload, b"\0\1\0\0" + payload):
        with contextlib.suppress(WireError):
            decode(raw)


@given(messages, st.data())
def test_what_is_cut_or_changed_is_refused_or_read(entities: ParticipantEntities, data: st.DataObject) -> None:
    raw = bytearray(encode(entities))
    for _ in range(data.draw(st.integers(0, 3))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    with contextlib.suppress(WireError):
        decode(bytes(raw[: data.draw(st.integers(0, len(raw)))]))


@pytest.mark.parametrize(
    ("payload", "reason"),
    [
        (b"", "plain CDR"),
        (b"\0\3\0\0" + bytes(20), "plain CDR"),
        (b"\0\1\0\0" + bytes(10), "ends early, after 10 bytes"),
        (b"\0\1\0\0" + bytes(16) + struct.pack("<I", 1 << 31), "2,147,483,648 elements where 1,000 are the most"),
        (encode(EXAMPLE) + bytes(4), "bytes too many"),
    ],
)
def test_errors_say_what_is_wrong(payload: bytes, reason: str) -> None:
    with pytest.raises(WireError, match=reason):
        decode(payload)
