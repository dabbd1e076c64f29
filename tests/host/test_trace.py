"""The trace of all that is published: what it counts, and what its hash is made of and what not."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

from robolink.host.trace import LARGE, MANY, Trace
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.rcl_interfaces.msg import Log
from robolink.message import encode
from robolink.qos import QoSProfile
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import DataKey, format_key, pack_attachment

QOS = QoSProfile(depth=10)
HASH = "RIHS01_" + "0" * 64
GID = bytes(range(16))


def key(topic: str, type_name: str = "std_msgs/msg/Int32") -> str:
    return format_key(DataKey(0, topic, type_name, HASH))


def published(*messages: tuple[str, bytes]) -> Trace:
    """Publish on topics; give the trace of it."""
    trace, session, numbers = Trace(), MemoryTransport(bus=Bus()), itertools.count(1)
    outlets = {topic: trace.tapped(key(topic), session.advertise(key(topic), QOS)) for topic in ("/scan", "/odom")}
    for topic, payload in messages:
        outlets[topic].put(payload, pack_attachment(next(numbers), 5, GID))
    return trace


def test_it_counts_messages_and_bytes_by_topic() -> None:
    trace = published(("/scan", b"abc"), ("/scan", b"de"))
    assert trace.messages == {"/odom": 0, "/scan": 2}
    assert trace.bytes == {"/odom": 0, "/scan": 5}


def test_the_hash_is_of_what_was_published_in_its_order() -> None:
    one = published(("/scan", b"abc"), ("/odom", b"d"))
    assert one.hexdigest() == published(("/scan", b"abc"), ("/odom", b"d")).hexdigest()
    others = [
        published(("/odom", b"d"), ("/scan", b"abc")),
        published(("/scan", b"ab"), ("/odom", b"cd")),
        published(("/scan", b"abc"), ("/scan", b"d")),
        published(("/scan", b"abc")),
    ]
    assert len({each.hexdigest() for each in (one, *others)}) == 1 + len(others)


def test_the_hash_is_the_same_whenever_it_is_asked_for() -> None:
    many = [("/scan", b"%d" % number) for number in range(2 * MANY)]
    large = ("/scan", bytes(LARGE + 1))
    trace, session = Trace(), MemoryTransport(bus=Bus())
    asked_often = {topic: trace.tapped(key(topic), session.advertise(key(topic), QOS)) for topic in ("/scan", "/odom")}
    for number, (topic, payload) in enumerate((*many, large, *many), 1):
        trace.hexdigest()
        asked_often[topic].put(payload, pack_attachment(number, 5, GID))
    assert trace.hexdigest() == published(*many, large, *many).hexdigest()


def test_the_hash_of_a_message_is_known() -> None:
    """It must not change between machines and versions without anybody's noticing."""
    assert published(("/scan", b"abc")).hexdigest() == KNOWN


def test_what_is_sent_arrives() -> None:
    trace, bus = Trace(), Bus()
    heard: list[bytes] = []
    ear = MemoryTransport(bus=bus)
    ear.subscribe(key("/scan"), QOS, lambda arrived: heard.append(ear.read(arrived).payload))
    outlet = trace.tapped(key("/scan"), MemoryTransport(bus=bus).advertise(key("/scan"), QOS))
    assert outlet.matched
    outlet.put(b"abc", pack_attachment(1, 5, GID))
    outlet.close()
    assert heard == [b"abc"]
    assert bus.outlets == {}


def logged(**fields: Any) -> str:
    trace, session = Trace(), MemoryTransport(bus=Bus())
    rosout = key("/rosout", "rcl_interfaces/msg/Log")
    outlet = trace.tapped(rosout, session.advertise(rosout, QOS))
    line: Any = {
        "stamp": Time(sec=1),
        "level": 20,
        "name": "world",
        "msg": "hello",
        "file": "/a/b.py",
        "line": 3,
    }
    outlet.put(encode(Log(**{**line, **fields})), pack_attachment(1, 5, GID))
    return trace.hexdigest()


def test_a_line_of_the_log_counts_by_its_words_not_by_its_place() -> None:
    assert logged() == logged(file=str(Path(__file__)), line=99, function="f")
    different: list[dict[str, object]] = [{"msg": "hullo"}, {"level": 30}, {"name": "other"}, {"stamp": Time(sec=2)}]
    assert len({logged(), *(logged(**each) for each in different)}) == 1 + len(different)


def test_a_traceback_in_the_log_does_not_count() -> None:
    text = "it failed:\nTraceback (most recent call last):\n  File {}, line {}"
    assert logged(msg=text.format("/a/b.py", 1)) == logged(msg=text.format("/c/d.py", 22))
    assert logged(msg="it failed:\n") != logged(msg="it fell:\n")


def test_a_compressed_image_counts_without_its_bytes() -> None:
    """Versions of OpenCV differ in them."""

    def compressed(*payloads: bytes) -> str:
        trace, session = Trace(), MemoryTransport(bus=Bus())
        images = key("/image/compressed", "sensor_msgs/msg/CompressedImage")
        outlet = trace.tapped(images, session.advertise(images, QOS))
        for payload in payloads:
            outlet.put(payload, pack_attachment(1, 5, GID))
        return trace.hexdigest()

    assert compressed(b"abc") == compressed(b"defg")
    assert compressed(b"abc") != compressed(b"abc", b"abc")


KNOWN = "3fd6bfd6ee33712769aef59f409706977b56449c3f3e994f9b108f0bf030c554"
