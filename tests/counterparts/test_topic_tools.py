"""topic_tools: messages of any type are passed on, as bytes."""

from __future__ import annotations

import math
from typing import Any

import pytest

from robolink.counterparts.topic_tools.mux import demux_parameters, mux_parameters
from robolink.counterparts.topic_tools.topic_tool import numbered, throttle_parameters
from robolink.exceptions import RobolinkError
from robolink.interfaces.geometry_msgs.msg import Quaternion
from robolink.interfaces.sensor_msgs.msg import Imu, LaserScan
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.topic_tools_interfaces.srv import (
    DemuxSelect,
    MuxAdd,
    MuxDelete,
    MuxList,
    MuxSelect,
)
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.testing import System

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def counted(system: System, count: int, period: float = 0.1, topic: str = "/count") -> None:
    """Publish 0, 1, 2 ..., after the tool has seen the topic."""
    publisher = system.node.create_publisher(Int32, topic, 50)
    system.run(0.2)
    for number in range(count):
        publisher.publish(Int32(data=number))
        system.run(period)


def numbers(messages: list[Any]) -> list[int]:
    return [each.data for each in messages]


def test_a_relay_passes_on_any_type_with_its_quality_of_service(system: System) -> None:
    system.start("topic_tools relay", args=["/scan"])
    system.publish("/scan", LaserScan(ranges=[1.0, 2.0]), LATCHED)
    system.run(0.5)
    (end,) = system.node.get_publishers_info_by_topic("/scan_relay")
    assert end.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert end.topic_type == "sensor_msgs/msg/LaserScan"
    assert list(system.expect("/scan_relay").ranges) == [1, 2]


def test_best_effort_stays_best_effort(system: System) -> None:
    system.start("topic_tools relay", parameters={"input_topic": "chatter", "output_topic": "other"})
    system.publish("/chatter", String(data="a"), QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
    system.run(0.5)
    (end,) = system.node.get_publishers_info_by_topic("/other")
    assert end.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT


def test_a_lazy_relay_listens_only_while_it_is_heard(system: System) -> None:
    system.start("topic_tools relay", parameters={"input_topic": "count", "lazy": True})
    publisher = system.node.create_publisher(Int32, "/count", 10)
    system.run(1.0)
    assert publisher.get_subscription_count() == 0
    subscription = system.node.create_subscription(Int32, "/count_relay", lambda message: None, 10)
    system.run(0.5)
    assert publisher.get_subscription_count() == 1
    system.node.destroy_subscription(subscription)
    system.run(0.5)
    assert publisher.get_subscription_count() == 0


def test_a_source_may_go_and_come_with_another_type(system: System) -> None:
    system.start("topic_tools relay", args=["/thing"])
    first = system.node.create_publisher(Int32, "/thing", 10)
    system.run(0.5)
    system.node.destroy_publisher(first)
    system.run(0.5)
    assert system.node.get_publishers_info_by_topic("/thing_relay") == []
    system.publish("/thing", String(data="a"))
    system.run(0.5)
    assert [each.topic_type for each in system.node.get_publishers_info_by_topic("/thing_relay")] == [
        "std_msgs/msg/String"
    ]


def test_so_many_messages_a_second(system: System) -> None:
    system.start("topic_tools throttle", args=["messages", "count", "2.0", "slow"])
    heard = system.messages("/slow", Int32)
    counted(system, 40)
    assert 7 <= len(heard) <= 9


def test_so_many_bytes_a_second(system: System) -> None:
    system.start("topic_tools throttle", args=["bytes", "count", "24", "1.0"])
    heard = system.messages("/count_throttle", Int32)
    counted(system, 40)
    assert 11 <= len(heard) <= 13  # three of 8 bytes a second


def test_some_are_dropped(system: System) -> None:
    system.start("topic_tools drop", args=["count", "2", "3"])
    heard = system.messages("/count_drop", Int32)
    counted(system, 9)
    assert numbers(heard) == [2, 5, 8]


def test_messages_are_delayed(system: System) -> None:
    system.start("topic_tools delay", args=["count", "0.55"])
    heard = system.messages("/count_delay", Int32)
    counted(system, 5)
    assert numbers(heard) == []
    system.run(0.1)
    assert numbers(heard) == [0]
    system.run(0.35)
    assert numbers(heard) == [0, 1, 2, 3, 4]


def test_a_mux_passes_on_the_selected_topic(system: System) -> None:
    system.start("topic_tools mux", args=["selected", "one", "two"])
    publishers = {name: system.node.create_publisher(Int32, f"/{name}", 10) for name in ("one", "two", "three")}
    heard = system.messages("/selected", Int32)

    def published() -> list[int]:
        del heard[:]
        system.run(0.3)
        for number, publisher in enumerate(publishers.values(), 1):
            publisher.publish(Int32(data=number))
        system.run(0.3)
        return numbers(heard)

    def select(topic: str) -> MuxSelect.Response:
        answer: MuxSelect.Response = system.call(MuxSelect, "/mux/select", MuxSelect.Request(topic=topic))
        return answer

    assert published() == [1]
    assert (select("/two").prev_topic, published()) == ("one", [2])
    assert not select("three").success
    assert system.call(MuxAdd, "/mux/add", MuxAdd.Request(topic="three")).success
    assert not system.call(MuxAdd, "/mux/add", MuxAdd.Request(topic="three")).success
    assert (select("three").success, published()) == (True, [3])
    assert not system.call(MuxDelete, "/mux/delete", MuxDelete.Request(topic="/three")).success
    assert not system.call(MuxDelete, "/mux/delete", MuxDelete.Request(topic="four")).success
    assert system.call(MuxDelete, "/mux/delete", MuxDelete.Request(topic="/one")).success
    assert system.call(MuxList, "/mux/list").topics == ["two", "three"]
    assert (select("__none").prev_topic, published()) == ("three", [])


def test_a_demux_passes_on_to_the_selected_topic(system: System) -> None:
    system.start("topic_tools demux", args=["count", "one", "two"])
    heard = {name: system.messages(f"/{name}", Int32) for name in ("one", "two")}
    counted(system, 2)
    assert system.call(DemuxSelect, "/demux/select", DemuxSelect.Request(topic="two")).prev_topic == "one"
    counted(system, 1)
    assert {name: numbers(each) for name, each in heard.items()} == {"one": [0, 1], "two": [0]}


def test_an_expression_makes_other_messages(system: System) -> None:
    expression = "std_msgs.msg.Float64(data=numpy.rad2deg(m))"
    args = ["/imu", "/degrees", "std_msgs/Float64", expression, "--field", "orientation.x", "-i", "std_msgs", "numpy"]
    system.start("topic_tools transform", args=args)
    system.publish("/imu", Imu(orientation=Quaternion(x=0.0)))
    system.run(0.5)
    system.publish("/imu", Imu(orientation=Quaternion(x=math.pi)))
    assert system.expect("/degrees").data == 180
    system.publish("/imu", Imu())
    assert system.expect("/degrees").data == 0


def test_an_expression_that_fails_is_told(system: System) -> None:
    system.start("topic_tools transform", args=["/count", "/half", "std_msgs/Int32", "m.value"])
    counted(system, 2)
    system.expect_log("a message cannot be converted: AttributeError: ")


def test_fields_are_relayed_into_another_type(system: System) -> None:
    fields = "{stamp: now, frame_id: 'm.data + \"!\"'}"
    system.start("topic_tools relay_field", args=["/chatter", "/header", "std_msgs/Header", fields])
    system.publish("/chatter", String(data="a"))
    system.run(1.0)
    system.publish("/chatter", String(data="map"))
    header = system.expect("/header")
    assert (header.frame_id, header.stamp.sec > 0) == ("map!", True)


@pytest.mark.parametrize(
    ("tool", "args", "said"),
    [
        ("relay", [], "the parameter input_topic is needed: topic to listen to"),
        ("relay", ["a", "b", "c"], "3 arguments: expected relay INTOPIC"),
        ("relay", ["a", "/a"], "input and output are one topic, a"),
        ("throttle", ["message", "a", "1"], "expected throttle messages INTOPIC"),
        ("throttle", ["messages", "a", "fast"], "msgs_per_sec: expected a number, got 'fast'"),
        ("throttle", ["messages", "a", "-1"], "msgs_per_sec: expected a number above 0, got -1"),
        ("drop", ["a", "3", "2"], "expected 0 <= X <= Y and Y at least 1, got 3 and 2"),
        ("drop", ["a", "0", "0"], "expected 0 <= X <= Y and Y at least 1, got 0 and 0"),
        ("delay", ["a", "inf"], "delay: expected seconds from 0 on, got inf"),
        ("transform", ["/a", "/b", "std_msgs/Int3", "m"], "did you mean 'Int32'"),
        ("transform", ["/a", "/b", "std_msgs/Int32", "m +"], "no expression of Python: invalid syntax"),
        ("transform", ["/a", "/b", "std_msgs/Int32", "m", "-i", "nowhere"], "--import nowhere: "),
        ("relay_field", ["/a", "/b", "std_msgs/Int32", "m"], "expected fields such as"),
        ("relay_field", ["/a", "/b", "std_msgs/Int32", "{data: m"], "EXPRESSION:1:"),
        ("mux", [], "the parameter input_topics is needed"),
    ],
)
def test_other_arguments_are_one_line(system: System, tool: str, args: list[str], said: str) -> None:
    with pytest.raises(RobolinkError, match=said):
        system.start(f"topic_tools {tool}", args=args)


def test_arguments_are_parameters() -> None:
    assert throttle_parameters(["bytes", "a", "1024", "0.5"]) == {
        "throttle_type": "bytes",
        "input_topic": "a",
        "bytes_per_sec": 1024,
        "window": 0.5,
    }
    assert mux_parameters(["out", "a", "b"]) == {"output_topic": "out", "input_topics": ["a", "b"]}
    assert numbered([], "usage", ("a", str)) == {}
    for parameters in (mux_parameters, demux_parameters):
        with pytest.raises(RobolinkError, match="1 argument: expected"):
            parameters(["a"])
