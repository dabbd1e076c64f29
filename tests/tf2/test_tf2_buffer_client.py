"""Lookups over the network: BufferClient and BufferServer, in callbacks and threads, and servers that are silent."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest

from robolink import Context
from robolink.action import ActionServer
from robolink.action.server import GoalResponse
from robolink.duration import Duration
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.geometry_msgs.msg import PointStamped
from robolink.interfaces.std_msgs.msg import Empty
from robolink.interfaces.tf2_msgs.action import LookupTransform
from robolink.tf2 import (
    Buffer,
    BufferClient,
    BufferServer,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    Stamped,
    TimeoutException,
    TransformException,
)
from robolink.time import Time
from tests.support.spins import spin_for, spin_until
from tests.support.transforms import transform
from tests.tf2.test_tf2_nodes import node_in

LATEST = Time()
PATIENCE = Duration(seconds=30)


@pytest.fixture
def buffer() -> Buffer:
    made = Buffer()
    for second in (1, 2):
        made.set_transform(transform("map", "base", second, (second, 0, 0)), "test")
    made.set_transform_static(transform("rig", "camera"), "test")
    return made


class Asker:
    """A node whose callbacks ask a server, in virtual time."""

    def __init__(self, context: Context, executor: SingleThreadedExecutor) -> None:
        self.node = node_in(context, "asker", executor)
        self.client = BufferClient(self.node, "/tf2_buffer_server")
        self.executor = executor

    def ask(self, question: Any) -> Any:
        """The answer to `question(client)`, asked in a callback; an exception is raised here."""
        answers: list[Any] = []

        def callback(_: Empty) -> None:
            try:
                answers.append(question(self.client))
            except TransformException as error:
                answers.append(error)

        subscription = self.node.create_subscription(Empty, "/go", callback, 1)
        self.node.create_publisher(Empty, "/go", 1).publish(Empty())
        spin_until(self.executor, lambda: bool(answers))
        self.node.destroy_subscription(subscription)
        if isinstance(answers[0], Exception):
            raise answers[0]
        return answers[0]


@pytest.fixture
def asker(virtual: Context, executor: SingleThreadedExecutor) -> Asker:
    return Asker(virtual, executor)


@pytest.fixture
def server(virtual: Context, executor: SingleThreadedExecutor, buffer: Buffer) -> BufferServer:
    return BufferServer(buffer, node_in(virtual, "server", executor), "tf2_buffer_server")


@pytest.mark.usefixtures("server")
def test_all_forms_of_lookup(asker: Asker) -> None:
    assert asker.ask(lambda c: c.lookup_transform("map", "base", Time(seconds=1.5))).transform.translation.x == 1.5
    full = asker.ask(lambda c: c.lookup_transform_full("base", Time(seconds=2), "base", Time(seconds=1), "map"))
    assert full.transform.translation.x == -1
    point = Stamped(PointStamped(), Time(seconds=1).to_msg(), "base")
    assert asker.ask(lambda c: c.transform(point, "map")).point.x == 1
    assert asker.ask(lambda c: c.can_transform("map", "base", LATEST)) is True
    assert asker.ask(lambda c: c.can_transform("map", "camera", LATEST)) is False
    asked = ("base", LATEST, "base", LATEST)
    assert asker.ask(lambda c: c.can_transform_full(*asked, "map")) is True
    assert asker.ask(lambda c: c.can_transform_full(*asked, "moon")) is False


@pytest.mark.parametrize(
    ("frames", "time", "kind"),
    [
        (("map", "moon"), LATEST, LookupException),
        (("map", "camera"), LATEST, ConnectivityException),
        (("map", "base"), Time(seconds=9), ExtrapolationException),
        (("map", "/base"), LATEST, InvalidArgumentException),
    ],
)
@pytest.mark.usefixtures("server")
def test_errors_come_as_the_exceptions_they_were(
    frames: tuple[str, str], time: Time, kind: type[Exception], asker: Asker, buffer: Buffer
) -> None:
    with pytest.raises(kind) as there:
        asker.ask(lambda c: c.lookup_transform(*frames, time))
    with pytest.raises(kind) as here:
        buffer.lookup_transform(*frames, time)
    assert str(there.value) == str(here.value)


def test_a_goal_that_waits_may_be_cancelled(asker: Asker, server: BufferServer) -> None:
    goal = LookupTransform.Goal(target_frame="map", source_frame="moon", timeout=PATIENCE.to_msg())
    sent = asker.client.action_client.send_goal_async(goal)
    spin_until(asker.executor, sent.done)
    handle = sent.result()
    assert handle is not None
    result = handle.get_result_async()
    spin_for(asker.executor, 0.1)
    assert server._waiting
    handle.cancel_goal_async()
    spin_until(asker.executor, result.done)
    answer: Any = result.result()
    assert (answer.status, answer.result.error.error) == (5, 1)  # canceled, a lookup error
    assert not server._waiting


def test_without_a_server_it_says_so_at_once(asker: Asker) -> None:
    with pytest.raises(TimeoutException, match="not ready"):
        asker.ask(lambda c: c.lookup_transform("map", "base", LATEST, PATIENCE))
    assert asker.executor.context.time.steady() == 0


def other_server(asker: Asker, execute: Any, **options: Any) -> ActionServer:
    node = node_in(asker.node.context, "other", asker.executor)
    return ActionServer(node, LookupTransform, "tf2_buffer_server", execute, **options)


def test_a_server_that_aborts_without_a_reason_has_timed_out(asker: Asker) -> None:
    def abort(handle: Any) -> Any:
        handle.abort()
        return LookupTransform.Result()

    other_server(asker, abort)
    with pytest.raises(TimeoutException, match="found no such transform in time"):
        asker.ask(lambda c: c.lookup_transform("map", "base", LATEST))


def test_a_server_that_rejects_or_is_silent(asker: Asker) -> None:
    async def sleep(handle: Any) -> Any:
        await asker.executor.create_future()

    server = other_server(asker, sleep, goal_callback=lambda _: GoalResponse.REJECT)
    with pytest.raises(TimeoutException, match="rejected"):
        asker.ask(lambda c: c.lookup_transform("map", "base", LATEST))
    server.register_goal_callback(None)
    with pytest.raises(TimeoutException, match="did not answer in time"):
        asker.ask(lambda c: c.lookup_transform("map", "base", LATEST, Duration(seconds=1)))
    assert asker.executor.context.time.steady() == 3 * 10**9  # and two seconds of padding


@pytest.fixture
def client(context: Context, buffer: Buffer) -> Iterator[BufferClient]:
    """A client whose node another thread spins, as well as the server's."""
    node = node_in(context, "both")
    server, made = BufferServer(buffer, node, "served"), BufferClient(node, "served")
    with SingleThreadedExecutor(context=context) as executor:
        executor.add_node(node)
        thread = threading.Thread(target=executor.spin)
        thread.start()
        assert made.action_client.wait_for_server(30)
        yield made
        made.destroy()
        server.destroy()
    thread.join()


def test_a_thread_asks_while_another_spins(client: BufferClient) -> None:
    assert client.lookup_transform("map", "base", LATEST, PATIENCE).header.stamp.sec == 2
    with pytest.raises(LookupException):
        client.lookup_transform("map", "moon", LATEST)


def test_the_server_waits_for_what_comes_late(client: BufferClient, buffer: Buffer) -> None:
    with pytest.raises(ExtrapolationException, match="into the future"):
        client.lookup_transform("map", "base", Time(seconds=3), Duration(seconds=0.05))
    timer = threading.Timer(0.05, lambda: buffer.set_transform(transform("map", "base", 4, (4, 0, 0)), "test"))
    timer.start()
    assert client.lookup_transform("map", "base", Time(seconds=3), PATIENCE).transform.translation.x == 3
    timer.join()


def test_the_server_does_not_wait_for_what_is_too_long_ago(client: BufferClient, buffer: Buffer) -> None:
    buffer.set_transform(transform("map", "base", 50), "test")
    with pytest.raises(ExtrapolationException, match="into the past"):
        client.lookup_transform("map", "base", Time(seconds=0.5), Duration(seconds=10_000))
