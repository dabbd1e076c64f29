"""Services over DDS: the servers and clients of one session, and the calls that stay within it.

A client comes with its token, and a call finds it by the gid in the attachment; a server comes with whichever is first,
the service or its token.
"""

from __future__ import annotations

import contextlib
import weakref
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robolink.dds.calls import Call, LocalQuery
from robolink.dds.clients import Client
from robolink.dds.forms import has_header
from robolink.dds.hashes import Hashes
from robolink.dds.names import Role, user_data_of
from robolink.dds.servers import DEFAULT, Server
from robolink.dds.streams import Place, Stream, stream_of
from robolink.rtps import Endpoint, Peer
from robolink.system.waits import fork_lock
from robolink.transport import lifetime
from robolink.transport.base import Sink, refuse_giant
from robolink.transport.gates import close_gate, make_gate
from robolink.wire import NO_HASH, EndpointToken, gid_in

if TYPE_CHECKING:
    from robolink.rtps import Participant

_OF_SERVICES = (f"{Role.REQUEST.value}/", f"{Role.REPLY.value}/")
_PARTS = {Role.REQUEST: "Request", Role.REPLY: "Response"}


class Services:
    """Servers and clients of one session."""

    participant: Participant
    """Participant of the session, set once before anything is declared."""

    def __init__(self, gids: dict[bytes, bytes], hashes: Hashes) -> None:
        """Make it, without any.

        Args:
            gids: Global ids of others' endpoints by their GUIDs; one that is not there goes by its GUID.
            hashes: Table in which the hashes of the session's own types are noted.
        """
        self.gids, self._hashes = gids, hashes
        self._lock = fork_lock()
        self._why_closed = ""
        self._servers: dict[tuple[str, str], list[Server]] = {}
        self._handles: dict[str, tuple[Serving, ...]] = {}
        """Services of this session by their keys."""
        self._clients: dict[bytes, Client] = {}
        self._anonymous: dict[Place, Client] = {}
        self._others: dict[Place, dict[bytes, bytes]] = {}
        """Readers of requests and of replies of others, by topic and type; then their vendors by their GUIDs."""
        self._vendors: dict[bytes, bytes] = {}
        """Vendor of each participant, by its prefix."""
        self._calls: weakref.WeakSet[Call] = weakref.WeakSet()

    def user_data(self, stream: Stream, role: Role) -> bytes:
        """Return the user data of one end of a service, which has the hash of the request or the response."""
        return user_data_of(self._hashes.of_part(stream.type_name, _PARTS[role]))

    # Servers

    def serve(self, key: str, sink: Sink) -> Serving:
        """Declare a service."""
        stream, gate = stream_of(key), make_gate(sink)
        with self._declaring(stream):
            serving = Serving(self, key, gate, None if self._is_second(stream) else self._feed(stream, gate))
            self._handles[key] = (*self._handles.get(key, ()), serving)
            return serving

    def announce_service(self, token: EndpointToken, stream: Stream) -> Server:
        """Make the server of an announced service, or take that of a service which has no token yet."""
        with self._declaring(stream):
            for server in self._servers.get((stream.name, stream.type_name), ()):
                if not server.has_token and server.stream == stream:
                    server.take_token(token.qos)
                    return server
            server = self._make(Server(self, stream, token.qos))
            server.has_token = True
            return server

    def _feed(self, stream: Stream, gate: Sink) -> Server:
        for server in self._servers.get((stream.name, stream.type_name), ()):
            if server.is_free and server.stream == stream:
                server.feed(gate)
                return server
        return self._make(Server(self, stream, DEFAULT, gate))

    def _make(self, server: Server) -> Server:
        self._servers.setdefault((server.stream.name, server.stream.type_name), []).append(server)
        self.introduce(server)
        return server

    def introduce(self, one: Server | Client) -> None:
        """Let a server or client speak with headers if such peers are there."""
        role = Role.REPLY if isinstance(one, Server) else Role.REQUEST
        if any(map(has_header, self._others.get(one.stream.place_of(role), {}).values())):
            one.speak_with_headers()

    def _is_second(self, stream: Stream) -> bool:
        """Return whether DDS has no such key: Humble's, beside the one with a hash."""
        others = self._servers.get((stream.name, stream.type_name), ())
        return stream.type_hash == NO_HASH and any(each.stream.type_hash != NO_HASH for each in others)

    # Calls

    def announce_client(self, token: EndpointToken, stream: Stream, gid: bytes) -> Client:
        """Make an announced client."""
        with self._declaring(stream):
            client = self._clients[gid] = Client(self, stream, token.qos, gid)
            self.introduce(client)
            return client

    def call(self, key: str, payload: bytes, attachment: bytes, sink: Sink) -> Call:
        """Send a request to all servers of a key."""
        refuse_giant(key, payload)
        stream = stream_of(key)
        with self._declaring(stream):
            call = Call(key, sink, self._calls.discard)
            self._calls.add(call)
            client = self._clients.get(gid_in(attachment)) or self._without_token(stream)
            here = self._handles.get(key, ())
        for serving in here:
            serving.ask(payload, attachment, call)
        if client is not None:
            client.send(call, payload, attachment)
        call.sent()
        return call

    def _without_token(self, stream: Stream) -> Client | None:
        """Return a client for callers that belong to no node; None where nobody could answer it."""
        place = stream.place_of(Role.REQUEST)
        if place not in self._others:
            return None
        if place not in self._anonymous:
            self._anonymous[place] = Client(self, stream, DEFAULT)
            self.introduce(self._anonymous[place])
        return self._anonymous[place]

    # Others

    def on_endpoint(self, endpoint: Endpoint, came: bool) -> None:
        """Note an endpoint of another participant."""
        if endpoint.is_writer or not endpoint.topic.startswith(_OF_SERVICES):
            return
        place = endpoint.topic, endpoint.type_name
        with self._lock:
            there = self._others.setdefault(place, {})
            if came:
                there[endpoint.guid] = endpoint.vendor
            else:
                there.pop(endpoint.guid, None)
                if not there:
                    del self._others[place]
            if came and has_header(endpoint.vendor):
                for each in self._all():
                    self.introduce(each)

    def _all(self) -> list[Server | Client]:
        servers = [each for some in self._servers.values() for each in some]
        return [*servers, *self._clients.values(), *self._anonymous.values()]

    def vendor_of(self, guid: bytes) -> bytes:
        """Return the vendor of an endpoint's participant; empty if that has gone."""
        return self._vendors.get(guid[:12], b"")

    def on_peer(self, peer: Peer, came: bool) -> None:
        """Note that a participant came or went."""
        if came:
            self._vendors[peer.prefix] = peer.vendor
        else:
            self._vendors.pop(peer.prefix, None)
            with self._lock:
                servers = [each for some in self._servers.values() for each in some]
            for server in servers:
                server.forget(peer.prefix)

    # The end

    @contextlib.contextmanager
    def _declaring(self, stream: Stream) -> Iterator[None]:
        with self._lock:
            if self._why_closed:
                raise lifetime.closed(self._why_closed)
            self._hashes.note(stream.type_name, stream.type_hash)
            yield

    def remove(self, declared: Serving | Server | Client) -> None:
        """Forget what is closed."""
        with self._lock:
            if isinstance(declared, Serving):
                left = tuple(each for each in self._handles.get(declared.key, ()) if each is not declared)
                if left:
                    self._handles[declared.key] = left
                else:
                    self._handles.pop(declared.key, None)
            elif isinstance(declared, Client):
                self._clients.pop(declared.gid, None)
            else:
                place = declared.stream.name, declared.stream.type_name
                others = [each for each in self._servers.get(place, ()) if each is not declared]
                if others:
                    self._servers[place] = others
                else:
                    self._servers.pop(place, None)

    def close(self, why: str) -> None:
        """End all calls, and serve no more."""
        with self._lock:
            self._why_closed = why
            calls = [*self._calls]
            servings = [each for some in self._handles.values() for each in some]
        for serving in servings:
            serving.shut()
        for call in calls:
            call.end()


class Serving:
    """A service of this session: its sink, and the server that feeds it from DDS."""

    def __init__(self, services: Services, key: str, gate: Sink, server: Server | None) -> None:
        self.key, self._services, self._gate, self._server = key, services, gate, server

    def ask(self, payload: bytes, attachment: bytes, call: Call) -> None:
        """Hand over a request of this session's own."""
        self._gate(LocalQuery(payload, attachment, call))

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        self.shut()
        if (server := self._server) is not None:
            self._server = None
            server.starve()
        self._services.remove(self)

    def shut(self) -> None:
        """Let nothing through any more."""
        close_gate(self._gate)
