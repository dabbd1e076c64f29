"""Nodes under /clock: use_sim_time, timers, jumps of the simulated time."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from robolink import Context, Node, Parameter, VirtualTime
from robolink.clock import Clock, ROSClock
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.interfaces.rosgraph_msgs.msg import Clock as ClockMsg
from robolink.time_source import TimeSource
from robolink.transport.memory import Bus, MemoryTransport
from tests.support.spins import counted_calls, spin_for

SECOND = 1_000_000_000


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual, parameter_overrides=[Parameter("use_sim_time", value=True)])
    executor.add_node(made)
    return made


@pytest.fixture
def tell_time(virtual: Context, executor: SingleThreadedExecutor) -> Callable[[float], None]:
    """Publish on /clock, and spin for a moment."""
    publisher = Node("world", context=virtual).create_publisher(ClockMsg, "/clock", 10)

    def tell(seconds: float) -> None:
        whole, rest = divmod(round(seconds * SECOND), SECOND)
        publisher.publish(ClockMsg(clock=TimeMsg(sec=whole, nanosec=rest)))
        spin_for(executor, 0.001)

    return tell


def test_time_is_what_clock_says(node: Node, tell_time: Callable[[float], None]) -> None:
    assert node.get_clock().now().nanoseconds == 0
    tell_time(12.5)
    assert node.get_clock().now().nanoseconds == 12_500_000_000
    tell_time(12.75)
    assert node.get_clock().now().nanoseconds == 12_750_000_000


def test_without_use_sim_time_clock_does_not_matter(
    virtual: Context, executor: SingleThreadedExecutor, tell_time: Callable[[float], None]
) -> None:
    node = Node("plain", context=virtual)
    executor.add_node(node)
    tell_time(99.0)
    assert node.get_clock().now().nanoseconds < SECOND
    assert node.count_subscribers("/clock") == 0


def test_timers_follow_clock(node: Node, executor: SingleThreadedExecutor, tell_time: Callable[[float], None]) -> None:
    calls: list[float] = []
    tell_time(100.0)
    node.create_timer(1.0, lambda: calls.append(node.get_clock().now().nanoseconds / SECOND))
    spin_for(executor, 60.0)
    assert calls == []
    for tenth in range(1, 36):
        tell_time(100 + tenth / 10)
    assert calls == [101.0, 102.0, 103.0]


def test_steady_timers_do_not(node: Node, executor: SingleThreadedExecutor) -> None:
    calls: list[int] = []
    node.create_timer(1.0, lambda: calls.append(1), clock=Clock(time_base=node.context.time))
    spin_for(executor, 3.5)
    assert len(calls) == 3


def test_timers_go_on_when_the_simulation_begins_anew(node: Node, tell_time: Callable[[float], None]) -> None:
    calls: list[float] = []
    tell_time(500.0)
    node.create_timer(1.0, lambda: calls.append(node.get_clock().now().nanoseconds / SECOND))
    tell_time(501.0)
    for half in range(8):
        tell_time(half / 2)
    assert calls == [501.0, 1.0, 2.0, 3.0]


def test_use_sim_time_may_be_switched(
    virtual: Context, executor: SingleThreadedExecutor, tell_time: Callable[[float], None]
) -> None:
    virtual.time.sleep(1000 * SECOND)
    node, calls = Node("node", context=virtual), list[int]()
    executor.add_node(node)
    node.create_timer(1.0, lambda: calls.append(node.get_clock().now().nanoseconds // SECOND))
    spin_for(executor, 1.5)
    assert calls == [1001]
    node.set_parameters([Parameter("use_sim_time", value=True)])
    for half in range(1, 5):
        tell_time(half / 2)
    assert calls == [1001, 1, 2]
    node.set_parameters([Parameter("use_sim_time", value=False)])
    assert node.count_subscribers("/clock") == 0
    spin_for(executor, 2.0)
    assert calls[3:] in ([1001, 1002, 1003], [1002, 1003])


def test_use_sim_time_must_be_a_bool(node: Node) -> None:
    (result,) = node.set_parameters([Parameter("use_sim_time", value=3)])
    assert not result.successful
    assert isinstance(node.get_clock(), ROSClock)
    assert node.get_parameter("use_sim_time").value is True


def test_simulated_time_goes_on_while_a_coroutine_waits(
    node: Node, executor: SingleThreadedExecutor, tell_time: Callable[[float], None]
) -> None:
    future, trace = executor.create_future(), list[str]()

    async def wait() -> None:
        timer.cancel()
        await future
        trace.append("done")

    timer = node.create_timer(1.0, wait)
    tell_time(1.0)
    node.create_timer(1.0, lambda: future.set_result(None), callback_group=node._rate_group)
    tell_time(2.0)
    assert trace == ["done"]


def test_a_time_source_sets_the_clocks_attached_to_it(virtual: Context) -> None:
    source, clock = TimeSource(), ROSClock(time_base=virtual.time)
    source.attach_clock(clock)
    source.ros_time_is_active = True
    assert clock.ros_time_is_active
    source.clock_callback(ClockMsg(clock=TimeMsg(sec=7)))
    late = ROSClock(time_base=virtual.time)
    source.attach_clock(late)
    assert clock.now_ns() == late.now_ns() == 7 * SECOND
    with pytest.raises(ValueError, match="ROS_TIME"):
        source.attach_clock(Clock())  # type: ignore[arg-type] # what is tested
    source.attach_node(Node("node", context=virtual))
    assert not late.ros_time_is_active
    source.detach_node()


def calls_of_a_clock_message(nodes: int) -> int:
    """How many functions run when /clock tells so many nodes, with a timer each, what time it is."""
    context = Context(transport=MemoryTransport(bus=Bus()), time=VirtualTime())
    context.init([])
    with context, SingleThreadedExecutor(context=context) as executor:
        called: list[None] = []
        for index in range(nodes):
            overrides = [Parameter("use_sim_time", value=True)]
            each = Node(f"node_{index}", context=context, parameter_overrides=overrides)
            each.create_timer(1.0, lambda: called.append(None))
            executor.add_node(each)
        publisher = Node("world", context=context).create_publisher(ClockMsg, "/clock", 10)
        publisher.publish(ClockMsg(clock=TimeMsg(sec=100)))
        spin_for(executor, 0.001)
        publisher.publish(ClockMsg(clock=TimeMsg(sec=101)))
        with counted_calls() as calls:
            spin_for(executor, 0.001)
        assert len(called) == 2 * nodes
    return len(calls)


def test_what_a_clock_message_costs_grows_with_the_nodes_and_no_faster() -> None:
    few, more, most = (calls_of_a_clock_message(nodes) for nodes in (5, 10, 20))
    assert most - more == 2 * (more - few)
