"""What a system's messages look like to whoever asks afterwards: kept, named, timed and told on one line."""

from __future__ import annotations

import math
import random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Context, Node, VirtualTime, interfaces
from robolink.interfaces.geometry_msgs.msg import Point32, Polygon, TransformStamped, Twist
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.message.one_line import WIDTH, short
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.serialization import deserialize_message
from robolink.testing.expectations import Ends, Event, messages_of, no_such, nothing_came, seconds, table
from robolink.testing.recorder import RETAINED, Recorder
from robolink.text.names import near
from robolink.transport.memory import Bus, MemoryTransport
from tests.support.filled import filled

LATCHED = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)

# Values


def test_only_what_is_not_the_default_is_shown_by_its_path() -> None:
    odometry = Odometry()
    odometry.header.stamp.sec = 12
    odometry.header.frame_id = "odom"
    odometry.pose.pose.position.x, odometry.pose.pose.position.y = 1.23456, 2.0
    odometry.twist.twist.angular.z = -0.5
    assert short(odometry) == "pose.pose.position.x=1.235 .y=2, twist.twist.angular.z=-0.5"


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (Twist(), ""),
        (LaserScan(ranges=[1.0, math.inf, math.nan, 2.0, 3.0]), "ranges=5 from 1 to 3"),
        (LaserScan(ranges=[1.0, math.inf, math.nan]), "ranges=[1, inf, nan]"),
        (LaserScan(ranges=[math.inf] * 5), "ranges=[inf, inf, inf, inf, ...]"),
        (LaserScan(ranges=[1.0] * 20_000), "ranges=[1, 1, 1, 1, ...]"),
        (String(data="a\nb"), r"data='a\nb'"),
    ],
)
def test_a_message_on_one_line(message: Any, text: str) -> None:
    assert short(message) == text


def test_a_long_scan_leaves_out_what_is_the_same_each_time_and_no_ranges() -> None:
    scan = LaserScan(angle_min=-3.142, angle_max=3.124, angle_increment=0.01745, scan_time=0.1, ranges=[0.6, 6.5] * 180)
    scan.range_min, scan.range_max, scan.time_increment = 0.12, 12.0, 0.000277
    text = short(scan)
    assert text.startswith("angle_min=-3.142, angle_max=3.124, ")
    assert text.endswith(", ..., ranges=360 from 0.6 to 6.5")
    assert len(text) <= WIDTH


def test_a_transform_tells_its_frames_and_what_is_not_zero() -> None:
    moved = TransformStamped(child_frame_id="base_link")
    moved.header.frame_id, moved.header.stamp.sec = "odom", 4
    moved.transform.translation.x, moved.transform.translation.y = 3.749, 0.596
    assert short(TFMessage(transforms=[moved])) == (
        "transforms=[{frame_id='odom', child_frame_id='base_link', transform.translation.x=3.749 .y=0.596}]"
    )


def test_a_line_has_an_end() -> None:
    assert short(String(data="x" * 1000)) == f"data='{'x' * 60}...'"
    assert len(short(Polygon(points=[Point32(x=float(each)) for each in range(100)]))) <= WIDTH


@given(st.sampled_from(interfaces.names()), st.integers(0, 1000))
def test_any_message_is_told_on_one_line(name: str, seed: int) -> None:
    text = short(filled(interfaces.find(name), random.Random(seed)))
    assert len(text) <= WIDTH
    assert text.isprintable()


# The recorder


@pytest.fixture
def network() -> tuple[Context, Recorder]:
    bus = Bus()
    context = Context(transport=MemoryTransport(bus=bus), time=VirtualTime(5))
    context.init([], domain_id=0)
    return context, Recorder(MemoryTransport(bus=bus), 0, context.time.now)


def numbers(recorder: Recorder, topic: str) -> list[int]:
    (found,) = recorder.named(topic)
    return [deserialize_message(recorder.sample(each).payload, Int32).data for each in found.retained]


def test_the_last_messages_of_each_topic_are_kept_and_nobody_sees_the_listener(
    network: tuple[Context, Recorder],
) -> None:
    context, recorder = network
    with context, Node("talker", context=context, namespace="/ada") as node:
        publisher = node.create_publisher(Int32, "count", 10)
        for each in range(2 * RETAINED):
            publisher.publish(Int32(data=each))
        assert numbers(recorder, "/ada/count") == list(range(RETAINED, 2 * RETAINED))
        assert recorder.named("/ada/count")[0].count == 2 * RETAINED
        assert recorder.named("/count") == []
        assert publisher.get_subscription_count() == 0
        assert node.get_fully_qualified_node_names() == ["/ada/talker"]
        heard = recorder.named("/ada/count")[0].retained[0]
        assert (heard.time_ns, recorder.sender(recorder.sample(heard))) == (5, "/ada/talker")


def test_who_listens_hears_what_comes_and_what_was_kept_for_late_ones(network: tuple[Context, Recorder]) -> None:
    context, recorder = network
    with context, Node("talker", context=context) as node:
        usual, latched = node.create_publisher(Int32, "usual", 10), node.create_publisher(Int32, "latched", LATCHED)
        for each in (usual, latched):
            each.publish(Int32(data=1))
        with recorder.listening("/usual") as ear, recorder.listening("/latched") as late:
            assert [len(each.take()) for each in (ear, late)] == [0, 1]
            usual.publish(Int32(data=2))
            ((topic, sample),) = ear.take()
            assert (topic.name, deserialize_message(sample.payload, Int32).data) == ("/usual", 2)
            assert ear.take() == []
        usual.publish(Int32(data=3))
        assert ear.take() == []


def test_a_topic_that_nobody_publishes_yet_is_heard_once_somebody_does(network: tuple[Context, Recorder]) -> None:
    context, recorder = network
    with context, recorder.listening("/later") as ear, Node("talker", context=context) as node:
        node.create_publisher(Int32, "later", 10).publish(Int32(data=7))
        node.create_publisher(String, "later", 10).publish(String(data="also"))
        assert [topic.type_name for topic, _ in ear.take()] == ["std_msgs/msg/Int32", "std_msgs/msg/String"]


def test_nonsense_on_the_wire_is_told_as_such(network: tuple[Context, Recorder]) -> None:
    context, recorder = network
    with context, Node("talker", context=context) as node:
        node.create_publisher(String, "words", 10)
        (topic,) = recorder.named("/words")
        MemoryTransport(bus=context.transport.bus).advertise(topic.key, LATCHED).put(b"\x00\x01", b"odd")  # type: ignore[attr-defined]
        (moment,) = messages_of(recorder, topic, lambda _: String, 3)
        assert moment.who == ""
        assert moment.text.startswith("2 bytes of std_msgs/msg/String: ")


# What a test is told


def test_a_table_is_in_order_of_time_and_counts_from_the_beginning() -> None:
    moments = [Event(3_500_000_000, "/scan", "/world", "ranges=[1]"), Event(1_000_000_000, "WARN", "goto", "late")]
    assert table(moments, 500_000_000).splitlines() == [
        "  0.500 s  WARN   goto    late",
        "  3.000 s  /scan  /world  ranges=[1]",
    ]
    assert table([], 0) == ""


KNOWN = [("/odom", "nav_msgs/msg/Odometry"), ("/ada/scan", "sensor_msgs/msg/LaserScan")]
TYPE = ("a/msg/B",)


@pytest.mark.parametrize(
    ("name", "ends", "tried", "text"),
    [
        ("/odom", Ends(("/world",), (), TYPE), 0, "nothing came on /odom SPAN, which /world may publish"),
        ("/odom", Ends(("/a", "/b"), (), TYPE), 7, "none of the 7 messages on /odom fulfilled the condition SPAN"),
        ("/odom", Ends(("/a",), (), TYPE), 1, "the only message on /odom did not fulfil the condition SPAN"),
        ("/x", Ends((), ("/a", "/b"), TYPE), 0, "nobody publishes /x [a/msg/B], to which /a and /b listen SPAN"),
        ("/odum", Ends((), (), ()), 0, "there is no topic /odum (did you mean '/odom'?) SPAN; there are: "),
        ("/scan", Ends((), (), ()), 0, "there is no topic /scan (did you mean '/ada/scan'?) SPAN; there are: "),
    ],
)
def test_why_nothing_came(name: str, ends: Ends, tried: int, text: str) -> None:
    told = nothing_came(name, ends, KNOWN, tried, "SPAN")
    assert told == text or (text.endswith(": ") and told.startswith(text))


def test_what_there_is_instead() -> None:
    assert no_such("service", "/reset", [], "SPAN") == "there is no service /reset SPAN; there is none at all"
    many = [(f"/t{each}", "a/msg/B") for each in range(100)]
    assert no_such("topic", "/q", many, "SPAN").endswith("/t19 [a/msg/B] and 88 more")
    assert near("/q", []) == ""


@pytest.mark.parametrize(("value", "text"), [(0.0, "0 s"), (5.0, "5 s"), (0.25, "0.25 s"), (12.3456, "12.346 s")])
def test_seconds(value: float, text: str) -> None:
    assert seconds(value) == text
