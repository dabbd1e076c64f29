"""Participants of DDS in virtual time, and a network that drops, doubles, delays and reorders datagrams by a seed."""

from __future__ import annotations

import heapq
import itertools
import math
import random
from collections.abc import Callable, Sequence
from typing import TypeVar

from robolink.rtps import Endpoint, Info, Peer, Qos, ids
from robolink.rtps.announcements import ParticipantData
from robolink.rtps.core import Core, LocalReader, LocalWriter
from robolink.rtps.discovery import Resolve
from robolink.rtps.parameters import Buffer, Locator
from robolink.rtps.submessages import parse

S = TypeVar("S")

HOST = "127.0.0.1"
TYPE = "std_msgs::msg::dds_::String_"
USUAL = Qos()
VENDORS = {"ours": ids.VENDOR_ROBOLINK, "fastdds": ids.VENDOR_EPROSIMA, "cyclone": ids.VENDOR_ECLIPSE}


class Faults:
    """What happens to datagrams on their way."""

    def __init__(
        self,
        *,
        every: int = 0,
        loss: float = 0.0,
        twice: float = 0.0,
        delay: float = 0.0001,
        jitter: float = 0.0,
        is_lost: Callable[[bytes, Locator], bool] | None = None,
    ) -> None:
        """Take what is to happen.

        Args:
            every: each n-th datagram is lost.
            loss: the share of them that is lost.
            twice: the share that arrives twice.
            delay: seconds on the way.
            jitter: seconds more at most: those that left later may arrive first.
            is_lost: decides of each datagram and address.
        """
        self.every, self.loss, self.twice, self.delay, self.jitter = every, loss, twice, delay, jitter
        self.is_lost = is_lost


class Member:
    """A participant on the network."""

    def __init__(self, network: Network, index: int, vendor: bytes, lease: float, prefix: bytes) -> None:
        self.network = network
        self.metatraffic, self.default = (network.host, 7410 + 2 * index), (network.host, 7411 + 2 * index)
        self.peers: list[tuple[bytes, bool]] = []
        self.found: list[tuple[Endpoint, bool]] = []
        self.is_up = True
        self.rewrite: Callable[[bytes], bytes] = bytes
        """What becomes of each datagram that it sends."""
        self.ticks = 0
        me = ParticipantData(prefix, vendor, (self.metatraffic,), (self.default,), lease, "/", b"enclave=/;", 0)
        self.core = Core(
            me,
            Resolve(network.search(self.metatraffic), network.choose),
            self._send,
            on_peer=self._on_peer,
            on_endpoint=lambda endpoint, came: self.found.append((endpoint, came)),
        )

    def _on_peer(self, peer: Peer, came: bool) -> None:
        self.peers.append((peer.prefix, came))

    def _send(self, address: Locator, buffers: Sequence[Buffer], pause: float) -> None:
        if self.is_up:
            self.network.carry(self.rewrite(b"".join(buffers)), address, self.default)

    def writer(
        self,
        topic: str = "rt/a",
        qos: Qos = USUAL,
        type_name: str = TYPE,
        accepts: Callable[[Endpoint], bool] | None = None,
    ) -> LocalWriter:
        """Make a writer."""
        return self.core.add_writer(self.network.now, topic, type_name, qos, accepts=accepts)

    def reader(
        self,
        topic: str = "rt/a",
        qos: Qos = USUAL,
        type_name: str = TYPE,
        accepts: Callable[[Endpoint], bool] | None = None,
    ) -> tuple[LocalReader, list[bytes]]:
        """Make a reader; return what it gets, too."""
        got: list[bytes] = []

        def sink(payload: bytes, info: Info) -> None:
            got.append(payload)

        return self.core.add_reader(self.network.now, topic, type_name, qos, sink, accepts=accepts), got

    def put(self, writer: LocalWriter, payload: bytes, related: tuple[bytes, int] | None = None) -> int:
        """Send a sample."""
        return self.core.put(self.network.now, writer, payload, related, 1_700_000_000_123_456_789)

    def leave(self) -> None:
        """Say goodbye."""
        self.core.goodbye()
        self.kill()

    def kill(self) -> None:
        """Be gone without a word."""
        self.is_up = False
        self.network.members = [member for member in self.network.members if member is not self]

    def call(self) -> None:
        """Do what a program is to be told."""
        calls, self.core.calls[:] = [*self.core.calls], []
        for function, what, how in calls:
            function(what, how)


class Network:
    """Members, and the datagrams between them."""

    def __init__(self, seed: int = 1, host: str = HOST) -> None:
        self.now = 100.0
        self.host = host
        """Address of all members; one that is not of loopback is another machine's to each of them."""
        self.members: list[Member] = []
        self.faults = Faults()
        self.sent: list[tuple[float, bytes, Locator]] = []
        """All that was sent since it was last cleared, whether it arrived or not."""
        self._random = random.Random(seed)
        self._under_way: list[tuple[float, int, bytes, Locator, Locator]] = []
        self._count = itertools.count(1)
        self._indices = itertools.count()

    def search(self, own: Locator) -> list[Locator]:
        """Return where participants may be."""
        return [(self.host, port) for port in range(7410, 7474, 2) if port != own[1]]

    def choose(self, addresses: Sequence[Locator], source: Locator) -> Locator | None:
        """Return where a participant is met."""
        return (self.host, addresses[0][1]) if addresses else None

    def join(
        self, vendor: str = "ours", lease: float = 20.0, index: int | None = None, prefix: bytes | None = None
    ) -> Member:
        """Let a participant join."""
        place = next(self._indices) if index is None else index
        name = VENDORS[vendor] + self._random.randbytes(10) if prefix is None else prefix
        member = Member(self, place, VENDORS[vendor], lease, name)
        self.members.append(member)
        return member

    def carry(self, raw: bytes, address: Locator, source: Locator) -> None:
        """Take a datagram on its way."""
        self.sent.append((self.now, raw, address))
        faults, dice, count = self.faults, self._random, next(self._count)
        if faults.is_lost is not None and faults.is_lost(raw, address):
            return
        if (faults.every and count % faults.every == 0) or dice.random() < faults.loss:
            return
        for _ in range(2 if dice.random() < faults.twice else 1):
            at = self.now + faults.delay + dice.uniform(0.0, faults.jitter)
            heapq.heappush(self._under_way, (at, next(self._count) << 20 | count, raw, address, source))

    def run(self, seconds: float, until: Callable[[], bool] | None = None) -> bool:
        """Let time go by; return early, and True, once a condition holds."""
        end = self.now + seconds
        while until is None or not until():
            arrival = self._under_way[0][0] if self._under_way else math.inf
            due = min((member.core.due for member in self.members), default=math.inf)
            at = max(min(arrival, due), self.now)
            if at > end:
                self.now = end
                return until is not None and until()
            self.now = at
            if arrival <= due:
                _, _, raw, address, source = heapq.heappop(self._under_way)
                self._arrive(raw, address, source)
            else:
                for member in self.members:
                    if member.core.due <= at:
                        member.ticks += 1
                        member.core.tick(at)
            for member in self.members:
                member.call()
        return True

    def _arrive(self, raw: bytes, address: Locator, source: Locator) -> None:
        for member in self.members:
            if address in {member.metatraffic, member.default}:
                member.core.receive(self.now, raw, source)

    def submessages(self, kind: type[S]) -> list[S]:
        """Return the submessages of a kind that were sent, but for announcements of participants."""
        return [
            each
            for _, raw, _ in self.sent
            for each in parse(raw).submessages
            if isinstance(each, kind) and _writer(each) != ids.SPDP_WRITER
        ]

    @property
    def is_quiet(self) -> bool:
        """Whether nothing was sent but announcements of participants."""
        parts = [each for _, raw, _ in self.sent for each in parse(raw).submessages]
        return all(_writer(each) in {b"", ids.SPDP_WRITER} for each in parts)


def _writer(each: object) -> bytes:
    found: bytes = getattr(each, "writer", b"")  # what only informs has none
    return found


def sample(number: int, size: int = 12) -> bytes:
    """Return a serialized sample of a size (a multiple of 4) that tells which one it is."""
    return (b"\0\1\0\0" + number.to_bytes(4, "little") + bytes(size))[:size]


def numbers(got: Sequence[bytes]) -> list[int]:
    """Return which samples arrived."""
    return [int.from_bytes(each[4:8], "little") for each in got]
