"""Services of a mirror: servers of one side are announced and served on the other, where each call is passed on."""

from __future__ import annotations

from collections import Counter
from typing import Any

from robolink.dds.mirror.sides import Announced, Later, Side
from robolink.exceptions import TransportError
from robolink.transport.base import Handle, Query
from robolink.wire import NO_HASH, EndpointKind, EndpointToken, answer_to, gid_in, is_attachment, numbers_in

REHASHED_FOR = 2.0
"""Time in seconds for which a service is still served without the hash of its type, once that is known."""

MOST_CALLS = 1000
"""Most calls of one service that are under way; beyond it the oldest ends unanswered."""


class PassedCall:
    """Call under way, from one side's client to the other side's servers."""

    droppable = False

    def __init__(self, flow: ServiceFlow, query: Query, caller: bytes, key: str) -> None:
        self.caller, self.key = caller, key
        """Gid of the client, and key of the servers."""
        self._flow, self._query = flow, query
        self.handle: Handle | None = None

    def deliver(self, content: Any) -> None:
        """Pass an answer back, on the lane of the servers' side; None is the end of all answers."""
        if content is None:
            self.end()
            return
        try:
            sample = self._flow.source.transport.read(content)
        except TransportError:  # an error in place of an answer: another server may do better, and the end comes
            return
        # Callers find their call by its number, and by who request: both are as the caller sent them.
        self._query.reply(sample.payload, answer_to(self._query.attachment, sample.attachment))

    def end(self) -> None:
        """End it on both sides, answered or not. Safe to call twice."""
        self._flow.calls.pop(self, None)
        if self.handle is not None:
            self.handle.close()
        self._query.close()


class _Serving:
    """Service on the target side under one key, behind which are the servers of the source side."""

    droppable = False

    def __init__(self, flow: ServiceFlow, key: str) -> None:
        self._flow = flow
        self.sources: Counter[str] = Counter()
        """Number of servers on the source side by their key there; it has been empty since the last of them went."""
        side = flow.target
        self.handle = side.transport.serve(key, side.lane.sink(self))

    def deliver(self, content: Any) -> None:
        """Pass a call on, on the lane of the clients' side."""
        flow = self._flow
        query = flow.target.transport.accept(content)
        request, caller = query.attachment, gid_in(query.attachment)
        # An echo: the mirror calls there in the name of its own clients, and the call comes to its own server too.
        if caller in flow.target.own or not is_attachment(request):
            query.close()
            return
        key = next(iter(self.sources), "")
        if not key:
            query.close()
            return
        flow.make_room()
        call = PassedCall(flow, query, caller, key)
        flow.calls[call] = None
        attachment = numbers_in(request) + flow.sender_of(caller)
        sink = flow.source.lane.sink(call)
        try:
            call.handle = flow.source.transport.call(key, query.payload, attachment, sink)
        except BaseException:
            call.end()
            raise
        if call not in flow.calls:  # it has ended meanwhile
            call.handle.close()


class ServiceFlow:
    """One direction of a service of one type: servers of one side, clients of the other.

    Args:
        source: Side of the servers.
        target: Side of the clients.
        later: Ways to do something later.
    """

    def __init__(self, source: Side, target: Side, later: Later) -> None:
        self.source, self.target, self._later = source, target, later
        self.calls: dict[PassedCall, None] = {}
        """Calls under way, the oldest first."""
        self._servers: dict[bytes, tuple[EndpointToken, Announced]] = {}
        self._clients: dict[bytes, tuple[EndpointToken, Announced]] = {}
        self._serving: dict[str, _Serving] = {}

    def add(self, gid: bytes, token: EndpointToken, type_hash: str) -> None:
        """Mirror a server of the source side, or a client of the target side.

        Args:
            gid: Its gid on its own side.
            token: Its token there.
            type_hash: Hash to announce it with on the other side.
        """
        if token.kind is EndpointKind.SERVICE:
            self._add_server(gid, token, type_hash)
        else:
            self._clients[gid] = token, self.source.announce(token, type_hash)

    def remove(self, gid: bytes, token: EndpointToken) -> None:
        """End what `add` has made."""
        if token.kind is EndpointKind.SERVICE:
            self._remove_server(gid)
        else:
            self._remove_client(gid)

    def flows(self) -> bool:
        """True if the target side can call a server of the source side."""
        return bool(self._servers)

    def _add_server(self, gid: bytes, token: EndpointToken, type_hash: str) -> None:
        """Serve it on the target side, and announce it there."""
        key = self.target.key(token._replace(type_hash=type_hash))
        if key not in self._serving:
            # One for all servers of the name: a call reaches each of them once, as it does on their own side.
            self._serving[key] = _Serving(self, key)
        self._serving[key].sources[self.source.key(token)] += 1
        self._servers[gid] = token, self.target.announce(token, type_hash)

    def _remove_server(self, gid: bytes) -> None:
        """End its announcement; with the last one end the calls that wait for an answer, too."""
        source_key = self.source.key(self._servers[gid][0])
        self._close_if_unused(self._withdraw(gid))
        if source_key not in {self.source.key(token) for token, _ in self._servers.values()}:
            self._end_calls(lambda call: call.key == source_key)

    def rehash(self, gid: bytes, token: EndpointToken, type_hash: str) -> None:
        """Announce something again with the hash that has become known; see `add`."""
        if token.kind is not EndpointKind.SERVICE:
            self.remove(gid, token)
            self.add(gid, token, type_hash)
            return
        key = self._withdraw(gid)
        serving = self._serving[key]
        self._add_server(gid, token, type_hash)
        # Whose client has made the hash known, has seen the server without it, and may be calling that just now.
        serving.sources[self.source.key(token)] += 1

        def end() -> None:
            serving.sources -= Counter([self.source.key(token)])
            if self._serving.get(key) is serving:
                self._close_if_unused(key)

        self._later.call_after(REHASHED_FOR, end)

    def _withdraw(self, gid: bytes) -> str:
        """End the announcement of a server; return the key of its service on the target side."""
        token, announced = self._servers.pop(gid)
        self.target.withdraw(announced, token)
        mirrored = announced.token
        assert isinstance(mirrored, EndpointToken)
        key = self.target.key(mirrored)
        self._serving[key].sources -= Counter([self.source.key(token)])
        return key

    def _close_if_unused(self, key: str) -> None:
        if not self._serving[key].sources:
            self._serving.pop(key).handle.close()

    def _remove_client(self, gid: bytes) -> None:
        """End its announcement, and its calls."""
        token, announced = self._clients.pop(gid)
        self.source.withdraw(announced, token)
        self._end_calls(lambda call: call.caller == gid)

    def sender_of(self, caller: bytes) -> bytes:
        """Return the end of the attachments of a client's calls on the source side."""
        client = self._clients.get(caller)
        return client[1].sender if client is not None else self.source.sender_of_nobody

    def make_room(self) -> None:
        """End the oldest call if there are too many."""
        if len(self.calls) >= MOST_CALLS:
            next(iter(self.calls)).end()

    def _end_calls(self, which: Any) -> None:
        for call in [each for each in list(self.calls) if which(each)]:
            call.end()

    def is_empty(self) -> bool:
        """True if nothing is left in this direction."""
        return not self._servers and not self._clients

    def hashless(self, announced_on: Side) -> list[tuple[bytes, EndpointToken]]:
        """Return the announcements on a side without a hash, since nobody knew one."""
        table = self._servers if announced_on is self.target else self._clients
        return [
            (gid, token)
            for gid, (token, announced) in table.items()
            if isinstance(announced.token, EndpointToken) and announced.token.type_hash == NO_HASH
        ]

    def close(self) -> None:
        """End all that is declared, and all calls."""
        self._end_calls(lambda call: True)
        for gid in list(self._servers):
            self._remove_server(gid)
        for key in list(self._serving):
            self._serving.pop(key).handle.close()
        for gid in list(self._clients):
            self._remove_client(gid)
