"""Clients on DDS: each writes requests and reads replies, among which it finds its own."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from robolink.dds.calls import Call
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


class Client:
    """A client on DDS: a writer of requests and a reader of replies, with the calls under way."""

    on_guids: Callable[[], object]

    def __init__(self, services: Services, stream: Stream, qos: QoSProfile, gid: bytes = b"") -> None:
        self.stream, self.gid, self._services = stream, gid, services
        self._lock = fork_lock()
        self._calls: dict[int, tuple[Call, bytes]] = {}
        """Calls by the number of their request, each with the request's attachment."""
        participant, requested = services.participant, announced(qos)
        topic, type_name = stream.place_of(Role.REPLY)
        self._replies = participant.reader(
            topic, type_name, requested, self._on_reply, user_data=services.user_data(stream, Role.REPLY)
        )
        topic, type_name = stream.place_of(Role.REQUEST)
        self._requests = participant.writer(
            topic, type_name, requested, user_data=services.user_data(stream, Role.REQUEST), on_match=self._on_server
        )

    @property
    def guids(self) -> Guids:
        """GUIDs of what it has on DDS."""
        return Guids((self._replies.guid,), (self._requests.guid,))

    def send(self, call: Call, payload: bytes, attachment: bytes) -> None:
        """Send a request to all servers that are matched; the call expects an answer of each."""
        with self._lock:  # the reply may come before the request's number is noted
            servers = self._requests.matched()
            if not servers:
                return
            for guid in servers:
                call.expect(guid)
            # rmw_fastrtps's servers wait for the reader that this names: they lose the reply to one not matched yet.
            number = self._requests.put(payload, related=(self._replies.guid, 0))
            self._calls[number] = call, attachment
            call.forget = lambda: self._calls.pop(number, None)
        self._replies.expect()

    def _on_reply(self, payload: bytes, info: Info) -> None:
        related = info.related
        if related is None or related[0] not in (self._replies.guid, self._requests.guid):
            return  # for another client: all read all replies
        with self._lock:
            found = self._calls.get(related[1])
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
            with self._lock:
                calls = [call for call, _ in self._calls.values()]
            for call in calls:
                call.finish(reader.guid)

    def withdraw(self) -> None:
        """End the client and its calls."""
        self._services.remove(self)
        with self._lock:
            calls = [call for call, _ in self._calls.values()]
        for call in calls:
            call.end()
        self._requests.close()
        self._replies.close()
