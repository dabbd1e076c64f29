"""Parameter lists: values in both byte orders, lists that are cut, values that are nonsense."""

from __future__ import annotations

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.rtps import parameters
from robolink.rtps.ids import RtpsError
from robolink.rtps.parameters import LIST_HEADER, SENTINEL, Parameters, parameter, read_list

PID = 0x2C
pids = st.integers(2, 0x3FFF)


def big(pid: int, value: bytes) -> Parameters:
    """Read one parameter of a big-endian machine."""
    return read_list(b"\0\2\0\0" + struct.pack(">HH", pid, len(value)) + value + b"\0\1\0\0")


def little(*written: bytes) -> Parameters:
    return read_list(LIST_HEADER + b"".join(written) + SENTINEL)


@given(st.lists(st.tuples(pids, st.binary(max_size=20))))
def test_parameters_come_back(pairs: list[tuple[int, bytes]]) -> None:
    found = little(*(parameter(pid, value) for pid, value in pairs))
    for pid in {pid for pid, _ in pairs}:
        first = next(value for other, value in pairs if other == pid)
        assert pid in found
        assert (found.raw(pid) or b"")[: len(first)] == first
    assert PID in found or found.raw(PID) is None


@given(st.binary(max_size=40), st.text(max_size=20))
def test_octets_and_texts_come_back(raw: bytes, text: str) -> None:
    assert little(parameter(PID, parameters.octets(raw))).octets(PID) == raw
    assert big(PID, struct.pack(">I", len(raw)) + raw).octets(PID) == raw
    if "\0" not in text:
        assert little(parameter(PID, parameters.text(text))).text(PID) == text
        value = text.encode() + b"\0"
        assert big(PID, struct.pack(">I", len(value)) + value).text(PID) == text


@given(st.none() | st.integers(0, (0x7FFFFFFF << 8) - 1))
def test_durations_come_back(parts: int | None) -> None:
    value = None if parts is None else parts / 256
    written = parameters.seconds(value)
    assert little(parameter(PID, written)).seconds(PID) == value
    assert big(PID, struct.pack(">iI", *struct.unpack("<iI", written))).seconds(PID) == value


def test_durations_at_the_edges() -> None:
    assert parameters.seconds(float("inf")) == parameters.seconds(None) == parameters.seconds(1e12)
    assert parameters.seconds(-1.0) == bytes(8)
    assert little().seconds(PID) is None
    with pytest.raises(RtpsError, match="a duration of -1 s"):
        little(parameter(PID, struct.pack("<iI", -1, 0))).seconds(PID)


@given(st.integers(0, 0xFFFFFFFF))
def test_numbers_come_back(value: int) -> None:
    assert little(parameter(PID, parameters.number(value))).number(PID, 5) == value
    assert big(PID, bytes(4) + struct.pack(">I", value)).number(PID, 5, at=4) == value
    assert little().number(PID, 5) == 5


def test_all_usable_locators_come_back() -> None:
    addresses = (("127.0.0.1", 7410), ("192.168.1.20", 65535), ("10.0.0.1", 1))
    shared_memory = parameter(PID, struct.pack("<iI16s", 19, 12411, b""))
    impossible = [parameter(PID, struct.pack("<iI12x4s", 1, port, b"\x7f\0\0\1")) for port in (0, 65536, 0xFFFFFFFF)]
    written = (shared_memory, parameters.locators(PID, addresses), *impossible, parameter(PID, b"cut!"))
    assert little(*written).locators(PID) == addresses
    assert big(PID, struct.pack(">iI12x4s", 1, 7410, bytes((127, 0, 0, 1)))).locators(PID) == (("127.0.0.1", 7410),)
    assert little().locators(PID) == ()


def test_a_must_understand_bit_is_no_other_parameter() -> None:
    assert little(parameter(0x4000 | PID, b"abcd")).raw(PID) == b"abcd"


def test_where_a_list_ends() -> None:
    raw = b"xx" + parameter(PID, b"a") + SENTINEL + b"payload"
    assert raw[Parameters(raw, 2).end :] == b"payload"


def test_a_value_that_has_no_room() -> None:
    assert little(parameter(PID, bytes(0xFFFC))).raw(PID) == bytes(0xFFFC)
    with pytest.raises(ValueError, match="parameter 0x002c of 65533 bytes: 65532 have room"):
        parameter(PID, bytes(0xFFFD))


@pytest.mark.parametrize(
    "value", [struct.pack("<I", 0xFFFFFFFF), struct.pack("<I", 2) + b"a", b"\5\0\0\0", b"\2\0\0\0\xff\xff"]
)
def test_texts_that_are_nonsense(value: bytes) -> None:
    with pytest.raises(RtpsError, match="parameter 0x002c"):
        Parameters(struct.pack("<HH", PID, len(value)) + value + SENTINEL).text(PID)


@pytest.mark.parametrize("raw", [b"", b"\0\3", b"\0\1\0\0" + SENTINEL, b"\1\3\0\0" + SENTINEL, b"abcd"])
def test_what_is_not_a_list(raw: bytes) -> None:
    with pytest.raises(RtpsError, match="not a parameter list"):
        read_list(raw)


def test_a_list_that_is_cut() -> None:
    whole = LIST_HEADER + parameter(PID, b"abcdefgh") + parameter(5, b"") + SENTINEL
    for size in range(len(whole) - 3):
        with pytest.raises(RtpsError):
            read_list(whole[:size])


@given(st.binary(max_size=100), st.sampled_from([b"", b"\0\3\0\0", b"\0\2\0\0"]))
def test_nonsense_is_refused_or_read(raw: bytes, header: bytes) -> None:
    try:
        found = read_list(header + raw)
        found.octets(PID), found.text(PID), found.seconds(PID), found.locators(PID), found.number(PID, 0)
    except RtpsError:
        pass
