"""Executors: order, waiting, exceptions, coroutines, callback groups, and nodes that come and go in the traffic."""

from __future__ import annotations

import functools
import sys
import threading
import time
from collections.abc import Generator, Iterator
from typing import Any

import pytest

from robolink import Context, Future, Node, VirtualTime
from robolink.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.exceptions import ExternalShutdownException
from robolink.executors import Executor, SingleThreadedExecutor
from robolink.guard_condition import GuardCondition
from robolink.interfaces.std_msgs.msg import Int32
from robolink.publisher import Publisher
from robolink.transport.memory import Bus, MemoryTransport
from tests.spins import done, numbers, spin_for, spin_until

PATIENCE = 5.0


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
        assert 0.05 <= time.monotonic() - begin < 0.5


def test_virtual_time_jumps_over_a_timeout(executor: SingleThreadedExecutor, virtual: Context) -> None:
    begin = time.monotonic()
    executor.spin_once(timeout_sec=3600.0)
    assert virtual.time.now() == 3600 * 10**9
    assert time.monotonic() - begin < 1.0


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
    assert not executor._polled


def test_a_coroutine_may_wait_for_something_unknown(executor: SingleThreadedExecutor) -> None:
    class Thrice:
        def __await__(self) -> Generator[None, None, None]:
            yield from (None, None, None)

    async def wait() -> str:
        await Thrice()
        return "done"

    assert done(executor, executor.create_task(wait)) == "done"


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


# Nodes that come and go


def test_adding_twice_and_removing_a_stranger_do_nothing(node: Node, executor: SingleThreadedExecutor) -> None:
    assert not executor.add_node(node)
    assert executor.get_nodes() == [node]
    other = SingleThreadedExecutor(context=executor.context)
    other.remove_node(node)
    assert node.executor is executor


@pytest.mark.parametrize("way", ["add_node", "executor"])
def test_a_node_moves_with_all_that_waits(node: Node, executor: SingleThreadedExecutor, way: str) -> None:
    other = SingleThreadedExecutor(context=executor.context)
    got, publisher = numbers(node, "topic"), node.create_publisher(Int32, "topic", 10)
    ticks: list[int] = []
    node.create_timer(1.0, lambda: ticks.append(1))
    for number in range(3):
        publisher.publish(Int32(data=number))
    executor.spin_once()
    if way == "add_node":
        assert other.add_node(node)
    else:
        node.executor = other
    publisher.publish(Int32(data=3))
    assert (node.executor, executor.get_nodes(), other.get_nodes()) == (other, [], [node])
    spin_for(executor, 0.1)
    assert got == [0]
    spin_for(other, 1.5)
    assert (got, ticks) == ([0, 1, 2, 3], [1])


def test_what_is_ready_keeps_its_turn_while_the_node_is_away(node: Node, executor: SingleThreadedExecutor) -> None:
    """A program that spins once and again takes its node in and out each time: nobody may starve by that."""
    trace: list[str] = []
    publisher = node.create_publisher(Int32, "busy", 5)
    node.create_subscription(Int32, "busy", lambda _: trace.append("busy"), 5)
    node.create_subscription(Int32, "seldom", lambda _: trace.append("seldom"), 5)
    node.create_timer(0.1, lambda: trace.append("timer"))
    node.create_publisher(Int32, "seldom", 5).publish(Int32())
    for _ in range(20):
        publisher.publish(Int32())
        publisher.publish(Int32())
        executor.context.time.sleep(10**8)
        executor.add_node(node)
        executor.spin_once()
        executor.remove_node(node)
    assert {"busy", "seldom", "timer"} == set(trace)
    assert trace.count("timer") >= 3
    assert len(node.queued) <= 10


@pytest.fixture
def hasty() -> Iterator[None]:
    """Threads give way to each other all the time."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


def send(node: Node, count: int) -> None:
    publisher = node.create_publisher(Int32, "topic", 10)
    for number in range(count):
        publisher.publish(Int32(data=number))


@pytest.mark.usefixtures("hasty")
def test_no_message_is_lost_while_a_node_moves_between_threads(context: Context) -> None:
    executors = [SingleThreadedExecutor(context=context) for _ in range(2)]
    node, talker = Node("listener", context=context), Node("talker", context=context)
    got = numbers(node, "topic", depth=100_000)
    threads = [threading.Thread(target=spin_quietly, args=(each,)) for each in executors]
    sender = threading.Thread(target=send, args=(talker, 20_000))
    for thread in [*threads, sender]:
        thread.start()
    moves = 0
    while sender.is_alive() or moves < 10:
        executors[moves % 2].add_node(node)
        moves += 1
    deadline = time.monotonic() + PATIENCE
    while len(got) < 20_000 and time.monotonic() < deadline:
        time.sleep(0.001)
    assert sorted(got) == list(range(20_000))
    for each in executors:
        each.shutdown()
    for thread in threads:
        thread.join(PATIENCE)


def spin_quietly(executor: Executor) -> None:
    try:
        executor.spin()
    except ExternalShutdownException:
        return


@pytest.mark.usefixtures("hasty")
def test_two_threads_may_swap_nodes_between_executors(context: Context) -> None:
    executors = [SingleThreadedExecutor(context=context) for _ in range(2)]
    nodes = [Node(f"node_{index}", context=context) for index in range(2)]
    for node in nodes:
        numbers(node, "topic")
        node.create_timer(0.001, lambda: None)

    def swap(index: int) -> None:
        for step in range(500):
            executors[(index + step) % 2].add_node(nodes[index])
            executors[step % 2].spin_once(timeout_sec=0)

    threads = [threading.Thread(target=swap, args=(index,), daemon=True) for index in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE)
    assert not any(thread.is_alive() for thread in threads)
    assert sum(len(each.get_nodes()) for each in executors) == 2


def test_two_executors_share_a_context(context: Context) -> None:
    executors = [SingleThreadedExecutor(context=context) for _ in range(2)]
    nodes = [Node(f"node_{index}", context=context) for index in range(2)]
    got = [numbers(node, f"to_{index}", depth=1000) for index, node in enumerate(nodes)]
    ran_in: list[set[int]] = [set(), set()]
    for index, (node, each) in enumerate(zip(nodes, executors, strict=True)):
        to_other = node.create_publisher(Int32, f"to_{1 - index}", 1000)
        node.create_timer(0.0005, lambda p=to_other: p.publish(Int32()))
        node.create_timer(0.0005, lambda seen=ran_in[index]: seen.add(threading.get_ident()))
        each.add_node(node)
    threads = [threading.Thread(target=spin_quietly, args=(each,)) for each in executors]
    for thread in threads:
        thread.start()
    deadline = time.monotonic() + PATIENCE
    while min(map(len, got)) < 50 and time.monotonic() < deadline:
        time.sleep(0.001)
    context.shutdown()
    for thread in threads:
        thread.join(PATIENCE)
    assert min(map(len, got)) >= 50
    assert ran_in == [{thread.ident} for thread in threads]


def test_a_destroyed_subscription_gets_nothing_more(node: Node, executor: SingleThreadedExecutor) -> None:
    got: list[int] = []

    def once(message: Int32) -> None:
        got.append(message.data)
        assert node.destroy_subscription(subscription)

    subscription = node.create_subscription(Int32, "topic", once, 10)
    send(node, 5)
    spin_for(executor, 0.1)
    assert got == [0]


def test_a_node_may_be_destroyed_in_its_own_callback(node: Node, executor: SingleThreadedExecutor) -> None:
    other = Node("other", context=executor.context)
    executor.add_node(other)
    trace: list[str] = []
    got = numbers(node, "topic")

    def last_act() -> None:
        trace.append("node")
        send(node, 3)
        node.destroy_node()

    node.create_timer(0.1, last_act)
    other.create_timer(0.15, lambda: trace.append("other"))
    spin_for(executor, 0.5)
    assert trace == ["node", "other", "other", "other"]
    assert got == []
    assert executor.get_nodes() == [other]


def test_a_hundred_idle_subscriptions_cost_nothing(context: Context) -> None:
    with SingleThreadedExecutor(context=context) as executor:
        node, ticks = Node("node", context=context), list[int]()
        executor.add_node(node)
        for index in range(100):
            numbers(node, f"topic_{index}")
        node.create_timer(0.01, lambda: ticks.append(1))
        spin_until(executor, lambda: len(ticks) > 2)
        ticks.clear()
        before = time.thread_time()
        spin_for(executor, 0.5)
        assert 10 <= len(ticks) <= 51
        assert (time.thread_time() - before) / len(ticks) < 0.03 * 0.01
