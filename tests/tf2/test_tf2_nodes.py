"""Broadcasters, listeners and buffers on nodes: what arrives, waiting for it, and clocks that jump."""

from __future__ import annotations

from typing import Any

import pytest
import yaml

from robolink import Context, Node
from robolink.clock import ROSClock
from robolink.duration import Duration
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.interfaces.rosgraph_msgs.msg import Clock as ClockMsg
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.interfaces.tf2_msgs.srv import FrameGraph
from robolink.parameter import Parameter
from robolink.qos import DurabilityPolicy
from robolink.tf2 import (
    Buffer,
    StaticTransformBroadcaster,
    TransformBroadcaster,
    TransformListener,
)
from robolink.time import Time
from tests.support.spins import done, spin_for, spin_until
from tests.support.transforms import transform

LATEST = Time()


def node_in(context: Context, name: str, executor: SingleThreadedExecutor | None = None, **options: Any) -> Node:
    made = Node(name, context=context, enable_rosout=False, **options)
    if executor is not None:
        executor.add_node(made)
    return made


@pytest.fixture
def robot(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    """The node that broadcasts."""
    return node_in(virtual, "robot", executor)


@pytest.fixture
def seer(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    """The node that listens."""
    return node_in(virtual, "seer", executor)


# --- what is sent arrives -------------------------------------------------------------------------------------


def test_one_several_or_any_iterable_are_sent(robot: Node, seer: Node, executor: SingleThreadedExecutor) -> None:
    buffer = Buffer()
    TransformListener(buffer, seer)  # nobody keeps it but the node
    broadcaster = TransformBroadcaster(robot)
    broadcaster.sendTransform(transform("a", "b", 1))
    broadcaster.sendTransform([transform("b", "c", 1), transform("c", "d", 1)])
    broadcaster.sendTransform(transform("d", f, 1) for f in "ef")
    spin_until(executor, lambda: len(buffer.get_all_frame_names()) == 6)
    assert buffer.lookup_transform("a", "f", Time(seconds=1)).child_frame_id == "f"
    assert "broadcaster: 'default_authority'" in buffer.all_frames_as_yaml()


def test_a_static_transform_reaches_whoever_comes_later(
    robot: Node, virtual: Context, executor: SingleThreadedExecutor
) -> None:
    broadcaster = StaticTransformBroadcaster(robot)
    given = transform("base", "lidar", 1, (1, 0, 0))
    broadcaster.sendTransform(given)
    given.child_frame_id = "camera"  # programs use one object again
    broadcaster.sendTransform(given)
    broadcaster.sendTransform([transform("base", "lidar", 2, (3, 0, 0))])
    buffer = Buffer()
    listener = TransformListener(buffer, node_in(virtual, "late", executor))
    spin_until(executor, lambda: buffer.can_transform("lidar", "camera", LATEST))
    assert buffer.lookup_transform("base", "lidar", LATEST).transform.translation.x == 3
    assert buffer.lookup_transform("base", "camera", LATEST).transform.translation.x == 1
    assert listener.tf_static_sub.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL


def test_topics_and_profiles_may_be_others(seer: Node) -> None:
    listener = TransformListener(Buffer(), seer, qos=7, static_qos=3, tf_topic="/old/tf", tf_static_topic="mine")
    assert [listener.tf_sub.topic, listener.tf_static_sub.topic] == ["/old/tf", "mine"]
    assert [listener.tf_sub.qos_profile.depth, listener.tf_static_sub.qos_profile.depth] == [7, 3]
    default = TransformListener(Buffer(), seer)
    assert [default.tf_sub.topic, default.tf_static_sub.topic] == ["/tf", "/tf_static"]
    assert default.tf_sub.qos_profile.depth == 100
    assert TransformBroadcaster(seer).pub_tf.qos_profile.depth == 100


def test_a_listener_ends(robot: Node, seer: Node, executor: SingleThreadedExecutor) -> None:
    buffer = Buffer()
    listener = TransformListener(buffer, seer)
    listener.unregister()
    listener.unregister()
    assert [each.topic_name for each in seer.subscriptions] == []
    TransformBroadcaster(robot).sendTransform(transform("a", "b", 1))
    spin_for(executor, 0.1)
    assert buffer.get_all_frame_names() == []


def test_a_bad_transform_of_a_message_spoils_none_beside_it(
    robot: Node, seer: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    buffer = Buffer()
    TransformListener(buffer, seer)
    bad = [transform("a", "a", 1), transform("a", "c", 1, (float("nan"), 0, 0)), transform("", "d", 1)]
    TransformBroadcaster(robot).sendTransform([*bad, transform("a", "b", 1)])
    spin_until(executor, lambda: buffer.can_transform("a", "b", LATEST))
    assert [line.message.split(":")[0] for line in log_lines] == ["TF_SELF_TRANSFORM", "TF_NAN_INPUT", "TF_NO_FRAME_ID"]


def test_the_frames_are_served(robot: Node, seer: Node, executor: SingleThreadedExecutor) -> None:
    buffer = Buffer(node=robot)
    buffer.set_transform_static(transform("a", "b"), "me")
    client = seer.create_client(FrameGraph, "tf2_frames")
    answer = done(executor, client.call_async(FrameGraph.Request()))
    assert yaml.safe_load(answer.frame_yaml)["b"]["parent"] == "a"


def test_how_long_transforms_are_kept_is_given(seer: Node) -> None:
    buffer = Buffer(Duration(seconds=2))
    for second in (1, 2, 3, 4, 5):
        buffer.set_transform(transform("a", "b", second), "me")
    assert not buffer.can_transform("a", "b", Time(seconds=1))
    assert buffer.can_transform("a", "b", Time(seconds=2))


# --- clocks ---------------------------------------------------------------------------------------------------


def sim_time(node: Node, seconds: float) -> None:
    clock = node.get_clock()
    assert isinstance(clock, ROSClock)
    clock.set_ros_time_override(Time(seconds=seconds))


@pytest.mark.parametrize("knows_node", [True, False])
def test_a_clock_that_jumps_back_clears_the_buffer(
    knows_node: bool, robot: Node, seer: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    seer.set_parameters([Parameter("use_sim_time", value=True)])
    buffer = Buffer(node=seer) if knows_node else Buffer()
    TransformListener(buffer, seer)
    ticks = robot.create_publisher(ClockMsg, "/clock", 10)

    def tick(second: int) -> None:
        ticks.publish(ClockMsg(clock=TimeMsg(sec=second)))
        spin_until(executor, lambda: seer.get_clock().now().nanoseconds == second * 10**9)

    tick(100)
    buffer.set_transform(transform("a", "b", 100), "me")
    buffer.set_transform_static(transform("b", "c"), "me")
    tick(101)
    assert buffer.can_transform("a", "c", LATEST)
    tick(5)
    assert not buffer.can_transform("a", "c", LATEST)
    assert buffer.can_transform("b", "c", LATEST)
    assert [line.message for line in log_lines] == ["Detected jump back in time. Clearing tf buffer."]
    buffer.set_transform(transform("a", "b", 5), "me")
    assert buffer.can_transform("a", "c", Time(seconds=5))


def test_another_source_of_time_clears_the_buffer(seer: Node, log_lines: list[Record]) -> None:
    buffer = Buffer(node=seer)
    buffer.set_transform(transform("a", "b", 100), "me")
    seer.set_parameters([Parameter("use_sim_time", value=True)])
    assert not buffer.can_transform("a", "b", LATEST)
    assert [line.message for line in log_lines] == ["The clock has another source now. Clearing tf buffer."]


def test_a_message_of_no_transforms_is_none() -> None:
    assert TFMessage().transforms == []
