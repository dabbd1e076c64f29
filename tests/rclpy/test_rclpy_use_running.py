"""What public programs use of contexts, timers, executors and futures does as in rclpy."""

from __future__ import annotations

import functools
import threading
from typing import Any

import pytest

import robolink as rclpy
from robolink import Context, Future, Node
from robolink.callback_groups import MutuallyExclusiveCallbackGroup
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from robolink.signals import SignalHandlerOptions
from robolink.transport.memory import Bus, MemoryTransport
from tests.support.rclpy_use import shows
from tests.support.spins import done, numbers, spin_for, spin_until


@pytest.fixture
def node(executor: SingleThreadedExecutor) -> Node:
    made = Node("robot", namespace="/lab", context=executor.context)
    executor.add_node(made)
    return made


# --- contexts ---------------------------------------------------------------------------------------------------------


@shows("create_node(namespace=)", "create_node(context=)", "shutdown(context=)", "Executor.context")
@shows("SingleThreadedExecutor(context=)", "init(context=)", "init(args=)", "init(signal_handler_options=)")
def test_a_context_of_ones_own_beside_the_default_one(bus: Bus) -> None:
    context = Context(transport=MemoryTransport(bus=bus))
    rclpy.init(
        args=["--ros-args", "-r", "__node:=renamed"], context=context, signal_handler_options=SignalHandlerOptions.NO
    )
    node = rclpy.create_node("robot", namespace="/lab", context=context)
    assert node.get_fully_qualified_name() == "/lab/renamed"
    assert SingleThreadedExecutor(context=context).context is context
    assert not rclpy.ok()
    rclpy.shutdown(context=context)
    assert not context.ok()


@shows("Context.init", "Context.ok", "Context.on_shutdown", "Context.shutdown", "Context.try_shutdown")
@shows("Context.destroy")
def test_a_contexts_life(bus: Bus) -> None:
    context = Context(transport=MemoryTransport(bus=bus))
    told: list[str] = []

    def tell() -> None:
        told.append("over")

    assert not context.ok()
    context.init(args=[])
    context.on_shutdown(tell)
    assert (context.ok(), told) == (True, [])
    context.shutdown()
    context.try_shutdown()
    assert (context.ok(), told) == (False, ["over"])
    context.destroy()
    with pytest.raises(RuntimeError):
        context.shutdown()


# --- timers, rates and guard conditions -------------------------------------------------------------------------------


@shows("Node.create_timer", "Timer.cancel", "Timer.reset", "Timer.clock", "Timer.destroy")
@shows("create_timer(timer_period_sec=)", "create_timer(callback=)")
def test_a_timer_ticks_until_it_is_cancelled(executor: SingleThreadedExecutor, node: Node) -> None:
    ticks: list[int] = []
    timer = node.create_timer(timer_period_sec=0.5, callback=lambda: ticks.append(node.context.time.steady()))
    spin_for(executor, 2.1)
    assert ticks == [500_000_000, 1_000_000_000, 1_500_000_000, 2_000_000_000]
    timer.cancel()
    spin_for(executor, 2.0)
    assert len(ticks) == 4
    timer.reset()
    spin_for(executor, 0.6)
    assert ticks[4:] == [4_600_000_000]
    assert timer.clock == node.get_clock()
    timer.destroy()
    spin_for(executor, 1.0)
    assert len(ticks) == 5


@shows("Node.create_rate", "Rate.sleep", "Rate.destroy")
def test_a_rate_paces_a_loop(node: Node) -> None:
    rate, steady = node.create_rate(10.0), node.context.time.steady
    woke = []
    for _ in range(3):
        rate.sleep()
        woke.append(steady())
    assert woke == [100_000_000, 200_000_000, 300_000_000]
    rate.destroy()
    with pytest.raises(RuntimeError):
        rate.sleep()


@shows("Node.create_guard_condition")
def test_a_guard_condition_wakes_its_executor(executor: SingleThreadedExecutor, node: Node) -> None:
    woken: list[int] = []
    guard = node.create_guard_condition(lambda: woken.append(1))
    spin_for(executor, 0.1)
    assert woken == []
    guard.trigger()
    executor.spin_once(timeout_sec=0.1)
    assert woken == [1]


# --- executors and futures --------------------------------------------------------------------------------------------


@shows("Executor.add_node", "Executor.remove_node", "Executor.spin_once", "spin_once(timeout_sec=)")
@shows("Executor.spin_until_future_complete", "spin_until_future_complete(timeout_sec=)", "Executor.shutdown")
def test_an_executor_runs_its_nodes_and_no_others(executor: SingleThreadedExecutor) -> None:
    inside, outside = (Node(name, context=executor.context) for name in ("inside", "outside"))
    got, missed = numbers(inside, "/number"), numbers(outside, "/number")
    publisher = inside.create_publisher(Int32, "/number", 10)
    assert executor.add_node(inside)
    assert not executor.add_node(inside)
    for number in range(3):
        publisher.publish(Int32(data=number))
    executor.spin_once(timeout_sec=1.0)
    assert got == [0]
    executor.spin_until_future_complete(Future(), timeout_sec=1.0)
    assert (got, missed) == ([0, 1, 2], [])
    executor.remove_node(inside)
    publisher.publish(Int32(data=3))
    executor.spin_once(timeout_sec=0.1)
    assert (len(got), executor.get_nodes()) == (3, [])
    assert executor.shutdown()


@shows("Executor.spin", "Executor.wake", "MultiThreadedExecutor(num_threads=)")
def test_a_pool_of_threads_runs_callbacks_side_by_side(context: Context) -> None:
    node, executor = Node("node", context=context), MultiThreadedExecutor(num_threads=2, context=context)
    both, met = threading.Barrier(2), threading.Event()

    def meet(index: int) -> None:
        timers[index].cancel()
        both.wait(30)
        met.set()

    timers = [
        node.create_timer(0.001, functools.partial(meet, index), callback_group=MutuallyExclusiveCallbackGroup())
        for index in range(2)
    ]
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    executor.wake()
    assert met.wait(30)
    context.shutdown()
    thread.join(30)
    assert not thread.is_alive()


@shows("spin(executor=)")
def test_spin_takes_an_executor(bus: Bus) -> None:
    context = Context(transport=MemoryTransport(bus=bus))
    context.init(args=[])
    node, executor, ran = Node("node", context=context), SingleThreadedExecutor(context=context), list[Any]()

    def end() -> None:
        ran.append(node.executor)
        context.shutdown()

    node.create_timer(0.001, end)
    rclpy.spin(node, executor=executor)
    assert ran == [executor]


@shows("Executor.create_task", "Future.result", "Future.done", "Future.set_result", "Future.add_done_callback")
@shows("Future.set_exception", "Future.exception", "Future.cancel")
def test_a_task_waits_for_a_future(executor: SingleThreadedExecutor) -> None:
    future, bad = Future[int](), Future[int]()
    told: list[Any] = []

    async def twice() -> int:
        found = await future
        assert found is not None
        return 2 * found

    task = executor.create_task(twice)
    task.add_done_callback(told.append)
    executor.spin_once(timeout_sec=0.1)
    assert (task.done(), told) == (False, [])
    future.set_result(21)
    assert done(executor, task) == 42
    spin_until(executor, lambda: told == [task])
    bad.set_exception(ValueError("no number"))
    assert str(bad.exception()) == "no number"
    with pytest.raises(ValueError, match="no number"):
        bad.result()
    forgotten = Future[int]()
    forgotten.cancel()
    assert forgotten.cancelled()


@shows("Executor.wait_for_ready_callbacks")
def test_what_is_ready_can_be_taken_from_an_executor(executor: SingleThreadedExecutor, node: Node) -> None:
    ticks: list[int] = []
    timer = node.create_timer(0.1, lambda: ticks.append(1))
    handler, entity, owner = executor.wait_for_ready_callbacks(timeout_sec=1.0)
    assert (entity, owner, ticks) == (timer, node, [])
    handler()
    assert ticks == [1]
