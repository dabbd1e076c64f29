"""A session in memory whose messages meet the faults of its network."""

from __future__ import annotations

import functools
from typing import Any

from robolink.exceptions import WireError
from robolink.faults.fate import Way
from robolink.faults.network import FaultyNetwork, Name
from robolink.qos import QoSProfile
from robolink.transport.base import Handle, Sample, Sink
from robolink.transport.memory import MemoryTransport
from robolink.wire import NodeToken, gid_of, parse_token

_GID = slice(17, 33)
"""Where the sender's id stands in an attachment."""


class FaultyTransport(MemoryTransport):
    """A program's session on a network with faults.

    Only what a fault can meet passes through code of ours; all else goes as it does in a MemoryTransport. Faults are on
    the receiver's side, since what happens to a message is a matter of who sends it and who is to receive it.
    """

    def __init__(self, network: FaultyNetwork, program: str) -> None:
        super().__init__(bus=network.bus)
        self.url = f"memory://{program}"
        self.network, self.program = network, program
        self._doors: list[_Door] = []
        network.join(self, program)

    def announce(self, token: str) -> Handle:
        """Show `token` to all who watch, and know from now on whose messages bear its id."""
        self.network.senders[gid_of(token)] = self.program
        node = _node_of(token)
        if node:
            self.network.join(self, self.program, node)
        return super().announce(token)

    def subscribe(self, key: str, qos: QoSProfile, sink: Sink) -> Handle:
        """Call `sink` for every sample published on `key` that arrives, when it arrives."""
        door = _Ear(self, key, sink)
        door.declared = super().subscribe(key, qos, door.led())
        return self._kept(door)

    def serve(self, key: str, sink: Sink) -> Handle:
        """Call `sink` for every call on `key` that arrives, when it arrives."""
        door = _Desk(self, key, sink)
        door.declared = super().serve(key, door.led())
        return self._kept(door)

    def _kept(self, door: _Door) -> Handle:
        self._doors = [*(each for each in self._doors if each.declared.open), door]
        return door.declared  # type: ignore[no-any-return]

    def lead_anew(self) -> None:
        """Lead what is received through the faults that there are now."""
        with self.bus.lock:
            for door in self._doors:
                door.declared.sink = door.led()

    def close(self) -> None:
        """Undeclare everything and leave the network."""
        super().close()
        self.network.leave(self)


def _node_of(token: str) -> str:
    try:
        parsed = parse_token(token)
    except WireError:  # whoever announces something else means no faults
        return ""
    return parsed.full_node_name.lstrip("/") if isinstance(parsed, NodeToken) else ""


class _Door:
    """Where something is received: what stands between the network and a sink, while a fault may be on the way."""

    of_service = False

    def __init__(self, session: FaultyTransport, key: str, sink: Sink) -> None:
        network = session.network
        self.network, self.program, self.sink = network, session.program, sink
        self.name: Name = network.name(key, of_service=self.of_service)
        self.declared: Any = None
        """What the bus knows it by: it has `open` and `sink`."""
        self._now, self._at = network.time.steady, network.time.at
        self._ways: dict[bytes, Way | None] = {}

    def led(self) -> Sink:
        """Give what the network is to call now: the sink itself if there is no fault that could concern it."""
        self._ways = {}
        return self if self.network.may_meet(self.name) else self.sink

    def __call__(self, arrived: Any) -> None:
        """Take what was sent."""
        raise NotImplementedError

    def _later(self, time: int, arrived: Any) -> None:
        self._at(time, functools.partial(self._arrive, arrived))

    def _arrive(self, arrived: Any) -> None:
        with self.network.bus.lock:
            if self.declared.open:
                self.sink(arrived)


class _Ear(_Door):
    """Where a subscription listens."""

    def __call__(self, arrived: Sample) -> None:
        """Hand a sample on now, later, twice or never."""
        gid = arrived.attachment[_GID]
        try:
            way = self._ways[gid]
        except KeyError:
            way = self._ways[gid] = self.network.way(gid, self.program, self.name)
        if way is None:
            self.sink(arrived)
            return
        now = self._now()
        times = way.arrivals(arrived, now)
        if times is None:
            self.sink(arrived)
            return
        for time in times:
            if time <= now:
                self.sink(arrived)
            else:
                self._later(time, arrived)


class _Desk(_Door):
    """Where a service takes calls."""

    of_service = True

    def __call__(self, arrived: Any) -> None:
        """Hand a call on now, later or never; its answer goes the other way."""
        gid, network = arrived.attachment[_GID], self.network
        there = network.way(gid, self.program, self.name)
        back = network.way_back(self.program, gid, self.name)
        if there is None and back is None:
            self.sink(arrived)
            return
        question, now = _Question(arrived, back, self), self._now()
        times = None if there is None else there.arrivals(question, now)
        if times is None or (times and times[0] <= now):
            self.sink(question)
        elif not times:
            question.lose()
        else:
            self._later(times[0], question)


class _Question:
    """A call as its server sees it, whose answer may come late or never arrive."""

    def __init__(self, query: Any, way: Way | None, desk: _Desk) -> None:
        self.payload, self.attachment = query.payload, query.attachment
        self._query, self._way, self._desk = query, way, desk
        self._last = 0
        self._lost = False

    def reply(self, payload: bytes, attachment: bytes) -> None:
        """Answer."""
        now = self._desk._now()
        times = None if self._way is None else self._way.arrivals(object(), now)
        if times is None or (times and times[0] <= now):
            self._query.reply(payload, attachment)
        elif not times:
            self._lost = True
            self.lose()
        else:
            self._last = max(self._last, times[0])
            self._desk._at(times[0], functools.partial(self._query.reply, payload, attachment))

    def close(self) -> None:
        """Say that nothing more will come, after what is still on its way."""
        if self._last > self._desk._now():
            self._desk._at(self._last, self._query.close)
        elif not self._lost:
            self._query.close()

    def lose(self) -> None:
        """Leave the caller waiting, who cannot know."""
        self._query.abandon()
