"""Waiting for transforms: in a callback, in a thread, and with a future."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

import robolink
from robolink import Context, Node
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.duration import Duration
from robolink.exceptions import ExternalShutdownException
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Empty
from robolink.parameter import Parameter
from robolink.tf2 import (
    Buffer,
    ExtrapolationException,
    LookupException,
    StaticTransformBroadcaster,
    StaticTransformListener,
    TransformBroadcaster,
    TransformListener,
)
from robolink.time import Time
from tests.support.spins import spin_until
from tests.support.transforms import transform

LATEST = Time()

SECOND = Duration(seconds=1)


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


def asks(node: Node, answers: list[Any], ask: Callable[[], Any]) -> None:
    """Have the node ask in a callback, on a message of /go."""

    def on_go(_: Empty) -> None:
        try:
            answers.append(ask())
        except LookupError as error:
            answers.append(error)

    node.create_subscription(Empty, "/go", on_go, 10)


def test_a_callback_waits_for_a_transform_that_is_under_way(
    robot: Node, seer: Node, executor: SingleThreadedExecutor
) -> None:
    """With rclpy's single-threaded executor this times out: /tf cannot be received meanwhile."""
    buffer, answers = Buffer(), list[Any]()
    TransformListener(buffer, seer)
    asks(seer, answers, lambda: buffer.lookup_transform("a", "c", Time(seconds=1), timeout=SECOND))
    robot.create_publisher(Empty, "/go", 10).publish(Empty())
    TransformBroadcaster(robot).sendTransform(transform("a", "b", 1, (2, 0, 0)))
    StaticTransformBroadcaster(robot).sendTransform(transform("b", "c", 0, (3, 0, 0)))
    spin_until(executor, lambda: bool(answers))
    assert answers[0].transform.translation.x == 5
    assert executor.context.time.steady() == 0  # it came before the clock had to move


def test_a_callback_waits_no_longer_than_it_says(robot: Node, seer: Node, executor: SingleThreadedExecutor) -> None:
    buffer, answers = Buffer(), list[Any]()
    TransformListener(buffer, seer)
    asks(seer, answers, lambda: buffer.can_transform("a", "c", LATEST, SECOND, True))
    asks(seer, answers, lambda: buffer.lookup_transform("a", "c", LATEST, SECOND))
    robot.create_publisher(Empty, "/go", 10).publish(Empty())
    spin_until(executor, lambda: len(answers) == 2)
    assert answers[0] == (False, '"a" passed to canTransform argument target_frame does not exist.')
    assert isinstance(answers[1], LookupException)
    assert executor.context.time.steady() == 2 * 10**9


def test_while_a_callback_waits_no_other_callback_runs(
    robot: Node, seer: Node, executor: SingleThreadedExecutor
) -> None:
    buffer, answers, told = Buffer(), list[Any](), list[str]()
    TransformListener(buffer, seer)
    asks(seer, answers, lambda: (buffer.lookup_transform("a", "b", LATEST, SECOND), told.copy()))
    seer.create_subscription(Empty, "/other", lambda _: told.append("other"), 10)
    for topic in ("/go", "/other"):
        robot.create_publisher(Empty, topic, 10).publish(Empty())
    TransformBroadcaster(robot).sendTransform(transform("a", "b", 1))
    spin_until(executor, lambda: bool(answers and told))
    assert answers[0][1] == []


def test_the_full_form_waits_as_well(robot: Node, seer: Node, executor: SingleThreadedExecutor) -> None:
    buffer, answers = Buffer(), list[Any]()
    TransformListener(buffer, seer)
    asked = ("b", Time(seconds=2), "b", Time(seconds=1), "a")
    asks(seer, answers, lambda: buffer.lookup_transform_full(*asked, timeout=SECOND))
    asks(seer, answers, lambda: buffer.can_transform_full(*asked, SECOND))
    asks(seer, answers, lambda: buffer.can_transform_full(*asked, SECOND, return_debug_tuple=True))
    robot.create_publisher(Empty, "/go", 10).publish(Empty())
    TransformBroadcaster(robot).sendTransform([transform("a", "b", s, (s, 0, 0)) for s in (1, 2)])
    spin_until(executor, lambda: len(answers) == 3)
    assert answers[0].transform.translation.x == -1
    assert answers[1:] == [True, (True, "")]


def test_callbacks_of_all_threads_may_wait(context: Context) -> None:
    robot, seer = node_in(context, "robot"), node_in(context, "seer")
    buffer, answers = Buffer(), list[Any]()
    TransformListener(buffer, seer)
    group = ReentrantCallbackGroup()
    patience = Duration(seconds=30)
    for topic in ("/one", "/two"):
        seer.create_subscription(
            Empty,
            topic,
            lambda _: answers.append(buffer.can_transform("a", "b", LATEST, patience)),
            10,
            callback_group=group,
        )
    with MultiThreadedExecutor(2, context=context) as executor:
        executor.add_node(seer)
        for topic in ("/one", "/two"):
            robot.create_publisher(Empty, topic, 10).publish(Empty())
        TransformBroadcaster(robot).sendTransform(transform("a", "b", 1))
        spin_until(executor, lambda: len(answers) == 2, patience=30)
    assert answers == [True, True]


def test_another_buffer_may_take_a_listeners_place(robot: Node, seer: Node, executor: SingleThreadedExecutor) -> None:
    old, new, answers = Buffer(), Buffer(), list[Any]()
    listener = TransformListener(old, seer)
    listener.buffer = new
    asks(seer, answers, lambda: new.can_transform("a", "b", LATEST, SECOND))
    robot.create_publisher(Empty, "/go", 10).publish(Empty())
    TransformBroadcaster(robot).sendTransform(transform("a", "b", 1))
    spin_until(executor, lambda: bool(answers))
    assert answers == [True]
    assert old.get_all_frame_names() == []
    old.set_transform(transform("a", "b", 1), "me")
    seer.set_parameters([Parameter("use_sim_time", value=True)])
    assert not new.can_transform("a", "b", LATEST)
    assert old.can_transform("a", "b", LATEST)  # that clock is none of its business now


def test_what_is_too_long_ago_is_not_waited_for(virtual: Context, seer: Node) -> None:
    buffer = Buffer()
    TransformListener(buffer, seer)
    for second in (50, 60):
        buffer.set_transform(transform("a", "b", second), "me")
    with pytest.raises(ExtrapolationException, match="into the past"):
        buffer.lookup_transform("a", "b", Time(seconds=1), Duration(seconds=1000))
    assert virtual.time.steady() == 0


def test_a_thread_waits_for_another_that_spins(context: Context) -> None:
    robot, seer = node_in(context, "robot"), node_in(context, "seer")
    buffer = Buffer()
    listener = TransformListener(buffer, seer, spin_thread=True)
    broadcaster = TransformBroadcaster(robot)
    timer = threading.Timer(0.05, lambda: broadcaster.sendTransform(transform("a", "b", 1)))
    timer.start()
    assert buffer.lookup_transform("a", "b", LATEST, Duration(seconds=30)).header.stamp.sec == 1
    timer.join()
    context.shutdown()
    listener.dedicated_listener_thread.join(10)
    assert not listener.dedicated_listener_thread.is_alive()


@pytest.fixture
def default_context(monkeypatch: pytest.MonkeyPatch) -> Iterator[Context]:
    """The default context, with nobody else on its network."""
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory")
    with robolink.init(args=[]):
        yield robolink.get_default_context()


def test_a_listener_without_a_node_makes_one_and_spins_it(default_context: Context) -> None:
    robot, buffer = node_in(default_context, "robot"), Buffer()
    listener = TransformListener(buffer, None)
    TransformBroadcaster(robot).sendTransform(transform("a", "b", 1))
    StaticTransformBroadcaster(robot).sendTransform(transform("b", "c"))
    assert buffer.lookup_transform("a", "c", LATEST, Duration(seconds=30)).header.stamp.sec == 1
    assert listener.node.get_name().startswith("transform_listener_impl_")
    assert listener.node.get_parameter("use_sim_time").value is False
    listener.unregister()
    listener.unregister()
    listener.dedicated_listener_thread.join(10)
    assert not listener.dedicated_listener_thread.is_alive()
    assert robot.get_node_names() == ["robot"]


@pytest.mark.parametrize(
    "make",
    [StaticTransformListener, lambda buffer, node: TransformListener(buffer, node, static_only=True)],
    ids=["class", "argument"],
)
def test_a_listener_to_static_transforms_alone(
    make: Any, robot: Node, seer: Node, executor: SingleThreadedExecutor
) -> None:
    buffer = Buffer()
    listener = make(buffer, seer)
    TransformBroadcaster(robot).sendTransform(transform("a", "b", 1))
    StaticTransformBroadcaster(robot).sendTransform(transform("b", "c"))
    spin_until(executor, lambda: buffer.can_transform("b", "c", LATEST))
    assert not buffer.can_transform("a", "b", LATEST)
    assert seer.count_subscribers("/tf") == 0
    listener.unregister()
    assert seer.count_subscribers("/tf_static") == 0


def test_who_spins_the_node_takes_it_from_the_listeners_thread(context: Context) -> None:
    robot, seer = node_in(context, "robot"), node_in(context, "seer")
    buffer, answers = Buffer(), list[Any]()
    TransformListener(buffer, seer, spin_thread=True)
    asks(seer, answers, lambda: buffer.can_transform("a", "b", LATEST, Duration(seconds=30)))
    with SingleThreadedExecutor(context=context) as executor:
        executor.add_node(seer)
        robot.create_publisher(Empty, "/go", 10).publish(Empty())
        TransformBroadcaster(robot).sendTransform(transform("a", "b", 1))
        spin_until(executor, lambda: bool(answers))
    assert answers == [True]


def test_the_end_of_the_context_ends_the_waiting(context: Context) -> None:
    buffer = Buffer()
    TransformListener(buffer, node_in(context, "seer"))
    timer = threading.Timer(0.05, context.shutdown)
    timer.start()
    with pytest.raises(ExternalShutdownException):
        buffer.lookup_transform("a", "b", LATEST, Duration(seconds=30))
    timer.join()


def test_a_buffer_without_a_listener_waits_for_whoever_fills_it() -> None:
    buffer = Buffer()
    timer = threading.Timer(0.05, lambda: buffer.set_transform(transform("a", "b", 1), "me"))
    timer.start()
    assert buffer.can_transform("a", "b", LATEST, Duration(seconds=30))
    timer.join()


def test_who_waits_while_nobody_spins_is_told_why_nothing_comes(
    virtual: Context, seer: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    buffer = Buffer()
    TransformListener(buffer, seer)
    for _ in range(2):
        assert not buffer.can_transform("a", "b", LATEST, SECOND)
    assert virtual.time.steady() == 2 * 10**9
    assert len(log_lines) == 1
    assert "nobody spins /seer, whose TransformListener brings them" in log_lines[0].message


@pytest.mark.parametrize("timeout", [1.0, None])
def test_a_timeout_is_a_duration(timeout: Any) -> None:
    with pytest.raises(TypeError, match="timeout must have sec and nanosec, or nanoseconds; got"):
        Buffer().can_transform("a", "b", LATEST, timeout)


def test_a_future_is_done_when_the_transform_comes() -> None:
    buffer = Buffer()
    future = buffer.wait_for_transform_async("a", "c", Time(seconds=1))
    full = buffer.wait_for_transform_full_async("a", Time(seconds=1), "c", Time(seconds=1), "b")
    buffer.set_transform(transform("a", "b", 1, (1, 0, 0)), "me")
    assert not future.done()
    buffer.set_transform_static(transform("b", "c", 0, (1, 0, 0)), "me")
    for each in (future, full):
        found = each.result()
        assert found is not None
        assert found.transform.translation.x == 2
    assert buffer.wait_for_transform_async("a", "c", Time(seconds=1)).done()


def test_a_future_fails_once_its_time_is_too_long_ago() -> None:
    buffer = Buffer()
    future = buffer.wait_for_transform_async("a", "b", Time(seconds=1))
    for second in (5, 10):
        buffer.set_transform(transform("a", "b", second), "me")
    assert not future.done()
    buffer.set_transform(transform("a", "b", 20), "me")
    assert isinstance(future.exception(), ExtrapolationException)


def test_a_cancelled_future_is_forgotten() -> None:
    buffer = Buffer()
    future = buffer.wait_for_transform_async("a", "b", LATEST)
    future.cancel()
    buffer.set_transform(transform("a", "b", 1), "me")
    assert future.cancelled()
    assert not future.done()


def test_coroutines_of_the_executor_await_transforms(robot: Node, seer: Node, executor: SingleThreadedExecutor) -> None:
    buffer, found = Buffer(), list[Any]()
    TransformListener(buffer, seer)

    async def on_go(_: Empty) -> None:
        found.append(await buffer.lookup_transform_async("a", "b", LATEST))
        found.append(await buffer.lookup_transform_full_async("a", LATEST, "b", LATEST, "a"))

    seer.create_subscription(Empty, "/go", on_go, 10)
    robot.create_publisher(Empty, "/go", 10).publish(Empty())
    broadcaster = TransformBroadcaster(robot)
    robot.create_timer(0.5, lambda: broadcaster.sendTransform(transform("a", "b", 1)))
    spin_until(executor, lambda: len(found) == 2)
    assert [each.child_frame_id for each in found] == ["b", "b"]


def test_coroutines_of_asyncio_await_transforms() -> None:
    buffer = Buffer()

    async def both() -> Any:
        asyncio.get_running_loop().call_later(0.01, lambda: buffer.set_transform(transform("a", "b", 1), "me"))
        return await asyncio.wait_for(buffer.lookup_transform_async("a", "b", LATEST), 30)

    assert asyncio.run(both()).child_frame_id == "b"
