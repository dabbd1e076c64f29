"""Helpers for tests of transports: subscriptions, servers, calls and watches that can be awaited."""

from __future__ import annotations

import functools
import itertools
import queue
import struct
import time
from collections.abc import Callable, Iterable
from typing import Any

from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from robolink.transport import Outlet, Query, Sample, Transport

PATIENCE = 30.0
CHATTER = "0/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported"
OTHER = "0/other/std_msgs::msg::dds_::String_/TypeHashNotSupported"
ADD = "0/add_two_ints/example_interfaces::srv::dds_::AddTwoInts_/TypeHashNotSupported"
GRAPH = "@ros2_lv/0/**"

PLAIN = QoSProfile(depth=10)
KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)
BEST_EFFORT = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


def latched(depth: int, reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE) -> QoSProfile:
    return QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=reliability)


def stamped(number: int, publisher: int = 0, at: int | None = None) -> bytes:
    """An attachment as of ROS 2; `at` is its time, the number by itself."""
    return struct.pack("<qqB16s", number, number if at is None else at, 16, b"%16d" % publisher)


class Network:
    """Opens sessions that see each other, and closes them."""

    def __init__(self, open_one: Callable[[], Transport]) -> None:
        self._open_one = open_one
        self.sessions: list[Transport] = []

    def session(self) -> Transport:
        self.sessions.append(self._open_one())
        return self.sessions[-1]

    def close(self) -> None:
        for session in self.sessions:
            session.close()


class Ear:
    """A subscription whose samples can be waited for."""

    def __init__(self, session: Transport, key: str = CHATTER, qos: QoSProfile = PLAIN) -> None:
        self.session, self.arrived = session, queue.SimpleQueue[Any]()
        self.handle = session.subscribe(key, qos, self.arrived.put)

    def next(self) -> bytes:
        return self.session.read(self.arrived.get(timeout=PATIENCE)).payload

    def take(self, count: int) -> list[bytes]:
        return [self.next() for _ in range(count)]

    def until(self, last: bytes) -> list[bytes]:
        return list(iter(self.next, last))

    def hears(self, last: bytes) -> bool:
        """Take everything up to this; whether it comes within a few seconds."""
        try:
            return last in iter(lambda: self.session.read(self.arrived.get(timeout=3.0)).payload, None)
        except queue.Empty:
            return False


def until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline, "it did not come true"
        time.sleep(0.001)


def reach(outlet: Outlet, *ears: Ear) -> None:
    """Wait until all of them hear the publisher, and begin with nothing in their queues."""
    for ear in ears:
        until(functools.partial(probe, outlet, ear))
    marks = itertools.count()
    until(lambda: begin(outlet, b"begin %d" % next(marks), ears))


def begin(outlet: Outlet, mark: bytes, ears: Iterable[Ear]) -> bool:
    """Whether all hear a mark, which comes last; on a very busy machine a publisher that does not wait may drop it."""
    outlet.put(mark, b"")
    return all(ear.hears(mark) for ear in ears)


def probe(outlet: Outlet, ear: Ear) -> bool:
    outlet.put(b"probe", b"")
    try:
        return bool(ear.arrived.get(timeout=0.02))
    except queue.Empty:
        return False


class Desk:
    """A server whose calls are answered by the test."""

    def __init__(self, session: Transport, key: str = ADD) -> None:
        self.session, self.arrived = session, queue.SimpleQueue[Any]()
        self.handle = session.serve(key, self.arrived.put)

    def next(self) -> Query:
        """The next call that is not one of `find`, which may come late."""
        while True:
            query = self.session.accept(self.arrived.get(timeout=PATIENCE))
            if query.payload != b"find":
                return query
            query.close()


class Caller:
    """A call and what became of it."""

    def __init__(self, session: Transport, payload: bytes = b"", key: str = ADD, attachment: bytes = b"") -> None:
        self.session, self.arrived = session, queue.SimpleQueue[Any]()
        self.handle = session.call(key, payload, attachment, self.arrived.put)

    def replies(self) -> list[Sample]:
        """Everything up to the end."""
        arrived = iter(functools.partial(self.arrived.get, timeout=PATIENCE), None)
        return [self.session.read(each) for each in arrived]

    def answers(self) -> list[bytes]:
        """The payloads of everything up to the end."""
        return [each.payload for each in self.replies()]


def find(caller_session: Transport, desk: Desk) -> None:
    """Wait until the caller's session knows of the server."""
    until(lambda: served(desk, Caller(caller_session, b"find")))


def served(desk: Desk, caller: Caller) -> bool:
    try:
        desk.session.accept(desk.arrived.get(timeout=0.02)).close()
    except queue.Empty:
        return False
    finally:
        caller.handle.close()
    return True


class Watcher:
    """A watch whose changes can be waited for."""

    def __init__(self, session: Transport, pattern: str = GRAPH) -> None:
        self.changes: queue.SimpleQueue[tuple[str, bool]] = queue.SimpleQueue()
        self.handle = session.watch(pattern, lambda token, alive: self.changes.put((token, alive)))

    def next(self) -> tuple[str, bool]:
        return self.changes.get(timeout=PATIENCE)
