"""Callbacks that wait in the multi-threaded executor: for services, for rates, for each other, and in virtual time."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator

import pytest

from robolink import Context, Future, Node
from robolink.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.exceptions import ROSInterruptException, ServiceError
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.guard_condition import GuardCondition
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.running.threads import CallbackThreads
from tests.support.spins import spin_for, spin_until
from tests.support.threads import ASK, EVERY_ONE, PATIENCE, answer, publish


@pytest.fixture
def two_virtual(virtual: Context) -> Iterator[MultiThreadedExecutor]:
    """An executor with two threads, in virtual time."""
    with MultiThreadedExecutor(num_threads=2, context=virtual) as made:
        yield made


@pytest.fixture
def node(context: Context, two: MultiThreadedExecutor) -> Node:
    made = Node("node", context=context)
    two.add_node(made)
    return made


@pytest.fixture
def timeless(virtual: Context, two_virtual: MultiThreadedExecutor) -> Node:
    """A node in virtual time."""
    made = Node("timeless", context=virtual)
    two_virtual.add_node(made)
    return made


# Waiting in callbacks


@pytest.mark.parametrize("timeout", [None, PATIENCE])
def test_calls_in_callbacks_are_answered_though_all_threads_call(
    node: Node, two: MultiThreadedExecutor, timeout: float | None
) -> None:
    """rclpy hangs here: each thread waits for a service that no thread is left to serve."""
    both, answers, group = threading.Barrier(2), list[bool](), ReentrantCallbackGroup()
    node.create_service(Trigger, "own", answer, callback_group=ReentrantCallbackGroup())
    client = node.create_client(Trigger, "own")

    def call(_: Int32) -> None:
        both.wait(PATIENCE)
        answers.append(client.call(ASK, timeout_sec=timeout).success)

    node.create_subscription(Int32, "topic", call, EVERY_ONE, callback_group=group)
    publish(node, "topic", 6)
    spin_until(two, lambda: len(answers) == 6)
    assert answers == [True] * 6


def test_a_call_that_would_wait_for_itself_is_refused_at_once(node: Node, two: MultiThreadedExecutor) -> None:
    node.create_service(Trigger, "own", answer)
    client = node.create_client(Trigger, "own")
    node.create_timer(0.001, lambda: client.call(ASK))
    with pytest.raises(ServiceError, match="/own is served only by the callback group that this call keeps busy"):
        two.spin()


def test_a_busy_group_is_no_reason_to_refuse_when_it_will_be_free(node: Node, two: MultiThreadedExecutor) -> None:
    group, busy, answers = MutuallyExclusiveCallbackGroup(), threading.Event(), list[bool]()
    called = threading.Event()
    node.create_service(Trigger, "own", answer, callback_group=group)
    client = node.create_client(Trigger, "own")

    def keep_busy() -> None:
        keeper.cancel()
        busy.set()
        called.wait(PATIENCE)

    def call() -> None:
        caller.cancel()
        busy.wait(PATIENCE)
        threading.Timer(0.01, called.set).start()
        answers.append(client.call(ASK).success)

    keeper = node.create_timer(0.001, keep_busy, group)
    caller = node.create_timer(0.001, call, MutuallyExclusiveCallbackGroup())
    spin_until(two, lambda: bool(answers))
    assert answers == [True]


def test_two_callbacks_that_wait_for_each_other_are_found_out(context: Context, two: MultiThreadedExecutor) -> None:
    nodes = [Node(name, context=context) for name in ("one", "two")]
    both, outcomes = threading.Barrier(2), list[str]()

    def call(mine: int) -> None:
        timers[mine].cancel()
        both.wait(PATIENCE)
        try:
            outcomes.append(str(clients[mine].call(ASK).success))
        except ServiceError as error:
            outcomes.append(str(error))

    clients = [each.create_client(Trigger, f"of_{1 - index}") for index, each in enumerate(nodes)]
    for index, each in enumerate(nodes):
        each.create_service(Trigger, f"of_{index}", answer)
        two.add_node(each)
    timers = [nodes[index].create_timer(0.001, lambda mine=index: call(mine)) for index in (0, 1)]
    spin_until(two, lambda: len(outcomes) == 2)
    refused, answered = sorted(outcomes, key=len, reverse=True)
    assert "keeps busy" in refused
    assert answered == "True"


def test_coroutines_wait_for_services_and_keep_their_group_busy(node: Node, two: MultiThreadedExecutor) -> None:
    trace = list[str]()
    node.create_service(Trigger, "own", answer, callback_group=ReentrantCallbackGroup())
    client = node.create_client(Trigger, "own")

    async def ask(message: Int32) -> None:
        trace.append(f"ask {message.data}")
        response = await client.call_async(ASK)
        trace.append(f"{response.success if response else None} {message.data}")

    node.create_subscription(Int32, "topic", ask, 10)
    publish(node, "topic", 2)
    spin_until(two, lambda: len(trace) == 4)
    assert trace == ["ask 0", "True 0", "ask 1", "True 1"]


def test_a_rate_in_a_callback_beside_others(node: Node, two: MultiThreadedExecutor, log_lines: list[Record]) -> None:
    """Both threads sleep; the ticks need none, and a warning says that rclpy's do."""
    rates, slept = [node.create_rate(500.0) for _ in range(2)], [0, 0]

    def work(index: int) -> None:
        timers[index].cancel()
        for _ in range(5):
            rates[index].sleep()
            slept[index] += 1

    groups = [MutuallyExclusiveCallbackGroup() for _ in range(2)]
    timers = [node.create_timer(0.001, lambda mine=index: work(mine), groups[index]) for index in (0, 1)]
    spin_until(two, lambda: slept == [5, 5])
    assert {line.message[:72] for line in log_lines} == {
        "rate.sleep() returns here, but never does with ROS 2: all threads of its"
    }


def test_the_end_of_the_context_wakes_a_rate_in_a_callback(
    node: Node, context: Context, two: MultiThreadedExecutor
) -> None:
    rate, begun, ended = node.create_rate(0.001), threading.Event(), threading.Event()

    def work() -> None:
        begun.set()
        try:
            rate.sleep()
        except ROSInterruptException:
            ended.set()

    node.create_guard_condition(work).trigger()
    spin_until(two, begun.is_set)
    context.shutdown()
    assert ended.wait(PATIENCE)


def test_a_rate_that_the_end_of_the_context_wakes_is_no_fault_of_its_callback(
    node: Node,
    context: Context,
    two: MultiThreadedExecutor,
    capsys: pytest.CaptureFixture[str],
) -> None:
    rate, begun = node.create_rate(0.001), threading.Event()

    def work() -> None:
        begun.set()
        rate.sleep()

    node.create_guard_condition(work).trigger()
    spin_until(two, begun.is_set)
    context.interrupt()
    assert two.shutdown(PATIENCE)
    assert capsys.readouterr().err == ""


# Virtual time


def test_virtual_time_stands_still_while_callbacks_work(timeless: Node, two_virtual: MultiThreadedExecutor) -> None:
    seen, clock = list[tuple[int, int]](), timeless.get_clock()

    def work() -> None:
        begin = clock.now_ns()
        threading.Event().wait(0.002)
        seen.append((begin, clock.now_ns()))

    for _ in range(2):
        timeless.create_timer(1.0, work, ReentrantCallbackGroup())
    spin_for(two_virtual, 10.5)
    spin_until(two_virtual, lambda: len(seen) >= 20)
    assert sorted(seen)[:20] == [(second * 10**9,) * 2 for second in range(1, 11) for _ in range(2)]


def test_virtual_time_goes_on_for_calls_and_rates(timeless: Node, two_virtual: MultiThreadedExecutor) -> None:
    clock, trace = timeless.get_clock(), list[int]()
    client, rate = timeless.create_client(Trigger, "slow"), timeless.create_rate(0.1)
    late = two_virtual.create_future()

    async def serve(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        await late
        return response

    def work() -> None:
        with pytest.raises(TimeoutError):
            client.call(ASK, timeout_sec=5.0)
        trace.append(clock.now_ns() // 10**9)
        for _ in range(3):
            rate.sleep()
            trace.append(clock.now_ns() // 10**9)

    timeless.create_service(Trigger, "slow", serve, callback_group=ReentrantCallbackGroup())
    timeless.create_guard_condition(work).trigger()
    spin_until(two_virtual, lambda: len(trace) == 4, patience=60.0)
    assert trace == [5, 10, 20, 30]


def test_virtual_time_goes_on_when_a_callback_waits_for_another(
    timeless: Node, two_virtual: MultiThreadedExecutor
) -> None:
    reached, waited = threading.Event(), Future[bool]()

    def wait() -> None:
        waited.set_result(reached.wait(PATIENCE))

    timeless.create_guard_condition(wait).trigger()
    timeless.create_timer(60.0, reached.set, ReentrantCallbackGroup())
    two_virtual.spin_until_future_complete(waited, timeout_sec=3600.0)
    assert waited.result()
    assert 60 * 10**9 <= timeless.get_clock().now_ns() < 3600 * 10**9


def test_work_that_is_brought_as_a_wait_ends_wakes_who_waits_for_its_group(
    virtual: Context, executor: SingleThreadedExecutor, monkeypatch: pytest.MonkeyPatch
) -> None:
    threads, trace = CallbackThreads(1, executor), list[str]()
    threads.free = 0  # so that work is brought to whoever waits
    work = GuardCondition(lambda: trace.append("work"), ReentrantCallbackGroup(), context=virtual)

    class AlmostDone(Future[None]):
        def when_done(self, waker: Callable[[], None]) -> None:
            threads.submit(work, True)
            self.set_result(None)
            super().when_done(waker)

    monkeypatch.setattr(executor._queue_, "wake", lambda: trace.append("wake"))
    threads.wait(AlmostDone(), None, serving=True)
    assert trace == ["wake", "work", "wake"]
    assert threads._working == 0, "as before the wait"
    threads.close(wait=True)
