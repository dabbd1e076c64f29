"""The multi-threaded executor: what runs side by side and what must not, waiting in callbacks, failures, its end."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from robolink import Context, Future, Node
from robolink.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.exceptions import InterruptedByUser, ROSInterruptException, ServiceError
from robolink.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor, TimeoutException
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.qos import HistoryPolicy, QoSProfile
from tests.spins import done, numbers, spin_for, spin_until
from tests.transports import Network

PATIENCE = 30.0
EVERY_ONE = QoSProfile(history=HistoryPolicy.KEEP_ALL)
ASK = Trigger.Request()


@pytest.fixture
def two(context: Context) -> Iterator[MultiThreadedExecutor]:
    """An executor with two threads, in real time."""
    with MultiThreadedExecutor(num_threads=2, context=context) as made:
        yield made


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


def answer(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
    response.success = True
    return response


def publish(node: Node, topic: str, count: int) -> None:
    publisher = node.create_publisher(Int32, topic, EVERY_ONE)
    for number in range(count):
        publisher.publish(Int32(data=number))


# Side by side


def test_callbacks_of_a_reentrant_group_run_at_once(node: Node, two: MultiThreadedExecutor) -> None:
    both, met = threading.Barrier(2), list[int]()

    def meet(message: Int32) -> None:
        both.wait(PATIENCE)
        met.append(message.data)

    node.create_subscription(Int32, "topic", meet, EVERY_ONE, callback_group=ReentrantCallbackGroup())
    publish(node, "topic", 4)
    spin_until(two, lambda: len(met) == 4)
    assert sorted(met) == [0, 1, 2, 3]


class Watched:
    """Counts how many callbacks are under way."""

    def __init__(self) -> None:
        self.now = self.most = 0
        self.seen: list[int] = []
        self._lock = threading.Lock()

    def callback(self, message: Int32) -> None:
        with self._lock:
            self.now += 1
            self.most = max(self.most, self.now)
        threading.Event().wait(0.0005)
        with self._lock:
            self.now -= 1
            self.seen.append(message.data)


def test_callbacks_of_one_group_run_one_after_the_other(node: Node, two: MultiThreadedExecutor) -> None:
    watched, other = Watched(), list[int]()
    group = MutuallyExclusiveCallbackGroup()
    for topic in ("one", "two"):
        node.create_subscription(Int32, topic, watched.callback, EVERY_ONE, callback_group=group)
    node.create_timer(0.001, lambda: other.append(1), ReentrantCallbackGroup())
    publish(node, "one", 50)
    publish(node, "two", 50)
    spin_until(two, lambda: len(watched.seen) == 100 and bool(other))
    assert watched.most == 1
    assert watched.seen == [*range(50), *range(50)]


class AtMost(CallbackGroup):
    """A program's own group: so many at a time."""

    def __init__(self, most: int) -> None:
        super().__init__()
        self.most, self.now, self.begun, self.ended = most, 0, 0, 0
        self._lock = threading.Lock()

    def can_execute(self, entity: Any) -> bool:
        return self.now < self.most

    def beginning_execution(self, entity: Any) -> bool:
        with self._lock:
            self.now += self.now < self.most
            self.begun += 1
            return True

    def ending_execution(self, entity: Any) -> None:
        with self._lock:
            self.now -= 1
            self.ended += 1


def test_a_programs_own_group_decides(context: Context) -> None:
    node, watched, group = Node("node", context=context), Watched(), AtMost(2)
    node.create_subscription(Int32, "topic", watched.callback, EVERY_ONE, callback_group=group)
    with MultiThreadedExecutor(num_threads=4, context=context) as executor:
        executor.add_node(node)
        publish(node, "topic", 40)
        spin_until(executor, lambda: len(watched.seen) == 40)
    assert watched.most == 2
    assert (group.begun, group.ended, group.now) == (40, 40, 0)


def test_what_waits_for_a_thread_waits_in_its_mailbox(node: Node, two: MultiThreadedExecutor) -> None:
    """So the oldest gives way, as the depth says, and what is taken is new."""
    go_on, got = threading.Event(), list[int]()

    def slow(message: Int32) -> None:
        got.append(message.data)
        go_on.wait(PATIENCE)

    node.create_subscription(Int32, "topic", slow, 5, callback_group=ReentrantCallbackGroup())
    publish(node, "topic", 2)
    spin_until(two, lambda: len(got) == 2)
    publish(node, "topic", 100)
    spin_for(two, 0.01)
    assert sorted(got) == [0, 1]
    go_on.set()
    spin_until(two, lambda: len(got) == 7)
    assert sorted(got[2:]) == [95, 96, 97, 98, 99]


def test_spinning_once_hands_out_one(node: Node, two: MultiThreadedExecutor) -> None:
    got, came = numbers(node, "topic"), threading.Event()
    node.create_subscription(Int32, "topic", lambda _: came.set(), 1, callback_group=ReentrantCallbackGroup())
    publish(node, "topic", 1)
    two.spin_once(timeout_sec=0)
    two.spin_once(timeout_sec=0)
    assert came.wait(PATIENCE)
    spin_until(two, lambda: got == [0])


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


def test_a_rate_in_a_callback_beside_others(node: Node, two: MultiThreadedExecutor) -> None:
    """Both threads sleep; the ticks need none."""
    rates, slept = [node.create_rate(500.0) for _ in range(2)], [0, 0]

    def work(index: int) -> None:
        timers[index].cancel()
        for _ in range(5):
            rates[index].sleep()
            slept[index] += 1

    groups = [MutuallyExclusiveCallbackGroup() for _ in range(2)]
    timers = [node.create_timer(0.001, lambda mine=index: work(mine), groups[index]) for index in (0, 1)]
    spin_until(two, lambda: slept == [5, 5])


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


# Failures and the end


@pytest.mark.parametrize("coroutine", [False, True])
def test_what_a_callback_raises_is_raised_by_the_spin(node: Node, two: MultiThreadedExecutor, coroutine: bool) -> None:
    calls = list[int]()

    def fail_first() -> None:
        calls.append(1)
        if len(calls) == 1:
            raise ValueError("broken callback")

    async def fail_later() -> None:
        fail_first()

    node.create_timer(0.001, fail_later if coroutine else fail_first)
    with pytest.raises(ValueError, match="broken callback"):
        two.spin()
    spin_until(two, lambda: len(calls) > 2)


def test_the_end_of_the_context_ends_the_spin_quietly(node: Node, context: Context, two: MultiThreadedExecutor) -> None:
    node.create_guard_condition(context.shutdown).trigger()
    two.spin()
    assert not context.ok()
    two.spin_once()


def test_an_interrupt_is_told(node: Node, context: Context, two: MultiThreadedExecutor) -> None:
    node.create_guard_condition(context.interrupt).trigger()
    with pytest.raises(InterruptedByUser):
        two.spin()


def test_shutdown_waits_for_callbacks_but_not_too_long(context: Context) -> None:
    executor, node = MultiThreadedExecutor(num_threads=2, context=context), Node("node", context=context)
    executor.add_node(node)
    begun, go_on, ended = threading.Event(), threading.Event(), threading.Event()

    def work() -> None:
        begun.set()
        go_on.wait(PATIENCE)
        ended.set()

    node.create_guard_condition(work).trigger()
    executor.spin_once()
    assert begun.wait(PATIENCE)
    assert not executor.shutdown(timeout_sec=0)
    assert not executor.shutdown(timeout_sec=0.01, wait_for_threads=False)
    assert node.executor is None
    threading.Timer(0.01, go_on.set).start()
    assert executor.shutdown()
    assert ended.is_set()
    assert not [each for each in threading.enumerate() if each.name.startswith("robolink callbacks")]


def test_a_callback_may_shut_its_executor_down(node: Node, two: MultiThreadedExecutor) -> None:
    answers = list[bool]()
    node.create_guard_condition(lambda: answers.append(two.shutdown())).trigger()
    two.spin()
    spin = threading.Thread(target=two.spin)
    spin.start()
    spin.join(PATIENCE)
    assert two.shutdown()
    assert answers == [True]


def test_shutdown_ends_a_call_that_waits(context: Context) -> None:
    executor, node = MultiThreadedExecutor(num_threads=2, context=context), Node("node", context=context)
    executor.add_node(node)
    Node("deaf", context=context).create_service(Trigger, "deaf", answer)
    client = node.create_client(Trigger, "deaf")
    node.create_guard_condition(lambda: client.call(ASK)).trigger()
    spin_until(executor, executor._threads.can_serve)
    assert executor.shutdown(timeout_sec=PATIENCE)


def test_the_single_threaded_one_waits_for_the_callback_of_another_thread_too(context: Context) -> None:
    executor, node = SingleThreadedExecutor(context=context), Node("node", context=context)
    executor.add_node(node)
    begun, go_on = threading.Event(), threading.Event()

    def work() -> None:
        begun.set()
        go_on.wait(PATIENCE)

    node.create_guard_condition(work).trigger()
    thread = threading.Thread(target=executor.spin)
    thread.start()
    assert begun.wait(PATIENCE)
    assert not executor.shutdown(timeout_sec=0)
    go_on.set()
    assert executor.shutdown()
    thread.join(PATIENCE)


@pytest.mark.filterwarnings("ignore:a MultiThreadedExecutor with one thread")  # on a machine of one core
def test_how_many_threads(context: Context) -> None:
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    with MultiThreadedExecutor(context=context) as executor:
        assert executor._threads.free == cores
    with pytest.warns(UserWarning, match="use that"), MultiThreadedExecutor(1, context=context):
        pass
    with pytest.raises(ValueError, match="greater than 0"):
        MultiThreadedExecutor(0, context=context)


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


# Executors of a program's own


class PriorityExecutor(Executor):
    """One thread for most nodes, several for the important ones."""

    def __init__(self, important: Node, context: Context) -> None:
        super().__init__(context=context)
        self.important = important
        self.pools = {True: ThreadPoolExecutor(2), False: ThreadPoolExecutor(1)}
        self.handed_out = {True: 0, False: 0}

    def spin_once(self, timeout_sec: float | None = None) -> None:
        try:
            handler, _, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        except TimeoutException:
            return
        self.handed_out[node is self.important] += 1
        self.pools[node is self.important].submit(handler)


def test_an_executor_of_a_programs_own(context: Context) -> None:
    important, other = Node("important", context=context), Node("other", context=context)
    future: Future[None] = Future()
    with PriorityExecutor(important, context) as executor:
        got = [numbers(each, "topic", 100) for each in (important, other)]
        for each in (important, other):
            assert executor.add_node(each)
        publish(important, "topic", 20)
        important.create_timer(0.001, lambda: future.set_result(None) if min(map(len, got)) == 20 else None)
        done(executor, future)
        for pool in executor.pools.values():
            pool.shutdown()
    assert got == [list(range(20))] * 2
    assert executor.handed_out[True] >= 21
    assert executor.handed_out[False] == 20


def test_work_of_certain_nodes(context: Context) -> None:
    wanted, other = Node("wanted", context=context), Node("other", context=context)
    with SingleThreadedExecutor(context=context) as executor:
        got = [numbers(each, "topic") for each in (wanted, other)]
        executor.add_node(other)
        executor.add_node(wanted)
        publish(other, "topic", 1)
        handler, entity, node = executor.wait_for_ready_callbacks(timeout_sec=0, nodes=[wanted])
        assert (node, entity) == (wanted, next(wanted.subscriptions))
        handler()
        assert handler.exception() is None
        assert got == [[0], []]
        with pytest.raises(TimeoutException):
            executor.wait_for_ready_callbacks(timeout_sec=0, nodes=[wanted])
        executor.spin_once(timeout_sec=0)
        assert got == [[0], [0]]


# Coming and going


def test_entities_come_and_go_while_it_spins(context: Context, two: MultiThreadedExecutor, node: Node) -> None:
    """Made and destroyed in callbacks and beside them: no callback fails, and the last one is heard."""
    calls, heard = list[int](), threading.Event()
    groups = [ReentrantCallbackGroup() for _ in range(2)]

    def come_and_go(index: int) -> None:
        subscription = node.create_subscription(Int32, f"topic_{index}", lambda _: None, 5)
        service = node.create_service(Trigger, f"service_{index}", answer)
        timer = node.create_timer(0.0001, lambda: None, groups[index])
        publish(node, f"topic_{index}", 3)
        assert node.destroy_subscription(subscription)
        assert node.destroy_service(service)
        assert node.destroy_timer(timer)
        calls.append(index)

    for index in (0, 1):
        node.create_timer(0.0005, lambda mine=index: come_and_go(mine), MutuallyExclusiveCallbackGroup())
    thread = threading.Thread(target=two.spin)
    thread.start()
    for _ in range(30):
        passing = Node("passing", context=context)
        two.add_node(passing)
        passing.create_timer(0.0001, lambda: None)
        passing.destroy_node()
    deadline = threading.Event()
    while len(calls) < 50:
        assert thread.is_alive()
        deadline.wait(0.001)
    node.create_subscription(Int32, "last", lambda _: heard.set(), 5)
    publish(node, "last", 1)
    assert heard.wait(PATIENCE)
    two.shutdown()
    thread.join(PATIENCE)


def test_a_node_may_be_destroyed_in_its_own_callback(context: Context, two: MultiThreadedExecutor) -> None:
    node, destroyed = Node("node", context=context), threading.Event()
    got = numbers(node, "topic")
    two.add_node(node)

    def last_act() -> None:
        publish(node, "topic", 3)
        node.destroy_node()
        destroyed.set()

    node.create_timer(0.001, last_act)
    spin_until(two, destroyed.is_set)
    spin_for(two, 0.01)
    assert got == []
    assert two.get_nodes() == []


def test_over_the_network(net: Network) -> None:
    """Nodes in two sessions call each other within their callbacks."""
    near, far = (Context(transport=net.session()) for _ in range(2))
    with near, far, MultiThreadedExecutor(2, context=near) as one, MultiThreadedExecutor(2, context=far) as other:
        nodes = [Node("near", context=near), Node("far", context=far)]
        clients = [node.create_client(Trigger, f"of_{1 - index}") for index, node in enumerate(nodes)]
        answers = list[bool]()

        def relay(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            response.success = clients[1].call(ASK, timeout_sec=PATIENCE).success
            return response

        nodes[0].create_service(Trigger, "of_0", answer, callback_group=ReentrantCallbackGroup())
        nodes[1].create_service(Trigger, "of_1", relay)
        one.add_node(nodes[0])
        other.add_node(nodes[1])
        assert all(client.wait_for_service(PATIENCE) for client in clients)
        asker = nodes[0].create_guard_condition(
            lambda: answers.append(clients[0].call(ASK, timeout_sec=PATIENCE).success)
        )
        thread = threading.Thread(target=other.spin)
        thread.start()
        asker.trigger()
        spin_until(one, lambda: bool(answers))
        other.shutdown()
        thread.join(PATIENCE)
    assert answers == [True]
