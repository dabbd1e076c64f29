"""ROS graph of a domain: the nodes, and what they publish, subscribe to, serve and call."""

from __future__ import annotations

import functools
import threading
from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, TypeVar

from robolink.exceptions import WireError
from robolink.logging import get_logger
from robolink.system import clocks, waits
from robolink.system.terminal import shown
from robolink.wire import (
    NO_HASH,
    EndpointKind,
    EndpointToken,
    NodeToken,
    format_token,
    gid_of,
    graph_pattern,
    own_tokens,
    parse_token,
)

if TYPE_CHECKING:
    from robolink.transport.base import Handle, Transport

Token = NodeToken | EndpointToken
NamesAndTypes = list[tuple[str, list[str]]]
Follower = Callable[[bytes, EndpointToken, bool], object]
"""Function of the gid and token of an endpoint of one topic or service: True if it came, False if it went."""
Place = tuple[str, EndpointKind]
"""Name of a topic or service, and the kind of its endpoints."""

SETTLED_WITHIN = 0.1
"""Longest wait for what was announced before, in seconds; it takes 2 ms."""

MOST_OF_SESSION = 20_000
"""Most tokens of one session that are stored: a stranger could fill the memory by announcing nodes.

Each takes 1 kB here, and 5 kB in Zenoh in any case; a node has some 15.
"""

MOST = 100_000
"""Most tokens of all sessions of others: a peer may call its session as it likes."""

EVERY = ""
"""Name with which all topics, or all services, are followed."""

LONG_STANDING = 1.0
"""Age of a session, in seconds, after which it knows what was there before it."""


class Graph:
    """Cache of what is announced on a domain, kept up to date by the transport. Every query is answered from memory.

    What this session announces itself is known at once; the first query waits until what others had announced before
    is known too.
    """

    def __init__(self, transport: Transport, domain_id: int) -> None:
        self.malformed = 0
        """Number of announcements that could not be read."""
        self.too_many = 0
        """Number of announcements that were refused, since there are more than there may be."""
        self._transport, self._domain_id = transport, domain_id
        self._own = own_tokens(domain_id, transport.session_id)
        self._index = _Index()
        self._changed = threading.Condition()
        self._followers: dict[Place, tuple[_Following, ...]] = {}
        self._humble: tuple[bytes, EndpointToken] | None = None
        self._await_humble: dict[_Following, None] = {}
        """Followers of the first Humble peer, one for each service: removing one of so many must not look at all."""
        self._news: deque[Callable[[], object]] = deque()
        self._telling = threading.Lock()
        self._settling = threading.Lock()
        self.settled = not transport.threaded
        """True once what was there before this session is known."""
        self._begin = clocks.monotonic()
        self._watch = transport.watch(graph_pattern(domain_id), self._on_news)

    # What comes in

    def announce(self, token: Token, text: str = "") -> Handle:
        """Announce something of this session's own, until the handle is closed.

        `text` is the token as it is on the wire, for whoever has it already.
        """
        text = text or format_token(token)
        handle = self._transport.announce(text)
        gid = gid_of(text)
        self._change(gid, token, True, own=True)
        return _Announced(handle, functools.partial(self._change, gid, token, False))

    def _on_news(self, text: str, alive: bool) -> bool:
        """Note a token from the transport, on its thread; False for one that is not worth remembering."""
        if text.startswith(self._own):  # noted in its turn
            return True
        try:
            token = parse_token(text)
        except WireError as error:
            self.malformed += alive
            if alive and self.malformed == 1:
                get_logger("robolink.graph.graph").warning(
                    f"somebody on domain {self._domain_id} announces what cannot be read: {error}"
                    " (the next ones are only counted)"
                )
            return False
        return self._change(gid_of(text), token, alive)

    def _change(self, gid: bytes, token: Token, alive: bool, own: bool = False) -> bool:
        """Note a token that has come or gone; False if it came and there is no room: then it is not seen later."""
        with self._changed:
            index = self._index
            if alive == (gid in index.tokens):
                return True
            full = alive and not own and index.why_full(token.session)
            if full:
                self.too_many += 1
            else:
                (index.add if alive else index.remove)(gid, token)
                self._changed.notify_all()
                if isinstance(token, EndpointToken):
                    self._notify(gid, token, alive)
        if full:
            self._refuse(full, token)
            return False
        if self._news:
            self._tell()
        return True

    def _refuse(self, full: str, token: Token) -> None:
        """Warn of the first announcement that is not taken in."""
        if self.too_many == 1:
            get_logger("robolink.graph.graph").warning(
                f"{full} on domain {self._domain_id}: further ones are not seen, that of"
                f" {shown(token.full_node_name)} is the first"
            )

    def _notify(self, gid: bytes, token: EndpointToken, alive: bool) -> None:
        """Note whom to tell of an endpoint that has come or gone."""
        followers = self._followers.get((token.name, token.kind), ())
        followers += self._followers.get((EVERY, token.kind), ())
        if self._humble is None and token.type_hash == NO_HASH:
            self._humble = gid, token
            followers += tuple(self._await_humble)
            self._await_humble.clear()
        if followers:
            self._news.extend(each.notification(gid, token, alive) for each in followers)

    # Who wants to know

    def follow(self, name: str, kind: EndpointKind, follower: Follower) -> Handle:
        """Call `follower(gid, token, alive)` for each end of this kind of a topic or service, those there first.

        The name EVERY stands for all topics or services. One call at a time and in order, until the handle is closed:
        on the thread that brings the change, or on one that is just telling of another; so it may begin after this
        has returned.
        """
        place = (name, kind)
        following = _Following(follower, functools.partial(self._stop_following, place))
        with self._changed:
            self._followers[place] = (*self._followers.get(place, ()), following)
            self._news.extend(following.notification(gid, token, True) for gid, token in self._index.at(place).items())
        self._tell()
        return following

    def follow_first_humble(self, follower: Follower) -> Handle:
        """Call `follower(gid, token, True)` once, for an end of a Humble peer: at once if there has been one.

        Else when the first comes, as with `follow`.
        """
        following = _Following(follower, self._stop_awaiting_humble)
        with self._changed:
            known = self._humble
            if known is None:
                self._await_humble[following] = None
        if known is not None:
            following.notification(*known, True)()
        return following

    def _tell(self) -> None:
        # Outside the lock, since followers declare and publish; and nobody waits for whoever tells already.
        while self._news and self._telling.acquire(blocking=False):
            try:
                while self._news:
                    self._news.popleft()()
            finally:
                self._telling.release()
            self.wake()  # what followers have done since may be what somebody waits for

    def _stop_following(self, place: Place, following: _Following) -> None:
        with self._changed:
            rest = tuple(each for each in self._followers.get(place, ()) if each is not following)
            if rest:
                self._followers[place] = rest
            else:
                self._followers.pop(place, None)

    def _stop_awaiting_humble(self, following: _Following) -> None:
        with self._changed:
            self._await_humble.pop(following, None)

    def wait_for(self, condition: Callable[[], bool], timeout: float | None) -> bool:
        """Wait, in real time, until `condition()` holds; look whenever something changed."""
        self._settle()
        return waits.wait_for(self._changed, condition, timeout)

    def wake(self) -> None:
        """Wake the threads in `wait_for`, which look again."""
        with self._changed:
            self._changed.notify_all()

    # Questions

    def nodes(self) -> list[NodeToken]:
        """Return all nodes, sorted."""
        with self._knowing() as index:
            return sorted(set(index.nodes.values()))

    def endpoints(self, *kinds: EndpointKind, name: str | None = None) -> list[EndpointToken]:
        """Return all endpoints of these kinds; of one topic or service, if named."""
        with self._knowing() as index:
            if name is None:
                return [each for each in index.endpoints.values() if each.kind in kinds]
            return [each for kind in kinds for each in index.at((name, kind)).values()]

    def gids(self, kind: EndpointKind, name: str) -> list[tuple[bytes, EndpointToken]]:
        """Return all endpoints of this kind that one topic or service has, each with its gid."""
        with self._knowing() as index:
            return list(index.at((name, kind)).items())

    def of_node(self, node_name: str, namespace: str, kind: EndpointKind) -> list[EndpointToken]:
        """Return the endpoints of a node."""
        with self._knowing() as index:
            found = index.by_node.get((node_name, namespace), {}).values()
            return [each for each in found if isinstance(each, EndpointToken) and each.kind is kind]

    def has_node(self, node_name: str, namespace: str) -> bool:
        """True if anything of this node is announced."""
        with self._knowing() as index:
            return (node_name, namespace) in index.by_node

    def count(self, kind: EndpointKind, name: str) -> int:
        """Return the number of endpoints of this kind that one topic or service has."""
        return len(self.endpoints(kind, name=name))

    def endpoint_of(self, gid: bytes) -> EndpointToken | None:
        """Return the endpoint of this gid, as far as is known now."""
        return self._index.endpoints.get(gid)

    @contextmanager
    def _knowing(self) -> Iterator[_Index]:
        self._settle()
        with self._changed:
            yield self._index

    def _settle(self) -> None:
        """Wait, once, until what was there before this session is known."""
        if self.settled:
            return
        with self._settling:
            if not self.settled and clocks.monotonic() - self._begin < LONG_STANDING:
                # A token that is lost just now costs the wait.
                known = set(self._readable(self._transport.tokens(graph_pattern(self._domain_id))))
                with self._changed:
                    self._changed.wait_for(lambda: known <= self._index.tokens.keys(), SETTLED_WITHIN)
            self.settled = True

    def _readable(self, texts: Iterable[str]) -> Iterable[bytes]:
        for text in texts:
            try:
                parse_token(text)
            except WireError:
                continue
            yield gid_of(text)


class _Index:
    """Index of the tokens that are alive: by their gids, by topic or service, and by node."""

    def __init__(self) -> None:
        self.tokens: dict[bytes, Token] = {}
        self.nodes: dict[bytes, NodeToken] = {}
        self.endpoints: dict[bytes, EndpointToken] = {}
        self.by_place: dict[Place, dict[bytes, EndpointToken]] = {}
        self.by_node: dict[tuple[str, str], dict[bytes, Token]] = {}
        self.of_session: Counter[str] = Counter()

    def why_full(self, session: str) -> str:
        """Return why nothing more of a session is taken in, '' if there is room."""
        if self.of_session[session] >= MOST_OF_SESSION:
            return f"session {session} announces more than {MOST_OF_SESSION:,} nodes, topics and services"
        if len(self.tokens) >= MOST:
            return f"there are more than {MOST:,} nodes, topics and services"
        return ""

    def add(self, gid: bytes, token: Token) -> None:
        self.tokens[gid] = token
        self.of_session[token.session] += 1
        self.by_node.setdefault((token.node_name, token.namespace), {})[gid] = token
        if isinstance(token, EndpointToken):
            self.endpoints[gid] = token
            self.by_place.setdefault((token.name, token.kind), {})[gid] = token
        else:
            self.nodes[gid] = token

    def remove(self, gid: bytes, token: Token) -> None:
        del self.tokens[gid]
        self.of_session[token.session] -= 1
        if not self.of_session[token.session]:
            del self.of_session[token.session]
        _drop(self.by_node, (token.node_name, token.namespace), gid)
        if isinstance(token, EndpointToken):
            del self.endpoints[gid]
            _drop(self.by_place, (token.name, token.kind), gid)
        else:
            del self.nodes[gid]

    def at(self, place: Place) -> Mapping[bytes, EndpointToken]:
        name, kind = place
        if name == EVERY:
            return {gid: each for gid, each in self.endpoints.items() if each.kind is kind}
        return self.by_place.get(place, {})


class _Following:
    """Registration of a follower, until closed."""

    def __init__(self, follower: Follower, stop: Callable[[_Following], None]) -> None:
        self._follower: Follower | None = follower
        self._stop = stop

    def notification(self, gid: bytes, token: EndpointToken, alive: bool) -> Callable[[], object]:
        """Return the call of the follower, to be made in its turn."""
        return functools.partial(self._tell, gid, token, alive)

    def _tell(self, gid: bytes, token: EndpointToken, alive: bool) -> None:
        follower = self._follower
        if follower is None:
            return
        try:
            follower(gid, token, alive)
        except Exception as error:  # noqa: BLE001 - it may be anybody's, and the others want to hear of it too
            what = f"{token.full_node_name}, which has {token.name} and {'came' if alive else 'went'}"
            get_logger("robolink.graph.graph").error(
                f"whoever was told of {what}, failed: {type(error).__name__}: {error}"
            )

    def close(self) -> None:
        """End the following; another thread may be in the midst of a call. Safe to call twice."""
        self._follower = None
        self._stop(self)


class _Announced:
    """Handle of an announcement of this session."""

    def __init__(self, handle: Handle, forget: Callable[[], object]) -> None:
        self._handle, self._forget = handle, forget

    def close(self) -> None:
        """End the announcement. Safe to call twice."""
        self._handle.close()
        self._forget()


KeyT = TypeVar("KeyT")
ValueT = TypeVar("ValueT")


def _drop(table: dict[KeyT, dict[bytes, ValueT]], key: KeyT, gid: bytes) -> None:
    del table[key][gid]
    if not table[key]:
        del table[key]


def names_and_types(endpoints: Iterable[EndpointToken]) -> NamesAndTypes:
    """Group endpoints by name; each with the types it is used with, both sorted."""
    found: dict[str, set[str]] = {}
    for endpoint in endpoints:
        found.setdefault(endpoint.name, set()).add(endpoint.type_name)
    return [(name, sorted(types)) for name, types in sorted(found.items())]
