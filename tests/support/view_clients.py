"""Clients of the view's server over real sockets, and a system in memory for it to show."""

from __future__ import annotations

import json
import socket
import struct
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from websockets.sync.client import ClientConnection, connect

from robolink import Context, Node
from robolink.executors import SingleThreadedExecutor
from robolink.transport.memory import Bus, MemoryTransport
from robolink.view.server import Settings, View
from robolink.view.server.learning import Exercises
from robolink.view.sources.live import LiveSource

WITHIN = 10.0
"""Longest wait for anything, in seconds."""

_ENTRY = struct.Struct("<IIQ")


class Got(NamedTuple):
    """A message that a client got."""

    subscription: int
    at: int
    payload: bytes


class Client:
    """A client on one subprotocol, which keeps what it has heard."""

    def __init__(self, socket_: ClientConnection) -> None:
        self.socket = socket_
        self.heard: list[dict[str, Any]] = []
        self.got: list[Got] = []
        self.binary: list[bytes] = []
        self._subscription = 0

    def send(self, op: str, **fields: Any) -> None:
        self.socket.send(json.dumps({"op": op, **fields}))

    def listen(self, timeout: float = WITHIN) -> None:
        """Take one frame."""
        raw = self.socket.recv(timeout)
        if isinstance(raw, str):
            self.heard.append(json.loads(raw))
        elif raw[0] == 0x80:
            self._take_batch(raw)
            self.socket.send(b"\x80")
        elif raw[0] == 1:
            subscription, at = struct.unpack_from("<IQ", raw, 1)
            self.got.append(Got(subscription, at, raw[13:]))
        else:
            self.binary.append(raw)

    def _take_batch(self, raw: bytes) -> None:
        offset = 1
        while offset < len(raw):
            length, subscription, at = _ENTRY.unpack_from(raw, offset)
            offset += _ENTRY.size + length
            self.got.append(Got(subscription, at, raw[offset - length : offset]))

    def wait_for(self, op: str, **fields: Any) -> dict[str, Any]:
        """Return the next operation with these fields that was not returned before."""
        while True:
            for index, each in enumerate(self.heard):
                if each["op"] == op and all(each.get(name) == value for name, value in fields.items()):
                    return self.heard.pop(index)
            self.listen()

    def channel(self, topic: str) -> dict[str, Any]:
        """Return the channel of a topic, once it is advertised."""
        return self._advertised("advertise", "channels", "topic", topic)

    def service(self, name: str) -> dict[str, Any]:
        return self._advertised("advertiseServices", "services", "name", name)

    def _advertised(self, op: str, where: str, key: str, value: str) -> dict[str, Any]:
        looked = 0
        while True:
            for each in self.heard[looked:]:
                for one in each.get(where, []) if each["op"] == op else []:
                    if one[key] == value:
                        found: dict[str, Any] = one
                        return found
            looked = len(self.heard)
            self.listen()

    def subscribe(self, topic: str, **more: Any) -> int:
        """Subscribe to a topic, and return the subscription's id."""
        self._subscription += 1
        wish = {"id": self._subscription, "channelId": self.channel(topic)["id"], **more}
        self.send("subscribe", subscriptions=[wish])
        return self._subscription

    def next(self, subscription: int) -> bytes:
        """Return the payload of the next message of a subscription."""
        while True:
            for index, each in enumerate(self.got):
                if each.subscription == subscription:
                    return self.got.pop(index).payload
            self.listen()

    def call(self, service: str, payload: bytes, encoding: str = "cdr", number: int = 9) -> bytes:
        """Call a service, and return the answer's payload; raises RuntimeError with the reason if it fails."""
        id_ = self.service(service)["id"]
        self.socket.send(struct.pack("<BIII", 2, id_, number, len(encoding)) + encoding.encode() + payload)
        begin = struct.pack("<BIII", 3, id_, number, len(encoding)) + encoding.encode()
        while True:
            for each in self.binary:
                if each.startswith(begin):
                    self.binary.remove(each)
                    return each[len(begin) :]
            for told in self.heard:
                if told["op"] == "serviceCallFailure" and (told["serviceId"], told["callId"]) == (id_, number):
                    self.heard.remove(told)
                    raise RuntimeError(told["message"])
            self.listen()

    def publish(self, channel: int, payload: bytes) -> None:
        self.socket.send(struct.pack("<BI", 1, channel) + payload)

    def settle(self) -> None:
        """Wait until the server has worked on all that was sent to it."""
        self.send("fetchAsset", uri="package://nothing", requestId=77)
        while not any(each[:5] == b"\x04\x4d\x00\x00\x00" for each in self.binary):
            self.listen()
        self.binary = [each for each in self.binary if each[0] != 4]


def until(condition: Callable[[], bool], within: float = WITHIN) -> float:
    """Wait until a condition holds, and return the time that took, in seconds."""
    begin = time.monotonic()
    while not condition():
        assert time.monotonic() - begin < within, "it did not come to pass"
        time.sleep(0.002)
    return time.monotonic() - begin


class Shown:
    """A system in memory with a view of it."""

    def __init__(self, exercises: Exercises | None = None, **settings: Any) -> None:
        self.bus = Bus()
        self.context = self.new_context()
        self.node = Node("robot", context=self.context)
        self.source = LiveSource(Node("_view", context=self.new_context(), start_parameter_services=False))
        self.view = View(self.source, Settings(**{"port": 0, **settings}), exercises)

    def new_context(self) -> Context:
        context = Context(transport=MemoryTransport(bus=self.bus))
        context.init(args=[], initialize_logging=False)
        return context

    @contextmanager
    def spinning(self) -> Iterator[Node]:
        """Spin the system's node on a thread for the block."""
        executor = SingleThreadedExecutor(context=self.context)
        executor.add_node(self.node)
        thread = threading.Thread(target=executor.spin)
        thread.start()
        try:
            yield self.node
        finally:
            executor.shutdown()
            thread.join(WITHIN)

    @contextmanager
    def client(self, subprotocol: str = "robolink.v1", *, token: bool = True, **options: Any) -> Iterator[Client]:
        query = f"/?token={self.view.token}" if token else "/"
        address = f"ws://127.0.0.1:{self.view.port}{query}"
        with connect(address, subprotocols=[subprotocol], compression=None, **options) as found:  # type: ignore[list-item]
            yield Client(found)

    def ask(self, path: str = "/", host: str = "", *lines: str) -> tuple[int, str]:
        """Send a request of HTTP with exactly these headers; returns the status and the whole answer."""
        host = host or f"127.0.0.1:{self.view.port}"
        with socket.create_connection(("127.0.0.1", self.view.port), WITHIN) as wire:
            wire.sendall("\r\n".join([f"GET {path} HTTP/1.1", f"Host: {host}", *lines, "", ""]).encode())
            answer = b""
            while part := wire.recv(65536):
                answer += part
                if b"101 Switching" in answer:
                    break
        return int(answer.split(b" ", 2)[1]), answer.decode(errors="replace")


@contextmanager
def shown(exercises: Exercises | None = None, **settings: Any) -> Iterator[Shown]:
    """Show a new system in memory for the block, with exercises for the page if there are some."""
    made = Shown(exercises, **settings)
    try:
        with made.view:
            yield made
    finally:
        made.source.context.try_shutdown()
        made.context.try_shutdown()
