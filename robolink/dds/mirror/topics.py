"""Topics of a mirror: the publishers of one side are announced on the other, and their samples go there if wanted.

A publisher has an outlet of its own on the other side, which keeps its identity, numbers and latched samples apart from
those of others. It is there while somebody subscribes there.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any, NamedTuple

from robolink.dds.mirror.crossing import Crossing, Forward
from robolink.dds.mirror.sides import Announced, Later, Side, gids_of
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.transport.base import Handle, Outlet
from robolink.wire import NO_HASH, EndpointKind, EndpointToken

MATCHED_WITHIN = 1.0
"""Longest wait for a subscription that the graph shows to match a new outlet, in seconds; DDS takes some 20 ms."""

MATCHED_EVERY = 0.01
"""Interval of the looks whether an outlet is matched, in seconds."""

SIFTED_FOR = 1.0
"""Time in seconds for which a new inlet may repeat what the one before it has brought."""


class _Subscription(NamedTuple):
    token: EndpointToken
    announced: Announced
    key: str
    """Key of its topic on the source side."""


class _Inlet(NamedTuple):
    """Subscription of the mirror under one key of the source side."""

    handle: Handle
    feeder: bytes
    """Gid of the subscription on the other side that it stands for; b"" if none has this key."""
    rank: int
    """That of the subscription's profile."""


class _Flowing(NamedTuple):
    """Outlet of a publisher whose samples flow, and the way to it."""

    outlet: Outlet
    forward: Forward
    key: str
    """Key of its topic on the source side."""


class _Publication:
    """Publisher of the source side, as it is announced on the target side."""

    def __init__(self, token: EndpointToken, type_hash: str, announced: Announced) -> None:
        self.token, self.type_hash, self.announced = token, type_hash, announced
        self.latched = is_latched(token.qos)
        self.flowing: _Flowing | None = None


class TopicFlow:
    """One direction of a topic of one type: publishers of one side, subscriptions of the other.

    Args:
        source: Side of the publishers.
        target: Side of the subscriptions.
        later: Ways to do something later.
    """

    def __init__(self, source: Side, target: Side, later: Later) -> None:
        self._source, self._target, self._later = source, target, later
        self.crossing = Crossing(source, later)
        self._publications: dict[bytes, _Publication] = {}
        self._subscriptions: dict[bytes, _Subscription] = {}
        self._of_hash: dict[str, int] = {}
        """Number of subscriptions by their type's hash."""
        self._of_key: dict[str, tuple[dict[bytes, None], ...]] = {}
        """Subscriptions by their key on the source side, and by the ranks of their profiles."""
        self._users: dict[str, int] = {}
        """Number of publishers whose samples flow, by their key on the source side."""
        self._inlets: dict[str, _Inlet] = {}
        self._several = False

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

    def rehash(self, gid: bytes, token: EndpointToken, type_hash: str) -> None:
        """Announce something again with the hash that has become known; see `add`."""
        self.remove(gid, token)
        self.add(gid, token, type_hash)

    # Publishers

    def _add_publisher(self, gid: bytes, token: EndpointToken, type_hash: str) -> None:
        announced = self._target.announce(token, type_hash)
        self._publications[gid] = publication = _Publication(token, type_hash, announced)
        if self._is_read(token):
            self._open(gid, publication)

    def _remove_publisher(self, gid: bytes) -> None:
        publication = self._publications.pop(gid)
        self._close(gid, publication)
        self._target.withdraw(publication.announced, publication.token)

    def _is_read(self, token: EndpointToken) -> bool:
        hashes = self._of_hash
        return bool(hashes) and (token.type_hash == NO_HASH or token.type_hash in hashes or NO_HASH in hashes)

    def _open(self, gid: bytes, publication: _Publication) -> None:
        mirrored = publication.announced.token
        assert isinstance(mirrored, EndpointToken)
        outlet = self._target.transport.advertise(self._target.key(mirrored), mirrored.qos)
        # A latched one retains what nobody is there for yet.
        forward = Forward(outlet, publication.announced.sender, waits=not publication.latched)
        key = self._source.key(publication.token)
        publication.flowing = flowing = _Flowing(outlet, forward, key)
        self._source.lane.post(functools.partial(self.crossing.admit, gids_of(gid, publication.token), forward))
        self._users[key] = self._users.get(key, 0) + 1
        self._feed(key)
        if not publication.latched:
            self._await_match(publication, flowing, self._later.now() + MATCHED_WITHIN)

    def _await_match(self, publication: _Publication, flowing: _Flowing, deadline: float) -> None:
        """Open the outlet as soon as it is matched: in DDS, what is sent to an unmatched reader is lost to it."""
        if publication.flowing is not flowing:
            return
        if flowing.outlet.matched or self._later.now() >= deadline:
            self._source.lane.post(flowing.forward.open)
        else:
            again = functools.partial(self._await_match, publication, flowing, deadline)
            self._later.call_after(MATCHED_EVERY, again)

    def _close(self, gid: bytes, publication: _Publication) -> None:
        flowing, publication.flowing = publication.flowing, None

        def end() -> None:
            if flowing is not None:
                flowing.forward.open()
            self.crossing.dismiss(gids_of(gid, publication.token))
            if flowing is not None:
                flowing.outlet.close()

        self._source.lane.post(end)  # behind the samples that wait
        if flowing is not None:
            self._release(flowing.key)

    def _release(self, key: str) -> None:
        """Count one less of the publishers of a key whose samples flow."""
        self._users[key] -= 1
        if not self._users[key]:
            del self._users[key]
            self._feed(key)

    # Subscriptions

    def _add_subscription(self, gid: bytes, token: EndpointToken, type_hash: str) -> None:
        """Let flow what it wants, then announce it on the source side: who sees it there may publish at once."""
        key = self._source.key(token._replace(type_hash=type_hash))
        self._of_key.setdefault(key, ({}, {}, {}, {}))[_rank(token.qos)][gid] = None
        self._subscriptions[gid] = _Subscription(token, _NOT_YET, key)
        self._of_hash[token.type_hash] = self._of_hash.get(token.type_hash, 0) + 1
        if self._of_hash[token.type_hash] == 1:
            for each, publication in self._publications.items():
                if publication.flowing is None and self._is_read(publication.token):
                    self._open(each, publication)
        self._feed(key)
        self._subscriptions[gid] = _Subscription(token, self._source.announce(token, type_hash), key)

    def _remove_subscription(self, gid: bytes) -> None:
        """End its announcement, and the flows that nobody else wants."""
        token, announced, key = self._subscriptions.pop(gid)
        del self._of_key[key][_rank(token.qos)][gid]
        if not any(self._of_key[key]):
            del self._of_key[key]
        self._of_hash[token.type_hash] -= 1
        if not self._of_hash[token.type_hash]:
            del self._of_hash[token.type_hash]
            for each, publication in self._publications.items():
                if publication.flowing is not None and not self._is_read(publication.token):
                    self._stop(each, publication)
        self._feed(key)
        self._source.withdraw(announced, token)

    def _stop(self, gid: bytes, publication: _Publication) -> None:
        """End a flow that nobody wants.

        A latched one is announced anew: what it has retained would be too old for who comes next.
        """
        flowing, publication.flowing = publication.flowing, None
        assert flowing is not None
        # At once, and what is under way is dropped: behind a lane that is slow, who comes next would get it.
        flowing.outlet.close()
        self._source.lane.post(functools.partial(self.crossing.silence, gids_of(gid, publication.token)))
        self._release(flowing.key)
        if publication.latched:
            before = publication.announced
            publication.announced = self._target.announce(publication.token, publication.type_hash)
            self._target.withdraw(before, publication.token)

    # Inlets

    def _feed(self, key: str) -> None:
        """Subscribe under a key of the source side as is right now, or end that.

        An inlet stands for one of the subscriptions that are announced there, with the same profile: on DDS it is
        that one's reader which brings the samples, and one more would be seen as somebody's.
        """
        now, feeder = self._inlets.get(key), self._feeder(key)
        if feeder is None:
            if now is not None:
                del self._inlets[key]
                now.handle.close()
                self._sift_if_several()
            return
        gid, qos = feeder
        rank = _rank(qos)
        if now is not None and (now.rank, bool(now.feeder)) == (rank, bool(gid)) and self._is_there(now, key):
            return
        if now is not None:  # the next one may bring the same, and a latched one what there was before
            self._sift(1)
            self._later.call_after(SIFTED_FOR, functools.partial(self._sift, -1))
        self._sift_if_several(key)
        handle = self._source.transport.subscribe(key, qos, self._source.lane.sink(self.crossing))
        self._inlets[key] = _Inlet(handle, gid, rank)
        if now is not None:
            now.handle.close()

    def _feeder(self, key: str) -> tuple[bytes, QoSProfile] | None:
        """Return the subscription for which to subscribe under a key: the one that hears what all others do."""
        for gids in reversed(self._of_key.get(key, ())):
            for gid in gids:
                return gid, self._subscriptions[gid].token.qos
        if key not in self._users:
            return None
        # Publishers whose key is not that of the subscriptions, since one of the two has no hash.
        return b"", next(iter(self._subscriptions.values())).token.qos if self._subscriptions else QoSProfile(depth=10)

    def _is_there(self, inlet: _Inlet, key: str) -> bool:
        return not inlet.feeder or inlet.feeder in self._of_key[key][inlet.rank]

    def _sift_if_several(self, *more: str) -> None:
        """Drop what comes twice while there are inlets of several keys: some publishers send to two."""
        several = len({*self._inlets, *more}) > 1
        if several != self._several:
            self._several = several
            self._sift(1 if several else -1)

    def _sift(self, more: int) -> None:
        self._source.lane.post(functools.partial(self.crossing.sift, more))

    # Both

    def is_empty(self) -> bool:
        """True if nothing is left in this direction."""
        return not self._publications and not self._subscriptions

    def hashless(self, announced_on: Side) -> list[tuple[bytes, EndpointToken]]:
        """Return the announcements on a side without a hash, since nobody knew one."""
        return [(gid, each.token) for gid, each in self._announced_on(announced_on) if _has_none(each.announced.token)]

    def _announced_on(self, side: Side) -> Iterator[tuple[bytes, _Publication | _Subscription]]:
        yield from (self._publications if side is self._target else self._subscriptions).items()

    def flows(self) -> bool:
        """True if samples of some publisher go to the other side now."""
        return any(each.flowing is not None for each in [*self._publications.values()])

    def close(self) -> None:
        """End all that is declared."""
        for gid in [*self._publications]:
            self._remove_publisher(gid)
        for gid in [*self._subscriptions]:
            self._remove_subscription(gid)


def is_latched(qos: QoSProfile) -> bool:
    """True if an end of this profile has to do with samples that are retained for late joiners."""
    return qos.durability is DurabilityPolicy.TRANSIENT_LOCAL


def _rank(qos: QoSProfile) -> int:
    """Return how much a subscription of this profile hears, from 0 to 3: a latched or RELIABLE one hears more."""
    return 2 * is_latched(qos) + (qos.reliability is not ReliabilityPolicy.BEST_EFFORT)


def _has_none(token: Any) -> bool:
    return isinstance(token, EndpointToken) and token.type_hash == NO_HASH


_NOT_YET: Any = None
"""Announcement of a subscription for which all is being prepared."""
