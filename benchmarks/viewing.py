"""Benchmark of `robolink view`: start-up, CPU and delay of the server beside many robots, and what they feel of it.

    python benchmarks/viewing.py [--robots 100] [--seconds 15] [--protocol robolink.v1,foxglove.sdk.v1]

A process publishes what the robots would (benchmarks/robots.py): 100 robots have 203 topics with 6,050 messages a
second. The server runs in another process; a light client in this one reads the frames from the bare socket, and
acknowledges batches as the page does.
"""

from __future__ import annotations

import argparse
import json
import os
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import psutil

sys.path.insert(0, str(Path(__file__).parents[1]))

from benchmarks.robots import RATE, Fleet
from robolink import Context, Node
from robolink.transport.port_sharing import free_domain

TOKEN = "benchmark"
SETTLING = 3.0
MASKED_ACK = b"\x82\x81\0\0\0\0\x80"


def load(robots: int) -> None:
    """Publish until standard input ends; print every second how many steps were late, and the CPU used, as JSON."""
    with Context() as context:
        node = Node("load", context=context)
        fleet = Fleet(node, robots)
        print("ready", flush=True)
        begin, lates = time.perf_counter(), []
        cpu = time.process_time()
        step = 0
        while True:
            fleet.publish()
            step += 1
            left = begin + step / RATE - time.perf_counter()
            lates.append(max(0.0, -left))
            time.sleep(max(0.0, left))
            if step % RATE == 0:
                used, cpu = time.process_time() - cpu, time.process_time()
                print(json.dumps({"late": max(lates), "cpu": used}), flush=True)
                lates.clear()


class Seen(NamedTuple):
    """Figures of a client over a time."""

    messages: int
    frames: int
    bytes: int
    delays: list[float]
    topics: int


class LightClient:
    """WebSocket client on a bare socket."""

    def __init__(self, port: int, protocol: str) -> None:
        self.wire = socket.create_connection(("127.0.0.1", port), 10)
        lines = [
            f"GET /?token={TOKEN} HTTP/1.1",
            f"Host: 127.0.0.1:{port}",
            "Connection: Upgrade",
            "Upgrade: websocket",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
            f"Sec-WebSocket-Protocol: {protocol}",
        ]
        self.wire.sendall("\r\n".join([*lines, "", ""]).encode())
        self.buffer = bytearray()
        while b"\r\n\r\n" not in self.buffer:
            self.buffer += self.wire.recv(65536)
        del self.buffer[: self.buffer.index(b"\r\n\r\n") + 4]
        self.subscribed = 0

    def frames(self, until: float) -> Iterator[tuple[int, bytes]]:
        """Yield the first byte and the payload of each frame until a time."""
        self.wire.settimeout(0.2)
        while time.perf_counter() < until:
            while (whole := self._whole()) is not None:
                yield whole
            try:
                part = self.wire.recv(1 << 20)
            except TimeoutError:
                continue
            if not part:
                raise SystemExit("the server has closed the connection")
            self.buffer += part

    def _whole(self) -> tuple[int, bytes] | None:
        buffer = self.buffer
        if len(buffer) < 10:
            return None
        length, begin = buffer[1], 2
        if length == 126:
            length, begin = int.from_bytes(buffer[2:4], "big"), 4
        elif length == 127:
            length, begin = int.from_bytes(buffer[2:10], "big"), 10
        if len(buffer) < begin + length:
            return None
        found = buffer[0], bytes(buffer[begin : begin + length])
        del buffer[: begin + length]
        return found

    def send(self, op: str, **fields: object) -> None:
        raw = json.dumps({"op": op, **fields}).encode()
        self.wire.sendall(b"\x81\xff" + len(raw).to_bytes(8, "big") + bytes(4) + raw)

    def read(self, seconds: float, *, only_first: bool = False) -> Seen:
        """Subscribe to all that is advertised, and count what comes for a time."""
        messages = frames = size = 0
        delays: list[float] = []
        for first, body in self.frames(time.perf_counter() + seconds):
            if first == 0x81:
                self._subscribe(json.loads(body))
            elif first == 0x89:
                self.wire.sendall(b"\x8a" + bytes((0x80 | len(body),)) + bytes(4) + body)
            elif body[0] in {1, 0x80}:
                now = time.time_ns()
                found = list(times(body))
                delays += [(now - each) * 1e-6 for each in found]
                messages, frames, size = messages + len(found), frames + 1, size + len(body)
                if body[0] == 0x80:
                    self.wire.sendall(MASKED_ACK)
                if only_first:
                    break
        return Seen(messages, frames, size, sorted(delays), self.subscribed)

    def _subscribe(self, reported: dict[str, object]) -> None:
        channels = reported.get("channels")
        if reported["op"] == "advertise" and isinstance(channels, list):
            self.subscribed += len(channels)
            self.send("subscribe", subscriptions=[{"id": each["id"], "channelId": each["id"]} for each in channels])


def times(body: bytes) -> Iterator[int]:
    """Yield the times of arrival in a frame, in ns."""
    if body[0] == 1:
        yield int.from_bytes(body[5:13], "little")
        return
    offset = 1
    while offset < len(body):
        length, _, at = struct.unpack_from("<IIQ", body, offset)
        yield at
        offset += 16 + length


@contextmanager
def started(command: list[str], environment: dict[str, str]) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


def server(port: int) -> list[str]:
    words = ["view", "--no-browser", "--port", str(port), "--token", TOKEN]
    return [sys.executable, "-m", "robolink", *words]


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def start_up(environment: dict[str, str]) -> float:
    """Return the time from the start of the server to the first message at a client, in seconds."""
    port, begin = free_port(), time.perf_counter()
    with started(server(port), environment):
        while True:
            try:
                client = LightClient(port, "robolink.v1")
                break
            except OSError:
                time.sleep(0.005)
        client.read(10.0, only_first=True)
        return time.perf_counter() - begin


class Load:
    """The publishing process, and what it tells of itself."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.reported: list[dict[str, float]] = []
        assert process.stdout is not None
        self._lines = process.stdout
        self._lines.readline()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        self.reported.extend(json.loads(line) for line in self._lines)

    def figures(self, begin: int) -> str:
        """Return the contacts of the robots since the line `begin`."""
        reported = self.reported[begin:] or [{"late": 0.0, "cpu": 0.0}]
        late = 1000 * max(each["late"] for each in reported)
        cpu = sum(each["cpu"] for each in reported) / len(reported)
        return f"steps late by {late:.0f} ms at most, {100 * cpu:.0f} % of a core"


def serve(protocol: str, seconds: float, environment: dict[str, str], robots: Load) -> None:
    """Measure one protocol, and print it."""
    port = free_port()
    with started(server(port), environment) as process:
        assert process.stdout is not None
        process.stdout.readline()
        client = LightClient(port, protocol)
        client.read(SETTLING)
        reported = len(robots.reported)
        used = psutil.Process(process.pid)
        before, begin = used.cpu_times(), time.perf_counter()
        seen = client.read(seconds)
        after, spent = used.cpu_times(), time.perf_counter() - begin
        cpu = (after.user - before.user + after.system - before.system) / spent
        middle, late = seen.delays[len(seen.delays) // 2], seen.delays[int(len(seen.delays) * 0.99)]
        print(f"{protocol}: {seen.topics} topics, {seen.messages / spent:,.0f} messages a second", end="")
        print(f" in {seen.frames / spent:,.0f} frames, {seen.bytes / spent / 1e6:.1f} MB/s")
        print(f"  server {100 * cpu:.1f} % of a core, {used.memory_info().rss / 1e6:.0f} MB of memory")
        print(f"  delay in the server: half within {middle:.1f} ms, 99 % within {late:.1f} ms")
        print(f"  the robots meanwhile: {robots.figures(reported)}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robots", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=15.0)
    parser.add_argument("--protocol", default="robolink.v1,foxglove.sdk.v1")
    parser.add_argument("--load", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.load:
        load(given.robots)
        return
    with free_domain() as domain:
        environment = dict(os.environ) | {"ROS_DOMAIN_ID": str(domain)}
        command = [sys.executable, __file__, "--load", "--robots", str(given.robots)]
        with started(command, environment) as loader:
            robots = Load(loader)
            time.sleep(given.seconds / 2)
            print(f"the robots alone: {robots.figures(0)}")
            print(f"first message after the start of the server: {start_up(environment):.2f} s")
            for protocol in given.protocol.split(","):
                serve(protocol, given.seconds, environment, robots)


if __name__ == "__main__":
    main()
