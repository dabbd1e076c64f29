"""Executors of a program's own, made of robolink's parts as of rclpy's."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest

from robolink import Context, Future, Node
from robolink.executors import Executor, SingleThreadedExecutor, TimeoutException
from tests.support.spins import done, numbers
from tests.support.threads import publish


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


class QueueingExecutor(SingleThreadedExecutor):
    """Executor with attributes that a program may well have."""

    def __init__(self, context: Context) -> None:
        super().__init__(context=context)
        self.queue: list[int] = []
        self.waiting = self.tasks = self.timers = self.threads = self.lock = None


def test_an_executors_own_attributes_have_any_name(context: Context) -> None:
    node = Node("node", context=context)
    with QueueingExecutor(context) as executor:
        executor.add_node(node)
        node.create_timer(0.001, lambda: executor.queue.append(1))
        task = executor.create_task(lambda: executor.queue.append(2))
        done(executor, task)
        executor.spin_once(timeout_sec=5)
        assert executor.queue == [2, 1]


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


def test_a_programs_attributes_of_entities_have_any_name(context: Context) -> None:
    node = Node("node", context=context)
    calls: list[int] = []
    timer = node.create_timer(0.001, lambda: calls.append(1))
    guard = node.create_guard_condition(lambda: calls.append(2))
    timer.queue = guard.queue = []  # type: ignore[attr-defined]
    with SingleThreadedExecutor(context=context) as executor:
        executor.add_node(node)
        guard.trigger()
        executor.spin_once(timeout_sec=5)
        executor.spin_once(timeout_sec=5)
    assert sorted(calls) == [1, 2]  # on a slow machine the timer is due before the first turn
