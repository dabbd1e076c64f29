"""What only one kind of transport does, and how one is chosen."""

from __future__ import annotations

import pytest

from robolink.exceptions import TransportError
from robolink.transport import connect
from robolink.transport.memory import Bus, MemoryTransport
from tests.support.transports import CHATTER, PLAIN, Ear, latched


def test_memory_sessions_of_one_name_share_a_bus() -> None:
    first, second, apart = connect("memory://a"), connect("memory://a"), connect("memory://b")
    assert (first.session_id, second.session_id, apart.session_id) == ("1", "2", "1")
    ear, outlet = Ear(second), first.advertise(CHATTER, PLAIN)
    stranger = Ear(apart)
    outlet.put(b"hello", b"")
    assert ear.next() == b"hello"
    assert stranger.arrived.empty()


def test_a_memory_sink_runs_inside_put() -> None:
    session = MemoryTransport(bus=Bus())
    order: list[object] = []
    session.subscribe(CHATTER, PLAIN, lambda arrived: order.append(session.read(arrived).payload))
    outlet = session.advertise(CHATTER, PLAIN)
    outlet.put(b"1", b"")
    order.append("after")
    assert order == [b"1", "after"]
    assert not session.threaded


def test_memory_replays_several_publishers_in_the_order_of_publishing() -> None:
    session = MemoryTransport(bus=Bus())
    outlets = [session.advertise(CHATTER, latched(5)) for _ in range(2)]
    for number in range(6):
        outlets[number % 2].put(b"%d" % number, b"")
    assert Ear(session, qos=latched(5)).take(6) == [b"%d" % number for number in range(6)]


def test_a_ready_transport_is_given_back() -> None:
    session = MemoryTransport(bus=Bus())
    assert connect(session) is session


@pytest.mark.parametrize("url", ["memry://x", "zenoh://somewhere", "", "x" * 10_000])
def test_an_unknown_url(url: str) -> None:
    with pytest.raises(TransportError, match="expected memory://NAME or zenoh://") as caught:
        connect(url)
    assert len(str(caught.value)) < 400


def test_connect_follows_the_environment(domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOLINK_NETWORK", "off")
    session = connect("zenoh://", domain)
    try:
        assert (session.url, session.threaded) == ("zenoh://", True)
        monkeypatch.setenv("ROBOLINK_NETWORK", "no/where")
        with pytest.raises(TransportError, match="ROBOLINK_NETWORK: no network, host or file 'no/where'"):
            connect("zenoh://", domain)
    finally:
        session.close()


@pytest.mark.parametrize("domain_id", [-1, 233])
def test_no_such_domain(domain_id: int) -> None:
    with pytest.raises(TransportError, match="from 0 to 232"):
        connect("zenoh://", domain_id)
