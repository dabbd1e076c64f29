"""Executors of one thread, EventsExecutor among them: the cases that rclpy's own test has of both, retold."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Generator, Iterator
from typing import Any

import pytest

import robolink
from robolink import Context, Future, Node
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.executors import SingleThreadedExecutor
from robolink.experimental import EventsExecutor
from robolink.interfaces.std_srvs.srv import Trigger
from tests.support.spins import PATIENCE, spin_for
from tests.support.waits import wait_until

KINDS = (SingleThreadedExecutor, EventsExecutor)


@pytest.fixture(params=KINDS)
def each(request: pytest.FixtureRequest, virtual: Context) -> Iterator[SingleThreadedExecutor]:
    """An executor in virtual time."""
    with request.param(context=virtual) as made:
        yield made


@pytest.fixture(params=KINDS)
def real(request: pytest.FixtureRequest, context: Context) -> Iterator[SingleThreadedExecutor]:
    """An executor in real time, for threads."""
    with request.param(context=context) as made:
        yield made


@pytest.fixture
def node(virtual: Context, each: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual)
    each.add_node(made)
    return made


def in_thread(function: Callable[..., Any], *arguments: Any) -> threading.Thread:
    thread = threading.Thread(target=function, args=arguments, daemon=True)
    thread.start()
    return thread


def joined(thread: threading.Thread) -> bool:
    thread.join(PATIENCE)
    return not thread.is_alive()


# Nodes


def test_a_node_is_added_once(node: Node, each: SingleThreadedExecutor) -> None:
    assert not each.add_node(node)
    assert each.get_nodes() == [node]
    assert node.executor is each


def test_what_is_due_is_run_until_the_node_is_removed(node: Node, each: SingleThreadedExecutor) -> None:
    calls: list[int] = []
    node.create_timer(0.1, lambda: calls.append(1))
    each.spin_once(timeout_sec=0)
    assert calls == []
    each.spin_once(timeout_sec=1.2)
    assert calls == [1]
    each.remove_node(node)
    each.spin_once(timeout_sec=0.2)
    assert calls == [1]


def test_a_node_that_is_added_wakes_it(context: Context, real: SingleThreadedExecutor) -> None:
    ticks: list[int] = []
    node = Node("node", context=context)
    node.create_timer(0.01, lambda: ticks.append(1))
    thread = in_thread(real.spin_once)
    wait_until(lambda: real.spinning)
    real.add_node(node)
    assert joined(thread)
    assert ticks == [1]


# Tasks


def test_tasks_give_their_results_in_one_turn(each: SingleThreadedExecutor) -> None:
    async def coroutine() -> str:
        return "of a coroutine"

    for callback, result in ((coroutine, "of a coroutine"), (lambda: "of a function", "of a function")):
        task = each.create_task(callback)
        assert not task.done()
        each.spin_once(timeout_sec=0)
        assert task.result() == result


def test_a_cancelled_task_is_never_done(each: SingleThreadedExecutor) -> None:
    async def coroutine() -> str:
        return "never"

    task = each.create_task(coroutine)
    task.cancel()
    each.spin_until_future_complete(task)
    assert task.cancelled()
    assert not task.done()
    assert task.result() is None


def test_a_task_awaits_a_later_one(each: SingleThreadedExecutor) -> None:
    async def first() -> str:
        return f"after {await later}"

    async def second() -> str:
        return "the other"

    task, later = each.create_task(first), each.create_task(second)
    for done in ((False, False), (False, True), (True, True)):
        each.spin_once(timeout_sec=0)
        assert (task.done(), later.done()) == done
    assert task.result() == "after the other"


def test_a_task_wakes_the_thread_that_spins(real: SingleThreadedExecutor) -> None:
    thread = in_thread(real.spin_once)
    wait_until(lambda: real.spinning)
    task = real.create_task(lambda: "done")
    assert joined(thread)
    assert task.result() == "done"


def test_a_coroutine_that_yields_goes_on_in_its_next_turn(node: Node, each: SingleThreadedExecutor) -> None:
    log: list[str] = []

    async def callback() -> None:
        log.append("begins")
        timer.cancel()
        await asyncio.sleep(0)
        log.append("ends")

    timer = node.create_timer(0.1, callback)
    each.spin_once(timeout_sec=1.2)
    assert log == ["begins"]
    each.spin_once(timeout_sec=0)
    assert log == ["begins", "ends"]


def test_a_coroutine_is_completed_by_spin_once_of_its_node(virtual: Context, each: SingleThreadedExecutor) -> None:
    class Door:
        is_open = False

        def __await__(self) -> Generator[None, None, None]:
            while not self.is_open:
                yield

    door, log, node = Door(), list[str](), Node("node", context=virtual)

    async def callback() -> None:
        log.append("waits")
        await door
        log.append("goes on")

    timer = node.create_timer(0.1, callback)
    robolink.spin_once(node, timeout_sec=0.5, executor=each)
    assert log == ["waits"]
    timer.cancel()
    door.is_open = True
    robolink.spin_once(node, timeout_sec=0, executor=each)
    assert log == ["waits", "goes on"]


# Futures


def test_a_spin_ends_at_its_timeout_while_a_timer_ticks(node: Node, each: SingleThreadedExecutor) -> None:
    node.create_timer(0.003, lambda: None)
    steady, future = each.context.time.steady, each.create_future()
    for seconds in (0.1, 0):
        before = steady()
        each.spin_until_future_complete(future, timeout_sec=seconds)
        assert steady() - before == pytest.approx(seconds * 1e9, abs=3e6)
    assert not future.done()


@pytest.mark.parametrize("timeout", [PATIENCE, None, -1])
@pytest.mark.parametrize("spin", ["spin_until_future_complete", "spin_once_until_future_complete"])
def test_a_future_that_another_thread_completes_ends_the_spin(
    real: SingleThreadedExecutor, spin: str, timeout: float | None
) -> None:
    future = real.create_future()
    thread = in_thread(getattr(real, spin), future, timeout)
    wait_until(lambda: real.spinning)
    future.set_result("finished")
    assert joined(thread)


def test_a_future_has_the_executor_that_made_it(each: SingleThreadedExecutor) -> None:
    future, called = each.create_future(), list[Future[Any]]()
    future.add_done_callback(called.append)
    future.set_result(None)
    assert called == []  # its executor calls it
    each.spin_once(timeout_sec=0)
    assert called == [future]


# Ends, and what is not lost


def test_shutdown_ends_a_spin_in_another_thread(context: Context, real: SingleThreadedExecutor) -> None:
    node, calls = Node("node", context=context), list[int]()
    node.create_timer(PATIENCE, lambda: calls.append(1))
    real.add_node(node)
    thread = in_thread(real.spin)
    real.shutdown()
    assert joined(thread)
    assert calls == []


def test_a_call_that_nobody_answers_loses_no_timer(node: Node, each: SingleThreadedExecutor) -> None:
    group, log = ReentrantCallbackGroup(), list[str]()
    client = node.create_client(Trigger, "nobody", callback_group=group)

    async def call() -> None:
        first.cancel()
        log.append("calls")
        await client.call_async(Trigger.Request())

    first = node.create_timer(0.5, call, group)
    node.create_timer(1.5, lambda: log.append("ticks"), group)
    spin_for(each, 4.0)
    assert log == ["calls", "ticks", "ticks"]
