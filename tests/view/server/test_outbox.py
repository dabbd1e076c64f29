"""Outbox of a client: order, batches with credits, rates, and what a slow client gets in bounded memory."""

from __future__ import annotations

import struct
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.view.channels import LARGEST, Channel
from robolink.view.server.outbox import BUFFERED, MEMORY, MOST_LATCHED, Outbox

ENTRY = struct.Struct("<IIQ")


class Wire:
    """A transport that keeps what is written."""

    def __init__(self) -> None:
        self.written: list[bytes] = []
        self.buffered = 0
        self.closing = False

    def write(self, data: bytes) -> None:
        self.written.append(data)

    def get_write_buffer_size(self) -> int:
        return self.buffered

    def is_closing(self) -> bool:
        return self.closing

    def abort(self) -> None:
        self.closing = True

    def take(self) -> list[list[tuple[int, int, bytes]]]:
        """Return the messages of each batch, or of each write of Foxglove's frames."""
        taken, self.written = self.written, []
        return [entries(each) for each in taken]


def entries(raw: bytes) -> list[tuple[int, int, bytes]]:
    found = []
    for body in bodies(raw):
        if body[0] == 1:
            subscription, at = struct.unpack_from("<IQ", body, 1)
            found.append((subscription, at, body[13:]))
            continue
        offset = 1
        while offset < len(body):
            length, subscription, at = ENTRY.unpack_from(body, offset)
            offset += ENTRY.size + length
            found.append((subscription, at, body[offset - length : offset]))
    return found


def bodies(raw: bytes) -> list[bytes]:
    """Return the payloads of WebSocket frames."""
    found, offset = [], 0
    while offset < len(raw):
        assert raw[offset] == 0x82
        length, begin = raw[offset + 1], offset + 2
        if length >= 126:
            size = 2 if length == 126 else 8
            length, begin = int.from_bytes(raw[begin : begin + size], "big"), begin + size
        found.append(raw[begin : begin + length])
        offset = begin + length
    return found


def sender(name: str) -> bytes:
    return bytes(17) + name.encode().rjust(16, b"-")


def box(batching: bool = True, **more: Any) -> tuple[Wire, Outbox, Any]:
    wire = Wire()
    outbox = Outbox(wire, batching=batching)
    return wire, outbox, outbox.want(1, more.get("rate", 0), latched=more.get("latched", False), retained=[])


@pytest.mark.parametrize("batching", [True, False])
@given(sizes=st.lists(st.sampled_from([0, 1, 109, 110, 125, 126, 65535, 65536]) | st.integers(0, 300), max_size=8))
def test_frames_can_be_read_whatever_their_size(batching: bool, sizes: list[int]) -> None:
    wire, outbox, take = box(batching)
    for at, size in enumerate(sizes):
        take(at, bytes(size), sender("a"))
    outbox.flush(0.0)
    assert [each for group in wire.take() for each in group] == [(1, at, bytes(n)) for at, n in enumerate(sizes)]


def test_with_two_batches_unacknowledged_the_newest_of_each_publisher_waits() -> None:
    wire, outbox, take = box()
    for at in range(2):
        take(at, b"x", sender("a"))
        outbox.flush(0.0)
    for at in range(2, 10):
        take(at, b"x", sender("ab"[at % 2]))
        outbox.flush(0.0)
    assert [len(each) for each in wire.take()] == [1, 1]
    outbox.acknowledge()
    outbox.flush(0.0)
    assert wire.take() == [[(1, 8, b"x"), (1, 9, b"x")]]
    assert (outbox.dropped, outbox.waiting) == (6, 0)


def test_a_foxglove_client_that_reads_slowly_gets_the_newest_too() -> None:
    wire, outbox, take = box(batching=False)
    wire.buffered = BUFFERED + 1
    for at in range(100):
        take(at, b"x", sender("a"))
        outbox.flush(0.0)
    assert (wire.take(), outbox.waiting) == ([], 1)
    wire.buffered = 0
    outbox.flush(0.0)
    assert wire.take() == [[(1, 99, b"x")]]


def test_latched_topics_are_never_thinned() -> None:
    wire, outbox, take = box(latched=True, rate=1.0)
    wire.buffered = BUFFERED + 1
    for at in range(5):
        take(at, b"x", sender("a"))
        outbox.flush(0.0)
    wire.buffered = 0
    outbox.flush(0.0)
    assert [len(each) for each in wire.take()] == [5]


@pytest.mark.parametrize("latched", [True, False])
def test_a_client_that_stands_still_costs_no_more_than_stated(latched: bool) -> None:
    wire, outbox, take = box(latched=latched)
    wire.buffered = BUFFERED + 1
    large = bytes(LARGEST // 4)
    for at in range(40):
        take(at, large, sender(str(at)))
        outbox.flush(0.0)
    assert outbox.waiting == MEMORY // len(large)
    wire.buffered = 0
    outbox.flush(0.0)
    assert [at for each in wire.take() for _, at, _ in each] == [36, 37, 38, 39]


def test_a_page_in_a_hidden_tab_costs_a_bounded_number_of_log_messages() -> None:
    wire, outbox, log = box(latched=True)
    other = outbox.want(2, 0, latched=False, retained=[])
    wire.buffered = BUFFERED + 1
    for at in range(2 * MOST_LATCHED):
        log(at, b"x", sender("a"))
        if at % 1000 == 0:
            other(at, b"y", sender("b"))
            outbox.flush(0.0)
    outbox.flush(0.0)
    assert outbox.waiting == MOST_LATCHED + 1
    assert outbox.dropped == MOST_LATCHED + 2 * MOST_LATCHED // 1000 - 1
    wire.buffered = 0
    outbox.flush(0.0)
    sent = [each for group in wire.take() for each in group]
    assert [at for number, at, _ in sent if number == 1] == list(range(MOST_LATCHED, 2 * MOST_LATCHED))


def test_what_waits_is_looked_through_only_when_more_came() -> None:
    wire, outbox, log = box(latched=True)
    wire.buffered = BUFFERED + 1
    log(0, b"x", sender("a"))
    outbox.flush(0.0)
    waiting = outbox._pending = Uncopied(outbox._pending)
    outbox.flush(0.0)
    assert waiting.times == 0


class Uncopied(list[Any]):
    """A list that counts how often it is looked through."""

    times = 0

    def __reversed__(self) -> Any:
        self.times += 1
        return super().__reversed__()


def test_a_rate_is_the_newest_of_each_publisher_in_each_period() -> None:
    wire, outbox, take = box(rate=10.0)
    for step in range(30):
        take(step, b"x", sender("ab"[step % 2]))
        outbox.flush(step / 100)
    assert [len(each) for each in wire.take()] == [1, 2]


def test_what_waits_for_its_period_is_bounded_too() -> None:
    wire, outbox, take = box(rate=0.001)
    outbox.flush(0.0)
    large = bytes(MEMORY // 4)
    for at in range(30):
        take(at, large, sender(str(at)))
    outbox.flush(2000.0)
    assert [at for each in wire.take() for _, at, _ in each] == [28, 29]
    take(30, large, sender("a"))
    outbox.flush(4000.0)
    assert [at for each in wire.take() for _, at, _ in each] == [30]


def test_after_a_jump_of_time_nothing_of_before_is_sent() -> None:
    wire, outbox, take = box(latched=True)
    limited = outbox.want(2, 1.0, latched=False, retained=[])
    for each in (take, limited):
        each(0, b"x", sender("a"))
    outbox.clear()
    limited(1, b"y", sender("a"))
    outbox.flush(0.0)
    assert wire.take() == [[(2, 1, b"y")]]
    assert outbox._held == 0


def test_nothing_is_written_to_a_connection_that_closes() -> None:
    wire, outbox, take = box()
    take(0, b"x", sender("a"))
    wire.closing = True
    outbox.flush(0.0)
    assert (wire.take(), outbox.waiting) == ([], 0)


def test_what_waits_for_a_subscription_goes_with_it() -> None:
    wire, outbox, take = box()
    take(0, b"x", sender("a"))
    assert outbox.forget(1) is take
    assert outbox.forget(1) is None
    outbox.flush(0.0)
    assert wire.take() == []


def test_giants_are_counted_and_not_sent() -> None:
    channel = Channel(1, "/giant", "a/msg/B", "")
    heard: list[int] = []
    channel.takers = [lambda at, payload, sender: heard.append(at)]
    channel.deliver(1, bytes(LARGEST + 1), b"")
    channel.deliver(2, bytes(LARGEST), b"")
    assert (heard, channel.count, channel.too_large) == ([2], 2, 1)
