"""Programs on a faulty network in memory, for tests: what they send, and what arrives when."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Callable
from typing import Any

from robolink.faults import FaultyNetwork, FaultyTransport, MessageFault, Partition
from robolink.qos import QoSProfile
from robolink.transport.base import Sample
from robolink.transport.memory import Bus
from robolink.wire import (
    DataKey,
    EndpointKind,
    EndpointToken,
    NodeToken,
    attachments,
    format_key,
    format_token,
    gid_of,
)

QOS = QoSProfile(depth=10)

HASH = "RIHS01_" + "0" * 64

MS = 1_000_000


class Timeline:
    """Time that a test lets pass."""

    def __init__(self) -> None:
        self.now, self._serial = 1_000 * MS, itertools.count()
        self._acts: list[tuple[int, int, Callable[[], object]]] = []

    def steady(self) -> int:
        return self.now

    @property
    def _now(self) -> int:
        return self.now

    def at(self, time_ns: int, act: Callable[[], object]) -> None:
        heapq.heappush(self._acts, (time_ns, next(self._serial), act))

    def go_on(self, seconds: float) -> None:
        end = self.now + round(seconds * 1e9)
        while self._acts and self._acts[0][0] <= end:
            self.now, _, act = heapq.heappop(self._acts)
            act()
        self.now = end


class Program:
    """A program with one node, which talks without robolink's own classes."""

    def __init__(self, system: System, name: str) -> None:
        self.system, self.name = system, name
        self.session = FaultyTransport(system.network, name)
        self.session.announce(format_token(NodeToken(0, self.session.session_id, "0", "/", "/", name)))
        self._ids = itertools.count(1)

    def publisher(self, topic: str, qos: QoSProfile = QOS) -> Callable[[int], None]:
        outlet, attach = self.session.advertise(key(topic), qos), self._attachments(topic, EndpointKind.PUBLISHER)
        return lambda number: outlet.put(b"%d" % number, attach())

    def client(self, service: str) -> Callable[[bytes], list[Any]]:
        attach = self._attachments(service, EndpointKind.CLIENT)

        def ask(payload: bytes) -> list[Any]:
            answers: list[Any] = []
            answered = self.session.call(key(service), payload, attach(), answers.append)
            self.system.held.append(answered)
            return answers

        return ask

    def hear(self, topic: str, qos: QoSProfile = QOS) -> list[tuple[float, int]]:
        heard: list[tuple[float, int]] = []

        def note(sample: Sample) -> None:
            heard.append((round((self.system.time.now - 1_000 * MS) / 1e9, 6), int(self.session.read(sample).payload)))

        self.session.subscribe(key(topic), qos, note)
        return heard

    def serve(self, service: str, *, at_once: bool = True) -> list[Any]:
        asked: list[Any] = []

        def answer(query: Any) -> None:
            asked.append(query.payload)
            query.reply(query.payload.upper(), query.attachment)
            query.close()

        self.session.serve(key(service), answer if at_once else asked.append)
        return asked

    def _attachments(self, name: str, kind: EndpointKind) -> Callable[[], bytes]:
        session, number = self.session.session_id, next(self._ids)
        token = format_token(
            EndpointToken(
                0, session, "0", str(number), kind, "/", "/", self.name, name, "std_msgs/msg/Int32", HASH, QOS
            )
        )
        self.session.announce(token)
        return attachments(gid_of(token), self.system.time.steady)


class System:
    """Programs on a network with faults."""

    def __init__(self, seed: int = 1) -> None:
        self.time = Timeline()
        self.network = FaultyNetwork(Bus(), self.time, seed=seed)
        self.held: list[Any] = []

    def program(self, name: str) -> Program:
        return Program(self, name)


def key(name: str) -> str:
    return format_key(DataKey(0, name, "std_msgs/msg/Int32", HASH))


def arrived(count: int, *faults: MessageFault | Partition, seed: int = 1, period: float = 0.02) -> list[Any]:
    """Publish numbers on /scan from `world` to `follower`; give when each arrived."""
    system = System(seed)
    for each in faults:
        system.network.add(each)
    heard, publish = system.program("follower").hear("/scan"), system.program("world").publisher("/scan")
    for number in range(count):
        publish(number)
        system.time.go_on(period)
    system.time.go_on(10.0)
    return heard


def numbers(heard: list[tuple[float, int]]) -> list[int]:
    return [number for _, number in heard]


def ask(fault: MessageFault | Partition) -> tuple[list[Any], list[Any], System]:
    system = System()
    system.network.add(fault)
    asked = system.program("server").serve("/reset")
    return asked, system.program("caller").client("/reset")(b"now"), system
