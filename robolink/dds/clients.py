"""Clients on DDS: each writes requests and reads replies, among which it finds its own."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable
from typing import TYPE_CHECKING

from robolink.dds.calls import Call
from robolink.dds.forms import Header, has_header, split_header, with_header
from robolink.dds.names import Role
from robolink.dds.nodes import Guids
from robolink.dds.profiles import announced
from robolink.dds.streams import Stream
from robolink.qos import QoSProfile
from robolink.rtps import Endpoint, Info
from robolink.system import clocks
from robolink.system.waits import fork_lock
from robolink.wire import fields_of, is_attachment, pack_attachment

if TYPE_CHECKING:
    from robolink.dds.services import Services
    from robolink.rtps import Writer

_Number = tuple[bool, int]
"""Number of a request, and whether it went out with a header: the two are counted apart."""


class Client:
    """A client on DDS: a reader of replies and a writer of requests, a second one where servers expect a header."""

    def __init__(self, services: Services, stream: Stream, qos: QoSProfile, gid: bytes = b"") -> None:
        self.stream, self.gid, self._services = stream, gid, services
        self.on_guids: Callable[[], object] = lambda: None
        self._lock = fork_lock()
        self._calls: dict[_Number, tuple[Call, bytes]] = {}
        """Calls by the number of their request, each with the request's attachment."""
        self._qos = announced(qos)
        self._id = int.from_bytes(os.urandom(8), "little")
        """Id of this client in headers."""
        self._numbers = itertools.count(1)
        topic, type_name = stream.place_of(Role.REPLY)
        self._replies = services.participant.reader(
            topic, type_name, self._qos, self._on_reply, user_data=services.user_data(stream, Role.REPLY)
        )
        self._requests = self._make_writer(headers=False)
        self._with_headers: Writer | None = None

    def _make_writer(self, *, headers: bool) -> Writer:
        topic, type_name = self.stream.place_of(Role.REQUEST)
        return self._services.participant.writer(
            topic,
            type_name,
            self._qos,
            user_data=self._services.user_data(self.stream, Role.REQUEST),
            accepts=lambda reader: has_header(reader.vendor) == headers,
            on_match=self._on_server,
        )

    def speak_with_headers(self) -> None:
        """Write to servers that expect a header, too, from now on."""
        with self._lock:
            if self._with_headers is not None:
                return
            self._with_headers = self._make_writer(headers=True)
        self.on_guids()

    @property
    def guids(self) -> Guids:
        """GUIDs of what it has on DDS."""
        more = () if self._with_headers is None else (self._with_headers.guid,)
        return Guids((self._replies.guid,), (self._requests.guid, *more))

    def send(self, call: Call, payload: bytes, attachment: bytes) -> None:
        """Send a request to all servers that are matched; the call expects an answer of each."""
        with self._lock:  # the reply may come before the request's number is noted
            if servers := self._requests.matched():
                # rmw_fastrtps's servers wait for the reader that this names: one not matched yet gets no reply.
                number = self._requests.put(payload, related=(self._replies.guid, 0))
                self._note(call, servers, (False, number), attachment)
            if self._with_headers is not None and (servers := self._with_headers.matched()):
                number = next(self._numbers)
                self._note(call, servers, (True, number), attachment)
                self._with_headers.put(with_header(payload, Header(self._id, number)))
        self._replies.expect()

    def _note(self, call: Call, servers: list[bytes], number: _Number, attachment: bytes) -> None:
        for guid in servers:
            call.expect(guid)
        self._calls[number] = call, attachment
        call.on_over.append(lambda: self._calls.pop(number, None))

    def _on_reply(self, payload: bytes, info: Info) -> None:
        """Find the call of a reply; all clients read all replies."""
        if has_header(self._services.vendor_of(info.writer)):
            split = split_header(payload)
            if split is None or split[0].client != self._id:
                return
            number, payload = (True, split[0].number), split[1]
        else:
            related = info.related
            if related is None or related[0] not in (self._replies.guid, self._requests.guid):
                return
            number = (False, related[1])
        with self._lock:
            found = self._calls.get(number)
        if found is not None:
            call, attachment = found
            call.answer(payload, self._reply_attachment(attachment, info))
            call.finish_one_of(info.writer[:12])
        if self._calls:
            self._replies.expect()

    def _reply_attachment(self, requested: bytes, info: Info) -> bytes:
        """Return the attachment of a reply: as over Zenoh, the request's number and its client's gid."""
        stamp = info.timestamp or clocks.now()
        if is_attachment(requested):
            number, _, _, gid = fields_of(requested)
            return pack_attachment(number, stamp, gid)
        return pack_attachment(info.number, stamp, info.writer)

    def _on_server(self, reader: Endpoint, came: bool) -> None:
        if not came:
            for call in self._under_way():
                call.finish(reader.guid)

    def _under_way(self) -> list[Call]:
        with self._lock:
            return [call for call, _ in self._calls.values()]

    def withdraw(self) -> None:
        """End the client and its calls."""
        self._services.remove(self)
        for call in self._under_way():
            call.end()
        for endpoint in (self._requests, self._replies, self._with_headers):
            if endpoint is not None:
                endpoint.close()
