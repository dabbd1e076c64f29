"""Executors: order, waiting, exceptions, coroutines, callback groups, and what idling costs."""

from __future__ import annotations

import functools
import threading
import time
from collections.abc import Generator
from typing import Any

import pytest

from robolink import Context, Future, Node, VirtualTime
from robolink.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.exceptions import ExternalShutdownException, NotInitializedException
from robolink.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from robolink.guard_condition import GuardCondition
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.publisher import Publisher
from robolink.qos import HistoryPolicy, QoSProfile
from robolink.transport.memory import Bus, MemoryTransport
from tests.support.spins import counted_calls, done, numbers, spin_for, spin_until

PATIENCE = 30.0


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual)
    executor.add_node(made)
    return made


def test_spin_once_runs_exactly_one_callback(node: Node, executor: SingleThreadedExecutor) -> None:
    got = numbers(node, "topic")
    publisher = node.create_publisher(Int32, "topic", 10)
    publisher.publish(Int32(data=1))
    publisher.publish(Int32(data=2))
    assert got == []
    executor.spin_once(timeout_sec=0)
    assert got == [1]
    executor.spin_once()
    assert got == [1, 2]


def test_spin_once_gives_up_after_its_timeout(context: Context) -> None:
    with SingleThreadedExecutor(context=context) as executor:
        executor.add_node(Node("idle", context=context))
        executor.spin_once(timeout_sec=0)  # what adding the node left behind
        begin = time.monotonic()
        executor.spin_once(timeout_sec=0.05)
        assert time.monotonic() - begin >= 0.05


def test_virtual_time_jumps_over_a_timeout(executor: SingleThreadedExecutor, virtual: Context) -> None:
    executor.spin_once(timeout_sec=3600.0)  # or else pytest gives up
    assert virtual.time.now() == 3600 * 10**9


def publish_and_trigger(publisher: Publisher[Int32], guard: GuardCondition, trace: list[tuple[int, str]]) -> None:
    publisher.publish(Int32(data=len(trace)))
    guard.trigger()


def run_a_small_system() -> list[tuple[int, str]]:
    """Timers of the same period, topics back and forth, a task and a guard: who ran when."""
    context = Context(transport=MemoryTransport(bus=Bus()), time=VirtualTime())
    context.init([])
    trace: list[tuple[int, str]] = []

    def note(what: str) -> None:
        trace.append((context.time.now(), what))

    def got(name: str, message: Int32) -> None:
        note(f"{name} got {message.data}")

    with context, SingleThreadedExecutor(context=context) as executor:
        for name in ("one", "two", "three"):
            node = Node(name, context=context)
            publisher = node.create_publisher(Int32, "topic", 10)
            node.create_subscription(Int32, "topic", functools.partial(got, name), 10)
            guard = node.create_guard_condition(functools.partial(note, f"{name} guard"))
            node.create_timer(0.1, functools.partial(note, f"{name} timer"))
            node.create_timer(0.1, functools.partial(publish_and_trigger, publisher, guard, trace))
            executor.add_node(node)
        spin_for(executor, 1.0)
    return trace


def test_the_order_is_the_same_every_time() -> None:
    trace = run_a_small_system()
    assert len(trace) > 100
    assert trace == run_a_small_system()


def test_an_exception_ends_the_spin_and_the_next_one_goes_on(node: Node, executor: SingleThreadedExecutor) -> None:
    calls: list[int] = []

    def fail_first() -> None:
        calls.append(len(calls))
        if len(calls) == 1:
            raise ValueError("broken callback")

    node.create_timer(0.1, fail_first)
    with pytest.raises(ValueError, match="broken callback"):
        executor.spin()
    spin_for(executor, 0.25)
    assert calls == [0, 1, 2]


def test_shutdown_in_a_callback_ends_the_spin(node: Node, executor: SingleThreadedExecutor, virtual: Context) -> None:
    node.create_timer(0.1, virtual.shutdown)
    executor.spin()
    assert not virtual.ok()


def test_shutdown_in_another_thread_is_told_by_an_exception(context: Context) -> None:
    executor = SingleThreadedExecutor(context=context)
    node = Node("node", context=context)
    executor.add_node(node)
    guard = node.create_guard_condition(lambda: threading.Thread(target=context.shutdown).start())
    guard.trigger()
    executor.spin_once()
    with pytest.raises(ExternalShutdownException):
        executor.spin_once()


def test_shutting_down_an_executor_ends_its_spin_and_frees_its_nodes(context: Context) -> None:
    executor, node = SingleThreadedExecutor(context=context), Node("node", context=context)
    executor.add_node(node)
    spinning = threading.Event()
    node.create_guard_condition(spinning.set).trigger()
    thread = threading.Thread(target=executor.spin)
    thread.start()
    assert spinning.wait(PATIENCE)
    assert executor.shutdown()
    thread.join(PATIENCE)
    assert not thread.is_alive()
    assert node.executor is None
    assert executor.get_nodes() == []


def test_a_task_gives_its_result_or_ends_the_spin(executor: SingleThreadedExecutor) -> None:
    task = executor.create_task(lambda a, b: a + b, 1, b=2)
    assert done(executor, task) == 3
    executor.create_task(lambda: 1 // 0)
    with pytest.raises(ZeroDivisionError):
        executor.spin_once()


def test_a_coroutine_waits_for_a_future_without_polling(node: Node, executor: SingleThreadedExecutor) -> None:
    future: Future[int] = Future()
    node.create_timer(1.0, lambda: future.set_result(5))

    async def double() -> int:
        return 2 * (await future or 0)

    task = executor.create_task(double)
    assert done(executor, task) == 10
    assert not executor._queue_.postponed


def test_a_coroutine_may_wait_for_something_unknown(executor: SingleThreadedExecutor) -> None:
    class Thrice:
        def __await__(self) -> Generator[None, None, None]:
            yield from (None, None, None)

    async def wait() -> str:
        await Thrice()
        return "done"

    assert done(executor, executor.create_task(wait)) == "done"
    task = executor.create_task(wait)
    for _ in range(4):
        executor.spin_once(timeout_sec=0)
    assert task.done()


def test_a_task_from_another_thread_wakes_the_executor(context: Context) -> None:
    executor, ran = SingleThreadedExecutor(context=context), threading.Event()
    thread = threading.Thread(target=executor.spin_once, daemon=True)
    thread.start()
    executor.create_task(ran.set)
    assert ran.wait(PATIENCE)
    thread.join(PATIENCE)


def test_spinning_until_a_future_is_done_stops_there(node: Node, executor: SingleThreadedExecutor) -> None:
    future: Future[None] = Future()
    calls: list[int] = []
    node.create_timer(0.1, lambda: calls.append(1))
    node.create_timer(0.35, lambda: future.set_result(None))
    executor.spin_until_future_complete(future, timeout_sec=10.0)
    assert len(calls) == 3
    executor.spin_once_until_future_complete(future)
    assert len(calls) == 3


def test_a_coroutine_callback_keeps_its_group_busy(node: Node, executor: SingleThreadedExecutor) -> None:
    future: Future[None] = Future()
    trace: list[str] = []

    async def slow(_: Int32) -> None:
        trace.append("begin")
        await future
        trace.append("end")

    group = MutuallyExclusiveCallbackGroup()
    node.create_subscription(Int32, "topic", slow, 10, callback_group=group)
    node.create_timer(0.1, lambda: trace.append("same group"), group).timer_period_ns = 10**9
    node.create_timer(0.2, lambda: trace.append("other group"), ReentrantCallbackGroup()).timer_period_ns = 10**9
    node.create_timer(0.3, lambda: future.set_result(None), ReentrantCallbackGroup()).timer_period_ns = 10**9
    node.create_publisher(Int32, "topic", 10).publish(Int32())
    spin_for(executor, 0.5)
    assert trace == ["begin", "other group", "end", "same group"]


@pytest.mark.parametrize("fails", [False, True])
def test_a_group_is_told_of_each_execution_once(node: Node, executor: SingleThreadedExecutor, fails: bool) -> None:
    class Counting(CallbackGroup):
        begun = ended = 0

        def can_execute(self, entity: Any) -> bool:
            return True

        def beginning_execution(self, entity: Any) -> bool:
            self.begun += 1
            return True

        def ending_execution(self, entity: Any) -> None:
            self.ended += 1

    async def callback(_: Int32) -> None:
        if fails:
            raise ValueError("broken coroutine")

    group = Counting()
    node.create_subscription(Int32, "topic", callback, 10, callback_group=group)
    node.create_publisher(Int32, "topic", 10).publish(Int32())
    if fails:
        with pytest.raises(ValueError, match="broken coroutine"):
            spin_for(executor, 0.1)
    else:
        spin_for(executor, 0.1)
    assert (group.begun, group.ended) == (1, 1)


def test_a_group_that_refuses_loses_no_message(node: Node, executor: SingleThreadedExecutor) -> None:
    class Moody(ReentrantCallbackGroup):
        willing = False

        def beginning_execution(self, entity: Any) -> bool:
            return self.willing

    group, got = Moody(), list[int]()
    node.create_subscription(Int32, "topic", lambda message: got.append(message.data), 10, callback_group=group)
    node.create_publisher(Int32, "topic", 10).publish(Int32(data=1))
    spin_for(executor, 0.1)
    assert got == []
    group.willing = True
    spin_for(executor, 0.1)
    assert got == [1]


def test_another_group_counts_as_soon_as_it_is_set(node: Node, executor: SingleThreadedExecutor) -> None:
    class Closed(MutuallyExclusiveCallbackGroup):
        def can_execute(self, entity: Any) -> bool:
            return False

    got = numbers(node, "topic")
    (subscription,) = (each for each in node.subscriptions if each.topic_name == "/topic")
    before, subscription.callback_group = subscription.callback_group, Closed()
    node.create_publisher(Int32, "topic", 10).publish(Int32(data=1))
    spin_for(executor, 0.1)
    assert got == []
    subscription.callback_group = before
    spin_for(executor, 0.1)
    assert got == [1]


def test_a_client_waits_for_no_group(node: Node) -> None:
    client = node.create_client(Trigger, "call")
    client.callback_group = MutuallyExclusiveCallbackGroup()
    assert client.gate is not client.callback_group


def test_messages_keep_their_order_while_they_come_in(context: Context) -> None:
    node, got = Node("node", context=context), list[int]()
    every_one = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    node.create_subscription(Int32, "topic", lambda message: got.append(message.data), every_one)
    publisher = node.create_publisher(Int32, "topic", every_one)

    def send() -> None:
        for number in range(5000):
            publisher.publish(Int32(data=number))

    with SingleThreadedExecutor(context=context) as executor:
        executor.add_node(node)
        thread = threading.Thread(target=send)
        thread.start()
        spin_until(executor, lambda: len(got) == 5000)
        thread.join(PATIENCE)
    assert got == list(range(5000))


def test_what_comes_in_waits_while_its_group_is_busy(context: Context) -> None:
    node, trace = Node("node", context=context), list[str]()
    publisher = node.create_publisher(Int32, "topic", 10)
    pause: Future[None] = Future()

    async def callback(message: Int32) -> None:
        trace.append(f"begin {message.data}")
        await pause
        trace.append(f"end {message.data}")

    node.create_subscription(Int32, "topic", callback, 10)
    with SingleThreadedExecutor(context=context) as executor:
        executor.add_node(node)
        publisher.publish(Int32(data=1))
        spin_until(executor, lambda: trace == ["begin 1"])
        threading.Timer(0.01, publisher.publish, (Int32(data=2),)).start()
        threading.Timer(0.05, pause.set_result, (None,)).start()
        spin_until(executor, lambda: len(trace) == 4)
    assert trace == ["begin 1", "end 1", "begin 2", "end 2"]


def calls_of_a_hundred_ticks(bus: Bus, subscriptions: int) -> int:
    """How many functions run for a hundred calls of one timer, beside so many idle subscriptions."""
    context = Context(transport=MemoryTransport(bus=bus), time=VirtualTime())
    context.init([])
    with context, SingleThreadedExecutor(context=context) as executor:
        node, ticks = Node("node", context=context), list[None]()
        executor.add_node(node)
        for index in range(subscriptions):
            numbers(node, f"topic_{index}")
        node.create_timer(0.01, lambda: ticks.append(None))
        spin_for(executor, 0.1)
        ticks.clear()
        with counted_calls() as calls:
            spin_for(executor, 1.0)
    assert len(ticks) == 100
    return len(calls)


def calls_of_taking_a_message(bus: Bus, subscriptions: int) -> int:
    """How many functions run when an executor of a program's own takes a message, beside so many idle subscriptions."""
    context = Context(transport=MemoryTransport(bus=bus), time=VirtualTime())
    context.init([])
    with context, SingleThreadedExecutor(context=context) as executor:
        node = Node("node", context=context)
        for index in range(subscriptions):
            numbers(node, f"topic_{index}")
        numbers(node, "topic")
        executor.add_node(node)
        node.create_publisher(Int32, "topic", 10).publish(Int32())
        with counted_calls() as calls:
            _, _, owner = executor.wait_for_ready_callbacks(timeout_sec=0, nodes=[node])
        assert owner is node
    return len(calls)


@pytest.mark.slow
def test_whose_callback_it_is_takes_no_search(bus: Bus) -> None:
    alone = calls_of_taking_a_message(bus, 0)
    assert 0 < alone == calls_of_taking_a_message(bus, 100)


@pytest.mark.slow
def test_a_hundred_idle_subscriptions_cost_nothing(bus: Bus) -> None:
    """What a tick takes of a core stands in benchmarks/executors.py."""
    alone = calls_of_a_hundred_ticks(bus, 0)
    assert 0 < alone == calls_of_a_hundred_ticks(bus, 100)


@pytest.mark.parametrize("kind", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_an_executor_needs_a_context_that_goes_on(bus: Bus, kind: type[Executor]) -> None:
    context = Context(transport=MemoryTransport(bus=bus))
    with pytest.raises(NotInitializedException, match="cannot make an executor"):
        kind(context=context)
    context.init(args=[])
    kind(context=context).shutdown()
    context.shutdown()
    with pytest.raises(NotInitializedException, match="cannot make an executor"):
        kind(context=context)


def test_what_a_callback_raises_is_for_whoever_spins_to_tell(
    node: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    node.create_timer(0.1, lambda: 1 // 0)
    with pytest.raises(ZeroDivisionError):
        executor.spin()
    assert log_lines == []
