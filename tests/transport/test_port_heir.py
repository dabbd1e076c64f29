"""The rendezvous port's heir: it listens there once the holder has ended, unless another one was faster."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from typing import Any

import pytest
import zenoh

from robolink.transport import joining
from robolink.transport.joining import Heir, claim_of
from robolink.transport.port_sharing import PortClaim
from robolink.transport.reach import Reach
from tests.support.waits import wait_until

LAN = Reach("peer", multicast="224.0.0.224:17447")


class Opened:
    """A session that has been opened; it counts how often it was closed."""

    def __init__(self) -> None:
        self.closed = 0

    def close(self) -> None:
        self.closed += 1


def never(listens: bool) -> Any:
    raise AssertionError("nothing is to be opened")


@pytest.fixture
def holder(monkeypatch: pytest.MonkeyPatch) -> Iterator[socket.socket]:
    monkeypatch.setattr(joining, "LOOKS_EVERY", 0.01)
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server


def test_the_port_is_taken_when_its_holder_has_ended_and_left_again(holder: socket.socket) -> None:
    session = Opened()
    asked: list[bool] = []

    def opened(listens: bool) -> Any:
        asked.append(listens)
        return session

    heir = Heir(holder.getsockname()[1], opened)
    assert heir.waits
    holder.close()
    wait_until(lambda: heir.granted)
    heir.release()
    heir.release()
    assert (asked, session.closed, heir.waits) == ([True], 1, False)


def test_another_one_may_be_faster(holder: socket.socket) -> None:
    tries: list[bool] = []

    def refused(listens: bool) -> Any:
        tries.append(listens)
        raise zenoh.ZError("Address already in use")

    heir = Heir(holder.getsockname()[1], refused)
    holder.close()
    wait_until(lambda: len(tries) > 1)
    assert heir.waits
    heir.release()


def test_a_session_that_has_been_closed_takes_nothing(holder: socket.socket) -> None:
    heir = Heir(holder.getsockname()[1], never)
    heir.close()
    wait_until(lambda: not heir.waits)
    holder.close()
    heir.take()
    assert not heir.granted


def test_only_sessions_that_others_may_come_to_wait_for_the_port(holder: socket.socket) -> None:
    port = holder.getsockname()[1]
    own = PortClaim(port)
    for within in (Reach("peer"), LAN._replace(listens=("tls/0.0.0.0:17447",))):
        assert claim_of(own, port, never, within) is own
    heir = claim_of(own, port, never, LAN)
    assert isinstance(heir, Heir)
    heir.release()
