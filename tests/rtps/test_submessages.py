"""Submessages: round trips, both byte orders, nonsense, and bytes of a real Fast DDS."""

from __future__ import annotations

import struct
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.rtps import ids
from robolink.rtps import submessages as subs
from robolink.rtps.ids import RtpsError
from robolink.rtps.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    HeartbeatFrag,
    InfoDestination,
    InfoSource,
    InfoTimestamp,
    Inline,
    NackFrag,
    Submessage,
    parse,
)

PREFIX = bytes(range(12))
READER, WRITER = b"\0\0\x01\x04", b"\0\0\x02\x03"
HEADER = subs.encode_header(PREFIX)

entities = st.binary(min_size=4, max_size=4)
guids = st.binary(min_size=16, max_size=16)
words = st.integers(0, 0xFFFFFFFF)
numbers = st.integers(1, (1 << 63) - 1)
payloads = st.binary(max_size=70)
inlines = st.builds(
    Inline,
    status=st.integers(0, 3),
    key_hash=st.none() | guids,
    related=st.none() | st.tuples(guids, st.integers(0, (1 << 63) - 1)),
)


@st.composite
def sets(draw: st.DrawFn, low: int, high: int) -> tuple[int, list[int]]:
    """Draw a base and numbers within 256 of it."""
    base = draw(st.integers(low, high))
    return base, sorted(base + place for place in draw(st.sets(st.integers(0, 255))))


def only(*parts: bytes | memoryview) -> Any:
    """Parse a datagram of one submessage."""
    (found,) = parse(b"".join((HEADER, *parts))).submessages
    return found


def swapped(kind: int, flags: int, layout: str, *values: Any) -> bytes:
    """Return a submessage of a big-endian machine."""
    body = struct.pack(">" + layout, *values)
    return struct.pack(">BBH", kind, flags & ~1, len(body)) + body


def padded(payload: bytes) -> bytes:
    return payload + bytes(-len(payload) % 4)


@given(entities, entities, numbers, payloads, inlines, st.booleans())
def test_data_comes_back(reader: bytes, writer: bytes, number: int, raw: bytes, inline: Inline, is_key: bool) -> None:
    found = only(subs.encode_data(reader, writer, number, raw, subs.encode_inline(inline), is_key=is_key))
    assert found == Data(reader, writer, number, memoryview(padded(raw)), inline, is_key)


@given(numbers, inlines)
def test_data_without_a_payload_comes_back(number: int, inline: Inline) -> None:
    found = only(subs.encode_data(READER, WRITER, number, None, subs.encode_inline(inline)))
    assert found == Data(READER, WRITER, number, None, inline, False)


def test_what_follows_a_payload_begins_at_a_multiple_of_four() -> None:
    beat = subs.encode_heartbeat(READER, WRITER, 1, 2, 3)
    for size in range(9):
        datagram = HEADER + subs.encode_data(READER, WRITER, 1, bytes(size)) + beat
        assert len(datagram) % 4 == 0
        data, after = parse(datagram).submessages
        assert isinstance(data, Data)
        assert bytes(data.payload or b"") == padded(bytes(size))
        assert after == Heartbeat(READER, WRITER, 1, 2, 3, final=False)


def test_a_payload_is_a_view_of_the_datagram() -> None:
    buffer = bytearray(HEADER + subs.encode_data(READER, WRITER, 1, b"\0\1\0\0abcd"))
    (data,) = parse(buffer).submessages
    buffer[-1] = ord("x")
    assert isinstance(data, Data)
    assert bytes(data.payload or b"") == b"\0\1\0\0abcx"


def test_the_last_submessage_may_be_longer_than_its_length_can_say() -> None:
    assert only(subs.encode_data(READER, WRITER, 1, bytes(70_000))).payload == bytes(70_000)


@given(numbers, st.binary(min_size=1, max_size=300), st.integers(1, 80), inlines, st.booleans())
def test_fragments_come_back(number: int, sample: bytes, size: int, inline: Inline, is_key: bool) -> None:
    whole, total = bytearray(len(sample)), -(-len(sample) // size)
    for fragment in range(1, total + 1):
        quality = subs.encode_inline(inline)
        pieces = subs.encode_data_frag(READER, WRITER, number, fragment, size, sample, quality, is_key=is_key)
        assert sum(map(len, pieces)) % 4 == 0
        found = only(*pieces)
        at = (fragment - 1) * size
        piece = memoryview(sample[at : at + size])
        assert found == DataFrag(READER, WRITER, number, fragment, 1, size, len(sample), piece, inline, is_key)
        whole[at : at + size] = found.payload
    assert whole == sample


@pytest.mark.parametrize(
    ("first", "count", "size", "total", "came"),
    [
        (0, 1, 4, 8, 8),  # they count from 1
        (1, 0, 4, 8, 8),
        (1, 1, 0, 8, 8),
        (3, 1, 4, 8, 8),  # begins at the sample's end
        (1, 3, 4, 8, 12),  # one more than there are
        (1, 2, 4, 8, 4),  # says two, brings one
        (0xFFFFFFFF, 0xFFFF, 0xFFFF, 0xFFFFFFFF, 60_000),
    ],
)
def test_fragments_that_contradict_themselves(first: int, count: int, size: int, total: int, came: int) -> None:
    head = struct.pack("<HH4s4siIIHHI", 0, 28, READER, WRITER, 0, 1, first, count, size, total)
    with pytest.raises(RtpsError, match="DATA_FRAG with"):
        only(struct.pack("<BBH", 0x16, 1, len(head) + came) + head + bytes(came))


def test_several_fragments_in_one() -> None:
    head = struct.pack("<HH4s4siIIHHI", 0, 28, READER, WRITER, 0, 1, 2, 2, 4, 11)
    found = only(struct.pack("<BBH", 0x16, 1, len(head) + 8) + head + b"abcdefg\0")
    assert (found.first, found.fragments, bytes(found.payload)) == (2, 2, b"abcdefg")


@given(entities, entities, numbers, st.integers(0, 1000), words, st.booleans(), st.booleans())
def test_heartbeats_come_back(
    reader: bytes, writer: bytes, first: int, more: int, serial: int, final: bool, alive: bool
) -> None:
    last = min(first - 1 + more, (1 << 63) - 1)
    little = subs.encode_heartbeat(reader, writer, first, last, serial, final=final, liveliness=alive)
    flags = final << 1 | alive << 2
    big = swapped(0x07, flags, "4s4sqqI", reader, writer, first, last, serial)
    assert only(little) == only(big) == Heartbeat(reader, writer, first, last, serial, final, alive)


@pytest.mark.parametrize(
    ("first", "last", "says"), [(0, 0, (1, 0)), (0, 5, (1, 5)), (1, 0, (1, 0)), (-1, 0, None), (5, 3, None)]
)
def test_what_heartbeats_may_say(first: int, last: int, says: tuple[int, int] | None) -> None:
    beat = subs.encode_heartbeat(READER, WRITER, first, last, 1)
    if says:
        assert only(beat)[2:4] == says
    else:
        with pytest.raises(RtpsError, match=f"HEARTBEAT of samples {first} to {last}"):
            only(beat)


@given(numbers, words, words)
def test_heartbeats_of_fragments_come_back(number: int, last: int, serial: int) -> None:
    big = swapped(0x13, 0, "4s4sqII", READER, WRITER, number, last, serial)
    found = only(subs.encode_heartbeat_frag(READER, WRITER, number, last, serial))
    assert found == only(big) == HeartbeatFrag(READER, WRITER, number, last, serial)


def bitmap(base: int, members: list[int]) -> tuple[int, list[int]]:
    """Return a set as the standard draws it, bit by bit."""
    bits = max(members) - base + 1 if members else 0
    words = [0] * ((bits + 31) // 32)
    for member in members:
        words[(member - base) // 32] |= 1 << (31 - (member - base) % 32)
    return bits, words


@given(sets(0, (1 << 63) - 300), words, st.booleans())
def test_acknacks_come_back(chosen: tuple[int, list[int]], serial: int, final: bool) -> None:
    base, missing = chosen
    bits, bit_words = bitmap(base, missing)
    layout = f"4s4sqI{len(bit_words)}II"
    big = swapped(0x06, final << 1, layout, READER, WRITER, base, bits, *bit_words, serial)
    found = only(subs.encode_acknack(READER, WRITER, base, missing, serial, final=final))
    assert found == only(big) == AckNack(READER, WRITER, base, missing, serial, final)


@given(numbers, sets(0, 0xFFFFFFFF - 300), words)
def test_requests_of_fragments_come_back(number: int, chosen: tuple[int, list[int]], serial: int) -> None:
    base, missing = chosen
    missing = [base, *(each for each in missing if each != base)]
    bits, bit_words = bitmap(base, missing)
    layout = f"4s4sqII{len(bit_words)}II"
    big = swapped(0x12, 0, layout, READER, WRITER, number, base, bits, *bit_words, serial)
    found = only(subs.encode_nack_frag(READER, WRITER, number, missing, serial))
    assert found == only(big) == NackFrag(READER, WRITER, number, missing, serial)


@given(sets(1, (1 << 63) - 300), st.data())
def test_gaps_come_back(chosen: tuple[int, list[int]], data: st.DataObject) -> None:
    base, others = chosen
    first = data.draw(st.integers(1, base))
    bits, bit_words = bitmap(base, others)
    big = swapped(0x08, 0, f"4s4sqqI{len(bit_words)}I", READER, WRITER, first, base, bits, *bit_words)
    found = only(subs.encode_gap(READER, WRITER, first, base, others))
    assert found == only(big) == Gap(READER, WRITER, first, base, others)


@pytest.mark.parametrize("missing", [[], [7], list(range(7, 263)), [7, 262]])
def test_sets_of_none_one_and_all(missing: list[int]) -> None:
    assert only(subs.encode_acknack(READER, WRITER, 7, missing, 1)).missing == missing


def test_a_set_keeps_what_it_can_span() -> None:
    assert only(subs.encode_acknack(READER, WRITER, 7, [8, 262, 263, 5000], 1)).missing == [8, 262]


def test_a_set_that_is_too_large() -> None:
    with pytest.raises(RtpsError, match="a set of 257 numbers: 256 are allowed"):
        only(struct.pack("<BBH4s4sqI", 6, 1, 200, READER, WRITER, 1, 257) + bytes(180))


@given(st.integers(1, 0xFFFFFFFE * 10**9))
def test_times_come_back_to_the_nanosecond(stamp: int) -> None:
    little = subs.encode_info_timestamp(stamp)
    big = swapped(0x09, 0, "II", *struct.unpack("<II", little[4:]))
    assert only(little) == only(big) == InfoTimestamp(stamp)


def test_times_that_nobody_knows() -> None:
    assert only(subs.encode_info_timestamp(0)) == InfoTimestamp(0)
    assert only(swapped(0x09, 0, "II", 0xFFFFFFFF, 0xFFFFFFFF)) == InfoTimestamp(0)
    both = parse(HEADER + subs.encode_info_timestamp(0) + subs.encode_info_timestamp(5))
    assert both.submessages == [InfoTimestamp(0), InfoTimestamp(5)]  # its length of 0 is not "up to the end"


@given(st.binary(min_size=12, max_size=12))
def test_destinations_and_sources_come_back(prefix: bytes) -> None:
    assert only(subs.encode_info_destination(prefix)) == InfoDestination(prefix)
    passed_on = swapped(0x0C, 0, "IBB2s12s", 0, 2, 2, b"\x01\x10", prefix)
    assert only(passed_on) == InfoSource(prefix, b"\x01\x10")


@given(numbers, payloads, st.none() | guids, st.integers(0, 3), numbers)
def test_data_of_a_big_endian_machine(number: int, raw: bytes, key: bytes | None, status: int, answers: int) -> None:
    guid = bytes(range(16))
    inline = struct.pack(">HH16sq", 0x83, 24, guid, answers) + struct.pack(">HH4s", 0x71, 4, bytes((0, 0, 0, status)))
    if key is not None:
        inline += struct.pack(">HH16s", 0x70, 16, key)
    inline += struct.pack(">HH", 1, 0)
    layout = f"HH4s4sq{len(inline)}s{len(raw)}s"
    found = only(swapped(0x15, 2 | 4, layout, 0, 16, READER, WRITER, number, inline, raw))
    assert found == Data(READER, WRITER, number, memoryview(raw), Inline(status, key, (guid, answers)), False)


def test_fragments_of_a_big_endian_machine() -> None:
    values = (0, 28, READER, WRITER, 5, 2, 1, 4, 6, b"ef")
    found = only(swapped(0x16, 0, "HH4s4sqIHHI2s", *values))
    assert found == DataFrag(READER, WRITER, 5, 2, 1, 4, 6, memoryview(b"ef"))


def test_an_unset_number_of_a_related_sample_is_none() -> None:
    inline = struct.pack("<HH16siI", 0x800F, 24, bytes(16), -1, 0) + b"\1\0\0\0"
    assert only(subs.encode_data(READER, WRITER, 1, b"", inline)).inline.related == (bytes(16), 0)


def test_what_later_versions_add_is_skipped() -> None:
    head = struct.pack("<HH4s4siI", 0, 20, READER, WRITER, 0, 9) + b"more"
    data = struct.pack("<BBH", 0x15, 5, len(head) + 4) + head + b"load"
    unknown, padding = b"\x80\x01\x04\0what", b"\x01\x01\0\0"
    (found,) = parse(HEADER + unknown + padding + data).submessages
    assert found == Data(READER, WRITER, 9, memoryview(b"load"))
    (beat,) = parse(
        HEADER + b"\x07\x01\x20\0" + subs.encode_heartbeat(READER, WRITER, 1, 2, 3)[4:] + b"more"
    ).submessages
    assert beat == Heartbeat(READER, WRITER, 1, 2, 3, final=False)


ALL = [
    subs.encode_info_destination(PREFIX),
    subs.encode_info_timestamp(10**18),
    subs.encode_data(READER, WRITER, 1, b"\0\1\0\0abc", subs.encode_inline(Inline(3, bytes(16), (bytes(16), 1)))),
    b"".join(subs.encode_data_frag(READER, WRITER, 1, 2, 8, bytes(16), subs.encode_inline(Inline(1)))),
    subs.encode_heartbeat(READER, WRITER, 1, 2, 3),
    subs.encode_heartbeat_frag(READER, WRITER, 1, 2, 3),
    subs.encode_acknack(READER, WRITER, 1, [1, 256], 1),
    subs.encode_nack_frag(READER, WRITER, 1, [1, 256], 1),
    subs.encode_gap(READER, WRITER, 1, 5, [7, 100]),
    swapped(0x0C, 0, "IBB2s12s", 0, 2, 2, b"\x01\x10", PREFIX),
]


def test_all_in_one_datagram() -> None:
    found = parse(HEADER + b"".join(ALL))
    assert (found.prefix, found.vendor, len(found.submessages)) == (PREFIX, ids.VENDOR_ROBOLINK, len(ALL))
    assert len({type(each) for each in found.submessages}) == len(ALL)


def test_whatever_is_cut_is_refused() -> None:
    ends = {len(HEADER + b"".join(ALL[:count])) for count in range(len(ALL) + 1)}
    whole = HEADER + b"".join(ALL)
    for size in range(len(whole)):
        if size in ends:
            parse(whole[:size])
        else:
            with pytest.raises(RtpsError):
                parse(whole[:size])


def test_a_body_that_is_cut_with_its_length_is_refused() -> None:
    for whole in ALL:
        for size in range(4, len(whole), 4):
            body = whole[4:size]
            cut = whole[:2] + len(body).to_bytes(2, "little" if whole[1] & 1 else "big") + body
            _parse_or_refuse(HEADER + cut)


@given(st.binary(max_size=200), st.booleans())
def test_nonsense_is_refused_or_read(raw: bytes, headed: bool) -> None:
    _parse_or_refuse(HEADER + raw if headed else raw)


@given(st.data())
def test_flipped_bytes_are_refused_or_read(data: st.DataObject) -> None:
    raw = bytearray(HEADER + b"".join(ALL))
    for at in data.draw(st.lists(st.integers(0, len(raw) - 1), max_size=6)):
        raw[at] = data.draw(st.integers(0, 255))
    _parse_or_refuse(raw)


def _parse_or_refuse(raw: bytes | bytearray) -> list[Submessage]:
    try:
        return parse(raw).submessages
    except RtpsError:
        return []


@pytest.mark.parametrize("raw", [b"", b"RTPS\2\3", b"RTPX" + HEADER[4:], b"RTPS\1\0" + HEADER[6:]])
def test_what_is_not_rtps(raw: bytes) -> None:
    with pytest.raises(RtpsError, match="not RTPS 2"):
        parse(raw)


# Captured on loopback: Fast DDS 3.2.3 (ROS 2 Kilted). Its last submessage (0x80) is its own statistics.
_FAST_HEADER = "525450530202010f010f78fd2533b77700000000"
_FAST_TO_US = "0e010c0001ee70c95e188b435c8d45a2"
_FAST_STATISTICS = "80013800010000007b3000000000000000000000000000007f000001b4370b6b" + "00" * 28
FAST_PREFIX, OUR_PREFIX = bytes.fromhex("010f78fd2533b77700000000"), bytes.fromhex("01ee70c95e188b435c8d45a2")


def captured(*parts: str) -> list[Submessage]:
    found = parse(bytes.fromhex(_FAST_HEADER + _FAST_TO_US + "".join(parts) + _FAST_STATISTICS))
    assert (found.prefix, found.vendor) == (FAST_PREFIX, ids.VENDOR_EPROSIMA)
    assert found.submessages[0] == InfoDestination(OUR_PREFIX)
    return found.submessages[1:]


def test_a_string_of_fast_dds() -> None:
    stamp, data = captured(
        "09010800b4370b6b0ea73e80",
        "150524000000100000000104000013030000000001000000000100000800000068656c6c6f203100",
    )
    assert isinstance(stamp, InfoTimestamp)
    assert stamp.timestamp // 10**9 == 0x6B0B37B4
    payload = memoryview(b"\0\1\0\0\x08\0\0\0hello 1\0")
    assert data == Data(b"\0\0\x01\x04", b"\0\0\x13\x03", 1, payload)


def test_a_reply_of_fast_dds() -> None:
    _, data = captured(
        "09010800b4370b6bbf77eac9",
        "150760000000100000000204000018030000000001000000",
        "8300180001ee70c95e188b435c8d45a2000002040000000001000000",
        "0f80180001ee70c95e188b435c8d45a2000002040000000001000000",
        "01000000",
        "00010000000000000100000000000000",
    )
    assert isinstance(data, Data)
    assert data.inline == Inline(related=(OUR_PREFIX + b"\0\0\x02\x04", 1))
    assert bytes(data.payload or b"") == bytes.fromhex("00010000000000000100000000000000")


def test_requests_and_offers_of_fast_dds() -> None:
    beat = "07011c00000001040000130300000000010000000000000000000000" + "01000000"
    first_request = "06011800000004c7000004c200000000000000000000000001000000"
    all_there = "0603180000001704000003030000000001000000000000000100" + "0000"
    assert captured(beat, first_request, all_there) == [
        Heartbeat(b"\0\0\x01\x04", b"\0\0\x13\x03", 1, 0, 1, final=False),
        AckNack(ids.SUBSCRIPTIONS_READER, ids.SUBSCRIPTIONS_WRITER, 0, [], 1, final=False),
        AckNack(b"\0\0\x17\x04", b"\0\0\x03\x03", 1, [], 1, final=True),
    ]


def test_a_goodbye_of_fast_dds() -> None:
    (data,) = captured(
        "1503340000001000000003c7000003c2000000000f00000070001000010f78fdd329620a0000000000000403710004000000000301000000"
    )
    gone = Inline(ids.STATUS_DISPOSED | ids.STATUS_UNREGISTERED, bytes.fromhex("010f78fdd329620a0000000000000403"))
    assert data == Data(ids.PUBLICATIONS_READER, ids.PUBLICATIONS_WRITER, 15, None, gone)
