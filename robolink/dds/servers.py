"""Servers on DDS: each reads requests and writes replies, which name the request that they answer."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.dds.forms import Header, has_header, split_header, with_header
from robolink.dds.names import Role
from robolink.dds.nodes import Guids
from robolink.dds.profiles import announced
from robolink.dds.streams import Stream
from robolink.qos import QoSProfile, qos_profile_services_default
from robolink.rtps import Endpoint, Info
from robolink.system import clocks
from robolink.system.waits import fork_lock
from robolink.transport.base import Sink, refuse_giant
from robolink.wire import pack_attachment

if TYPE_CHECKING:
    from robolink.dds.services import Services
    from robolink.rtps import Writer

_MOST_HELD = 100
"""Most requests that wait for a sink, and most replies that wait for their client's reader."""

_NOBODY = bytes(16)


class Identity(NamedTuple):
    """Identity that a reply names: whom it answers, and which request."""

    client: bytes
    """GUID of the reader for which the reply is meant; of the writer of the request if that did not name one."""
    number: int
    is_reader: bool = False
    """True if it is the reader's."""
    header: Header | None = None
    """Header of the request, which the reply repeats."""


def identity_of(info: Info) -> Identity:
    """Return the identity that a reply to this request names.

    rmw_fastrtps's clients put the GUID of the reader of their replies in the request's related identity.
    """
    if info.related is not None and info.related[0] != _NOBODY:
        return Identity(info.related[0], info.number, is_reader=True)
    return Identity(info.writer, info.number)


class Server:
    """A service on DDS: a reader of requests and a writer of replies, a second one where clients expect a header."""

    def __init__(self, services: Services, stream: Stream, qos: QoSProfile, gate: Sink | None = None) -> None:
        self.stream, self.has_token = stream, False
        self.on_guids: Callable[[], object] = lambda: None
        self._services, self._gate = services, gate
        self._lock = fork_lock()
        self._held: deque[RemoteQuery] = deque(maxlen=_MOST_HELD)
        self._clients: set[bytes] = set()
        """Readers of replies that are matched."""
        self._waiting: deque[tuple[Identity, bytes]] = deque(maxlen=_MOST_HELD)
        """Replies whose client's reader is not matched yet."""
        self._qos = announced(qos)
        self._open()

    def _open(self) -> None:
        self._replies = self._make_writer(headers=False)
        self._with_headers: Writer | None = None
        topic, type_name = self.stream.place_of(Role.REQUEST)
        self._requests = self._services.participant.reader(
            topic, type_name, self._qos, self._on_request, user_data=self._services.user_data(self.stream, Role.REQUEST)
        )

    def _make_writer(self, *, headers: bool) -> Writer:
        topic, type_name = self.stream.place_of(Role.REPLY)
        return self._services.participant.writer(
            topic,
            type_name,
            self._qos,
            user_data=self._services.user_data(self.stream, Role.REPLY),
            accepts=lambda reader: has_header(reader.vendor) == headers,
            on_match=self._on_client,
        )

    def speak_with_headers(self) -> None:
        """Write to clients that expect a header, too, from now on."""
        with self._lock:
            if self._with_headers is not None:
                return
            self._with_headers = self._make_writer(headers=True)
        self.on_guids()

    @property
    def is_free(self) -> bool:
        """True if nobody has what comes here."""
        return self._gate is None

    @property
    def guids(self) -> Guids:
        """GUIDs of what it has on DDS."""
        more = () if self._with_headers is None else (self._with_headers.guid,)
        return Guids((self._requests.guid,), (self._replies.guid, *more))

    def take_token(self, qos: QoSProfile) -> None:
        """Belong to an announced service, with its profile."""
        self.has_token = True
        if announced(qos) != self._qos:
            self._close_endpoints()
            self._qos = announced(qos)
            self._open()
            self._services.introduce(self)

    # Requests

    def _on_request(self, payload: bytes, info: Info) -> None:
        gid = self._services.gids.get(info.writer, info.writer)
        attachment = pack_attachment(info.number, info.timestamp or clocks.now(), gid)
        identity = identity_of(info)
        if has_header(self._services.vendor_of(info.writer)):
            split = split_header(payload)
            if split is None:
                return  # not a request
            header, payload = split
            identity = Identity(info.writer, info.number, header=header)
        query = RemoteQuery(self, payload, attachment, identity)
        gate = self._gate
        if gate is None:
            self._hold(query)
        else:
            gate(query)

    def _hold(self, query: RemoteQuery) -> None:
        with self._lock:
            if (gate := self._gate) is not None:
                gate(query)
            else:
                self._held.append(query)

    def feed(self, gate: Sink) -> None:
        """Hand requests to a sink from now on, first those that were held."""
        with self._lock:
            while self._held:
                gate(self._held.popleft())
            self._gate = gate

    def starve(self) -> None:
        """Hand requests to nobody; without a token it ends."""
        self._gate = None
        if not self.has_token:
            self._close()

    def withdraw(self) -> None:
        """Withdraw the token; without a sink it ends."""
        self.has_token = False
        if self.is_free:
            self._close()

    # Replies

    def reply(self, identity: Identity, payload: bytes) -> None:
        """Send a reply; it waits until its client's reader is matched, since one that is not gets nothing ever."""
        refuse_giant(f"the answer to a call of {self.stream.key}", payload)
        with self._lock:
            if not self._is_met(identity):
                self._waiting.append((identity, payload))
                return
        self._send(identity, payload)

    def _is_met(self, identity: Identity) -> bool:
        if identity.is_reader:
            return identity.client in self._clients
        return any(each[:12] == identity.client[:12] for each in self._clients)

    def _send(self, identity: Identity, payload: bytes) -> None:
        if identity.header is None:
            self._replies.put(payload, related=(identity.client, identity.number))
        elif self._with_headers is not None:
            self._with_headers.put(with_header(payload, identity.header))

    def _on_client(self, reader: Endpoint, came: bool) -> None:
        with self._lock:
            if not came:
                self._clients.discard(reader.guid)
                return
            self._clients.add(reader.guid)
            met = [each for each in self._waiting if self._is_met(each[0])]
            for each in met:
                self._waiting.remove(each)
        for each in met:
            self._send(*each)

    def forget(self, prefix: bytes) -> None:
        """Drop the replies for a participant that is gone."""
        with self._lock:
            for each in [each for each in self._waiting if each[0].client[:12] == prefix]:
                self._waiting.remove(each)

    # The end

    def _close(self) -> None:
        self._services.remove(self)
        self._close_endpoints()

    def _close_endpoints(self) -> None:
        for endpoint in (self._requests, self._replies, self._with_headers):
            if endpoint is not None:
                endpoint.close()
        self._clients.clear()


class RemoteQuery:
    """Server's side of a call from another participant."""

    def __init__(self, server: Server, payload: bytes, attachment: bytes, identity: Identity) -> None:
        self.payload, self.attachment = payload, attachment
        self._server: Server | None = server
        self._identity = identity

    def reply(self, payload: bytes, attachment: bytes) -> None:
        """Send the reply, from any thread; DDS has one to a request. Does nothing when the caller is gone."""
        server, self._server = self._server, None
        if server is not None:
            server.reply(self._identity, payload)

    def close(self) -> None:
        """Finish the call. A caller that got no reply is not told: DDS has no sign for that."""
        self._server = None


DEFAULT: Any = qos_profile_services_default
"""Profile of a service or client of which no token says another."""
