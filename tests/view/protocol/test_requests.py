"""Decoder of clients' messages: each operation, and nonsense, which is refused in one line."""

from __future__ import annotations

import json
import struct
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robolink.view.protocol import requests
from robolink.view.protocol.requests import ProtocolError, decode

VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=10,
)


def refusal(raw: str | bytes) -> str:
    try:
        decode(raw)
    except ProtocolError as error:
        return str(error)
    return "OK"


@given(st.text() | st.binary() | VALUES.map(json.dumps))
@example("[" * 100_000)
@example('{"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]}')
@example("\ud800")
@example(b"\x03")
def test_anything_is_decoded_or_refused_in_one_line(raw: str | bytes) -> None:
    assert "\n" not in refusal(raw)


@given(
    st.sampled_from(requests._OP_NAMES), st.dictionaries(st.sampled_from(["subscriptions", "id", "channels"]), VALUES)
)
@example("subscribe", {"subscriptions": None, "id": float("inf")})  # Python writes Infinity, which is not JSON
def test_no_fields_of_an_operation_break_the_decoder(op: str, fields: dict[str, Any]) -> None:
    assert refusal(json.dumps({"op": op, **fields})).startswith((op, "a message that is not JSON", "OK"))


@given(
    st.booleans(),
    st.floats(0.125, 100, width=32),
    st.none() | st.integers(0, 2**64 - 1),
    st.text(max_size=40),
)
def test_playback(play: bool, speed: float, seek: int | None, name: str) -> None:
    raw_name = name.encode()
    raw = struct.pack("<BBfBQI", 3, not play, speed, seek is not None, seek or 0, len(raw_name)) + raw_name
    assert decode(raw) == requests.PlaybackControl(play, speed, seek, name)
    for cut in range(1, len(raw)):
        with pytest.raises(ProtocolError):
            decode(raw[:cut])


@given(st.integers(0, 2**32 - 1), st.binary())
def test_message_data(channel: int, payload: bytes) -> None:
    assert decode(struct.pack("<BI", 1, channel) + payload) == requests.MessageData(channel, payload)


@pytest.mark.parametrize("encoding", ["cdr", "json"])
def test_service_call(encoding: str) -> None:
    raw = struct.pack("<BIII", 2, 5, 6, len(encoding)) + encoding.encode() + b"body"
    assert decode(raw) == requests.ServiceCall(5, 6, encoding, b"body")


@pytest.mark.parametrize(
    ("raw", "part"),
    [
        ("{", "not JSON"),
        ("{}", "without 'op'"),
        ('{"op":"subscrib"}', "subscribe"),
        ('{"op":"subscribe"}', "subscribe: Object missing required field `subscriptions`"),
        (b"", "empty"),
        (b"\x63", "no binary operation 99; there are 1, 2, 3, 128"),
        (struct.pack("<BIII", 2, 5, 6, 3) + b"xml", "expected cdr or json"),
        (struct.pack("<BBfBQI", 3, 0, float("nan"), 0, 0, 0), "a speed above 0"),
        (struct.pack("<BBfBQI", 3, 9, 1, 0, 0, 0), "no command 9"),
    ],
)
def test_what_is_refused_says_why(raw: str | bytes, part: str) -> None:
    with pytest.raises(ProtocolError, match=part):
        decode(raw)
