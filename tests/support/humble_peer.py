"""A peer of Humble on the memory transport, for tests."""

from __future__ import annotations

import queue
from pathlib import Path
from typing import Any

from robolink import Context, Node
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from robolink.message import decode, encode
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.transport import Transport
from robolink.wire import (
    NO_HASH,
    EndpointKind,
    EndpointToken,
    format_token,
    gid_of,
    pack_attachment,
    unpack_attachment,
)
from tests.support.transports import PATIENCE

DATA = Path(__file__).parents[1] / "data" / "wire"

PLAIN = QoSProfile(depth=10)

LATCHED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)

TYPES = {
    EndpointKind.PUBLISHER: "std_msgs/msg/Int32",
    EndpointKind.SUBSCRIPTION: "std_msgs/msg/Int32",
    EndpointKind.SERVICE: "std_srvs/srv/SetBool",
    EndpointKind.CLIENT: "std_srvs/srv/SetBool",
}


class Peer:
    """A node of Humble, made of bare calls of a transport."""

    def __init__(self, session: Transport, name: str = "/topic") -> None:
        self.session, self.name = session, name
        self.arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self.sequence = 0

    def announce(self, kind: EndpointKind, qos: QoSProfile = PLAIN) -> EndpointToken:
        number = str(list(EndpointKind).index(kind) + 1)
        token = EndpointToken(
            0, self.session.session_id, "0", number, kind, "/", "/", "old", self.name, TYPES[kind], NO_HASH, qos
        )
        self.handle = self.session.announce(format_token(token))
        self.gid = gid_of(format_token(token))
        return token

    def key(self, kind: EndpointKind) -> str:
        package, part, name = TYPES[kind].split("/")
        return f"0{self.name}/{package}::{part}::dds_::{name}_/{NO_HASH}"

    def advertise(self, qos: QoSProfile = PLAIN) -> Peer:
        self.outlet = self.session.advertise(self.key(EndpointKind.PUBLISHER), qos)
        self.announce(EndpointKind.PUBLISHER, qos)
        return self

    def put(self, *numbers: int) -> None:
        for number in numbers:
            self.sequence += 1
            self.outlet.put(encode(Int32(data=number)), pack_attachment(self.sequence, 5, self.gid))

    def subscribe(self, qos: QoSProfile = PLAIN) -> Peer:
        self.session.subscribe(self.key(EndpointKind.SUBSCRIPTION), qos, self.arrived.put)
        self.announce(EndpointKind.SUBSCRIPTION, qos)
        return self

    def received(self, count: int) -> list[int]:
        """The next numbers, each from a sender that the attachment names."""
        samples = [self.session.read(self.arrived.get(timeout=PATIENCE)) for _ in range(count)]
        assert len({unpack_attachment(each.attachment).gid for each in samples}) == 1
        return [decode(Int32, each.payload).data for each in samples]


def spinning(context: Context, name: str = "node") -> tuple[Node, SingleThreadedExecutor]:
    node, executor = Node(name, context=context), SingleThreadedExecutor(context=context)
    executor.add_node(node)
    return node, executor
