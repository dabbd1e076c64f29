"""Participants of a real ROS 2 in memory, by hand, and what a session of ours makes of them."""

from __future__ import annotations

import contextlib
from typing import Any

from robolink.dds import entities
from robolink.dds.entities import NodeEntities, ParticipantEntities
from robolink.dds.names import Role, dds_topic, dds_type, enclave_data, user_data_of
from robolink.dds.transport import DdsTransport
from robolink.exceptions import WireError
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import type_hash
from robolink.qos import QoSProfile
from robolink.rtps import Endpoint, Info, Qos
from robolink.wire import (
    DataKey,
    EndpointKind,
    EndpointToken,
    NodeToken,
    format_key,
    format_token,
    own_tokens,
    parse_token,
)
from tests.support.fake_rtps import EPROSIMA, FakeNetwork, FakeParticipant, FakeReader, FakeWriter
from tests.support.transports import GRAPH

STRING, SET_BOOL = "std_msgs/msg/String", "std_srvs/srv/SetBool"
HASH, SERVICE_HASH = type_hash(String), type_hash(SetBool)
TALK = format_key(DataKey(0, "/talk", STRING, HASH))
SERVICE = format_key(DataKey(0, "/set", SET_BOOL, SERVICE_HASH))
DEPTH_3 = QoSProfile(depth=3)
DEPTH_7 = Qos(depth=7)
PLACE = "rt/talk", "std_msgs::msg::dds_::String_"
LATCHED = Qos(reliable=True, transient_local=True, depth=1)


def open_session(fake: FakeNetwork) -> DdsTransport:
    opens: Any = fake.open
    return DdsTransport(opens)


def token(
    session: DdsTransport, kind: EndpointKind, name: str, type_name: str, hash_text: str, qos: QoSProfile = DEPTH_3
) -> str:
    """A token of the node /here/talker."""
    number = str(next(COUNT))
    return format_token(
        EndpointToken(0, session.session_id, "1", number, kind, "/", "/here", "talker", name, type_name, hash_text, qos)
    )


COUNT = iter(range(10, 10_000))


def node_token(session: DdsTransport) -> str:
    return format_token(NodeToken(0, session.session_id, "1", "/", "/here", "talker"))


class Other:
    """A participant of a real ROS 2, by hand."""

    def __init__(self, fake: FakeNetwork, user_data: bytes = enclave_data("/"), vendor: bytes = EPROSIMA) -> None:
        self.listed: list[ParticipantEntities] = []
        self.seen: dict[str, Endpoint] = {}
        self.got: list[tuple[bytes, Info]] = []
        self.participant: FakeParticipant = fake.open(user_data=user_data, vendor=vendor, on_endpoint=self._on_endpoint)
        self._writer = self.participant.writer(entities.TOPIC, entities.TYPE, LATCHED)
        self.participant.reader(entities.TOPIC, entities.TYPE, LATCHED, self._on_entities)

    def _on_endpoint(self, endpoint: Endpoint, came: bool) -> None:
        if came:
            self.seen[endpoint.topic] = endpoint
        else:
            self.seen.pop(endpoint.topic, None)

    def _on_entities(self, payload: bytes, info: Info) -> None:
        with contextlib.suppress(WireError):
            self.listed.append(entities.decode(payload))

    def sink(self, payload: bytes, info: Info) -> None:
        self.got.append((payload, info))

    def tell(self, name: str, *endpoints: FakeReader | FakeWriter) -> None:
        """Tell that a node owns some endpoints."""
        readers = tuple(each.guid for each in endpoints if isinstance(each, FakeReader))
        writers = tuple(each.guid for each in endpoints if isinstance(each, FakeWriter))
        node = NodeEntities("/there", name, readers, writers)
        self._writer.put(entities.encode(ParticipantEntities(self.participant.guid, (node,))))

    def tell_nobody(self) -> None:
        self._writer.put(entities.encode(ParticipantEntities(self.participant.guid, ())))

    def publisher(self, qos: Qos = DEPTH_7, hash_text: str = HASH) -> FakeWriter:
        return self.participant.writer(*PLACE, qos, user_data=user_data_of(hash_text))

    def subscription(self) -> FakeReader:
        return self.participant.reader(*PLACE, DEPTH_7, self.sink, user_data=user_data_of(HASH))

    def server(self, type_name: str = SET_BOOL) -> tuple[FakeReader, FakeWriter]:
        return self._reader(Role.REQUEST, type_name), self._writer_of(Role.REPLY, type_name)

    def client(self) -> tuple[FakeReader, FakeWriter]:
        return self._reader(Role.REPLY), self._writer_of(Role.REQUEST)

    def _reader(self, role: Role, type_name: str = SET_BOOL) -> FakeReader:
        return self.participant.reader(dds_topic(role, "/set"), dds_type(role, type_name), Qos(), self.sink)

    def _writer_of(self, role: Role, type_name: str = SET_BOOL) -> FakeWriter:
        return self.participant.writer(dds_topic(role, "/set"), dds_type(role, type_name), Qos())


def seen_tokens(session: DdsTransport) -> list[NodeToken | EndpointToken]:
    own = own_tokens(0, session.session_id)
    return [parse_token(each) for each in session.tokens(GRAPH) if not each.startswith(own)]


def kinds(session: DdsTransport) -> list[str]:
    return sorted(
        f"{each.kind.value} {each.node_name}" for each in seen_tokens(session) if isinstance(each, EndpointToken)
    )
