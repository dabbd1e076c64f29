"""How fast messages are: round trips, throughput and codec, each beside a peer in the same run.

    python benchmarks/messaging.py [--rounds 5] [--seconds 2]

Figures of one machine at one moment mean little; the ratios carry over. Two processes play ping-pong, one pinned to
each of two cores, robolink's nodes and bare zenoh-python callbacks taking turns. The bare ones do the least that a
program can do with a message: they take its bytes and send them.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
import timeit
from array import array
from collections.abc import Callable
from typing import Any

import msgspec

import robolink
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.message import Message, decoder, encode, encoder
from robolink.qos import HistoryPolicy, QoSProfile

TRIPS, WARM_UP = 3000, 300
DOMAIN = 97
FLOOD = QoSProfile(depth=1, history=HistoryPolicy.KEEP_ALL)
MESSAGES: dict[str, type[Message]] = {"Twist": Twist, "LaserScan": LaserScan}


def sample(name: str) -> Any:
    """A message as a robot would send it; the scan has 360 beams."""
    if name == "Twist":
        twist = Twist()
        twist.linear.x, twist.angular.z = 0.3, -0.5
        return twist
    scan = LaserScan(ranges=array("f", [1.5 + 0.001 * beam for beam in range(360)]))
    scan.header.frame_id = "laser"
    return scan


def pin(core: int) -> None:
    """Stay on one core, where the system can do that."""
    if hasattr(os, "sched_setaffinity") and (os.cpu_count() or 1) > 1:
        os.sched_setaffinity(0, {core})


# Round trips


def bare_session(first: bool) -> Any:
    import zenoh

    from robolink.transport.network import load

    return zenoh.open(load(None, DOMAIN, os.environ, holds_port=first))


def bare_pong(name: str) -> None:
    session = bare_session(first=True)
    back = session.declare_publisher("bench/pong")
    _keep = session.declare_subscriber("bench/ping", lambda got: back.put(got.payload.to_bytes()))
    say_ready()
    sys.stdin.read()


def bare_ping(name: str) -> list[float]:
    import threading

    session, payload, times, done = bare_session(first=False), encode(sample(name)), [], threading.Event()
    out = session.declare_publisher("bench/ping")

    def on_pong(got: Any) -> None:
        nonlocal payload
        payload = got.payload.to_bytes()
        times.append(time.perf_counter())
        if len(times) < TRIPS:
            out.put(payload)
        else:
            done.set()

    _keep = session.declare_subscriber("bench/pong", on_pong)
    while not times:  # until both ends know each other
        out.put(payload)
        time.sleep(0.05)
    done.wait(30)
    session.close()
    return times


def robolink_pong(name: str) -> None:
    robolink.init(args=[], domain_id=DOMAIN)
    node = robolink.create_node("pong")
    back = node.create_publisher(MESSAGES[name], "pong", 10)
    node.create_subscription(MESSAGES[name], "ping", back.publish, 10)
    say_ready()
    robolink.spin(node)


def robolink_ping(name: str) -> list[float]:
    robolink.init(args=[], domain_id=DOMAIN)
    node = robolink.create_node("ping")
    message, times, done = sample(name), [], robolink.Future[None]()
    out = node.create_publisher(MESSAGES[name], "ping", 10)

    def on_pong(_: Any) -> None:
        times.append(time.perf_counter())
        if len(times) < TRIPS:
            out.publish(message)
        else:
            done.set_result(None)

    node.create_subscription(MESSAGES[name], "pong", on_pong, 10)
    while not times:
        out.publish(message)
        robolink.spin_once(node, timeout_sec=0.05)
    robolink.spin_until_future_complete(node, done, timeout_sec=30)
    robolink.shutdown()
    return times


# Throughput


def robolink_sink(name: str) -> None:
    """Count what arrives from first to last; the pace is the receiver's."""
    robolink.init(args=[], domain_id=DOMAIN)
    node = robolink.create_node("sink")
    last_speed, count, started = Twist(), 0, 0.0
    done = robolink.Future[None]()

    def on_message(twist: Twist) -> None:
        nonlocal count, started, last_speed
        started = started or time.perf_counter()
        count += 1
        last_speed = twist
        if twist.linear.z:
            done.set_result(None)

    node.create_subscription(Twist, "flood", on_message, FLOOD)
    print("ready", flush=True)
    robolink.spin_until_future_complete(node, done, timeout_sec=60)
    print(count, int(last_speed.linear.y), time.perf_counter() - started, flush=True)
    robolink.shutdown()


def flood(seconds: float) -> tuple[int, int, float]:
    """Send for so long as fast as it goes; give sent, received, and received a second."""
    sink = start("robolink_sink", "Twist", core=1)
    robolink.init(args=[], domain_id=DOMAIN)
    node = robolink.create_node("source")
    out = node.create_publisher(Twist, "flood", FLOOD)
    while not out.get_subscription_count():
        time.sleep(0.01)
    time.sleep(0.3)
    twist, sent, end = Twist(), 0, time.perf_counter() + seconds
    while time.perf_counter() < end:
        for _ in range(100):
            sent += 1
            twist.linear.y = float(sent)
            out.publish(twist)
    twist.linear.z = 1.0
    out.publish(twist)
    assert sink.stdout is not None
    received, _, took = sink.stdout.readline().split()
    sink.wait()
    robolink.shutdown()
    return sent + 1, int(received), int(received) / float(took)


# Processes


def say_ready() -> None:
    print("ready", flush=True)


def start(role: str, name: str, core: int) -> subprocess.Popen[str]:
    command = [sys.executable, __file__, "--role", role, "--message", name, "--core", str(core)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    return process


def round_trips(kind: str, name: str) -> list[float]:
    """Microseconds of each trip, of one game in two fresh processes."""
    pong = start(f"{kind}_pong", name, core=1)
    command = [sys.executable, __file__, "--role", f"{kind}_ping", "--message", name, "--core", "0"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    pong.kill()
    pong.wait()
    return [float(each) for each in text.split()]


def play(role: str, name: str) -> None:
    """Be one of the two processes."""
    times = globals()[role](name)
    if times:
        trips = [1e6 * (b - a) for a, b in zip(times[WARM_UP:], times[WARM_UP + 1 :], strict=False)]
        print(*(f"{trip:.1f}" for trip in trips))


# Codec


class Vector(msgspec.Struct):
    x: float
    y: float
    z: float


class PlainTwist(msgspec.Struct):
    linear: Vector
    angular: Vector


class PlainHeader(msgspec.Struct):
    sec: int
    nanosec: int
    frame_id: str


class PlainScan(msgspec.Struct):
    header: PlainHeader
    angle_min: float
    angle_max: float
    angle_increment: float
    time_increment: float
    scan_time: float
    range_min: float
    range_max: float
    ranges: list[float]
    intensities: list[float]


def microseconds(function: Callable[[Any], Any], argument: Any, number: int = 20000) -> float:
    """The best of five: what is slower was disturbed."""
    return min(timeit.repeat(lambda: function(argument), number=number, repeat=5)) / number * 1e6


def codec(name: str) -> dict[str, tuple[float, float]]:
    """Microseconds out and in, for robolink, msgspec and rosbags."""
    from rosbags.typesys import Stores, get_typestore

    message, cls = sample(name), MESSAGES[name]
    data = encode(message)
    plain: Any
    if name == "Twist":
        plain = PlainTwist(Vector(0.3, 0.0, 0.0), Vector(0.0, 0.0, -0.5))
    else:
        plain = PlainScan(PlainHeader(0, 0, "laser"), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, list(message.ranges), [])
    packer, unpacker = msgspec.msgpack.Encoder(), msgspec.msgpack.Decoder(type(plain))
    store = get_typestore(Stores.ROS2_JAZZY)
    ros_type = cls.__ros_type__
    ros_message = store.deserialize_cdr(data, ros_type)
    return {
        "robolink": (microseconds(encoder(cls), message), microseconds(decoder(cls), data)),
        "msgspec": (microseconds(packer.encode, plain), microseconds(unpacker.decode, packer.encode(plain))),
        "rosbags": (
            microseconds(lambda each: store.serialize_cdr(each, ros_type), ros_message, 5000),
            microseconds(lambda each: store.deserialize_cdr(each, ros_type), data, 5000),
        ),
    }


def report(rounds: int, seconds: float) -> None:
    print("codec, us              out      in     out + in, against msgspec")
    for name in MESSAGES:
        figures = codec(name)
        base = sum(figures["msgspec"])
        for peer, (out, back) in figures.items():
            print(f"  {name:10} {peer:9} {out:6.2f}  {back:6.2f}     {(out + back) / base:.2f}")
    print(f"\nround trip between two processes, us, medians of {rounds} rounds by turns")
    for name in MESSAGES:
        games = [(round_trips("bare", name), round_trips("robolink", name)) for _ in range(rounds)]
        bare = statistics.median(statistics.median(game[0]) for game in games)
        ours = statistics.median(statistics.median(game[1]) for game in games)
        print(f"  {name:10} bare zenoh {bare:6.1f}   robolink {ours:6.1f}   ratio {ours / bare:.2f}")
    sent, received, rate = flood(seconds)
    print(f"\nTwist, node to node, KEEP_ALL: {rate:,.0f} received a second; {sent - received} of {sent} lost")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--role", help=argparse.SUPPRESS)
    parser.add_argument("--message", default="Twist", help=argparse.SUPPRESS)
    parser.add_argument("--core", type=int, default=0, help=argparse.SUPPRESS)
    options = parser.parse_args()
    pin(options.core) if options.role else None
    if options.role:
        play(options.role, options.message)
    else:
        report(options.rounds, options.seconds)


if __name__ == "__main__":
    main()
