"""Cyclone DDS's Python: DDS, as ROS 2 has it, but with messages that are put into bytes by Python code."""

from __future__ import annotations

import importlib
import os
import time
from collections.abc import Callable
from typing import Any

from benchmarks.messages.games import Count, Ping, Task, pour, say_ready
from benchmarks.messages.samples import SIDES, pixels, ranges

core: Any = importlib.import_module("cyclonedds.core")
domain: Any = importlib.import_module("cyclonedds.domain")
idl: Any = importlib.import_module("cyclonedds.idl")
types: Any = importlib.import_module("cyclonedds.idl.types")
pub: Any = importlib.import_module("cyclonedds.pub")
sub: Any = importlib.import_module("cyclonedds.sub")
topic: Any = importlib.import_module("cyclonedds.topic")
util: Any = importlib.import_module("cyclonedds.util")

HERE = """
<General>
<Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces><AllowMulticast>false</AllowMulticast>
</General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
"""
"""Settings: this machine only."""


def struct(name: str, **fields: Any) -> Any:
    """Make the class of a message."""
    return idl.make_idl_struct(name, name, fields)


FLOATS = ("angle_min", "angle_max", "angle_increment", "time_increment", "scan_time", "range_min", "range_max")
Stamp = struct("Time", sec=types.int32, nanosec=types.uint32)
Header = struct("Header", stamp=Stamp, frame_id=str)
Vector3 = struct("Vector3", x=types.float64, y=types.float64, z=types.float64)
Twist = struct("Twist", linear=Vector3, angular=Vector3)
TwistStamped = struct("TwistStamped", header=Header, twist=Twist)
LaserScan = struct(
    "LaserScan",
    header=Header,
    **dict.fromkeys(FLOATS, types.float32),
    ranges=types.sequence[types.float32],
    intensities=types.sequence[types.float32],
)
Image = struct(
    "Image",
    header=Header,
    height=types.uint32,
    width=types.uint32,
    encoding=str,
    is_bigendian=types.uint8,
    step=types.uint32,
    data=types.sequence[types.uint8],
)


def sample(kind: str) -> Any:
    header, twist = Header(Stamp(0, 0), "frame"), Twist(Vector3(0.3, 0.0, 0.0), Vector3(0.0, 0.0, -0.5))
    if kind == "twist":
        return twist
    if kind == "stamped":
        return TwistStamped(header, twist)
    if kind == "scan":
        return LaserScan(header, *[0.0] * 7, ranges(), [])
    width, height, channels, encoding = SIDES[kind]
    return Image(header, height, width, encoding, 0, width * channels, list(pixels(kind)))


class Peer:
    """A participant."""

    def __init__(self, task: Task) -> None:
        self._type = type(sample(task.kind))
        number = int(os.environ["ROS_DOMAIN_ID"])
        self._domain = domain.Domain(number, f"<CycloneDDS><Domain>{HERE}</Domain></CycloneDDS>")
        self._participant = domain.DomainParticipant(number)
        stored = core.Policy.History.KeepLast(10) if task.large else core.Policy.History.KeepAll
        self._qos = core.Qos(core.Policy.Reliability.Reliable(util.duration(seconds=1)), stored)
        self._stored: list[object] = []

    def writer(self, name: str) -> Any:
        return pub.DataWriter(self._participant, topic.Topic(self._participant, name, self._type), qos=self._qos)

    def read(self, name: str, callback: Callable[[Any], object]) -> None:
        """Call back for each message, on a thread of Cyclone's."""

        def on_data_available(reader: Any) -> None:
            for message in reader.take(100):
                callback(message)

        listener = core.Listener(on_data_available=on_data_available)
        of = topic.Topic(self._participant, name, self._type)
        self._stored.append(sub.DataReader(self._participant, of, qos=self._qos, listener=listener))


def pong(task: Task) -> None:
    peer = Peer(task)
    back = peer.writer("pong")
    peer.read("ping", back.write)
    say_ready()
    time.sleep(task.seconds + 60)


def ping(task: Task) -> None:
    peer, game, message = Peer(task), Ping(task.seconds, retry=5.0), sample(task.kind)
    out = peer.writer("ping")

    def on_pong(answer: Any) -> None:
        if game.answered():
            out.write(message)
        else:
            game.checked = answer == message

    peer.read("pong", on_pong)
    wait_for_match(out)
    game.play(lambda: out.write(message), time.sleep)
    time.sleep(task.seconds + 60)


def sink(task: Task) -> None:
    peer, count = Peer(task), Count()
    peer.read("flood", count.add)
    count.answer()
    say_ready()
    time.sleep(task.seconds + 60)


def source(task: Task) -> None:
    peer, message = Peer(task), sample(task.kind)
    out = peer.writer("flood")
    wait_for_match(out)
    pour(task, out.write, message)


def wait_for_match(out: Any) -> None:
    """Wait until a reader is known, and a little longer: the other way it is not known here."""
    while not out.get_matched_subscriptions():
        time.sleep(0.005)
    time.sleep(0.3)
