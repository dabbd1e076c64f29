"""Topics of a mirror: the publishers of one side are announced on the other, and their samples go there if wanted.

A publisher has an outlet of its own on the other side, which keeps its identity, numbers and latched samples apart from
those of others. It is there while somebody subscribes there. An inlet takes what arrives under one key.
"""

from __future__ import annotations

import functools
from collections import Counter, deque
from collections.abc import Callable
from typing import Any

from robolink.dds.mirror.lanes import Lane
from robolink.dds.mirror.sides import Announced, Later, Side
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from robolink.transport.base import Handle, Outlet
from robolink.wire import NO_HASH, EndpointKind, EndpointToken, gid_in, is_attachment, numbers_in

MATCHED_WITHIN = 1.0
"""Longest wait for a subscription that the graph shows to match a new outlet, in seconds; DDS takes some 20 ms."""

MATCHED_EVERY = 0.01
"""Interval of the looks whether an outlet is matched, in seconds."""

KNOWN_WITHIN = 2.0
"""Time in seconds for which samples of a publisher wait whose announcement has not come yet."""

MOST_PARKED = 100
"""Most samples of one publisher that wait, for its announcement or for its outlet to be matched."""

MOST_BYTES_PARKED = 16 << 20
"""Most bytes that wait at an inlet for announcements."""

_BEST = {
    latched: QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )
    for latched in (False, True)
}
"""Profiles of inlets, volatile and latched: reliable, so that they get what the publishers have."""


def is_latched(qos: QoSProfile) -> bool:
    """True if the publisher of this profile retains samples for late joiners."""
    return qos.durability is DurabilityPolicy.TRANSIENT_LOCAL


class Forward:
    """Way of one publisher's samples to its outlet on the other side; used on the lane's thread only."""

    def __init__(self, outlet: Outlet, sender: bytes, *, waits: bool) -> None:
        self._outlet, self.sender = outlet, sender
        self._waiting: deque[tuple[bytes, bytes]] | None = deque(maxlen=MOST_PARKED) if waits else None
        self.put: Callable[[bytes, bytes], object] = self._hold if waits else outlet.put
        """Send a payload with its attachment, once the outlet is matched."""
        self.count = 0
        """Number of samples that have come this way."""

    def _hold(self, payload: bytes, attachment: bytes) -> None:
        assert self._waiting is not None
        self._waiting.append((payload, attachment))

    def open(self) -> None:
        """Send what waits, and from now on all that comes."""
        waiting, self._waiting = self._waiting or (), None
        self.put = self._outlet.put
        for payload, attachment in waiting:
            self._outlet.put(payload, attachment)


class Inlet:
    """Subscription of the mirror under one key of the source side, volatile or latched.

    All but `__init__`, `begin` and `close` run on the lane's thread.
    """

    droppable = True

    def __init__(self, flow: TopicFlow, key: str, *, latched: bool) -> None:
        self._flow, self.key, self.latched = flow, key, latched
        self.users = 0
        """Number of publishers and kinds of subscriptions that need it."""
        self._handle: Handle | None = None
        self._read = flow.source.transport.read
        self._forwards: dict[bytes, Forward] = {}
        self._parked: dict[bytes, tuple[float, deque[tuple[bytes, bytes]]]] = {}
        self._bytes_parked = 0

    def begin(self) -> None:
        """Subscribe, unless that has been done."""
        if self._handle is None:
            side = self._flow.source
            self._handle = side.transport.subscribe(self.key, _BEST[self.latched], side.lane.sink(self))

    def close(self) -> None:
        """End the subscription."""
        if self._handle is not None:
            self._handle.close()

    def deliver(self, content: Any) -> None:
        """Carry a sample over. This runs once a message: nothing of it is parsed but the sender's gid."""
        payload, attachment = self._read(content)
        forward = self._forwards.get(gid_in(attachment))
        if forward is None:
            self._park(payload, attachment)
            return
        forward.count += 1
        # The number and time are the sender's; the gid is that of its announcement on the other side.
        forward.put(payload, numbers_in(attachment) + forward.sender)

    def _park(self, payload: bytes, attachment: bytes) -> None:
        """Keep a sample whose sender is not known yet: data may be faster than the token, above all from a new one.

        An echo of the mirror's own is dropped, and so is what another inlet brings, or nobody wants.
        """
        gid = gid_in(attachment)
        if gid in self._flow.source.own or not is_attachment(attachment):
            return
        publication = self._flow.publications.get(gid)
        if publication is not None and publication.inlet is not self:
            return
        if self._bytes_parked + len(payload) > MOST_BYTES_PARKED:
            return
        if not self._parked:
            self._flow.later.call(self._expire_later)
        _, waiting = self._parked.setdefault(gid, (self._flow.later.now(), deque()))
        if len(waiting) < MOST_PARKED:
            waiting.append((payload, attachment))
            self._bytes_parked += len(payload)

    def _expire_later(self) -> None:
        lane = self._flow.source.lane
        self._flow.later.call_after(KNOWN_WITHIN, functools.partial(lane.post, self._expire))

    def _expire(self) -> None:
        before = self._flow.later.now() - KNOWN_WITHIN
        for gid in [gid for gid, (since, _) in self._parked.items() if since <= before]:
            self._bytes_parked -= sum(len(payload) for payload, _ in self._parked.pop(gid)[1])
        if self._parked:
            self._flow.later.call(self._expire_later)

    def admit(self, gid: bytes, forward: Forward) -> None:
        """Send the samples of this publisher on from now on, those that wait first."""
        self._forwards[gid] = forward
        _, waiting = self._parked.pop(gid, (0.0, ()))
        for payload, attachment in waiting:
            self._bytes_parked -= len(payload)
            forward.count += 1
            forward.put(payload, numbers_in(attachment) + forward.sender)

    def dismiss(self, gid: bytes) -> None:
        """Forget a publisher."""
        self._forwards.pop(gid, None)


class Publication:
    """Publisher of the source side, as it is announced on the target side; its samples flow while it has an inlet."""

    def __init__(self, token: EndpointToken, announced: Announced) -> None:
        self.token, self.announced = token, announced
        self.inlet: Inlet | None = None
        self.forward: Forward | None = None
        self.outlet: Outlet | None = None


class TopicFlow:
    """One direction of a topic of one type: publishers of one side, subscriptions of the other.

    Args:
        source: Side of the publishers.
        target: Side of the subscriptions.
        later: Ways to do something later.
    """

    def __init__(self, source: Side, target: Side, later: Later) -> None:
        self.source, self.target, self.later = source, target, later
        self.publications: dict[bytes, Publication] = {}
        self._subscriptions: dict[bytes, tuple[EndpointToken, Announced]] = {}
        self._wanted: Counter[str] = Counter()
        """Number of subscriptions by their type's hash."""
        self._inlets: dict[tuple[str, bool], Inlet] = {}

    @property
    def lane(self) -> Lane:
        """Lane of the samples."""
        return self.source.lane

    def add(self, gid: bytes, token: EndpointToken, type_hash: str) -> None:
        """Mirror a publisher of the source side, or a subscription of the target side.

        Args:
            gid: Its gid on its own side.
            token: Its token there.
            type_hash: Hash to announce it with on the other side.
        """
        if token.kind is EndpointKind.PUBLISHER:
            self._add_publisher(gid, token, type_hash)
        else:
            self._add_subscription(gid, token, type_hash)

    def remove(self, gid: bytes, token: EndpointToken) -> None:
        """End what `add` has made."""
        if token.kind is EndpointKind.PUBLISHER:
            self._remove_publisher(gid)
        else:
            self._remove_subscription(gid)

    # Publishers

    def _add_publisher(self, gid: bytes, token: EndpointToken, type_hash: str) -> None:
        """Announce a publisher on the target side, and let its samples flow if somebody wants them there."""
        self.publications[gid] = publication = Publication(token, self.target.announce(token, type_hash))
        if self._is_wanted(token):
            self._open(gid, publication)
            self._begin()

    def _remove_publisher(self, gid: bytes) -> None:
        """End its announcement and its outlet."""
        publication = self.publications.pop(gid)
        self._close(gid, publication)
        self.target.withdraw(publication.announced, publication.token)

    def _is_wanted(self, token: EndpointToken) -> bool:
        wanted = self._wanted
        return bool(wanted) and (token.type_hash == NO_HASH or token.type_hash in wanted or NO_HASH in wanted)

    def _open(self, gid: bytes, publication: Publication) -> None:
        latched = is_latched(publication.token.qos)
        mirrored = publication.announced.token
        assert isinstance(mirrored, EndpointToken)
        publication.outlet = self.target.transport.advertise(self.target.key(mirrored), mirrored.qos)
        # A latched one retains what nobody is there for yet.
        publication.forward = Forward(publication.outlet, publication.announced.sender, waits=not latched)
        publication.inlet = self._use(self.source.key(publication.token), latched)
        self.lane.post(functools.partial(publication.inlet.admit, gid, publication.forward))
        if not latched:
            self._await_match(publication, publication.outlet, self.later.now() + MATCHED_WITHIN)

    def _await_match(self, publication: Publication, outlet: Outlet, deadline: float) -> None:
        """Open the outlet as soon as it is matched: in DDS, what is sent to an unmatched reader is lost to it."""
        if publication.outlet is not outlet or publication.forward is None:
            return
        if outlet.matched or self.later.now() >= deadline:
            self.lane.post(publication.forward.open)
        else:
            self.later.call_after(MATCHED_EVERY, functools.partial(self._await_match, publication, outlet, deadline))

    def _close(self, gid: bytes, publication: Publication) -> None:
        inlet, outlet, forward = publication.inlet, publication.outlet, publication.forward
        if inlet is None or outlet is None or forward is None:
            return
        publication.inlet = publication.outlet = publication.forward = None

        def end() -> None:
            forward.open()
            inlet.dismiss(gid)
            outlet.close()

        self.lane.post(end)  # behind the samples that wait
        self._leave(inlet)

    # Subscriptions

    def _add_subscription(self, gid: bytes, token: EndpointToken, type_hash: str) -> None:
        """Let flow what it wants, then announce it on the source side: who sees it there may publish at once."""
        first = token.type_hash not in self._wanted
        self._wanted[token.type_hash] += 1
        if first:
            self._use(self.source.key(token._replace(type_hash=type_hash)), latched=False)
            for each, publication in self.publications.items():
                if publication.inlet is None and self._is_wanted(publication.token):
                    self._open(each, publication)
            self._begin()
        self._subscriptions[gid] = token, self.source.announce(token, type_hash)

    def _remove_subscription(self, gid: bytes) -> None:
        """End its announcement, and the flows that nobody else wants.

        A latched publisher's goes on: what its outlet retains must be right for who comes next.
        """
        token, announced = self._subscriptions.pop(gid)
        self.source.withdraw(announced, token)
        self._wanted[token.type_hash] -= 1
        if self._wanted[token.type_hash]:
            return
        del self._wanted[token.type_hash]
        mirrored = announced.token
        assert isinstance(mirrored, EndpointToken)
        for each, publication in self.publications.items():
            if not self._is_wanted(publication.token) and not is_latched(publication.token.qos):
                self._close(each, publication)
        self._leave(self._inlets[self.source.key(mirrored), False])

    # Inlets

    def _use(self, key: str, latched: bool) -> Inlet:
        inlet = self._inlets.get((key, latched))
        if inlet is None:
            inlet = self._inlets[key, latched] = Inlet(self, key, latched=latched)
        inlet.users += 1
        return inlet

    def _begin(self) -> None:
        """Subscribe where that was not done yet: behind the publishers' admission, so that nothing is parked."""
        for each in self._inlets.values():
            each.begin()

    def _leave(self, inlet: Inlet) -> None:
        inlet.users -= 1
        if not inlet.users:
            del self._inlets[inlet.key, inlet.latched]
            inlet.close()

    # Both

    def is_empty(self) -> bool:
        """True if nothing is left in this direction."""
        return not self.publications and not self._subscriptions

    def hashless(self, announced_on: Side) -> list[tuple[bytes, EndpointToken]]:
        """Return what is announced on a side without a hash, since nobody knew one."""
        if announced_on is self.target:
            publications = ((gid, each.token, each.announced.token) for gid, each in self.publications.items())
            return [(gid, token) for gid, token, mirrored in publications if _has_none(mirrored)]
        subscriptions = ((gid, *each) for gid, each in self._subscriptions.items())
        return [(gid, token) for gid, token, announced in subscriptions if _has_none(announced.token)]

    def samples(self) -> int:
        """Return the number of samples of the publishers that flow now."""
        return sum(each.forward.count for each in self.publications.values() if each.forward is not None)

    def flows(self) -> bool:
        """True if samples of some publisher go to the other side now."""
        return any(each.inlet is not None for each in self.publications.values())

    def close(self) -> None:
        """End all that is declared."""
        for gid in list(self.publications):
            self._remove_publisher(gid)
        for gid in list(self._subscriptions):
            self._remove_subscription(gid)


def _has_none(token: Any) -> bool:
    return isinstance(token, EndpointToken) and token.type_hash == NO_HASH
