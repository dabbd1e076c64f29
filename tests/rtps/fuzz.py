"""Fuzz of a participant without sockets: mutated datagrams of a true conversation, in virtual time.

    python -m tests.rtps.fuzz [--count 1000000] [--seed 1]

Two participants talk with all kinds of submessages, in both byte orders; what one of them sends is mutated and given to
a third that knows it. It must live, and answer its peer as before; its memory must be flat, and no datagram may cost it
more time than one of its size may.
"""

from __future__ import annotations

import argparse
import gc
import itertools
import random
import struct
import sys
import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

from robolink.rtps import Qos, ids
from robolink.rtps import submessages as subs
from robolink.rtps.core import Core
from robolink.rtps.submessages import HEADER_BYTES, Inline
from robolink.rtps.writer import FRAGMENT
from tests.support.rtps_network import Faults, Member, Network, numbers, sample

LATCHED, ALL, BEST_EFFORT = Qos(transient_local=True, depth=3), Qos(depth=0), Qos(reliable=False)
QOS = {"rt/all": ALL, "rt/latched": LATCHED, "rt/rough": BEST_EFFORT}
PEER = ids.VENDOR_ROBOLINK + b"the peer.."
PLACE = 7410
"""The peer's port for discovery."""
STEP = 0.001
"""Seconds of virtual time between datagrams."""
LIFE = 20_000
"""Datagrams that a victim gets before a new one takes its place: some of them leave it with nobody to talk to."""
GREETING = 500
"""Datagrams after which the peer greets again as it should: some of them have made the victim forget it."""

LOOK = 5_000
"""Datagrams between two looks at the memory."""

_EDGES = (0, 1, 2, 3, 0x7F, 0x80, 0xFE, 0xFF)
_WORDS = (0, 1, 0xFF, 0x100, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFE, 0xFFFFFFFF)
_KINDS = (0x01, 0x06, 0x07, 0x08, 0x09, 0x0C, 0x0D, 0x0E, 0x0F, 0x12, 0x13, 0x15, 0x16, 0x30, 0x80)


class Corpus(NamedTuple):
    """What a peer said in a true conversation."""

    greeting: list[bytes]
    """Until both knew all of each other."""
    all: list[bytes]


def record() -> Corpus:
    """Let a peer talk with another participant, over a network that loses datagrams, and return what it said."""
    network = Network()
    peer = network.join(index=0, prefix=PEER)
    assert peer.metatraffic[1] == PLACE
    other, _ = _victim_of(network)
    said: list[bytes] = []
    others = [peer.writer(topic, qos) for topic, qos in QOS.items()]
    for topic, qos in QOS.items():
        peer.reader(topic, qos)

    def collect() -> None:
        said.extend(raw for _, raw, _ in network.sent if raw[8:20] == PEER)
        network.sent.clear()

    network.run(2)
    collect()
    greeting = list(dict.fromkeys(said))
    network.faults = Faults(every=3)
    mine = [local for local in other.core._writers.values() if local.entity[3] == ids.KEYLESS_WRITER]
    for number in range(30):
        for writer in (*others, *mine):
            member = peer if writer in others else other
            size = 2 * FRAGMENT + 100 if number % 10 == 5 else 8 + 4 * number
            member.core.put(network.now, writer, sample(number, size), (PEER + b"\0\0\1\4", number))
        network.run(0.05)
    network.run(2)
    network.faults = Faults()
    peer.core.remove(network.now, others[0])
    network.run(1)
    peer.leave()
    collect()
    said = list(dict.fromkeys(said))  # an announcement goes to 32 ports
    return Corpus(greeting, [*said, *_rare(), *(swapped(raw) for raw in said if _can_swap(raw))])


def _victim_of(network: Network) -> tuple[Member, list[list[bytes]]]:
    """Let a participant join; return what its readers get, too."""
    victim = network.join(index=1, prefix=ids.VENDOR_ROBOLINK + b"the victim")
    got = []
    for topic, qos in QOS.items():
        writer = victim.writer(topic, qos)
        victim.put(writer, sample(1))
        victim.put(writer, sample(2, 3 * FRAGMENT))
        got.append(victim.reader(topic, qos)[1])
    return victim, got


def _rare() -> list[bytes]:
    """Return datagrams with what our own participants do not send."""
    header, reader, writer = subs.encode_header(PEER), b"\0\0\2\4", b"\0\0\1\3"
    beat = subs.encode_heartbeat_frag(reader, writer, 40, 3, 1)
    source = struct.pack("<BBHIBB2s12s", 0x0C, 1, 20, 0, 2, 3, ids.VENDOR_EPROSIMA, b"another one.")
    several = struct.pack("<BBHHH4s4siIIHHI", 0x16, 1, 44, 0, 28, reader, writer, 0, 40, 1, 3, 4, 100) + bytes(12)
    gap = subs.encode_gap(reader, writer, 35, 60, [61, 99, 300])
    key = subs.encode_data(
        reader, writer, 41, b"\0\3\0\0\1\0\0\0", subs.encode_inline(Inline(3, bytes(16))), is_key=True
    )
    return [header + each for each in (beat, source + beat, several, gap, key, beat + several + gap + key + source)]


def _can_swap(raw: bytes) -> bool:
    return {kind for kind, *_ in _split(raw)} <= {0x06, 0x07, 0x09, 0x0E, 0x15}


def _split(raw: bytes) -> list[tuple[int, int, bytes]]:
    """Return the submessages of a good datagram: kind, flags and body."""
    found, at = [], HEADER_BYTES
    while at + 4 <= len(raw):
        kind, flags, size = struct.unpack_from("<BBH", raw, at)
        end = at + 4 + size if size or kind in {0x01, 0x09} else len(raw)
        found.append((kind, flags, raw[at + 4 : end]))
        at = end
    return found


def swapped(raw: bytes) -> bytes:
    """Return a good datagram of heartbeats, acknowledgements and samples as a big-endian machine would send it."""
    out = raw[:HEADER_BYTES]
    for kind, flags, body in _split(raw):
        if kind == 0x15:
            skip = struct.unpack("<HH4s4s2I", body[:20])
            new = struct.pack(">HH4s4s2I", *skip) + body[20:]
            if flags & 2:  # the inline QoS, parameter by parameter
                new, at = new[:20], 20
                while True:
                    pid, size = struct.unpack_from("<HH", body, at)
                    value = body[at + 4 : at + 4 + size]
                    if pid in {ids.PID_RELATED_SAMPLE, ids.PID_RELATED_SAMPLE_FASTDDS}:
                        value = value[:16] + struct.pack(">2I", *struct.unpack("<2I", value[16:]))
                    new += struct.pack(">HH", pid, size) + value
                    at += 4 + size
                    if pid == ids.PID_SENTINEL:
                        break
                new += body[at:]
        elif kind == 0x0E:
            new = body
        else:
            head = 0 if kind == 0x09 else 8
            words = struct.unpack(f"<{(len(body) - head) // 4}I", body[head:])
            new = body[:head] + struct.pack(f">{len(words)}I", *words)
        out += struct.pack(">BBH", kind, flags & ~1, len(new)) + new
    return out


class Mutator:
    """Makes nonsense of good datagrams, by a seed."""

    def __init__(self, corpus: Sequence[bytes], seed: int) -> None:
        self._corpus, self._dice = corpus, random.Random(seed)
        self._ways: list[Callable[[bytearray], None]] = [
            *[self._flip] * 4,
            *[self._edge] * 4,
            self._word,
            self._kind,
            self._order,
            self._cut,
            self._insert,
            self._splice,
            self._stranger,
        ]

    def next(self) -> bytes:
        """Return the next datagram; one in twenty is as it was."""
        raw = bytearray(self._dice.choice(self._corpus))
        if self._dice.random() > 0.05:
            for _ in range(self._dice.randint(1, 4)):
                self._dice.choice(self._ways)(raw)
        return bytes(raw)

    def _place(self, raw: bytearray) -> int:
        # Most of what decides is at the beginning.
        most = len(raw) if self._dice.random() < 0.3 else min(len(raw), 150)
        return self._dice.randrange(HEADER_BYTES if len(raw) > HEADER_BYTES else 0, most) if raw else 0

    def _flip(self, raw: bytearray) -> None:
        if raw:
            raw[self._place(raw) % len(raw)] ^= 1 << self._dice.randrange(8)

    def _edge(self, raw: bytearray) -> None:
        if raw:
            raw[self._place(raw) % len(raw)] = self._dice.choice(_EDGES)

    def _word(self, raw: bytearray) -> None:
        at = self._place(raw) & ~3
        raw[at : at + 4] = struct.pack("<I", self._dice.choice(_WORDS))

    def _kind(self, raw: bytearray) -> None:
        if len(raw) > HEADER_BYTES:
            raw[HEADER_BYTES] = self._dice.choice(_KINDS)

    def _order(self, raw: bytearray) -> None:
        if len(raw) > HEADER_BYTES + 1:
            raw[HEADER_BYTES + 1] ^= 1

    def _cut(self, raw: bytearray) -> None:
        del raw[self._place(raw) :]

    def _insert(self, raw: bytearray) -> None:
        at = self._place(raw)
        raw[at:at] = self._dice.randbytes(self._dice.choice((1, 4, 8, 200)))

    def _splice(self, raw: bytearray) -> None:
        raw += self._dice.choice(self._corpus)[HEADER_BYTES:]

    def _stranger(self, raw: bytearray) -> None:
        """Let somebody else say it, who is elsewhere."""
        prefix = ids.VENDOR_ROBOLINK + self._dice.randbytes(10)
        place = self._dice.randrange(1024, 65536).to_bytes(4, "little")
        raw[:] = raw.replace(PEER, prefix).replace(PLACE.to_bytes(4, "little"), place)


class Victim:
    """The participant that gets it all."""

    def __init__(self, corpus: Corpus) -> None:
        self._network = Network()
        self.member, self._got = _victim_of(self._network)
        self.core: Core = self.member.core
        self._corpus = corpus
        self.longest = 0.0
        """Seconds that a datagram took."""
        self.answered = 0
        """Bytes that were sent."""
        self.most_answered = 0
        """For one datagram."""

    def greet(self) -> None:
        """Let the peer greet as it should."""
        for raw in self._corpus.greeting:
            self.take(raw)

    def take(self, raw: bytes) -> None:
        """Give it a datagram, and the time that comes with it."""
        network = self._network
        network.now += STEP
        begun = time.thread_time()
        self.core.receive(network.now, memoryview(raw), self.member.metatraffic)
        if self.core.due <= network.now:
            self.core.tick(network.now)
        self.member.call()
        self.longest = max(self.longest, time.thread_time() - begun)
        answer = sum(len(each) for _, each, _ in network.sent)
        self.answered += answer
        self.most_answered = max(self.most_answered, answer)
        network.sent.clear()
        network._under_way.clear()
        for got in self._got:
            got.clear()
        self.member.found.clear()
        self.member.peers.clear()

    def is_well(self) -> bool:
        """Return whether it still meets a participant, and gets what that writes."""
        network, member = self._network, self.member
        friend = network.join(index=40, prefix=ids.VENDOR_ROBOLINK + b"the friend")
        writer = friend.writer("rt/well", ALL)
        _, got = member.reader("rt/well", ALL)
        friend.put(writer, sample(0))
        network.run(5, until=lambda: bool(writer.readers))
        for number in (1, 2, 3):
            friend.put(writer, sample(number, 100_000 * number))
        return network.run(5, until=lambda: numbers(got)[-3:] == [1, 2, 3])


class Outcome(NamedTuple):
    """What a fuzz found."""

    datagrams: int
    seconds: float
    nonsense: int
    size: int
    """Bytes of all datagrams."""
    answered: int
    """Bytes that were sent because of them."""
    most_answered: int
    longest: float
    """Seconds that one datagram took."""
    memory: list[int]
    """Of the process, in kB, again and again."""
    all_well: bool


def run(count: int, seed: int = 1, life: int = LIFE) -> Outcome:
    """Give so many mutated datagrams to victims."""
    corpus = record()
    mutator = Mutator(corpus.all, seed)
    begun = time.perf_counter()
    nonsense = size = answered = most_answered = 0
    longest, all_well = 0.0, True
    memory: list[int] = []
    for begin in range(0, count, life):
        victim = Victim(corpus)
        for number in range(min(life, count - begin)):
            if number % GREETING == 0:
                victim.greet()
            raw = mutator.next()
            size += len(raw)
            victim.take(raw)
            if number % LOOK == LOOK - 1:
                memory.append(_memory())
        nonsense += victim.core.nonsense
        answered += victim.answered
        longest, most_answered = max(longest, victim.longest), max(most_answered, victim.most_answered)
        all_well = all_well and victim.is_well()
        del victim
        gc.collect()
    return Outcome(
        count, time.perf_counter() - begun, nonsense, size, answered, most_answered, longest, memory, all_well
    )


def _memory() -> int:
    import psutil

    return int(psutil.Process().memory_info().rss) // 1024


def main() -> None:
    """Fuzz, and say what was found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--life", type=int, default=LIFE, help="datagrams that one participant gets")
    requested = parser.parse_args()
    found = run(requested.count, requested.seed, requested.life)
    tenths = list(itertools.islice(found.memory, 0, None, max(1, len(found.memory) // 10)))
    print(  # noqa: T201
        f"{found.datagrams} datagrams, {found.datagrams / found.seconds:.0f} a second, {found.nonsense} were nonsense;"
        f" {found.size} bytes came, {found.answered} were sent because of them, {found.most_answered} at most for one;"
        f" the longest took {1000 * found.longest:.1f} ms; memory in kB: {tenths}; all well: {found.all_well}"
    )
    sys.exit(not found.all_well)


if __name__ == "__main__":
    main()
