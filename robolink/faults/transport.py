"""In-memory session with fault injection."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from robolink.exceptions import WireError
from robolink.faults.delivery import Link
from robolink.faults.network import FaultyNetwork, Name
from robolink.qos import QoSProfile
from robolink.transport.base import Handle, Sink
from robolink.transport.memory import MemoryTransport
from robolink.wire import NodeToken, gid_in, gid_of, parse_token

_Arrivals = Callable[[object, int], tuple[int, ...] | None]
"""`Link.arrivals`."""


class FaultyTransport(MemoryTransport):
    """A program's session on a network with faults.

    Only what a fault can concern passes through code of ours; all else goes as it does in a MemoryTransport. Faults are
    on the receiver's side, since what happens to a message depends on both its sender and its receiver.

    Args:
        network: Network that the session joins.
        program: Name of the program.
    """

    def __init__(self, network: FaultyNetwork, program: str) -> None:
        super().__init__(bus=network.bus)
        self.url = f"memory://{program}"
        self.network, self.program = network, program
        self._interceptors: list[_Interceptor] = []
        network.join(self, program)

    def announce(self, token: str) -> Handle:
        """Announce `token`, and remember the program of the messages that bear its id."""
        self.network.senders[gid_of(token)] = self.program
        node = _node_of(token)
        if node:
            self.network.join(self, self.program, node)
        return super().announce(token)

    def subscribe(self, key: str, qos: QoSProfile, sink: Sink) -> Handle:
        """Call `sink` with every sample published on `key` that arrives, when it arrives, with the QoS `qos`."""
        interceptor = _SubscriptionInterceptor(self, key, sink)
        interceptor.declared = super().subscribe(key, qos, interceptor.route())
        return self._registered(interceptor)

    def serve(self, key: str, sink: Sink) -> Handle:
        """Call `sink` with every call on `key` that arrives, when it arrives."""
        interceptor = _ServiceInterceptor(self, key, sink)
        interceptor.declared = super().serve(key, interceptor.route())
        return self._registered(interceptor)

    def _registered(self, interceptor: _Interceptor) -> Handle:
        self._interceptors = [*(each for each in self._interceptors if each.declared.open), interceptor]
        return interceptor.declared  # type: ignore[no-any-return]

    def reroute(self) -> None:
        """Route what is received through the current faults."""
        with self.bus.lock:
            for interceptor in self._interceptors:
                interceptor.declared.sink = interceptor.route()

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


class _Interceptor:
    """Interceptor between the network and a sink, while a fault may concern it."""

    of_service = False

    def __init__(self, session: FaultyTransport, key: str, sink: Sink) -> None:
        network = session.network
        self.network, self.program, self.sink = network, session.program, sink
        self.name: Name = network.name(key, of_service=self.of_service)
        self.declared: Any = None
        """Entry on the bus; it has `open` and `sink`."""
        self._now, self._at = network.time.steady, network.time.at

    def route(self) -> Sink:
        """Return the function for the network to call now: the sink itself if no fault can concern it."""
        return self._receiving() if self.network.may_meet(self.name) else self.sink

    def _receiving(self) -> Sink:
        """Return the function that receives what was sent, by the current faults."""
        raise NotImplementedError

    def _later(self, time: int, arrived: Any) -> None:
        self._at(time, functools.partial(self._arrive, arrived))

    def _arrive(self, arrived: Any) -> None:
        with self.network.bus.lock:
            if self.declared.open:
                self.sink(arrived)


class _SubscriptionInterceptor(_Interceptor):
    """Interceptor of a subscription."""

    def _receiving(self) -> Sink:
        """Return the function that delivers a sample now, later, twice or never: a closure, for each comes here."""
        links: dict[bytes, _Arrivals | None] = {}
        clock, sink = self.network.time, self.sink

        def receive(arrived: tuple[bytes, bytes]) -> None:
            gid = gid_in(arrived[1])
            try:
                arrivals = links[gid]
            except KeyError:
                link = self.network.link(gid, self.program, self.name)
                arrivals = links[gid] = None if link is None else link.arrivals
            if arrivals is None:
                sink(arrived)
                return
            now = clock._now  # a call less than `steady()`
            times = arrivals(arrived, now)
            if times is None:
                sink(arrived)
                return
            for time in times:
                if time <= now:
                    sink(arrived)
                else:
                    self._later(time, arrived)

        return receive


class _ServiceInterceptor(_Interceptor):
    """Interceptor of a service."""

    of_service = True

    def _receiving(self) -> Sink:
        return self._receive

    def _receive(self, arrived: Any) -> None:
        """Deliver a call now, later or never; its response goes the other way."""
        gid, network = gid_in(arrived.attachment), self.network
        there = network.link(gid, self.program, self.name)
        back = network.link_back(self.program, gid, self.name)
        if there is None and back is None:
            self.sink(arrived)
            return
        query, now = _DelayedQuery(arrived, back, self), self._now()
        times = None if there is None else there.arrivals(query, now)
        if times is None or (times and times[0] <= now):
            self.sink(query)
        elif not times:
            query.lose()
        else:
            self._later(times[0], query)


class _DelayedQuery:
    """A call as its server sees it, whose response may come late or never arrive."""

    def __init__(self, query: Any, link: Link | None, service: _ServiceInterceptor) -> None:
        self.payload, self.attachment = query.payload, query.attachment
        self._query, self._link, self._service = query, link, service
        self._last = 0
        self._lost = False

    def reply(self, payload: bytes, attachment: bytes) -> None:
        """Send the response."""
        now = self._service._now()
        times = None if self._link is None else self._link.arrivals(object(), now)
        if times is None or (times and times[0] <= now):
            self._query.reply(payload, attachment)
        elif not times:
            self._lost = True
            self.lose()
        else:
            self._last = max(self._last, times[0])
            self._service._at(times[0], functools.partial(self._query.reply, payload, attachment))

    def close(self) -> None:
        """End the call, after what is still on its way."""
        if self._last > self._service._now():
            self._service._at(self._last, self._query.close)
        elif not self._lost:
            self._query.close()

    def lose(self) -> None:
        """Leave the caller waiting, who cannot know."""
        self._query.abandon()
