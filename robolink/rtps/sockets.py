"""Sockets of a participant: its ports, what they let in, and how datagrams leave, paced where there are many.

The only file of the room that speaks to the network. It never binds 0.0.0.0: on loopback nobody else can reach us, with
an interface only those there. Whatever the network answers to a datagram, nobody is harmed: what RELIABLE needs is sent
again.
"""

from __future__ import annotations

import contextlib
import errno
import selectors
import socket
import sys
import threading
import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

from robolink.rtps.parameters import Buffer, Locator
from robolink.rtps.reach import (
    GROUP,
    LOOPBACK,
    LOOPBACK_ONLY,
    MOST_DOMAIN,
    Bounds,
    Reach,
    ReachError,
    bounds_of,
    interface_of,
    multicast_port,
    ports,
)

Take = Callable[[memoryview, Locator], object]
"""Gets a datagram, valid during the call only, and where it came from."""

RECEIVE_BUFFER = 8 << 20
"""Bytes that are requested; Linux gives at most net.core.rmem_max (212,992 by default), but for root."""

_SEND_BUFFER = 4 << 20
_INDICES = 120
_LARGEST = 65536
_AT_ONCE = 64
"""Datagrams that are read of one socket before the others have their turn."""

_PACE_BYTES = 48 << 10
"""Between two pauses. A receiver with the usual buffer has room for three fragments of 63 kB: unpaced, 5 of 60 images
of 1 MB came, with a pause after each fragment 59. The shortest pause takes some 0.1 ms on Linux."""
_FULL_PAUSE, _FULL_TRIES = 0.0002, 100
"""Time in seconds for which a datagram waits, and how often, for room in our own buffer, before it is lost."""

# Numbers that the socket module does not have.
_IP_MULTICAST_ALL = 49
_IP_UNICAST_IF = 50
_SO_RCVBUFFORCE = 33

_LINUX, _WINDOWS = sys.platform == "linux", sys.platform == "win32"


class _Pair(NamedTuple):
    """The two sockets at an address. All is sent from the first one."""

    address: str
    metatraffic: socket.socket
    user: socket.socket

    @classmethod
    def bound(cls, address: str, numbers: tuple[int, int]) -> _Pair:
        """Bind two ports of an address, or none."""
        pair = cls(address, *(socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in numbers))
        try:
            for each, port in zip(pair.both, numbers, strict=True):
                if sys.platform == "win32":  # else a program that binds 0.0.0.0 later takes the port from us
                    each.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
                each.bind((address, port))
                each.setblocking(False)
                _enlarge(each, socket.SO_RCVBUF, RECEIVE_BUFFER)
            if address == LOOPBACK:
                _enlarge(pair.metatraffic, socket.SO_SNDBUF, _SEND_BUFFER)
            else:
                # Its usual size (212,992): we wait for room then, as fast as the link is. With a larger one the kernel
                # took all at once, and dropped what the link's queue had no room for: on 20 Mbit/s each of 25
                # BEST_EFFORT images of 200 kB.
                _keep_on_interface(pair.metatraffic, address)
        except (OSError, OverflowError):
            pair.close()
            raise
        return pair

    @property
    def both(self) -> tuple[socket.socket, socket.socket]:
        return self.metatraffic, self.user

    def close(self) -> None:
        for each in self.both:
            each.close()


class Counts:
    """Counts of the network's doings, for whoever looks for the cause of losses."""

    def __init__(self) -> None:
        self.received = 0
        self.strangers = 0
        """Datagrams that were not let in."""
        self.sent = 0
        self.lost = 0
        """Datagrams that were not sent: no room, no route, or nobody there."""
        self.errors: dict[str, int] = {}
        """Those of them by the name of the error."""


class Sockets:
    """The sockets of one participant. Sending is safe from any thread; receiving is for one."""

    def __init__(self, domain: int, reach: Reach = LOOPBACK_ONLY) -> None:
        """Bind the first free ports of a domain.

        Args:
            domain: 0 to 232.
            reach: how far the participant reaches.

        Raises:
            ReachError: if there is no free port, no such interface, or a static peer without an address.
            ValueError: if there is no such domain.
        """
        if not 0 <= domain <= MOST_DOMAIN:
            raise ValueError(f"domain {domain}: 0 to {MOST_DOMAIN} have ports")
        self.bounds: Bounds = bounds_of(reach)
        self.counts = Counts()
        self._domain = domain
        self._pairs, self.index = self._bind()
        self._local = self._pairs[0]
        groups = self.bounds.groups()
        self._senders = {
            LOOPBACK: [self._local.metatraffic],
            GROUP: [pair.metatraffic for pair in self._pairs if pair.address in groups and _can_multicast(pair)],
        }
        self._far = [pair.metatraffic for pair in self._pairs[1:]]
        self._group = self._join()
        self._paced = 0
        self._stalled: set[socket.socket] = set()
        """Those whose last datagram found no room."""
        self._views: list[memoryview] = []
        self._waking = threading.Event()
        self._selector = selectors.DefaultSelector()  # not select(): it knows no file numbers above 1023
        for each in self._receivers():
            self._selector.register(each, selectors.EVENT_READ, each)

    # Where we are

    @property
    def metatraffic(self) -> Locator:
        """Where our discovery is reached."""
        return self.bounds.announced, ports(self._domain, self.index)[0]

    @property
    def default(self) -> Locator:
        """Where our endpoints are reached."""
        return self.bounds.announced, ports(self._domain, self.index)[1]

    @property
    def search(self) -> list[Locator]:
        """Where participants may be that are not known yet."""
        there = self.bounds.search(self._domain, self.index)
        return there if self._senders[GROUP] else [each for each in there if each[0] != GROUP]

    @property
    def hears_multicast(self) -> bool:
        """True if announcements by multicast come in: not on every machine."""
        return self._group is not None

    @property
    def receive_buffer(self) -> int:
        """Bytes that the kernel gave for what waits to be read, comparable with net.core.rmem_max."""
        given = self._local.user.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)
        return given // 2 if _LINUX else given  # Linux reserves, and reports, the double for its own needs

    def _bind(self) -> tuple[list[_Pair], int]:
        """Bind the ports of the first index that are free at each of our addresses: loopback, then the interface."""
        addresses = [LOOPBACK, *([self.bounds.address] if self.bounds.address else [])]
        error = "none"
        for index in range(_INDICES):
            made: list[_Pair] = []
            try:
                for address in addresses:
                    made.append(_Pair.bound(address, ports(self._domain, index)))
            except (OSError, OverflowError) as found:  # OverflowError: beyond 65535, in the last domains
                error = str((isinstance(found, OSError) and found.strerror) or found)
                for pair in made:
                    pair.close()
            else:
                return made, index
        raise ReachError(
            errno.EADDRINUSE,
            f"no free ports for a participant of domain {self._domain} at {' and '.join(addresses)}"
            f" ({_INDICES} were tried; the last error: {error}): end some of them, or use another domain",
        )

    def _join(self) -> socket.socket | None:
        """Join the group of announcements where that is possible; without it we meet those that we search, too."""
        addresses = self.bounds.groups()
        if not addresses:
            return None
        group = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            # Not SO_REUSEPORT: with it, Linux (6.18) gave what came in on an interface to one of all sockets with that
            # option, also to one that had joined the group on another interface only, and to no other.
            group.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            # Bound to the group, so that nothing else can come in here. Windows cannot; there, to one address.
            group.bind((addresses[-1] if _WINDOWS else GROUP, multicast_port(self._domain)))
            if _LINUX:
                # Else the socket gets what comes to the group on all interfaces on which anybody joined it.
                group.setsockopt(socket.IPPROTO_IP, _IP_MULTICAST_ALL, 0)
            joined = [address for address in addresses if _joins(group, address)]
            if not joined:
                raise OSError(errno.ENODEV, "multicast is possible nowhere")
            group.setblocking(False)
            _enlarge(group, socket.SO_RCVBUF, RECEIVE_BUFFER)
        except OSError:
            group.close()
            return None
        return group

    # Receiving

    def receive(self, timeout: float, take: Take) -> None:
        """Wait until something comes, `wake` is called or the time is over, and give away what is there.

        Args:
            timeout: in seconds; infinity: as long as it takes.
            take: gets each datagram of those who are let in.
        """
        if self._waking.is_set():
            timeout = 0.0
        ready = self._selector.select(None if timeout > threading.TIMEOUT_MAX else max(timeout, 0.0))
        self._waking.clear()
        for key, _ in ready:
            self._drain(key.data, take)

    def _drain(self, sock: socket.socket, take: Take) -> None:
        """Empty a socket, then give away what it had: its buffer has room for a few large datagrams only."""
        came: list[tuple[memoryview, Locator]] = []
        while len(came) < _AT_ONCE:
            if len(came) == len(self._views):
                self._views.append(memoryview(bytearray(_LARGEST)))
            view = self._views[len(came)]
            try:
                size, source = sock.recvfrom_into(view)
            except BlockingIOError:
                break
            except ConnectionResetError:
                # Windows: somebody to whom we sent was not there. (SIO_UDP_CONNRESET would turn that off, but Python's
                # `ioctl` does not take it.) The next datagram may well be good.
                continue
            except OSError as error:  # the interface is gone, or we are closed
                self._count(error)
                break
            if not size:
                continue  # from `wake`
            if self.bounds.admits(source[0]):
                came.append((view[:size], source))
            else:
                self.counts.strangers += 1
        self.counts.received += len(came)
        for datagram, source in came:
            take(datagram, source)

    def wake(self) -> None:
        """Make `receive` return soon, from any thread."""
        if not self._waking.is_set():
            self._waking.set()
            with contextlib.suppress(OSError):
                self._local.user.sendto(b"", self._local.metatraffic.getsockname())

    # Sending

    def send(self, address: Locator, buffers: Sequence[Buffer], pause: float = 0.0) -> None:
        """Send a datagram. Call it without holding a lock: it may sleep.

        Args:
            address: where to; the group goes to all interfaces that we use.
            buffers: the pieces of the datagram.
            pause: it is one of many in a row: sleep for so many seconds after some of them, for the receiver.
        """
        senders = self._senders.get(address[0], self._far)
        if not senders:
            self._count(OSError(errno.ENETUNREACH, "this participant stays on loopback"))
        for sock in senders:
            try:
                self._send(sock, address, buffers)
                self.counts.sent += 1
            except (OSError, OverflowError) as error:
                # ENOBUFS, ENETUNREACH, EHOSTDOWN, ECONNREFUSED of an earlier one, EMSGSIZE, EPERM of a firewall ...
                self._count(error)
        if pause:
            self._paced += sum(map(len, buffers))
            if self._paced >= _PACE_BYTES:
                self._paced = 0
                time.sleep(pause)

    def _send(self, sock: socket.socket, address: Locator, buffers: Sequence[Buffer]) -> None:
        # Who has waited in vain does not wait again until something gets through: a sample is thousands of datagrams.
        is_stalled = sock in self._stalled
        for _ in range(1 if is_stalled else _FULL_TRIES):
            try:
                if len(buffers) == 1:
                    sock.sendto(buffers[0], address)
                elif sys.platform == "win32":
                    sock.sendto(b"".join(buffers), address)
                else:
                    sock.sendmsg(buffers, [], 0, address)  # the kernel collects the pieces: no copy of ours
            except BlockingIOError:
                if not is_stalled:
                    time.sleep(_FULL_PAUSE)
            else:
                if is_stalled:
                    self._stalled.discard(sock)
                return
        self._stalled.add(sock)
        raise OSError(errno.ENOBUFS, "no room for what is to be sent")

    def _count(self, error: Exception) -> None:
        self.counts.lost += 1
        number = error.errno if isinstance(error, OSError) else None
        name = errno.errorcode.get(number, str(number)) if number is not None else type(error).__name__
        self.counts.errors[name] = self.counts.errors.get(name, 0) + 1

    def close(self) -> None:
        """Close all, once nobody is in `receive` any more."""
        self._selector.close()
        for each in self._receivers():
            each.close()

    def _receivers(self) -> list[socket.socket]:
        found = [sock for pair in self._pairs for sock in pair.both]
        return [*found, self._group] if self._group else found


def _can_multicast(pair: _Pair) -> bool:
    """Let a pair's multicast leave by its own interface only; return whether that is possible."""
    # 0: does not leave the machine, 1: does not leave the network.
    lifetime = 0 if pair.address == LOOPBACK else 1
    try:
        for option, value in (
            (socket.IP_MULTICAST_IF, socket.inet_aton(pair.address)),
            (socket.IP_MULTICAST_TTL, lifetime),
            (socket.IP_MULTICAST_LOOP, 1),
        ):
            pair.metatraffic.setsockopt(socket.IPPROTO_IP, option, value)
    except OSError:
        return False
    return True


def _joins(group: socket.socket, address: str) -> bool:
    """Join the group at an interface's address; return whether that is possible (on macOS lo0 needs a route)."""
    try:
        membership = socket.inet_aton(GROUP) + socket.inet_aton(address)
        group.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
    except OSError:
        return False
    return True


def _enlarge(sock: socket.socket, option: int, size: int) -> None:
    """Request a large buffer; what one gets is what the machine allows."""
    if _LINUX and option == socket.SO_RCVBUF:
        with contextlib.suppress(OSError):  # of root only
            sock.setsockopt(socket.SOL_SOCKET, _SO_RCVBUFFORCE, size)
    if sock.getsockopt(socket.SOL_SOCKET, option) < size:
        with contextlib.suppress(OSError):
            sock.setsockopt(socket.SOL_SOCKET, option, size)


def _keep_on_interface(sock: socket.socket, address: str) -> None:
    """Let nothing out of a socket by another interface, whatever the routes say (Linux; needs no rights)."""
    if not _LINUX:
        return
    index = socket.if_nametoindex(interface_of(address)[0])
    with contextlib.suppress(OSError):
        sock.setsockopt(socket.IPPROTO_IP, _IP_UNICAST_IF, index.to_bytes(4, "big"))
