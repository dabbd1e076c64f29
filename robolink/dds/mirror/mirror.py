"""Mirror between two networks: what one side has is announced on the other, and data flows where both ends are there.

It joins any two Transports, and is symmetric. Payloads pass unchanged, so it carries types that this installation does
not know. One thread follows the graphs and alone declares; two more, the lanes, carry what the transports bring, one in
each direction: no transport is called from within a sink of the other, where it may hold a lock.
"""

from __future__ import annotations

import functools
import heapq
import itertools
import queue
import threading
from collections import Counter
from collections.abc import Callable
from typing import NamedTuple

from robolink.dds.mirror.services import ServiceFlow
from robolink.dds.mirror.sides import Announced, Later, Side
from robolink.dds.mirror.topics import TopicFlow
from robolink.exceptions import RobolinkError, TransportClosedError, WireError
from robolink.logging import get_logger
from robolink.system import clocks
from robolink.transport.base import Transport
from robolink.wire import NO_HASH, EndpointKind, EndpointToken, NodeToken, gid_of, graph_pattern, parse_token

LINGER = 0.25
"""Time in seconds for which what is gone stays mirrored: its last messages may come behind the news of its end."""

MOST_OF_SESSION = 20_000
"""Most tokens of one session that are mirrored, as in `robolink.graph.graph`."""

MOST = 100_000
"""Most tokens of one side that are mirrored."""

_TOPIC_KINDS = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
_GIVING = (EndpointKind.PUBLISHER, EndpointKind.SERVICE)

Token = NodeToken | EndpointToken
Flow = TopicFlow | ServiceFlow
Place = tuple[bool, str, str]
"""Key of a topic (True) or service (False): with its name, and its type."""


class Count(NamedTuple):
    """Figures of a mirror, for a progress line."""

    nodes: tuple[int, int]
    """Number of nodes on each side, without those that are mirrored there."""
    topics: int
    """Number of topics of which samples go to the other side now."""
    services: int
    """Number of services that are offered on the other side."""
    dropped: int
    """Number of samples that were dropped, since one side was too slow."""
    failed: int
    """Number of samples that could not be carried over."""


class Mirror:
    """Mirror between two transports of one domain, which the caller opens and closes.

    Args:
        a: Session on one network.
        b: Session on the other.
        domain: ROS domain id of both.
        clock: Function that returns the time in seconds; tests pass their own.
    """

    def __init__(
        self, a: Transport, b: Transport, domain: int = 0, clock: Callable[[], float] = clocks.monotonic
    ) -> None:
        self.sides = (Side(a, domain), Side(b, domain))
        self._clock = clock
        self._places: dict[Place, _Place] = {}
        self._known: tuple[dict[bytes, _Known], dict[bytes, _Known]] = ({}, {})
        self._of_session: tuple[Counter[str], Counter[str]] = (Counter(), Counter())
        self._news: queue.SimpleQueue[Callable[[], object] | None] = queue.SimpleQueue()
        self._timers: list[tuple[float, int, Callable[[], object]]] = []
        self._order = itertools.count()
        self._later = Later(self._news.put, clock, self._call_after)
        self._thread: threading.Thread | None = None
        self._reported: set[str] = set()
        self._watches = [
            side.transport.watch(graph_pattern(domain), functools.partial(self._on_token, number))
            for number, side in enumerate(self.sides)
        ]

    # Running

    def start(self) -> None:
        """Mirror on threads of its own, until `close`."""
        for number, side in enumerate(self.sides):
            side.lane.start(f"robolink mirror {number}")
        self._thread = threading.Thread(target=self._run, name="robolink mirror", daemon=True)
        self._thread.start()

    def step(self) -> None:
        """Do all that is due now, on this thread: for tests, in place of `start`."""
        busy = True
        while busy:
            busy = self._take_news() | self._take_timers()
            for side in self.sides:
                busy |= side.lane.step()

    def close(self) -> None:
        """End all that is mirrored, and all calls under way; the transports stay open. Safe to call twice."""
        for watch in self._watches:
            watch.close()
        if self._thread is not None:
            self._news.put(None)
            self._thread.join()
            self._thread = None
        for place in self._places.values():
            for flow in place.flows:
                self._quietly(flow.close)
        self._places.clear()
        for number, known in enumerate(self._known):
            for each in known.values():
                if each.announced is not None:
                    self._quietly(functools.partial(self.sides[1 - number].withdraw, each.announced, each.token))
            known.clear()
        for side in self.sides:
            side.lane.stop()
            side.lane.step()

    def _run(self) -> None:
        while True:
            try:
                wait = max(0.0, self._timers[0][0] - self._clock()) if self._timers else None
                news = self._news.get(timeout=wait)
            except queue.Empty:
                self._take_timers()
                continue
            if news is None:
                return
            self._quietly(news)
            self._take_timers()

    def _take_news(self) -> bool:
        waiting = self._news.qsize()
        for _ in range(waiting):
            if (news := self._news.get_nowait()) is not None:
                self._quietly(news)
        return waiting > 0

    def _take_timers(self) -> bool:
        now, any_due = self._clock(), False
        while self._timers and self._timers[0][0] <= now:
            self._quietly(heapq.heappop(self._timers)[2])
            any_due = True
        return any_due

    def _call_after(self, seconds: float, action: Callable[[], object]) -> None:
        heapq.heappush(self._timers, (self._clock() + seconds, next(self._order), action))

    def _quietly(self, action: Callable[[], object]) -> None:
        """Run an action; what fails is logged, and the rest goes on."""
        try:
            action()
        except TransportClosedError:  # one of the sides ends just now
            pass
        except RobolinkError as error:
            self._report(f"something cannot be mirrored: {error}")
        except Exception as error:  # noqa: BLE001 - what one announcement does must not end the others
            self._report(f"something cannot be mirrored: {type(error).__name__}: {error}")

    def _report(self, text: str) -> None:
        if text not in self._reported and len(self._reported) < _MOST_REPORTED:
            self._reported.add(text)
            get_logger("robolink.dds").warning(text)

    # Graphs

    def _on_token(self, number: int, text: str, alive: bool) -> bool:
        """Queue a token of one side, on a thread of its transport; False for one that is not worth remembering."""
        if text.startswith(self.sides[number].own_prefix):
            return True
        try:
            token = parse_token(text)
        except WireError as error:
            if alive:
                self._report(f"an announcement is not mirrored, since it cannot be read: {error}")
            return False
        gid = gid_of(text)
        self._news.put(functools.partial(self._came if alive else self._went, number, gid, token))
        return True

    def _came(self, number: int, gid: bytes, token: Token) -> None:
        known = self._known[number].get(gid)
        if known is not None:
            known.going = False
            return
        sessions = self._of_session[number]
        if sessions[token.session] >= MOST_OF_SESSION or len(self._known[number]) >= MOST:
            self._report(f"there are too many nodes, topics and services: {token.full_node_name} is not mirrored")
            return
        sessions[token.session] += 1
        self._known[number][gid] = known = _Known(token)
        if isinstance(token, EndpointToken):
            self._add(number, gid, token)
        else:
            known.announced = self.sides[1 - number].announce(token)

    def _went(self, number: int, gid: bytes, token: Token) -> None:
        known = self._known[number].get(gid)
        if known is not None and not known.going:
            known.going = True
            self._call_after(LINGER, functools.partial(self._forget, number, gid, known))

    def _forget(self, number: int, gid: bytes, known: _Known) -> None:
        if not known.going or self._known[number].get(gid) is not known:  # it is back
            return
        del self._known[number][gid]
        sessions = self._of_session[number]
        sessions[known.token.session] -= 1
        if not sessions[known.token.session]:
            del sessions[known.token.session]
        if isinstance(known.token, EndpointToken):
            self._remove(number, gid, known.token)
        elif known.announced is not None:
            self.sides[1 - number].withdraw(known.announced, known.token)

    def _add(self, number: int, gid: bytes, token: EndpointToken) -> None:
        place = self._place(token)
        place.learn(number, token.type_hash)
        place.add(number, gid, token)

    def _remove(self, number: int, gid: bytes, token: EndpointToken) -> None:
        place = self._place(token)
        place.remove(number, gid, token)
        if place.is_empty():
            del self._places[_place_of(token)]

    def _place(self, token: EndpointToken) -> _Place:
        at = _place_of(token)
        place = self._places.get(at)
        if place is None:
            place = self._places[at] = _Place(self.sides, self._later, is_topic=at[0])
        return place

    # Figures

    def count(self) -> Count:
        """Return the counts of what the mirror has met; from any thread, and roughly where all is in motion."""
        places = list(self._places.items())
        nodes = [sum(isinstance(each.token, NodeToken) for each in list(known.values())) for known in self._known]
        lanes = [side.lane for side in self.sides]
        return Count(
            nodes=(nodes[0], nodes[1]),
            topics=len({at[1] for at, place in places if at[0] and any(each.flows() for each in place.flows)}),
            services=len({at[1] for at, place in places if not at[0] and any(each.flows() for each in place.flows)}),
            dropped=sum(each.dropped for each in lanes),
            failed=sum(each.failed for each in lanes),
        )


_MOST_REPORTED = 20
"""Most different warnings of a mirror: a stranger must not fill the log."""


def _place_of(token: EndpointToken) -> Place:
    return token.kind in _TOPIC_KINDS, token.name, token.type_name


class _Known:
    """Token of one side that is mirrored."""

    def __init__(self, token: Token) -> None:
        self.token = token
        self.announced: Announced | None = None
        """Its announcement on the other side, if it is a node's."""
        self.going = False
        """True from its end on, until it is forgotten."""


class _Place:
    """Topic or service of one type, with its two directions."""

    def __init__(self, sides: tuple[Side, Side], later: Later, *, is_topic: bool) -> None:
        self._sides = sides
        a, b = sides
        self.flows: tuple[Flow, Flow] = (
            (TopicFlow(a, b, later), TopicFlow(b, a, later))
            if is_topic
            else (ServiceFlow(a, b, later), ServiceFlow(b, a, later))
        )
        """From the first side to the second, and back."""
        self._hashes = ["", ""]
        """Hash of the type on each side, as far as a token there has told one."""

    def learn(self, number: int, type_hash: str) -> None:
        """Note the hash of one side, and announce again there what had none.

        DDS tells the hash of a service's request, not of the service, and Humble tells none: a type that this
        installation does not know gets the one that the other end has.
        """
        if type_hash == NO_HASH or self._hashes[number]:
            return
        self._hashes[number] = type_hash
        for flow in self.flows:
            for gid, token in flow.hashless(self._sides[number]):
                flow.rehash(gid, token, type_hash)

    def add(self, number: int, gid: bytes, token: EndpointToken) -> None:
        """Mirror an endpoint of a side."""
        type_hash = token.type_hash
        if type_hash == NO_HASH:
            type_hash = self._hashes[1 - number] or NO_HASH
        self._flow(number, token).add(gid, token, type_hash)

    def remove(self, number: int, gid: bytes, token: EndpointToken) -> None:
        """End it."""
        self._flow(number, token).remove(gid, token)

    def _flow(self, number: int, token: EndpointToken) -> Flow:
        """Return the direction in which an endpoint gives, or takes what comes from the other side."""
        return self.flows[number if token.kind in _GIVING else 1 - number]

    def is_empty(self) -> bool:
        """True if nothing is left of it."""
        return all(each.is_empty() for each in self.flows)
