"""Discovery by a real ROS 2 of participants of ours whose announcements of endpoints were lost, and sent again."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Sequence
from typing import Any

import pytest

from robolink.rtps import Participant, Qos, ids, sockets
from robolink.rtps.parameters import Buffer, Locator
from robolink.rtps.submessages import Data, parse
from tests.dds.conftest import Lab
from tests.dds.peers import until

pytestmark = pytest.mark.processes

TYPE = "std_msgs::msg::dds_::String_"


@pytest.mark.parametrize("distribution", ["kilted", "jazzy"])
def test_two_participants_whose_first_announcements_were_lost_are_both_met(
    lab: Lab, distribution: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Fast DDS has what came after them at one reader, sorted by source timestamps. On a busy machine it happens."""
    losing: set[sockets.Sockets] = set()
    send = sockets.Sockets.send

    def lossy(self: sockets.Sockets, address: Locator, buffers: Sequence[Buffer], pause: float = 0.0) -> None:
        parts = parse(b"".join(buffers)).submessages if self in losing else ()
        firsts = [each for each in parts if isinstance(each, Data) and each.number == 1]
        if not any(each.writer == ids.SUBSCRIPTIONS_WRITER for each in firsts):
            send(self, address, buffers, pause)

    monkeypatch.setattr(sockets.Sockets, "send", lossy)

    def seen(topic: str) -> int:
        return len(real.ask("endpoints", topic=f"/lab/{topic}")[1])

    with lab.real(distribution) as real, contextlib.ExitStack() as stack:
        real.ready()
        both = [Participant(lab.domain) for _ in range(2)]
        for each in both:
            stack.callback(each.close)
        until(lambda: all(len(each.peers()) == 2 and each.settled() for each in both), "all three have met")
        losing.update(each._sockets for each in both)
        for each in both:
            for topic in ("first", "second", "third"):
                each.reader(f"rt/lab/{topic}", TYPE, Qos(), _nothing)
            until(functools.partial(_has_sent, each, 3), "it has announced them")
        for each in both:
            losing.discard(each._sockets)
            until(functools.partial(_is_acknowledged, each), "the real one has all")
        until(lambda: [seen(topic) for topic in ("first", "second", "third")] == [2, 2, 2], "each reader is there")


def _nothing(*_: Any) -> None:
    pass


def _proxies(participant: Participant) -> list[Any]:
    """Return the others' readers of the announcements of readers."""
    with participant._lock:
        return [*participant._core._discovery.writers[False].readers.values()]


def _has_sent(participant: Participant, count: int) -> bool:
    with participant._lock:
        return participant._core._discovery.writers[False].last == count


def _is_acknowledged(participant: Participant) -> bool:
    return all(each.acked == 4 for each in _proxies(participant))
