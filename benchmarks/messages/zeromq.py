"""pyzmq: a pair of sockets, over which msgspec's Structs go as MessagePack; it needs to be told who is there."""

from __future__ import annotations

import importlib
import os
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import msgspec

from benchmarks.messages.games import Beat, Count, Ping, Task, pour, say_ready
from benchmarks.messages.plain import plain

zmq: Any = importlib.import_module("zmq")

STORED = 10
"""Large messages that wait at either end before the sender has to; of small ones there are 10,000."""


def paired(task: Task, first: bool) -> Any:
    """A socket, connected to that of the other process."""
    socket = zmq.Context().socket(zmq.PAIR)
    socket.set_hwm(STORED if task.large else 10_000)
    domain = os.environ["ROS_DOMAIN_ID"]
    path = Path(tempfile.gettempdir(), f"robolink-benchmark-{domain}")
    address = f"tcp://127.0.0.1:{30_000 + int(domain)}" if sys.platform == "win32" else f"ipc://{path}"
    socket.bind(address) if first else socket.connect(address)
    return socket


def pong(task: Task) -> None:
    socket, pack = paired(task, first=True), msgspec.msgpack.Encoder().encode
    unpack = msgspec.msgpack.Decoder(type(plain(task.kind))).decode
    say_ready()
    while True:
        socket.send(pack(unpack(socket.recv(copy=not task.large))), copy=not task.large)


def ping(task: Task) -> None:
    socket, message, game = paired(task, first=False), plain(task.kind), Ping(task.seconds, retry=3.0)
    pack, unpack = msgspec.msgpack.Encoder().encode, msgspec.msgpack.Decoder(type(message)).decode

    def receive() -> None:
        answer = unpack(socket.recv(copy=not task.large))
        if game.answered():
            socket.send(pack(message), copy=not task.large)
        else:
            game.checked = answer == message

    game.play(lambda: socket.send(pack(message), copy=not task.large), lambda _: receive())
    while True:
        receive()


def number_of(kind: str) -> tuple[str, str]:
    """Return the names by which a flood's number is found in a message."""
    return ("linear", "x") if kind == "twist" else ("header", "nanosec")


def sink(task: Task) -> None:
    socket, count = paired(task, first=True), Count()
    unpack = msgspec.msgpack.Decoder(type(plain(task.kind))).decode
    part, name = number_of(task.kind)
    count.answer()
    say_ready()
    while True:
        count.add(getattr(getattr(unpack(socket.recv(copy=not task.large)), part), name))


def source(task: Task) -> None:
    socket, pack, message = paired(task, first=False), msgspec.msgpack.Encoder().encode, plain(task.kind)
    part, name = number_of(task.kind)
    of = getattr(message, part)

    def send(number: int) -> None:
        setattr(of, name, number)
        socket.send(pack(message), copy=not task.large)

    time.sleep(0.2)
    pour(task, send)


def beat(task: Task) -> None:
    socket, pack, message = paired(task, first=False), msgspec.msgpack.Encoder().encode, plain(task.kind)
    Beat(task, lambda: socket.send(pack(message))).keep()
