"""Sockets on loopback: ports, what comes through, what the network refuses, and that nothing kills them."""

from __future__ import annotations

import contextlib
import errno
import socket
import sys
import threading
import time
from collections.abc import Iterator

import pytest

from robolink.rtps.parameters import Locator
from robolink.rtps.reach import GROUP, LOOPBACK, Range, Reach, ReachError, multicast_port, ports
from robolink.rtps.sockets import Sockets
from tests.support.domains import free_dds_domain

Received = list[tuple[bytes, tuple[str, int]]]


@pytest.fixture
def domain() -> Iterator[int]:
    with free_dds_domain() as found:
        yield found


@pytest.fixture
def pair(domain: int) -> Iterator[tuple[Sockets, Sockets]]:
    with contextlib.closing(Sockets(domain)) as one, contextlib.closing(Sockets(domain)) as other:
        yield one, other


def receive(sockets: Sockets, number: int, patience: float = 5.0) -> Received:
    """Return the datagrams that come, once there are so many."""
    found: Received = []
    end = time.monotonic() + patience
    while len(found) < number and time.monotonic() < end:
        sockets.receive(0.1, lambda raw, source: found.append((bytes(raw), source)))
    return found


def test_participants_of_a_domain_have_ports_of_their_own(pair: tuple[Sockets, Sockets], domain: int) -> None:
    one, other = pair
    assert one.index < other.index
    for each in pair:
        assert (each.metatraffic, each.default) == tuple((LOOPBACK, port) for port in ports(domain, each.index))
        assert each.metatraffic not in each.search
    assert other.metatraffic in one.search


def test_a_port_that_is_taken_is_passed_over(domain: int) -> None:
    with socket.socket(type=socket.SOCK_DGRAM) as taken:
        taken.bind((LOOPBACK, ports(domain, 0)[1]))
        with contextlib.closing(Sockets(domain)) as sockets:
            assert sockets.index >= 1


def test_a_domain_that_is_full(domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.rtps.sockets._INDICES", 1)
    says = f"no free ports for a participant of domain {domain} at 127.0.0.1"
    with contextlib.closing(Sockets(domain)), pytest.raises(ReachError, match=says):
        Sockets(domain)


@pytest.mark.parametrize("impossible", [-1, 233])
def test_a_domain_without_ports(impossible: int) -> None:
    with pytest.raises(ValueError, match=f"domain {impossible}: 0 to 232 have ports"):
        Sockets(impossible)


def test_the_last_domain_has_room() -> None:
    made = []
    try:
        for _ in range(3):
            made.append(Sockets(232))
        assert all(each.default[1] <= 65535 for each in made)
    finally:
        for each in made:
            each.close()


def test_datagrams_come_through_at_both_ports(pair: tuple[Sockets, Sockets]) -> None:
    one, other = pair
    one.send(other.metatraffic, [b"whole"])
    one.send(other.default, [b"in ", memoryview(b"some "), bytearray(b"pieces")])
    assert sorted(receive(other, 2)) == [(b"in some pieces", one.metatraffic), (b"whole", one.metatraffic)]


def test_a_socket_is_emptied_before_anything_is_done_with_what_it_had(pair: tuple[Sockets, Sockets]) -> None:
    one, other = pair
    for number in range(5):
        one.send(other.default, [bytes([number])])
    found: list[bytes] = []

    def take(raw: memoryview, source: Locator) -> None:
        with pytest.raises(BlockingIOError):
            other._local.user.recv(1)  # the buffer has room for what comes meanwhile
        found.append(bytes(raw))

    end = time.monotonic() + 5
    while len(found) < 5 and time.monotonic() < end:
        other.receive(0.1, take)
    assert found == [bytes([number]) for number in range(5)]


def test_the_largest_datagram_comes_through(pair: tuple[Sockets, Sockets]) -> None:
    one, other = pair
    one.send(other.default, [bytes(65_507)])
    assert [len(raw) for raw, _ in receive(other, 1)] == [65_507]


def test_one_that_is_too_large_is_counted(pair: tuple[Sockets, Sockets]) -> None:
    one, other = pair
    one.send(other.default, [bytes(70_000)])
    assert (one.counts.lost, one.counts.errors) == (1, {"EMSGSIZE": 1})


def test_a_mebibyte_in_paced_fragments_comes_through(pair: tuple[Sockets, Sockets]) -> None:
    one, other = pair
    for number in range(16):
        one.send(other.default, [number.to_bytes(2, "big"), bytes(63 * 1024)], pause=1e-5)
    assert sorted({int.from_bytes(raw[:2], "big") for raw, _ in receive(other, 16)}) == list(range(16))


def test_pauses_are_between_large_ones_only(pair: tuple[Sockets, Sockets], monkeypatch: pytest.MonkeyPatch) -> None:
    one, other = pair
    slept: list[float] = []
    monkeypatch.setattr("robolink.rtps.sockets.time.sleep", slept.append)
    for _ in range(10):
        one.send(other.default, [bytes(1000)], pause=1e-5)
        one.send(other.default, [bytes(60_000)])
    assert slept == []
    for _ in range(3):
        one.send(other.default, [bytes(60_000)], pause=1e-5)
    assert len(slept) == 3


@pytest.mark.skipif(sys.platform != "linux", reason="where the loopback interface has multicast")
def test_multicast_reaches_all_of_the_domain(pair: tuple[Sockets, Sockets], domain: int) -> None:
    one, _ = pair
    assert one.hears_multicast
    assert (GROUP, multicast_port(domain)) in one.search
    one.send((GROUP, multicast_port(domain)), [b"I am here"])
    for each in pair:
        assert receive(each, 1) == [(b"I am here", one.metatraffic)]


def test_without_multicast_those_that_are_searched_are_met(domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """As on macOS, where the loopback interface has no route for it."""
    monkeypatch.setattr("robolink.rtps.sockets._joins", lambda group, address: False)
    monkeypatch.setattr("robolink.rtps.sockets._can_multicast", lambda pair: False)
    with contextlib.closing(Sockets(domain)) as one, contextlib.closing(Sockets(domain)) as other:
        assert not one.hears_multicast
        assert other.metatraffic in one.search
        assert {address for address, _ in one.search} == {LOOPBACK}
        one.send((GROUP, multicast_port(domain)), [b"nobody hears it"])
        one.send(other.metatraffic, [b"hello"])
        assert receive(other, 1) == [(b"hello", one.metatraffic)]


def test_nothing_is_sent_beyond_loopback(pair: tuple[Sockets, Sockets]) -> None:
    one, _ = pair
    for address in ("192.0.2.77", "8.8.8.8", "255.255.255.255", "224.0.0.1"):
        one.send((address, 7410), [b"x"])
    assert (one.counts.sent, one.counts.errors) == (0, {"ENETUNREACH": 4})


def test_who_is_not_let_in_is_counted(domain: int) -> None:
    with contextlib.closing(Sockets(domain, Reach(range=Range.OFF))) as off:
        assert off.search == []
        with socket.socket(type=socket.SOCK_DGRAM) as stranger:
            stranger.sendto(b"let me in", off.metatraffic)
        assert receive(off, 1, patience=0.3) == []
        assert off.counts.strangers == 1


def test_what_the_network_refuses_kills_nobody(pair: tuple[Sockets, Sockets], monkeypatch: pytest.MonkeyPatch) -> None:
    one, other = pair
    for number in (errno.ENOBUFS, errno.ENETUNREACH, errno.ECONNREFUSED, errno.EPERM, errno.EHOSTDOWN):
        broken = _Broken(OSError(number, "as requested"))
        monkeypatch.setitem(one._senders, LOOPBACK, [broken])
        one.send(other.default, [b"x"])
        assert one.counts.errors[errno.errorcode[number]] == 1
    monkeypatch.undo()
    one.send((LOOPBACK, 70_000), [b"x"])
    assert one.counts.errors["OverflowError"] == 1
    one.send(other.default, [b"still here"])
    assert receive(other, 1)[0][0] == b"still here"


def test_a_full_buffer_is_waited_for_but_not_forever(
    pair: tuple[Sockets, Sockets], monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = pair
    slept: list[float] = []
    monkeypatch.setattr("robolink.rtps.sockets.time.sleep", slept.append)
    monkeypatch.setitem(one._senders, LOOPBACK, [_Broken(BlockingIOError(), times=3)])
    one.send(other.default, [b"x"])
    assert (len(slept), one.counts.sent) == (3, 1)
    monkeypatch.setitem(one._senders, LOOPBACK, [_Broken(BlockingIOError())])
    one.send(other.default, [b"x"])
    assert (sum(slept) < 0.1, one.counts.errors) == (True, {"ENOBUFS": 1})


def test_a_link_that_stands_still_is_waited_for_once(
    pair: tuple[Sockets, Sockets], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else 6 MB to another machine would take a minute and a half of its publisher, in 5,000 datagrams."""
    one, other = pair
    slept: list[float] = []
    monkeypatch.setattr("robolink.rtps.sockets.time.sleep", slept.append)
    broken = _Broken(BlockingIOError(), times=200)
    monkeypatch.setitem(one._senders, LOOPBACK, [broken])
    for _ in range(101):
        one.send(other.default, [b"x"])
    assert (one.counts.sent, one.counts.lost, len(slept)) == (0, 101, 100)
    broken.left = 0
    one.send(other.default, [b"x"])
    broken.left = 3
    one.send(other.default, [b"x"])  # it is waited for again
    assert (one.counts.sent, len(slept)) == (2, 103)


class _Broken:
    """A socket that refuses to send, for so many times."""

    def __init__(self, error: OSError, times: int = 1000) -> None:
        self._error, self.left = error, times

    def sendto(self, _raw: bytes, _address: tuple[str, int]) -> None:
        self.left -= 1
        if self.left >= 0:
            raise self._error


def test_waking_ends_a_wait(pair: tuple[Sockets, Sockets]) -> None:
    one, _ = pair
    found: Received = []
    thread = threading.Thread(target=one.receive, args=(60.0, lambda raw, source: found.append((bytes(raw), source))))
    thread.start()
    one.wake()
    thread.join(5.0)
    assert not thread.is_alive()
    begun = time.monotonic()
    for _ in range(3):
        one.wake()
    one.receive(60.0, lambda raw, source: found.append((bytes(raw), source)))
    assert time.monotonic() - begun < 5.0
    assert found == []


def test_the_receive_buffer_that_the_kernel_gave(pair: tuple[Sockets, Sockets]) -> None:
    assert 2048 <= pair[0].receive_buffer <= 8 << 20
