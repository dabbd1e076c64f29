"""The multi-threaded executor: what runs side by side and what must not, failures, its end, what comes and goes."""

from __future__ import annotations

import os
import threading
from typing import Any

import pytest

from robolink import Context, Node
from robolink.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.exceptions import InterruptedByUser
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from tests.support.spins import numbers, spin_for, spin_until
from tests.support.threads import ASK, EVERY_ONE, PATIENCE, answer, publish
from tests.support.transports import Network


@pytest.fixture
def node(context: Context, two: MultiThreadedExecutor) -> Node:
    made = Node("node", context=context)
    two.add_node(made)
    return made


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
    assert watched.seen == [number for number in range(50) for _ in range(2)]  # by turns


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


def test_what_the_end_of_the_context_takes_away_from_a_callback_is_no_fault_of_it(
    node: Node, context: Context, two: MultiThreadedExecutor, log_lines: list[Record]
) -> None:
    publisher, tried = node.create_publisher(Int32, "topic", 1), threading.Event()

    def end_and_go_on() -> None:
        context.shutdown()
        try:
            publisher.publish(Int32())
        finally:
            tried.set()

    node.create_guard_condition(end_and_go_on).trigger()
    two.spin()
    assert tried.wait(PATIENCE)
    assert two.shutdown()
    assert log_lines == []


def test_an_interrupt_is_told(node: Node, context: Context, two: MultiThreadedExecutor) -> None:
    node.create_guard_condition(context.interrupt).trigger()
    with pytest.raises(InterruptedByUser):
        two.spin()


def test_shutdown_waits_for_callbacks_but_not_too_long(context: Context) -> None:
    before = set(threading.enumerate())
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
    assert not [each for each in set(threading.enumerate()) - before if each.name.startswith("robolink callbacks")]


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


def test_the_task_that_is_waited_for_raises_what_it_raised_there(two: MultiThreadedExecutor) -> None:
    """And not in the next spin, which has nothing to do with it."""

    async def fail() -> None:
        raise FileNotFoundError("x")

    for _ in range(20):
        with pytest.raises(FileNotFoundError):
            two.spin_until_future_complete(two.create_task(fail), timeout_sec=PATIENCE)
        two.spin_once(timeout_sec=0)
