"""Reach: who is searched and let in, and where somebody is met, without a socket."""

from __future__ import annotations

import ipaddress

import psutil
import pytest

from robolink.rtps.reach import (
    GROUP,
    LOOPBACK,
    Bounds,
    Here,
    Range,
    Reach,
    ReachError,
    bounds_of,
    interface_of,
    multicast_port,
    ports,
)

MINE, NEAR, FAR, PEER = "10.0.0.1", "10.0.0.9", "172.16.0.9", "172.16.0.5"
HERE = {LOOPBACK, MINE, "192.168.7.1"}


class FixedHere(Here):
    """Addresses of a machine that does not exist."""

    def __contains__(self, address: str) -> bool:
        return address in HERE


def bounds(interface: str | None = f"{MINE}/24", peers: tuple[str, ...] = (), reach: Range = Range.SUBNET) -> Bounds:
    network = ipaddress.IPv4Interface(interface) if interface else None
    return Bounds(network, peers, reach, FixedHere())


def test_ports_are_those_of_the_standard() -> None:
    assert multicast_port(0) == 7400
    assert ports(0, 0) == (7410, 7411)
    assert ports(20, 3) == (12416, 12417)


def test_loopback_searches_this_machine_only() -> None:
    there = bounds(None, peers=(PEER,)).search(7, 2)
    assert len(there) == 32
    assert {address for address, _ in there} == {LOOPBACK, GROUP}
    assert (LOOPBACK, ports(7, 2)[0]) not in there
    assert there[-1] == (GROUP, multicast_port(7))


def test_an_interface_searches_static_peers_too() -> None:
    there = bounds(peers=(PEER, MINE, PEER)).search(7, 2)
    assert [port for address, port in there if address == PEER] == [ports(7, index)[0] for index in range(32)]
    assert MINE not in {address for address, _ in there}


@pytest.mark.parametrize(
    ("interface", "reach", "groups"),
    [
        (None, Range.SUBNET, [LOOPBACK]),
        (None, Range.LOCALHOST, [LOOPBACK]),
        (f"{MINE}/24", Range.SUBNET, [LOOPBACK, MINE]),
        (f"{MINE}/24", Range.LOCALHOST, [LOOPBACK]),
        (f"{MINE}/24", Range.OFF, []),
        (None, Range.OFF, []),
    ],
)
def test_where_multicast_goes(interface: str | None, reach: Range, groups: list[str]) -> None:
    assert bounds(interface, reach=reach).groups() == groups


def test_no_port_beyond_the_last_is_searched() -> None:
    assert max(port for _, port in bounds().search(232, 0)) <= 65535


@pytest.mark.parametrize(
    ("interface", "reach", "admitted"),
    [
        (None, Range.SUBNET, HERE),
        (None, Range.LOCALHOST, HERE),
        (None, Range.OFF, set()),
        (f"{MINE}/24", Range.OFF, set()),
        (f"{MINE}/24", Range.LOCALHOST, HERE | {PEER}),
        (f"{MINE}/24", Range.SUBNET, HERE | {PEER, NEAR, FAR}),
    ],
)
def test_who_is_let_in(interface: str | None, reach: Range, admitted: set[str]) -> None:
    chosen = bounds(interface, (PEER,), reach)
    assert {address for address in {*HERE, NEAR, FAR, PEER} if chosen.admits(address)} == admitted


def test_this_machine_is_met_on_loopback_whatever_it_announces() -> None:
    said = [("192.168.7.1", 7413), (MINE, 7413)]
    for chosen in (bounds(None), bounds()):
        for source in ((LOOPBACK, 5000), (MINE, 5000)):
            assert chosen.choose(said, source) == (LOOPBACK, 7413)


def test_loopback_meets_nobody_elsewhere() -> None:
    assert bounds(None).choose([(NEAR, 7410), (LOOPBACK, 7410)], (NEAR, 7410)) is None


@pytest.mark.parametrize(
    ("said", "source", "met"),
    [
        ([(FAR, 7410), (NEAR, 7412)], NEAR, (NEAR, 7412)),
        ([("10.0.0.8", 7410), (NEAR, 7412)], NEAR, (NEAR, 7412)),  # from where it came is best
        ([(FAR, 7410), (NEAR, 7410)], FAR, (FAR, 7410)),  # by a route
        ([(FAR, 7410)], NEAR, None),  # it could name anybody
        ([(LOOPBACK, 7410)], NEAR, None),  # that would be ourselves
        ([(MINE, 7410)], NEAR, None),
        ([("10.0.0.255", 7410)], NEAR, None),  # everybody
        ([(GROUP, 7410)], NEAR, None),
        ([(PEER, 7410)], NEAR, (PEER, 7410)),
        ([(NEAR, 53)], NEAR, None),  # no participant, but a name server
        ([], NEAR, None),
    ],
)
def test_where_others_are_met(said: list[tuple[str, int]], source: str, met: tuple[str, int] | None) -> None:
    assert bounds(peers=(PEER,)).choose(said, (source, 7410)) == met


def test_addresses_of_this_machine() -> None:
    here = Here()
    assert LOOPBACK in here
    assert "127.0.0.5" in here
    for other in ("192.0.2.77", GROUP, "0.0.0.0", "255.255.255.255"):
        assert other not in here


def test_addresses_are_looked_up_again_and_do_not_fill_the_memory() -> None:
    now = [0.0]
    here = Here(lambda: now[0])
    for number in range(3000):
        assert f"198.18.{number // 256}.{number % 256}" not in here
    assert len(here._known) <= 1000
    looked_up = dict(here._known)
    now[0] = 11.0
    assert LOOPBACK in here
    assert "198.18.0.1" not in here
    assert len(here._known) < len(looked_up)


def test_what_was_requested() -> None:
    for reach in (Reach(), Reach("127.0.0.1"), Reach(peers=("127.0.0.1",))):
        assert (bounds_of(reach).address, bounds_of(reach).announced) == (None, LOOPBACK)
    with pytest.raises(ReachError, match=r"no interface 'eth77' with an IPv4 address: there are .*127\.0\.0\.1"):
        bounds_of(Reach("eth77"))
    with pytest.raises(ReachError, match=r"static peer 'no-such-host\.invalid' has no IPv4 address"):
        bounds_of(Reach(peers=("no-such-host.invalid",)))


def test_an_interface_by_name_and_by_address() -> None:
    for name, addresses in psutil.net_if_addrs().items():
        for each in addresses:
            if each.family.name == "AF_INET":
                assert interface_of(each.address)[0] == name
                assert str(interface_of(each.address)[1].ip) == each.address
                assert interface_of(name)[0] == name
