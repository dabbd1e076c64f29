"""EventsExecutor: order of arrival, callback groups without effect, and what refuses to be spun."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import Context, Future, Node
from robolink.callback_groups import MutuallyExclusiveCallbackGroup
from robolink.exceptions import ExternalShutdownException
from robolink.executors import SingleThreadedExecutor
from robolink.experimental import EventsExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from tests.support.hosts import start_files, traced
from tests.support.spins import PATIENCE, spin_for, spin_until


@pytest.fixture
def events(virtual: Context) -> Iterator[EventsExecutor]:
    """An EventsExecutor in virtual time."""
    with EventsExecutor(context=virtual) as made:
        yield made


@pytest.fixture
def node(virtual: Context, events: EventsExecutor) -> Node:
    made = Node("node", context=virtual)
    events.add_node(made)
    return made


def heard(node: Node, *topics: str) -> list[str]:
    """Subscribe to topics; the list fills with their names and numbers as callbacks are called."""
    log: list[str] = []
    for topic in topics:

        def note(message: Int32, topic: str = topic) -> None:
            log.append(f"{topic}{message.data}")

        node.create_subscription(Int32, topic, note, 10)
    return log


def publish(node: Node, topic: str, *data: int) -> None:
    publisher = node.create_publisher(Int32, topic, 10)
    for each in data:
        publisher.publish(Int32(data=each))


def test_each_message_has_its_turn_when_it_came(node: Node, events: EventsExecutor) -> None:
    log = heard(node, "a", "b")
    publish(node, "a", 0, 1)
    publish(node, "b", 0)
    publish(node, "a", 2)
    publish(node, "b", 1)
    spin_until(events, lambda: len(log) == 5)
    assert log == ["a0", "a1", "b0", "a2", "b1"]


def test_a_single_threaded_one_takes_turns_instead(virtual: Context) -> None:
    node = Node("node", context=virtual)
    log = heard(node, "a", "b")
    with SingleThreadedExecutor(context=virtual) as executor:
        executor.add_node(node)
        publish(node, "a", 0, 1)
        publish(node, "b", 0)
        spin_until(executor, lambda: len(log) == 3)
    assert log == ["a0", "b0", "a1"]


def test_what_waited_for_the_executor_comes_topic_by_topic(virtual: Context, events: EventsExecutor) -> None:
    node = Node("node", context=virtual)
    log = heard(node, "a", "b")
    for number in range(3):
        publish(node, "a", number)
        publish(node, "b", number)
    events.add_node(node)
    spin_until(events, lambda: len(log) == 6)
    assert log == ["a0", "a1", "a2", "b0", "b1", "b2"]


def test_of_more_than_the_depth_the_newest_are_received(node: Node, events: EventsExecutor) -> None:
    log = heard(node, "a")
    publish(node, "a", *range(15))
    spin_for(events, 1.0)
    assert log == [f"a{number}" for number in range(5, 15)]


def test_a_backlog_goes_before_a_timer(node: Node, events: EventsExecutor) -> None:
    log = heard(node, "a")
    timer = node.create_timer(0.0, lambda: log.append("tick"))
    timer.cancel()
    publish(node, "a", 0, 1, 2)
    events.spin_once(timeout_sec=0)
    timer.reset()
    spin_until(events, lambda: "tick" in log)
    assert log[:4] == ["a0", "a1", "a2", "tick"]


def test_a_coroutine_that_waits_keeps_no_group_busy(node: Node, events: EventsExecutor) -> None:
    group, woken, log = MutuallyExclusiveCallbackGroup(), Future[None](), list[str]()

    async def wait() -> None:
        log.append("waits")
        first.cancel()
        await woken
        log.append("goes on")

    def wake() -> None:
        log.append("wakes")
        if not woken.done():
            woken.set_result(None)

    first = node.create_timer(0.1, wait, callback_group=group)
    node.create_timer(0.15, wake, callback_group=group)
    spin_until(events, lambda: "goes on" in log)
    assert log == ["waits", "wakes", "goes on"]


def test_a_coroutine_is_begun_again_before_it_has_ended(node: Node, events: EventsExecutor) -> None:
    begun: list[int] = []

    async def wait(message: Int32) -> None:
        begun.append(message.data)
        await Future[None]()

    node.create_subscription(Int32, "a", wait, 10)
    publish(node, "a", 0, 1, 2)
    spin_for(events, 0.1)
    assert begun == [0, 1, 2]


def test_a_service_whose_coroutine_waits_is_answered_later(node: Node, events: EventsExecutor) -> None:
    may_answer = Future[None]()

    async def serve(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        await may_answer
        response.message = "done"
        return response

    node.create_service(Trigger, "service", serve)
    answer = node.create_client(Trigger, "service").call_async(Trigger.Request())
    spin_for(events, 1.0)
    assert not answer.done()
    node.create_timer(0.1, lambda: may_answer.set_result(None))
    events.spin_until_future_complete(answer, timeout_sec=PATIENCE)
    result = answer.result()
    assert result is not None
    assert result.message == "done"


def test_what_a_coroutine_raises_is_raised_by_the_spin(node: Node, events: EventsExecutor) -> None:
    async def fail() -> None:
        raise ValueError("in the coroutine")

    node.create_timer(0.1, fail)
    with pytest.raises(ValueError, match="in the coroutine"):
        events.spin()


def test_a_spin_of_no_time_runs_all_that_is_ready(node: Node, events: EventsExecutor) -> None:
    log, woken = heard(node, "a"), Future[None]()

    async def wait() -> None:
        log.append("waits")
        await woken
        log.append("goes on")

    events.create_task(wait)
    publish(node, "a", 0, 1, 2)
    events.create_task(lambda: woken.set_result(None))
    spin_for(events, 0)
    assert log == ["waits", "a0", "a1", "a2", "goes on"]


def test_a_done_future_ends_it_though_more_is_ready(node: Node, events: EventsExecutor) -> None:
    log, second = list[int](), Future[None]()
    for number in range(4):
        events.create_task(log.append, number)
        if number == 1:
            events.create_task(second.set_result, None)
    events.spin_until_future_complete(second, timeout_sec=0)
    assert log == [0, 1]


def test_what_never_ends_ends_with_the_timeout(node: Node, events: EventsExecutor) -> None:
    calls: list[int] = []

    def again() -> None:
        calls.append(1)
        events.create_task(again)

    again()
    spin_for(events, 0)
    assert 1 < len(calls) < 10


@pytest.mark.parametrize("end", ["executor", "context"])
def test_an_end_leaves_what_is_ready(virtual: Context, node: Node, events: EventsExecutor, end: str) -> None:
    log: list[int] = []
    events.create_task(log.append, 0)
    events.create_task(events.shutdown if end == "executor" else virtual.shutdown)
    events.create_task(log.append, 1)
    with contextlib.suppress(ExternalShutdownException):
        spin_for(events, 0)
    assert log == [0]


def test_a_callback_cannot_spin_it(node: Node, events: EventsExecutor) -> None:
    node.create_timer(0.1, lambda: events.spin_once(timeout_sec=0))
    with pytest.raises(RuntimeError, match="already-spinning"):
        spin_for(events, 1.0)
    events.spin_once(timeout_sec=0)  # it is free again; the timer is not due


def test_a_second_thread_cannot_spin_it(context: Context) -> None:
    with EventsExecutor(context=context) as executor:
        spins, may_end = threading.Event(), Future[None]()
        executor.create_task(spins.set)
        thread = threading.Thread(target=executor.spin_until_future_complete, args=(may_end,))
        thread.start()
        try:
            assert spins.wait(PATIENCE)
            with pytest.raises(RuntimeError, match="already-spinning"):
                executor.spin_once(timeout_sec=0)
        finally:
            may_end.set_result(None)
            thread.join(PATIENCE)
    assert not thread.is_alive()


def test_the_end_of_the_context_within_a_callback_is_raised(
    virtual: Context, node: Node, events: EventsExecutor
) -> None:
    node.create_timer(0.1, virtual.shutdown)
    with pytest.raises(ExternalShutdownException):
        events.spin()
    with pytest.raises(ExternalShutdownException):
        events.spin_until_future_complete(Future[None]())


def test_its_own_end_within_a_callback_is_not(node: Node, events: EventsExecutor) -> None:
    node.create_timer(0.1, lambda: events.shutdown())
    events.spin()
    assert events.get_nodes() == []


def test_guard_conditions_work_and_a_warning_says_where_they_do_not(
    virtual: Context, events: EventsExecutor, log_lines: list[Record]
) -> None:
    node, calls = Node("node", context=virtual), list[int]()
    guard = node.create_guard_condition(lambda: calls.append(1))
    events.add_node(node)
    guard.trigger()
    events.spin_once(timeout_sec=0)
    assert calls == [1]
    (warning,) = [line.message for line in log_lines if "guard condition" in line.message]
    assert "RuntimeError" in warning


PROGRAM = """
import rclpy
from rclpy.experimental import EventsExecutor
from std_msgs.msg import Int32

with rclpy.init():
    node = rclpy.create_node("script")
    publishers = [node.create_publisher(Int32, topic, 10) for topic in "ab"]
    log = node.create_publisher(Int32, "log", 10)
    for index, topic in enumerate("ab"):
        node.create_subscription(Int32, topic, lambda m, i=index: log.publish(Int32(data=10 * i + m.data)), 10)

    def burst():
        for number in range(3):
            for publisher in publishers:
                publisher.publish(Int32(data=number))

    node.create_timer(0.5, burst)
    executor = EventsExecutor()
    executor.add_node(node)
    executor.spin_until_future_complete(rclpy.Future(), timeout_sec=5.2)
"""


def test_a_simulated_script_spins_one_the_same_way_twice(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(PROGRAM)
    one, other = (traced(6.0, lambda host: start_files(host, [str(script)])) for _ in range(2))
    assert one == other
    assert one[1]["/log"] == 60
