"""Announcements of participants and endpoints: round trips, defaults, nonsense, and bytes of a real Fast DDS."""

from __future__ import annotations

import contextlib
import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.rtps import ids
from robolink.rtps.announcements import (
    NO_DEPTH,
    EndpointData,
    ParticipantData,
    encode_endpoint,
    encode_key,
    encode_participant,
    read_endpoint,
    read_key,
    read_participant,
)
from robolink.rtps.ids import RtpsError
from robolink.rtps.parameters import LIST_HEADER, SENTINEL, parameter, text
from robolink.rtps.types import Qos

PREFIX = bytes(range(12))
GUID = PREFIX + b"\0\0\x01\x03"

prefixes = st.binary(min_size=12, max_size=12)
names = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=30)
topics = names.filter(bool)
blobs = st.binary(max_size=30)
addresses = st.tuples(st.ip_addresses(v=4).map(str), st.integers(1, 65535))
some_locators = st.lists(addresses, max_size=4).map(tuple)
durations = st.none() | st.integers(0, 1 << 36).map(lambda parts: parts / 256)
qualities = st.builds(
    Qos,
    reliable=st.booleans(),
    transient_local=st.booleans(),
    depth=st.integers(-1, 0x7FFFFFFF),
    deadline=durations,
    lifespan=st.none(),
    liveliness=st.integers(0, 2),
    lease=durations,
)


def swapped(payload: bytes) -> bytes:
    """Return the list as a big-endian machine would announce it."""
    out, at = b"\0\2\0\0", 4
    while True:
        pid, size = struct.unpack_from("<HH", payload, at)
        value = payload[at + 4 : at + 4 + size]
        at += 4 + size
        as_bytes = {ids.PID_PROTOCOL_VERSION, ids.PID_VENDOR, ids.PID_KEY_HASH}
        if pid in as_bytes | {ids.PID_PARTICIPANT_GUID, ids.PID_ENDPOINT_GUID}:
            head = 0
        elif pid in {ids.PID_TOPIC, ids.PID_TYPE, ids.PID_ENTITY_NAME, ids.PID_USER_DATA}:
            head = 4
        elif pid in {ids.PID_UNICAST, ids.PID_DEFAULT_UNICAST, ids.PID_METATRAFFIC_UNICAST}:
            head = 8
        else:
            head = size
        words = struct.unpack_from(f"<{head // 4}I", value)
        out += struct.pack(">HH", pid, size) + struct.pack(f">{head // 4}I", *words) + value[head:]
        if pid == ids.PID_SENTINEL:
            return out


@given(
    st.builds(
        ParticipantData,
        prefix=prefixes,
        vendor=st.binary(min_size=2, max_size=2),
        metatraffic=some_locators,
        default=some_locators,
        lease=st.just(math.inf) | st.integers(0, 1 << 36).map(lambda parts: parts / 256),
        name=names,
        user_data=blobs,
        domain=st.none() | st.integers(0, 232),
        builtin_endpoints=st.integers(0, 0xFFFFFFFF),
    )
)
def test_participants_come_back(data: ParticipantData) -> None:
    payload = encode_participant(data)
    assert read_participant(payload) == read_participant(swapped(payload)) == data


@given(prefixes, st.binary(min_size=4, max_size=4), st.booleans(), topics, topics, qualities, some_locators, blobs)
def test_endpoints_come_back(
    prefix: bytes,
    entity: bytes,
    is_writer: bool,
    topic: str,
    type_name: str,
    qos: Qos,
    locators: tuple[tuple[str, int], ...],
    user_data: bytes,
) -> None:
    if is_writer:
        qos = qos._replace(lifespan=qos.deadline)
    data = EndpointData(prefix + entity, is_writer, topic, type_name, qos, locators, user_data)
    payload = encode_endpoint(data)
    for each in (payload, swapped(payload)):
        assert read_endpoint(each, is_writer=is_writer) == data


def test_what_is_not_said_is_the_default() -> None:
    who = parameter(ids.PID_PARTICIPANT_GUID, PREFIX + ids.PARTICIPANT_ENTITY)
    found = read_participant(LIST_HEADER + who + SENTINEL)
    assert found == ParticipantData(PREFIX, b"\0\0", lease=100.0, domain=None)
    named = parameter(ids.PID_ENDPOINT_GUID, GUID) + parameter(ids.PID_TOPIC, text("rt/a"))
    payload = LIST_HEADER + named + parameter(ids.PID_TYPE, text("T")) + SENTINEL
    unsaid = Qos(reliable=True, depth=NO_DEPTH)
    assert read_endpoint(payload, is_writer=True) == EndpointData(GUID, True, "rt/a", "T", unsaid)
    assert read_endpoint(payload, is_writer=False).qos == unsaid._replace(reliable=False)


@pytest.mark.parametrize("missing", [ids.PID_ENDPOINT_GUID, ids.PID_TOPIC, ids.PID_TYPE])
def test_an_endpoint_that_lacks_something(missing: int) -> None:
    parts = {ids.PID_ENDPOINT_GUID: GUID, ids.PID_TOPIC: text("rt/a"), ids.PID_TYPE: text("T")}
    said = b"".join(parameter(pid, value) for pid, value in parts.items() if pid != missing)
    with pytest.raises(RtpsError, match="an endpoint without a GUID, a topic or a type"):
        read_endpoint(LIST_HEADER + said + SENTINEL, is_writer=True)


def test_whoever_does_not_say_who_he_is() -> None:
    for read, complaint in ((read_participant, "a participant without a GUID"), (read_key, "a key without a GUID")):
        for said in (b"", parameter(ids.PID_PARTICIPANT_GUID, PREFIX)):
            with pytest.raises(RtpsError, match=complaint):
                read(LIST_HEADER + said + SENTINEL)


@pytest.mark.parametrize("guid", [GUID, PREFIX + ids.PARTICIPANT_ENTITY])
def test_keys_come_back(guid: bytes) -> None:
    assert read_key(encode_key(guid)) == guid
    assert read_key(swapped(encode_key(guid))) == guid


def test_announcements_that_are_cut() -> None:
    participant = encode_participant(ParticipantData(PREFIX, name="/", user_data=b"enclave=/;"))
    endpoint = encode_endpoint(EndpointData(GUID, True, "rt/a", "T"))
    for size in range(len(participant)):
        with pytest.raises(RtpsError):
            read_participant(participant[:size])
    for size in range(len(endpoint)):
        with pytest.raises(RtpsError):
            read_endpoint(endpoint[:size], is_writer=True)


def test_an_announcement_that_is_too_large() -> None:
    more = encode_endpoint(EndpointData(GUID, True, "rt/a", "T"))[:-4] + parameter(0x3000, bytes(60_000)) * 2 + SENTINEL
    with pytest.raises(RtpsError, match="an announcement of 120192 bytes: 65536 are read"):
        read_endpoint(more, is_writer=True)


@given(st.data())
def test_flipped_bytes_are_refused_or_read(data: st.DataObject) -> None:
    participant = bytearray(encode_participant(ParticipantData(PREFIX, name="/", user_data=b"enclave=/;")))
    endpoint = bytearray(encode_endpoint(EndpointData(GUID, True, "rt/a", "T")))
    for raw in (participant, endpoint):
        for at in data.draw(st.lists(st.integers(0, len(raw) - 1), max_size=6)):
            raw[at] = data.draw(st.integers(0, 255))
    for read in (read_participant, read_key, lambda raw: read_endpoint(raw, is_writer=False)):
        for raw in (participant, endpoint):
            with contextlib.suppress(RtpsError):
                read(raw)


# Captured on loopback: Fast DDS 3.2.3 (ROS 2 Kilted), ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST. Without the list of
# properties (0x59) and type information (0x75).
FAST_PARTICIPANT = bytes.fromhex(
    "00030000150004000202000016000400010f000000800400030202000f0004001400000050001000010f78fdd229bbfe00000000000001c1"
    "078004001300000032001800010000007a300000000000000000000000000000c000020231001800130000007b3000005578fd0000000000"
    "000000000000000031001800010000007b300000000000000000000000000000c0000202020008001400000000000000580004003ffc0000"
    "62000800020000002f0000002c0010000b000000656e636c6176653d2f3b000001000000"
)
FAST_SUBSCRIPTION = bytes.fromhex(
    "000300005a001000010f78fdd229bbfe000000000000160407800400130000002f001800130000007b3000005578fd0000000000000000"
    "00000000002f001800010000007b300000000000000000000000000000c0000202430004000000000050001000010f78fdd229bbfe0000"
    "0000000001c105000c000600000072742f6265000000070024001d0000007374645f6d7367733a3a6d73673a3a6464735f3a3a53747269"
    "6e675f0000000070001000010f78fdd229bbfe0000000000001604150004000202000016000400010f00001d0004000000000023000800"
    "01000000000000802700080000000000000000001b000c0000000000ffffff7fffffffff1a000c0001000000000000009a9999192b0008"
    "00ffffff7fffffffff2c0058005100000074797065686173683d5249485330315f64663636386337343034383262626434386662333964"
    "3736613730646664346264353964623132383830323137343335303332353965393438663662316131383b0000001f0004000000000025"
    "0004000000000021000800000000000000000029000400000000002e000400000000002d00040000000000730008000100000000000000"
    "74000800010001010000000001000000"
)


def test_a_participant_of_fast_dds() -> None:
    assert read_participant(FAST_PARTICIPANT) == ParticipantData(
        prefix=bytes.fromhex("010f78fdd229bbfe00000000"),
        vendor=ids.VENDOR_EPROSIMA,
        metatraffic=(("192.0.2.2", 12410),),
        default=(("192.0.2.2", 12411),),  # and one of shared memory, which is of no use here
        lease=20.0,
        name="/",
        user_data=b"enclave=/;\0",
        domain=20,
        builtin_endpoints=0xFC3F,
    )


def test_a_subscription_of_fast_dds() -> None:
    found = read_endpoint(FAST_SUBSCRIPTION, is_writer=False)
    assert found._replace(user_data=b"") == EndpointData(
        guid=bytes.fromhex("010f78fdd229bbfe0000000000001604"),
        is_writer=False,
        topic="rt/be",
        type_name="std_msgs::msg::dds_::String_",
        qos=Qos(reliable=False, depth=NO_DEPTH, deadline=1.5),
        locators=(("192.0.2.2", 12411),),
    )
    assert found.user_data == (b"typehash=RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18;")
