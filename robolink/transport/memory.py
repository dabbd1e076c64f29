"""In-memory transport: a deterministic network inside one process, without threads, for tests and simulation.

Samples are delivered inside `put`, requests inside `call`, and replies inside `reply`.
"""

from __future__ import annotations

import itertools
import threading
import weakref
from collections import Counter, deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from operator import itemgetter
from typing import Any

from robolink.exceptions import TransportClosedError
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.system import heap
from robolink.system.waits import fork_lock
from robolink.transport.base import Handle, NumberingOutlet, Query, Sample, Sink, Transport, make_sample, refuse_giant
from robolink.transport.history import Latch, latched_depth
from robolink.transport.patterns import matcher
from robolink.wire import pair_opener


class Bus:
    """Shared state of the sessions of one in-memory network; two buses are separate networks."""

    def __init__(self) -> None:
        # Held while sinks are called, so that all subscriptions see one order and a closed one sees nothing.
        self.lock = fork_lock()
        self.subscriptions: dict[str, tuple[_Subscription, ...]] = {}
        self.outlets: dict[str, tuple[_Outlet, ...]] = {}
        self.servers: dict[str, tuple[_Server, ...]] = {}
        self.watches: tuple[_Watch, ...] = ()
        self.tokens: Counter[str] = Counter()
        self._session_ids = itertools.count(1)
        self._order = itertools.count()

    @classmethod
    def named(cls, name: str) -> Bus:
        """Return the bus of that name, which lives as long as somebody uses it."""
        with _naming:
            return _buses.setdefault(name, cls())

    def new_session_id(self) -> str:
        """Return the next session id of this bus, in hex."""
        return f"{next(self._session_ids):x}"

    def next_order(self) -> int:
        """Return the next number of a published sample, over all topics."""
        return next(self._order)


_naming = threading.Lock()
_buses: weakref.WeakValueDictionary[str, Bus] = weakref.WeakValueDictionary()


class MemoryTransport(Transport):
    """A session on a bus: `MemoryTransport(bus=Bus())` for a separate network, or the bus of a name."""

    threaded = False

    def __init__(self, name: str = "", bus: Bus | None = None) -> None:
        self.url = f"memory://{name}"
        self.bus = bus or Bus.named(name)
        self.session_id = self.bus.new_session_id()
        self._handles: dict[_Declared, None] = {}
        self._calls: weakref.WeakSet[_Call] = weakref.WeakSet()
        self._queries: weakref.WeakSet[_Query] = weakref.WeakSet()
        self._closed = False

    def advertise(self, key: str, qos: QoSProfile) -> NumberingOutlet:
        """Declare a publisher. With TRANSIENT_LOCAL it retains the last `qos.depth` samples for late joiners."""
        with self._declaring():
            return _Outlet(self, key, qos)

    def subscribe(self, key: str, qos: QoSProfile, sink: Sink) -> Handle:
        """Call `sink` for every sample published on `key`; with TRANSIENT_LOCAL what was retained comes first."""
        with self._declaring():
            return _Subscription(self, key, qos, sink)

    def serve(self, key: str, sink: Sink) -> Handle:
        """Call `sink` for every call on `key`."""
        with self._declaring():
            return _Server(self, key, sink)

    def call(self, key: str, payload: bytes, attachment: bytes, sink: Sink) -> Handle:
        """Send a request to all servers of `key`: `sink` gets each reply, then None."""
        refuse_giant(key, payload)
        with self._declaring():
            servers = self.bus.servers.get(key, ())
            call = _Call(self.bus, key, sink, len(servers))
            self._calls.add(call)
            for server in servers:
                server.ask(_Query(payload, attachment, call))
            return call

    def announce(self, token: str) -> Handle:
        """Declare a liveliness token, visible to all watches until it is closed."""
        with self._declaring():
            announced = _Announced(self, token)
        _notify(self.bus)
        return announced

    def watch(self, pattern: str, on_change: Callable[[str, bool], object]) -> Handle:
        """Call `on_change(token, alive)` for each token that matches, at once for those already there."""
        with self._declaring():
            watch = _Watch(self, pattern, on_change)
        watch.drain()
        return watch

    def tokens(self, pattern: str) -> list[str]:
        """Return the tokens that match `pattern`, sorted."""
        with self._declaring():
            return sorted(filter(matcher(pattern), self.bus.tokens))

    def read(self, arrived: Any) -> Sample:
        """Return the item as a Sample: what was published comes as a plain pair, a reply is one already."""
        return arrived if type(arrived) is Sample else make_sample(arrived)

    def opener(self, check: Callable[[bytes], object], decode: Callable[[bytes], Any]) -> Callable[[Any], Any]:
        """Return a function that does `read`, `check` and `decode` to an item, without a call of `read`."""
        return pair_opener(check, decode)

    def accept(self, arrived: Any) -> Query:
        """Return the item itself: it is a Query already."""
        query: _Query = arrived
        return query

    def close(self) -> None:
        """Undeclare everything; the calls of this session end, and those that it has not answered."""
        with self.bus.lock:
            self._closed = True
            handles, self._handles = self._handles, {}
            for handle in reversed(handles):
                handle.remove()
            for call in list(self._calls):
                call.end()
            for query in list(self._queries):
                query.close()
        _notify(self.bus)

    @contextmanager
    def _declaring(self) -> Iterator[None]:
        with self.bus.lock:
            if self._closed:
                raise TransportClosedError(f"session {self.session_id} of {self.url} has been closed")
            yield


class _Declared:
    """A declaration of a session, until either is closed."""

    def __init__(self, session: MemoryTransport) -> None:
        self.session, self.bus, self.open = session, session.bus, True
        session._handles[self] = None

    def close(self) -> None:
        with self.bus.lock:
            self.session._handles.pop(self, None)
            self.remove()
        _notify(self.bus)

    def remove(self) -> None:
        """Remove it from the bus, whose lock is held; does nothing the second time."""
        if self.open:
            self.open = False
            self.leave()

    def leave(self) -> None:
        raise NotImplementedError


class _Outlet(_Declared):
    def __init__(self, session: MemoryTransport, key: str, qos: QoSProfile) -> None:
        super().__init__(session)
        self.key = key
        latched = qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
        self.latch: Latch[tuple[int, tuple[bytes, bytes]]] | None = Latch(latched_depth(qos)) if latched else None
        self.put_numbered = _putting(self)
        self.bus.outlets[key] = (*self.bus.outlets.get(key, ()), self)

    def put(self, payload: bytes, attachment: bytes) -> None:
        self.put_numbered(payload, lambda: attachment)

    @property
    def matched(self) -> bool:
        return bool(self.bus.subscriptions.get(self.key))

    def leave(self) -> None:
        _drop(self.bus.outlets, self.key, self)
        if self.latch is not None:
            self.latch.clear()


def _putting(outlet: _Outlet) -> Callable[[bytes, Callable[[], bytes]], bytes]:
    """Return an outlet's `put_numbered`: a closure, for every message comes here. It hands on plain pairs for `read`.

    It takes the lock without `with`, which would cost twice as much on Python 3.11.
    """
    bus, key, latch = outlet.bus, outlet.key, outlet.latch
    acquire, release, listening = bus.lock.acquire, bus.lock.release, bus.subscriptions.get

    def put_numbered(payload: bytes, attachment: Callable[[], bytes]) -> bytes:
        acquire()
        try:
            if not outlet.open:
                raise TransportClosedError(f"the publisher of {key} has been closed")
            if len(payload) >= heap.LARGE:
                refuse_giant(key, payload)
                heap.keep()
            subscriptions, sent = listening(key), attachment()
            pair = (payload, sent)
            if latch is not None:
                latch.retain((bus.next_order(), pair))
            if subscriptions is not None:
                for each in subscriptions:
                    if each.open:  # no sink before it has closed this one
                        sink = each.sink  # for Python 3.11 a function in an attribute, no method
                        sink(pair)
            return sent
        finally:
            release()

    return put_numbered


class _Subscription(_Declared):
    def __init__(self, session: MemoryTransport, key: str, qos: QoSProfile, sink: Sink) -> None:
        super().__init__(session)
        self.key, self.sink = key, sink
        self.bus.subscriptions[key] = (*self.bus.subscriptions.get(key, ()), self)
        if qos.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            self._catch_up(latched_depth(qos))

    def _catch_up(self, depth: int) -> None:
        latches = [outlet.latch for outlet in self.bus.outlets.get(self.key, ()) if outlet.latch is not None]
        retained = (each for latch in latches for each in latch.last(depth))
        for _, sample in sorted(retained, key=itemgetter(0)):
            self.sink(sample)

    def leave(self) -> None:
        _drop(self.bus.subscriptions, self.key, self)


class _Server(_Declared):
    def __init__(self, session: MemoryTransport, key: str, sink: Sink) -> None:
        super().__init__(session)
        self.key, self.sink = key, sink
        self.bus.servers[key] = (*self.bus.servers.get(key, ()), self)

    def ask(self, query: _Query) -> None:
        self.session._queries.add(query)
        self.sink(query)

    def leave(self) -> None:
        _drop(self.bus.servers, self.key, self)


class _Call:
    """A pending call: ends when every server has closed its query, or when the caller gives up."""

    def __init__(self, bus: Bus, key: str, sink: Sink, servers: int) -> None:
        self.bus, self.key, self._waiting = bus, key, servers
        self._sink: Sink | None = sink
        self.abandoned: list[_Query] = []  # held by whoever waits, and forgotten with the wait
        if not servers:
            self.end()

    def give(self, sample: Sample) -> None:
        if self._sink:
            self._sink(sample)

    def one_less(self) -> None:
        self._waiting -= 1
        if not self._waiting:
            self.end()

    def end(self) -> None:
        sink, self._sink = self._sink, None
        if sink:
            sink(None)

    def close(self) -> None:
        with self.bus.lock:
            self._sink = None


class _Query:
    """Server's side of a call; freeing it closes it."""

    def __init__(self, payload: bytes, attachment: bytes, call: _Call) -> None:
        self.payload, self.attachment = payload, attachment
        self._call, self._open = call, True

    def reply(self, payload: bytes, attachment: bytes) -> None:
        refuse_giant(f"the answer to a call of {self._call.key}", payload)
        with self._call.bus.lock:
            if self._open:
                self._call.give(Sample(payload, attachment))

    def close(self) -> None:
        with self._call.bus.lock:
            if self._open:
                self._open = False
                self._call.one_less()

    def abandon(self) -> None:
        """Lose the reply: the caller waits until it gives up, or until either session closes."""
        self._call.abandoned.append(self)

    __del__ = close


class _Announced(_Declared):
    def __init__(self, session: MemoryTransport, token: str) -> None:
        super().__init__(session)
        self.token = token
        self.bus.tokens[token] += 1
        if self.bus.tokens[token] == 1:
            _tell(self.bus, token, True)

    def leave(self) -> None:
        self.bus.tokens[self.token] -= 1
        if not self.bus.tokens[self.token]:
            del self.bus.tokens[self.token]
            _tell(self.bus, self.token, False)


class _Watch(_Declared):
    """A watch of tokens: changes are queued under the bus's lock and delivered outside it, in order, one at a time."""

    def __init__(self, session: MemoryTransport, pattern: str, on_change: Callable[[str, bool], object]) -> None:
        super().__init__(session)
        self.matches, self.on_change = matcher(pattern), on_change
        self.changes = deque((token, True) for token in sorted(filter(self.matches, self.bus.tokens)))
        self._telling = threading.Lock()
        self.bus.watches = (*self.bus.watches, self)

    def drain(self) -> None:
        while self.changes and self._telling.acquire(blocking=False):
            try:
                self._tell_all()
            finally:
                self._telling.release()

    def _tell_all(self) -> None:
        while change := self._next():
            self.on_change(*change)

    def _next(self) -> tuple[str, bool] | None:
        with self.bus.lock:
            return self.changes.popleft() if self.changes else None

    def leave(self) -> None:
        self.bus.watches = tuple(watch for watch in self.bus.watches if watch is not self)
        self.changes.clear()


def _tell(bus: Bus, token: str, alive: bool) -> None:
    for watch in bus.watches:
        if watch.matches(token):
            watch.changes.append((token, alive))


def _notify(bus: Bus) -> None:
    for watch in bus.watches:
        watch.drain()


def _drop(table: dict[str, tuple[Any, ...]], key: str, one: object) -> None:
    rest = tuple(each for each in table[key] if each is not one)
    if rest:
        table[key] = rest
    else:
        del table[key]
