"""A publisher of messages too large for a subscriber's link says so: nobody else could know."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from robolink.impl.log_output import Record
from robolink.networks.settings import LONGEST_WAIT
from robolink.transport import zenoh_handles
from robolink.transport.pieces import LARGE
from robolink.transport.zenoh_declare import Publishers
from robolink.transport.zenoh_handles import Holdings, ZenohOutlet
from tests.support.transports import CHATTER


class Link:
    """Stands for Zenoh's publisher; each message keeps it for so many seconds."""

    matching_status = SimpleNamespace(matching=True)

    def __init__(self, seconds: float) -> None:
        self.seconds, self.now = seconds, 0.0

    def put(self, payload: bytes, attachment: bytes) -> None:
        self.now += self.seconds


def outlet(link: Link, monkeypatch: pytest.MonkeyPatch) -> ZenohOutlet:
    monkeypatch.setattr(zenoh_handles, "clocks", SimpleNamespace(monotonic=lambda: link.now))
    return ZenohOutlet(Holdings(), CHATTER, Publishers(link, link, object))


def test_a_large_message_that_found_no_room_is_told_once(
    monkeypatch: pytest.MonkeyPatch, log_lines: list[Record]
) -> None:
    slow = outlet(Link(LONGEST_WAIT + 0.001), monkeypatch)
    for size in (LARGE - 1, 6_000_000, 7_000_000):
        slow.put(bytes(size), b"")
    (line,) = log_lines
    assert line.message == (
        f"{CHATTER}: a message of 6,000,000 bytes waited 0.19 s for room and may not arrive: a subscriber's link is too"
        " slow for messages of this size, or it stands still (said once)"
    )


def test_one_that_waited_less_is_not(monkeypatch: pytest.MonkeyPatch, log_lines: list[Record]) -> None:
    outlet(Link(LONGEST_WAIT - 0.001), monkeypatch).put(bytes(6_000_000), b"")
    assert log_lines == []
