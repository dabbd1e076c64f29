"""Two networks in memory with a mirror between them, in one virtual time: nodes on each, spun by turns."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink import Context, Node, VirtualTime
from robolink.dds.mirror import Mirror
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.std_msgs.msg import Int32
from robolink.message import type_hash
from robolink.qos import QoSProfile
from robolink.serialization import serialize_message
from robolink.transport.base import Transport
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import EndpointKind, EndpointToken, NodeToken

STEP = 10_000_000
"""Time that passes between two turns, in nanoseconds."""


class Half:
    """One of the two networks, with the nodes of a test on it."""

    def __init__(self, time: VirtualTime) -> None:
        self.bus, self._time = Bus(), time
        self.context = self.new_context()
        self.executor = SingleThreadedExecutor(context=self.context)

    def new_context(self) -> Context:
        """Begin another session on this network."""
        context = Context(transport=MemoryTransport(bus=self.bus), time=self._time)
        context.init([])
        return context

    def node(self, name: str, **options: Any) -> Node:
        """Make a node that is spun."""
        node = Node(name, context=self.context, **options)
        self.executor.add_node(node)
        return node

    def session(self) -> MemoryTransport:
        """Open a session without nodes."""
        return MemoryTransport(bus=self.bus)


class Mirrored:
    """Two networks, and a mirror between them once `join` has been called."""

    def __init__(self) -> None:
        self.time = VirtualTime()
        self.a, self.b = Half(self.time), Half(self.time)
        self.halves = (self.a, self.b)
        self.mirror: Mirror | None = None
        self.transports: list[Transport] = []

    def join(self) -> Mirror:
        """Put a mirror between them."""
        self.transports = [half.session() for half in self.halves]
        a, b = self.transports
        self.mirror = Mirror(a, b, 0, lambda: self.time.steady() / 1e9)
        return self.mirror

    def part(self) -> None:
        """Take the mirror away."""
        if self.mirror is not None:
            self.mirror.close()
            self.mirror = None
            for each in self.transports:
                each.close()

    def turn(self) -> None:
        """Let everybody do what is due, then let a little time pass."""
        for _ in range(3):
            for half in self.halves:
                for _ in range(20):
                    half.executor.spin_once(timeout_sec=0)
            if self.mirror is not None:
                self.mirror.step()
        self.time.sleep(STEP)

    def run(self, seconds: float) -> None:
        """Take turns for so long."""
        end = self.time.steady() + int(seconds * 1e9)
        while self.time.steady() < end:
            self.turn()

    def until(self, condition: Callable[[], Any], within: float = 5.0) -> float:
        """Take turns until the condition holds; return the seconds that it took."""
        begin = self.time.steady()
        while not condition():
            assert self.time.steady() - begin < within * 1e9, "it did not come true"
            self.turn()
        return (self.time.steady() - begin) / 1e9

    def close(self) -> None:
        """End all."""
        self.part()
        for half in self.halves:
            half.executor.shutdown()
            half.context.try_shutdown()


def heard(node: Node, topic: str = "chatter", qos: Any = 10, kind: type[Any] = Int32) -> list[Any]:
    """Subscribe; the list fills."""
    got: list[Any] = []
    node.create_subscription(kind, topic, lambda message: got.append(message.data), qos)
    return got


def send(publisher: Any, *values: int) -> None:
    for each in values:
        publisher.publish(Int32(data=each))


def raw_tokens(session: str, hash_text: str = "") -> tuple[EndpointToken, NodeToken]:
    """Return the tokens of a publisher of Int32 and of its node."""
    shown = hash_text or type_hash(Int32)
    endpoint = EndpointToken(
        0,
        session,
        "1",
        "2",
        EndpointKind.PUBLISHER,
        "/",
        "/",
        "raw",
        "/chatter",
        "std_msgs/msg/Int32",
        shown,
        QoSProfile(depth=10),
    )
    return endpoint, NodeToken(0, session, "1", "/", "/", "raw")


def packed(value: int) -> bytes:
    return bytes(serialize_message(Int32(data=value)))


def crossings(scene: Mirrored) -> list[Any]:
    assert scene.mirror is not None
    flows = [flow for place in scene.mirror._places.values() for flow in place.flows]
    return [flow.crossing for flow in flows if hasattr(flow, "crossing")]


def services(scene: Mirrored) -> list[Any]:
    assert scene.mirror is not None
    return [flow for place in scene.mirror._places.values() for flow in place.flows if hasattr(flow, "calls")]


def adds(node: Node, name: str = "add", plus: int = 0) -> list[Any]:
    """Serve AddTwoInts; the list fills with the requests."""
    asked: list[Any] = []

    def add(request: Any, response: Any) -> Any:
        asked.append((request.a, request.b))
        response.sum = request.a + request.b + plus
        return response

    node.create_service(AddTwoInts, name, add)
    return asked
