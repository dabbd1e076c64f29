"""DDS in memory: participants with the interface of `robolink.rtps.Participant`, whose network is a queue.

Nothing is told, matched or delivered on the caller's thread: what waits in the queue is done by `deliver`, in order, or
by a thread of the network.
"""

from __future__ import annotations

import functools
import itertools
import queue
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from robolink.dds.profiles import shortcomings
from robolink.rtps import Endpoint, Info, Peer, Qos

OURS, EPROSIMA, ECLIPSE = b"\x01\xee", b"\x01\x0f", b"\x01\x10"
PATIENCE = 30.0
USUAL = Qos()


def nothing(*_: Any) -> None:
    pass


class FakeNetwork:
    """A DDS network."""

    def __init__(self, *, threaded: bool = True) -> None:
        self.lock = threading.RLock()
        self.participants: dict[bytes, FakeParticipant] = {}
        self.numbers = itertools.count(1)
        self._calls: queue.SimpleQueue[Callable[[], object] | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        if threaded:
            self._thread = threading.Thread(target=self._run, name="fake rtps", daemon=True)
            self._thread.start()

    def open(self, domain: int = 0, **options: Any) -> FakeParticipant:
        """What `DdsTransport` takes to open a participant."""
        return FakeParticipant(self, domain, **options)

    def post(self, call: Callable[[], object]) -> None:
        self._calls.put(call)

    def deliver(self) -> None:
        """Do all that waits, and what comes of it."""
        while not self._calls.empty():
            call = self._calls.get()
            assert call is not None
            call()

    @property
    def is_quiet(self) -> bool:
        return self._calls.empty()

    def _run(self) -> None:
        while (call := self._calls.get()) is not None:
            call()

    def close(self) -> None:
        if self._thread is not None:
            self._calls.put(None)
            self._thread.join(PATIENCE)


class FakeParticipant:
    """A participant."""

    def __init__(
        self,
        network: FakeNetwork,
        domain: int,
        *,
        name: str = "/",
        user_data: bytes = b"",
        vendor: bytes = OURS,
        on_peer: Callable[[Peer, bool], object] = nothing,
        on_endpoint: Callable[[Endpoint, bool], object] = nothing,
    ) -> None:
        self.network, self.domain = network, domain
        self.prefix = vendor + next(network.numbers).to_bytes(10, "big")
        self.guid = self.prefix + b"\0\0\1\xc1"
        self.peer = Peer(self.prefix, vendor, name, user_data, 20.0, ("127.0.0.1", 7410))
        self.on_peer, self.on_endpoint = on_peer, on_endpoint
        self.mine: dict[bytes, FakeWriter | FakeReader] = {}
        self.known: dict[bytes, Endpoint] = {}
        self.is_open = True
        self._entities = itertools.count(1)
        with network.lock:
            for other in self.others():
                network.post(functools.partial(self._meet, other))
                network.post(functools.partial(other._meet, self))
            network.participants[self.prefix] = self

    def others(self) -> list[FakeParticipant]:
        found = self.network.participants.values()
        return [each for each in found if each is not self and each.domain == self.domain]

    def _meet(self, other: FakeParticipant) -> None:
        if self.is_open and other.is_open:
            self.on_peer(other.peer, True)
            for endpoint in [each.endpoint for each in [*other.mine.values()]]:
                self._learn(endpoint)

    def _learn(self, endpoint: Endpoint) -> None:
        owner = self.network.participants.get(endpoint.guid[:12])
        if endpoint.guid in self.known or not self.is_open or owner is None or endpoint.guid not in owner.mine:
            return
        self.known[endpoint.guid] = endpoint
        self.on_endpoint(endpoint, True)
        for mine in [*self.mine.values()]:
            mine.meet(endpoint)

    def _forget(self, endpoint: Endpoint) -> None:
        if self.is_open and self.known.pop(endpoint.guid, None) is not None:
            for mine in [*self.mine.values()]:
                mine.lose(endpoint)
            self.on_endpoint(endpoint, False)

    def _forget_peer(self, peer: Peer) -> None:
        for endpoint in [each for each in self.known.values() if each.guid[:12] == peer.prefix]:
            self._forget(endpoint)
        if self.is_open:
            self.on_peer(peer, False)

    def writer(
        self,
        topic: str,
        type_name: str,
        qos: Qos = USUAL,
        *,
        user_data: bytes = b"",
        accepts: Callable[[Endpoint], bool] | None = None,
        on_match: Any = None,
    ) -> FakeWriter:
        endpoint = self._endpoint(True, topic, type_name, qos, user_data)
        writer = FakeWriter(self, endpoint, on_match or nothing, accepts or (lambda _: True))
        self._add(writer)
        return writer

    def reader(
        self,
        topic: str,
        type_name: str,
        qos: Qos,
        sink: Callable[[bytes, Info], object],
        *,
        user_data: bytes = b"",
        accepts: Callable[[Endpoint], bool] | None = None,
        on_match: Any = None,
    ) -> FakeReader:
        endpoint = self._endpoint(False, topic, type_name, qos, user_data)
        reader = FakeReader(self, endpoint, on_match or nothing, sink, accepts or (lambda _: True))
        self._add(reader)
        return reader

    def _endpoint(self, is_writer: bool, topic: str, type_name: str, qos: Qos, user_data: bytes) -> Endpoint:
        guid = self.prefix + next(self._entities).to_bytes(3, "big") + (b"\3" if is_writer else b"\4")
        return Endpoint(guid, is_writer, topic, type_name, qos, user_data, self.peer.vendor)

    def _add(self, mine: FakeWriter | FakeReader) -> None:
        with self.network.lock:
            self.mine[mine.guid] = mine
            for endpoint in [*self.known.values()]:
                mine.meet(endpoint)
            for other in self.others():
                self.network.post(functools.partial(other._learn, mine.endpoint))

    def remove(self, mine: FakeWriter | FakeReader) -> None:
        with self.network.lock:
            if self.mine.pop(mine.guid, None) is not None:
                for other in self.others():
                    self.network.post(functools.partial(other._forget, mine.endpoint))

    def peers(self) -> list[Peer]:
        with self.network.lock:
            return [each.peer for each in self.others()]

    def endpoints(self) -> list[Endpoint]:
        return [*self.known.values()]

    def settled(self) -> bool:
        return self.network.is_quiet

    def close(self) -> None:
        with self.network.lock:
            if self.is_open:
                self.is_open = False
                others = self.others()
                self.network.participants.pop(self.prefix, None)
                for other in others:
                    self.network.post(functools.partial(other._forget_peer, self.peer))


class FakeWriter:
    def __init__(
        self,
        participant: FakeParticipant,
        endpoint: Endpoint,
        on_match: Callable[[Endpoint, bool], object],
        accepts: Callable[[Endpoint], bool],
    ) -> None:
        self.participant, self.endpoint, self.on_match, self.accepts = participant, endpoint, on_match, accepts
        self.guid = endpoint.guid
        self.readers: dict[bytes, Endpoint] = {}
        self.history: deque[tuple[bytes, Info]] = deque(maxlen=max(endpoint.qos.depth, 0) or None)
        self.number = 0

    def meet(self, other: Endpoint) -> None:
        mine = self.endpoint
        if other.is_writer or (other.topic, other.type_name) != (mine.topic, mine.type_name):
            return
        if other.guid not in self.readers and not shortcomings(other.qos, mine.qos) and self.accepts(other):
            self.readers[other.guid] = other
            if other.qos.transient_local and other.qos.reliable:  # as Fast DDS 3.2 does
                for payload, info in [*self.history]:
                    self.participant.network.post(functools.partial(self._deliver, other.guid, payload, info))
            self.participant.network.post(lambda: self.on_match(other, True))

    def lose(self, other: Endpoint) -> None:
        if self.readers.pop(other.guid, None) is not None:
            self.on_match(other, False)

    def put(self, payload: bytes, *, related: tuple[bytes, int] | None = None, timestamp: int = 0) -> int:
        network = self.participant.network
        with network.lock:
            if not self.participant.is_open:
                return 0
            self.number += 1
            info = Info(self.guid, self.number, timestamp or time.time_ns(), related)
            if self.endpoint.qos.transient_local:
                self.history.append((payload, info))
            for guid in [*self.readers]:
                network.post(functools.partial(self._deliver, guid, payload, info))
            return self.number

    def _deliver(self, guid: bytes, payload: bytes, info: Info) -> None:
        there = self.participant.network.participants.get(guid[:12])
        reader = there.mine.get(guid) if there is not None else None
        if there is not None and isinstance(reader, FakeReader):
            if self.guid in reader.writers:
                reader.sink(payload, info)
            elif self.guid not in there.known:  # it learns of the writer later; RELIABLE sends again until then
                self.participant.network.post(lambda: self._deliver(guid, payload, info))

    def matched(self) -> list[bytes]:
        return [*self.readers]

    def close(self) -> None:
        self.readers.clear()
        self.participant.remove(self)


class FakeReader:
    def __init__(
        self,
        participant: FakeParticipant,
        endpoint: Endpoint,
        on_match: Callable[[Endpoint, bool], object],
        sink: Callable[[bytes, Info], object],
        accepts: Callable[[Endpoint], bool],
    ) -> None:
        self.participant, self.endpoint, self.on_match, self.sink, self.accepts = (
            participant,
            endpoint,
            on_match,
            sink,
            accepts,
        )
        self.guid = endpoint.guid
        self.writers: dict[bytes, Endpoint] = {}

    def meet(self, other: Endpoint) -> None:
        mine = self.endpoint
        if not other.is_writer or (other.topic, other.type_name) != (mine.topic, mine.type_name):
            return
        if other.guid not in self.writers and not shortcomings(mine.qos, other.qos) and self.accepts(other):
            self.writers[other.guid] = other
            self.participant.network.post(lambda: self.on_match(other, True))

    def lose(self, other: Endpoint) -> None:
        if self.writers.pop(other.guid, None) is not None:
            self.on_match(other, False)

    def expect(self) -> None:
        """Nothing is lost here that one could ask for."""

    def matched(self) -> list[bytes]:
        return [*self.writers]

    def close(self) -> None:
        self.participant.remove(self)
