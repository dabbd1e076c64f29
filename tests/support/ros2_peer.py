"""Reference ROS 2 node on bare Zenoh calls, as rmw_zenoh makes them, and its router: an oracle without robolink.

Formats and settings are those of rmw_zenoh's docs/design.md and docs/configuration.md. Run as a program, this file is
the router: it prints the port on which it listens, and goes on until its input ends.
"""

from __future__ import annotations

import contextlib
import itertools
import json
import queue
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import xxhash
import zenoh

PATIENCE = 30.0

ROUTER: dict[str, Any] = {
    "mode": "router",
    "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": True}},
    "timestamping": {"enabled": True},
    "queries_default_timeout": 60_000,
    "routing": {"router": {"peers_failover_brokering": False}},
    "transport": {
        "unicast": {"open_timeout": 60_000, "accept_timeout": 60_000, "accept_pending": 10_000, "max_sessions": 10_000},
        "link": {"tx": {"lease": 60_000, "keep_alive": 2}},
        "shared_memory": {"enabled": False},
    },
    "adminspace": {"permissions": {"read": True, "write": False}},
}

SESSION: dict[str, Any] = ROUTER | {
    "mode": "peer",
    "connect": {
        "timeout_ms": -1,
        "exit_on_failure": False,
        "retry": {"period_init_ms": 1000, "period_max_ms": 4000, "period_increase_factor": 2},
    },
    "listen": {"endpoints": ["tcp/localhost:0"]},
    "scouting": {
        "delay": 1,
        "multicast": {"enabled": False},
        "gossip": {
            "enabled": True,
            "target": {"router": ["router", "peer"], "peer": ["router"]},
            "autoconnect": {"router": [], "peer": ["router", "peer"]},
            "autoconnect_strategy": {"peer": {"to_router": "always", "to_peer": "greater-zid"}},
        },
    },
}


class Type(NamedTuple):
    """A message or service type as it stands in keys."""

    dds_name: str
    hash: str

    @property
    def for_humble(self) -> Type:
        """What it is to a Humble node, which knows no hashes."""
        return Type(self.dds_name, "TypeHashNotSupported")


# The hashes are those that ROS 2 Jazzy announces.
STRING = Type("std_msgs::msg::dds_::String_", "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18")
TWIST = Type(
    "geometry_msgs::msg::dds_::Twist_", "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"
)
ADD_TWO_INTS = Type(
    "example_interfaces::srv::dds_::AddTwoInts_",
    "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
)

RELIABLE, SENSOR_DATA, LATCHED = "::,10:,:,:,,", "2::,5:,:,:,,", ":1:,3:,:,:,,"
SERVICES = RELIABLE


def packed_string(text: str) -> bytes:
    """A std_msgs/String in CDR."""
    raw = text.encode() + b"\0"
    return b"\0\1\0\0" + struct.pack("<I", len(raw)) + raw


def packed_twist(*numbers: float) -> bytes:
    """A geometry_msgs/Twist in CDR: x, y, z linear and angular."""
    return b"\0\1\0\0" + struct.pack("<6d", *numbers)


def packed_ints(*numbers: int) -> bytes:
    """Both messages of AddTwoInts in CDR: a and b, or the sum."""
    return b"\0\1\0\0" + struct.pack(f"<{len(numbers)}q", *numbers)


def unpacked_ints(payload: bytes) -> tuple[int, ...]:
    """Undo `packed_ints`."""
    assert payload[:4] == b"\0\1\0\0"
    return struct.unpack(f"<{len(payload) // 8}q", payload[4:])


def packed_attachment(sequence: int, timestamp: int, gid: bytes) -> bytes:
    """The 33 bytes that go with everything."""
    return struct.pack("<q", sequence) + struct.pack("<q", timestamp) + b"\x10" + gid


def gid_of(token: str) -> bytes:
    """XXH3-128 of the token: its low half and then its high half, both little endian."""
    high, low = divmod(xxhash.xxh3_128_intdigest(token.encode()), 1 << 64)
    return struct.pack("<QQ", low, high)


class Received(NamedTuple):
    """A sample or a reply."""

    payload: bytes
    attachment: bytes | None

    @property
    def sender(self) -> tuple[int, int, bytes]:
        """Sequence number, timestamp and gid of the attachment."""
        assert self.attachment is not None
        sequence, timestamp, length, gid = struct.unpack("<qqB16s", self.attachment)
        assert length == 16
        return sequence, timestamp, gid


class Peer:
    """A context of rmw_zenoh: a session, and one counter for its nodes and endpoints."""

    def __init__(self, port: int, domain: int, mode: str = "peer") -> None:
        config = SESSION | {"mode": mode, "connect": SESSION["connect"] | {"endpoints": [f"tcp/localhost:{port}"]}}
        self.session: Any = zenoh.open(zenoh.Config.from_json5(json.dumps(config)))
        self.domain, self.zid = domain, str(self.session.info.zid())
        self.counter = itertools.count()
        self._kept: list[Any] = []  # what is forgotten is undeclared
        self._seen: set[str] = set()
        self._graph = f"@ros2_lv/{domain}/**"
        self.keep(self.session.liveliness().declare_subscriber(self._graph, self._on_token, history=True))

    def node(self, name: str, namespace: str = "/") -> PeerNode:
        """Announce a node."""
        return PeerNode(self, name, namespace)

    def tokens(self) -> list[str]:
        """The tokens of this domain that others announce."""
        return sorted(token for token in self._seen.copy() if token.split("/")[2] != self.zid)

    def got_tokens(self) -> list[str]:
        """The same by one liveliness get, in which those of the last instants may be missing."""
        replies = self.session.liveliness().get(self._graph, timeout=PATIENCE)
        found = [str(reply.ok.key_expr) for reply in replies if reply.ok]
        return sorted(token for token in found if token.split("/")[2] != self.zid)

    def _on_token(self, sample: Any) -> None:
        change = self._seen.add if sample.kind == zenoh.SampleKind.PUT else self._seen.discard
        change(str(sample.key_expr))

    def keep(self, entity: Any) -> Any:
        """Keep what has been declared until the end."""
        self._kept.append(entity)
        return entity

    def announce(self, token: str) -> None:
        """Announce any token."""
        self.keep(self.session.liveliness().declare_token(token))

    def close(self) -> None:
        """Leave the network."""
        self.session.close()


class PeerNode:
    """A node, from which its endpoints are made."""

    def __init__(self, peer: Peer, name: str, namespace: str) -> None:
        self.peer, self.number = peer, next(peer.counter)
        self._place = f"@ros2_lv/{peer.domain}/{peer.zid}/{self.number}"
        self._name = f"%/{namespace.replace('/', '%')}/{name}"
        self.token = f"{self._place}/{self.number}/NN/{self._name}"
        peer.announce(self.token)

    def endpoint(self, kind: str, topic: str, type_: Type, qos: str) -> tuple[str, str]:
        """The token of a new endpoint and the key on which it talks."""
        own = f"{self._place}/{next(self.peer.counter)}/{kind}/{self._name}"
        token = f"{own}/{topic.replace('/', '%')}/{type_.dds_name}/{type_.hash}/{qos}"
        return token, f"{self.peer.domain}/{topic.strip('/')}/{type_.dds_name}/{type_.hash}"

    def publisher(self, topic: str, type_: Type, qos: str = RELIABLE) -> PeerPublisher:
        """Publish on a topic."""
        return PeerPublisher(self, topic, type_, qos)

    def subscription(self, topic: str, type_: Type, qos: str = RELIABLE) -> PeerSubscription:
        """Subscribe to a topic."""
        return PeerSubscription(self, topic, type_, qos)

    def service(self, name: str, type_: Type, answer: Callable[[PeerQuery], None]) -> PeerService:
        """Serve; `answer(query)` is called on a thread of Zenoh's."""
        return PeerService(self, name, type_, answer)

    def client(self, name: str, type_: Type) -> PeerClient:
        """Call a service."""
        return PeerClient(self, name, type_)


class PeerPublisher:
    """An AdvancedPublisher, which keeps what it sent if that is what the QoS says."""

    def __init__(self, node: PeerNode, topic: str, type_: Type, qos: str) -> None:
        self.token, self.key = node.endpoint("MP", topic, type_, qos)
        self.gid, self.numbers = gid_of(self.token), itertools.count(1)
        best_effort, keeps, depth = qos.startswith("2:"), ":1:" in qos, int(qos.split(",")[1].split(":")[0])
        options: dict[str, Any] = {}
        if keeps:
            options["cache"] = zenoh.ext.CacheConfig(max_samples=depth)
            options["publisher_detection"] = True
            options["sample_miss_detection"] = zenoh.ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=0.5)
        self.entity = zenoh.ext.declare_advanced_publisher(
            node.peer.session,
            self.key,
            congestion_control=zenoh.CongestionControl.DROP,
            reliability=zenoh.Reliability.BEST_EFFORT if best_effort else zenoh.Reliability.RELIABLE,
            **options,
        )
        node.peer.announce(self.token)

    def put(self, payload: bytes, timestamp: int | None = None) -> None:
        """Publish, as the next of this publisher's."""
        stamp = time.time_ns() if timestamp is None else timestamp
        self.entity.put(payload, attachment=packed_attachment(next(self.numbers), stamp, self.gid))


class PeerSubscription:
    """An AdvancedSubscriber, which asks for what was kept if that is what the QoS says."""

    def __init__(self, node: PeerNode, topic: str, type_: Type, qos: str) -> None:
        self.token, self.key = node.endpoint("MS", topic, type_, qos)
        self.arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()
        options: dict[str, Any] = {}
        if ":1:" in qos:
            depth = int(qos.split(",")[1].split(":")[0])
            options["history"] = zenoh.ext.HistoryConfig(detect_late_publishers=True, max_samples=depth)
            options["recovery"] = zenoh.ext.RecoveryConfig(periodic_queries=None, heartbeat=True)
            options["subscriber_detection"] = True
        self.entity = zenoh.ext.declare_advanced_subscriber(
            node.peer.session, self.key, zenoh.handlers.Callback(self.arrived.put, indirect=False), **options
        )
        node.peer.announce(self.token)

    def next(self) -> Received:
        """The next sample."""
        sample = self.arrived.get(timeout=PATIENCE)
        return Received(sample.payload.to_bytes(), sample.attachment and sample.attachment.to_bytes())

    def take_until(self, payload: bytes) -> list[Received]:
        """The next samples up to one of this payload."""
        received = [self.next()]
        while received[-1].payload != payload:
            received.append(self.next())
        return received


class PeerQuery:
    """A request, which the server answers."""

    def __init__(self, key: str, query: Any) -> None:
        self.raw, self.key = query, key
        self.payload = query.payload.to_bytes()
        self.sequence, self.timestamp, self.gid = Received(self.payload, query.attachment.to_bytes()).sender

    def reply(self, payload: bytes) -> None:
        """Answer as rmw_zenoh does: the request's own number and gid, and a new stamp."""
        self.raw.reply(self.key, payload, attachment=packed_attachment(self.sequence, time.time_ns(), self.gid))


class PeerService:
    """A complete queryable."""

    def __init__(self, node: PeerNode, name: str, type_: Type, answer: Callable[[PeerQuery], None]) -> None:
        self.token, self.key = node.endpoint("SS", name, type_, SERVICES)
        self.requests: list[PeerQuery] = []

        def on_query(raw: Any) -> None:
            with contextlib.closing(_Dropped(raw)):
                self.requests.append(PeerQuery(self.key, raw))
                answer(self.requests[-1])

        self.entity = node.peer.keep(node.peer.session.declare_queryable(self.key, on_query, complete=True))
        node.peer.announce(self.token)


class _Dropped:
    """Ends a query."""

    def __init__(self, raw: Any) -> None:
        self.close = raw.drop


class PeerClient:
    """Asks all who serve."""

    def __init__(self, node: PeerNode, name: str, type_: Type) -> None:
        self.session, self.numbers = node.peer.session, itertools.count(1)
        self.token, self.key = node.endpoint("SC", name, type_, SERVICES)
        self.gid = gid_of(self.token)
        node.peer.announce(self.token)

    def call(self, payload: bytes, attachment: bytes | None = None) -> list[Received]:
        """Ask, and give all replies; an attachment of one's own may stand in for the right one."""
        own = packed_attachment(next(self.numbers), time.time_ns(), self.gid)
        replies = self.session.get(
            self.key,
            payload=payload,
            attachment=own if attachment is None else attachment,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=PATIENCE,
        )
        samples = [reply.ok for reply in replies if reply.ok]
        return [Received(each.payload.to_bytes(), each.attachment and each.attachment.to_bytes()) for each in samples]


@contextlib.contextmanager
def router(port: int = 0) -> Iterator[int]:
    """A router in a process of its own, with the settings of rmw_zenoh's; gives the port on which it listens."""
    command = [sys.executable, __file__, str(port)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout
            yield int(process.stdout.readline())
        finally:
            process.kill()


def free_port() -> int:
    """A port on which nobody listens now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def opened_router(port: int) -> tuple[Any, int]:
    """Open a router; on the next free port if none is asked for."""
    for attempt in itertools.count():
        chosen = port or free_port()
        config = ROUTER | {"listen": {"endpoints": [f"tcp/127.0.0.1:{chosen}"]}}
        try:
            return zenoh.open(zenoh.Config.from_json5(json.dumps(config))), chosen
        except zenoh.ZError:  # somebody else was faster
            if port or attempt > 10:
                raise
    raise AssertionError


def main() -> None:
    session, port = opened_router(int(sys.argv[1]))
    sys.stdout.write(f"{port}\n")
    sys.stdout.flush()
    sys.stdin.read()
    session.close()


if __name__ == "__main__":
    main()
