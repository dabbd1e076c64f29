"""Reach of a participant: whom it looks for, who is let in, and at which address somebody is met.

Without an interface that is this machine, over loopback, whatever the range says: nothing leaves it. The rest is as
rmw_fastrtps has it for ROS_AUTOMATIC_DISCOVERY_RANGE and ROS_STATIC_PEERS.
"""

from __future__ import annotations

import errno
import ipaddress
import socket
import time
from collections.abc import Callable, Sequence
from enum import Enum
from typing import NamedTuple

from robolink.rtps.parameters import Locator

LOOPBACK = "127.0.0.1"
GROUP = "239.255.0.1"
"""Multicast group in which participants announce themselves. RTPS 2.5, 9.6.1.4."""
SEARCHED = 32
"""Participants of a machine that are looked for, one port each: as many as rmw_fastrtps looks for."""
MOST_DOMAIN = 232

_PORT_BASE, _DOMAIN_GAIN, _PARTICIPANT_GAIN = 7400, 250, 2
_METATRAFFIC, _USER = 10, 11
_WELL_KNOWN_PORTS = range(1024)
_FORGET_AFTER, _MOST_ADDRESSES = 10.0, 1000


class ReachError(OSError):
    """No participant can be where it was requested: it says what there is."""


class Range(Enum):
    """Of ROS_AUTOMATIC_DISCOVERY_RANGE."""

    OFF = "OFF"
    """Nobody is met, not even on this machine."""
    LOCALHOST = "LOCALHOST"
    """This machine, and the static peers."""
    SUBNET = "SUBNET"
    """Whoever an interface's multicast reaches, this machine, and the static peers."""


class Reach(NamedTuple):
    """A requested reach."""

    interface: str = ""
    """Name or IPv4 address of the one interface that is used beside loopback; "": none; nothing leaves the machine."""
    peers: tuple[str, ...] = ()
    """Names or IPv4 addresses of machines that are looked for where there is an interface (static peers)."""
    range: Range = Range.SUBNET


LOOPBACK_ONLY = Reach()


def multicast_port(domain: int) -> int:
    """Return the port at which the announcements of a domain's participants come in by multicast."""
    return _PORT_BASE + _DOMAIN_GAIN * domain


def ports(domain: int, index: int) -> tuple[int, int]:
    """Return the ports of a machine's participant with this index: for discovery, and for the rest."""
    base = multicast_port(domain) + _PARTICIPANT_GAIN * index
    return base + _METATRAFFIC, base + _USER


class Here:
    """Addresses of this machine: those to which a socket can be bound."""

    def __init__(self, now: Callable[[], float] = time.perf_counter) -> None:
        self._now = now
        self._known: dict[str, bool] = {}
        self._forget_at = 0.0

    def __contains__(self, address: str) -> bool:
        if address == LOOPBACK:
            return True
        # An interface may get another address; and whoever sends from many addresses must not fill the memory.
        if self._now() >= self._forget_at or len(self._known) >= _MOST_ADDRESSES:
            self._known.clear()
            self._forget_at = self._now() + _FORGET_AFTER
        if address not in self._known:
            self._known[address] = _can_bind(address)
        return self._known[address]


def _can_bind(address: str) -> bool:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind((address, 0))
            probe.connect(probe.getsockname())  # refused for addresses of everybody, to which one can bind, too
        except OSError:
            return False
    return not ipaddress.IPv4Address(address).is_multicast and address != "0.0.0.0"


class Bounds:
    """A request as it is on this machine: the pure decisions over addresses."""

    def __init__(
        self,
        network: ipaddress.IPv4Interface | None = None,
        peers: Sequence[str] = (),
        range_: Range = Range.SUBNET,
        here: Here | None = None,
    ) -> None:
        """Take what `bounds_of` found.

        Args:
            network: address and network of the interface; None: loopback only.
            peers: addresses of static peers.
            range_: as requested.
            here: addresses of this machine.
        """
        self.address = None if network is None else str(network.ip)
        """Of the interface; None: loopback only."""
        self._network = None if network is None else network.network
        self._here = Here() if here is None else here
        self._range = range_
        elsewhere = () if network is None else [peer for peer in peers if peer not in self._here]
        self._peers = frozenset(elsewhere)
        self._order = tuple(dict.fromkeys(elsewhere))

    @property
    def announced(self) -> str:
        """Address under which we say to be met: never one of an interface that was not requested."""
        return self.address or LOOPBACK

    def groups(self) -> list[str]:
        """Return the addresses of the interfaces on which announcements are heard and sent by multicast."""
        if self._range is Range.OFF:
            return []
        with_interface = self.address is not None and self._range is Range.SUBNET
        return [LOOPBACK, str(self.address)] if with_interface else [LOOPBACK]

    def search(self, domain: int, index: int) -> list[Locator]:
        """Return where participants may be, but for ourselves, who have this index."""
        if self._range is Range.OFF:
            return []
        found = [(LOOPBACK, ports(domain, other)[0]) for other in range(SEARCHED) if other != index]
        found += [(peer, ports(domain, other)[0]) for peer in self._order for other in range(SEARCHED)]
        return [each for each in found if each[1] <= 0xFFFF] + [(GROUP, multicast_port(domain))]

    def admits(self, address: str) -> bool:
        """Return whether what comes from an address is read.

        On loopback that is not granted: a socket that joined a group there also gets, on Linux, what comes to the group
        on an interface where another program joined it, so participants of other machines would be among our peers.
        """
        if self._range is Range.OFF:
            return False
        if address in self._here:
            return True
        if self.address is None:
            return False
        return self._range is Range.SUBNET or address in self._peers

    def choose(self, locators: Sequence[Locator], source: Locator) -> Locator | None:
        """Return where a participant is met that is at any of these, and whose announcement came from there.

        One of this machine is met at 127.0.0.1, whatever it says: nodes with the range SUBNET name the addresses of
        their other interfaces only, but listen on all. None: at none of them; what it says of third parties is not
        believed, or anybody could have us send to anybody.
        """
        usable = [
            each for each in locators if each[1] not in _WELL_KNOWN_PORTS and self._may_be_met(each[0], source[0])
        ]
        if not usable or not self.admits(source[0]):
            return None
        if source[0] in self._here:
            return LOOPBACK, usable[0][1]
        return min(usable, key=lambda each: (each[0] != source[0], not self._is_near(each[0])))

    def _may_be_met(self, address: str, source: str) -> bool:
        if source in self._here:
            return True
        return address == source or address in self._peers or self._is_near(address)

    def _is_near(self, address: str) -> bool:
        """Return whether an address is one machine on the interface's network, and not this one."""
        if self._network is None or address in self._here:
            return False
        number = ipaddress.IPv4Address(address)
        return number in self._network and number != self._network.broadcast_address


def bounds_of(reach: Reach) -> Bounds:
    """Find the interface and the static peers that were requested.

    Raises:
        ReachError: if there is no such interface, or a peer's name has no address.
    """
    peers = [_resolve(peer) for peer in reach.peers]
    interface = reach.interface
    network = interface_of(interface)[1] if interface else None
    if network is not None and network.ip.is_loopback:
        network = None
    return Bounds(network, peers, reach.range)


def _resolve(peer: str) -> str:
    try:
        found = socket.getaddrinfo(peer, None, socket.AF_INET, socket.SOCK_DGRAM)
    except (OSError, UnicodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise ReachError(errno.EADDRNOTAVAIL, f"static peer {peer!r} has no IPv4 address: {reason}") from None
    return str(found[0][4][0])


def interface_of(interface: str) -> tuple[str, ipaddress.IPv4Interface]:
    """Return the name of an interface, and its address and network, given its name or its address.

    Raises:
        ReachError: if there is none, or it has no IPv4 address.
    """
    import psutil  # here: it takes 20 ms, and only who leaves loopback needs it

    there: list[str] = []
    for name, addresses in psutil.net_if_addrs().items():
        for each in addresses:
            if each.family != socket.AF_INET:
                continue
            if interface in {name, each.address}:
                return name, ipaddress.IPv4Interface(f"{each.address}/{each.netmask or 32}")
            there.append(f"{name} ({each.address})")
    raise ReachError(
        errno.ENODEV, f"no interface {interface!r} with an IPv4 address: there are {', '.join(there) or 'none'}"
    )
