"""The functions of the module: init, spin and their sisters, as programs call them."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import pytest

import robolink as rclpy
from robolink import Context, Future, Node
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.transport.memory import Bus, MemoryTransport
from robolink.utilities import set_default_context
from tests.support.spins import numbers, spin_for, spin_until

PATIENCE = 30.0


@pytest.fixture
def default(virtual: Context) -> Iterator[Context]:
    """Make the default context one in memory and in virtual time."""
    set_default_context(virtual)
    yield virtual
    set_default_context(None)


def memory() -> Context:
    return Context(transport=MemoryTransport(bus=Bus()))


def test_init_ok_shutdown_and_again() -> None:
    for _ in range(2):
        set_default_context(memory())
        assert not rclpy.ok()
        rclpy.init(args=[])
        assert rclpy.ok()
        with pytest.raises(RuntimeError, match="only be called once"):
            rclpy.init(args=[])
        rclpy.shutdown()
        assert not rclpy.ok()
        with pytest.raises(RuntimeError, match="must be initialized"):
            rclpy.shutdown()
        rclpy.try_shutdown()


def test_init_is_a_context_manager() -> None:
    set_default_context(memory())
    with rclpy.init(args=[]) as session:
        assert rclpy.ok()
        assert session.context is rclpy.get_default_context()
    assert not rclpy.ok()
    context = memory()
    with rclpy.init(args=[], context=context):
        assert rclpy.ok(context=context)
        assert not rclpy.ok()
    assert not rclpy.ok(context=context)


def test_create_node_passes_everything_on(default: Context) -> None:
    node = rclpy.create_node("node", namespace="/left", enable_rosout=False, allow_undeclared_parameters=True)
    assert node.get_fully_qualified_name() == "/left/node"
    assert node.count_publishers("/rosout") == 0
    assert node.get_parameter("whatever").value is None


def test_spin_runs_until_shutdown(default: Context) -> None:
    node, calls = rclpy.create_node("node"), list[int]()

    def tick() -> None:
        calls.append(1)
        if len(calls) == 3:
            rclpy.shutdown()

    node.create_timer(0.1, tick)
    rclpy.spin(node)
    assert len(calls) == 3
    node.destroy_node()


@pytest.mark.usefixtures("default")
def test_only_nodes_spin() -> None:
    for spin in (rclpy.spin, rclpy.spin_once):
        with pytest.raises(TypeError, match=r"expected a Node to spin, got <class .*Node'>: call it, Node\(\)"):
            spin(Node)  # type: ignore[arg-type]
        with pytest.raises(TypeError, match=r"expected a Node to spin, got None$"):
            spin(None)  # type: ignore[arg-type]


def test_spin_once_with_the_executor_of_all(default: Context) -> None:
    node = rclpy.create_node("node")
    got, publisher = numbers(node, "topic"), node.create_publisher(Int32, "topic", 10)
    publisher.publish(Int32(data=1))
    publisher.publish(Int32(data=2))
    rclpy.spin_once(node)
    assert got == [1]
    assert node.executor is None
    rclpy.spin_once(node, timeout_sec=0)
    assert got == [1, 2]
    rclpy.spin_once(node, timeout_sec=5.0)
    assert default.time.steady() == 5 * 10**9


def test_spin_once_takes_its_timeout_and_no_longer(context: Context) -> None:
    node = Node("node", context=context)
    rclpy.spin_once(node, timeout_sec=0)
    begin = time.monotonic()
    rclpy.spin_once(node, timeout_sec=0.05)
    assert 0.05 <= time.monotonic() - begin < 5.0


def test_nobody_starves_when_a_program_spins_once_and_again(default: Context) -> None:
    node, ticks = rclpy.create_node("node"), list[int]()
    busy, publisher = numbers(node, "busy"), node.create_publisher(Int32, "busy", 10)
    seldom, other = numbers(node, "seldom"), node.create_publisher(Int32, "seldom", 10)
    node.create_timer(0.1, lambda: ticks.append(1))
    other.publish(Int32())
    for _ in range(60):
        publisher.publish(Int32())
        publisher.publish(Int32())
        default.time.sleep(10**8)
        rclpy.spin_once(node)
    assert len(seldom) == 1
    assert len(ticks) >= 25  # half of 60 each: the busy topic drops messages, so they take turns
    assert len(busy) >= 25


def test_a_future_is_waited_for_from_a_constructor(default: Context) -> None:
    server = rclpy.create_node("server")
    server.create_service(Trigger, "ready", lambda _, response: response)

    class Needy(Node):
        def __init__(self) -> None:
            super().__init__("needy")
            client = self.create_client(Trigger, "ready")
            self.answer = client.call_async(Trigger.Request())
            rclpy.get_global_executor().add_node(server)
            rclpy.spin_until_future_complete(self, self.answer, timeout_sec=1.0)
            rclpy.get_global_executor().remove_node(server)
            self.create_timer(0.1, rclpy.shutdown)

    node = Needy()
    assert isinstance(node.answer.result(), Trigger.Response)
    rclpy.spin(node)
    assert not rclpy.ok()


def test_spinning_until_a_future_is_done_gives_up(default: Context) -> None:
    node, future = rclpy.create_node("node"), Future[int]()
    rclpy.spin_until_future_complete(node, future, timeout_sec=2.0)
    assert not future.done()
    assert default.time.steady() == 2 * 10**9
    future.set_result(1)
    rclpy.spin_until_future_complete(node, future)
    assert default.time.steady() == 2 * 10**9


def test_waiting_within_a_callback_does_not_take_the_node_away(
    default: Context, executor: SingleThreadedExecutor
) -> None:
    """rclpy leaves the executor without its node after this, which hangs then."""
    server, node = rclpy.create_node("server"), rclpy.create_node("node")
    server.create_service(Trigger, "ready", lambda _, response: response)
    rclpy.get_global_executor().add_node(server)
    client, answers = node.create_client(Trigger, "ready"), list[object]()

    def tick() -> None:
        future = client.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
        answers.append(future.result())

    executor.add_node(node)
    node.create_timer(0.1, tick)
    spin_for(executor, 0.35)
    assert len(answers) == 3
    assert all(isinstance(each, Trigger.Response) for each in answers)
    assert node.executor is executor


def test_a_thread_spins_until_the_main_program_shuts_down() -> None:
    set_default_context(memory())
    rclpy.init(args=[])
    node, ran = rclpy.create_node("node"), threading.Event()
    node.create_timer(0.001, ran.set)
    thread = threading.Thread(target=rclpy.spin, args=(node,))
    thread.start()
    assert ran.wait(PATIENCE)
    rclpy.shutdown()
    thread.join(PATIENCE)
    assert not thread.is_alive()


def test_an_executor_of_ones_own_is_used(default: Context, executor: SingleThreadedExecutor) -> None:
    node, other = rclpy.create_node("node"), rclpy.create_node("other")
    executor.add_node(other)
    got = numbers(other, "topic")
    node.create_publisher(Int32, "topic", 10).publish(Int32(data=1))
    rclpy.spin_once(node, executor=executor)
    assert got == [1]
    assert executor.get_nodes() == [other]


def test_an_executor_says_whether_it_spins(virtual: Context, executor: SingleThreadedExecutor) -> None:
    node, seen = Node("node", context=virtual), list[bool]()
    executor.add_node(node)
    node.create_timer(0.1, lambda: seen.append(executor.is_spinning))
    assert not executor.is_spinning
    executor.spin_once()
    assert (seen, executor.is_spinning) == ([True], False)


def test_the_executor_of_all_lasts_as_long_as_the_context(default: Context) -> None:
    first = rclpy.get_global_executor()
    assert rclpy.get_global_executor() is first
    assert first.context is default
    rclpy.shutdown()
    set_default_context(memory())
    rclpy.init(args=[])
    assert rclpy.get_global_executor() is not first
    assert rclpy.get_global_executor().context is rclpy.get_default_context()


def test_a_context_of_ones_own_leaves_no_executors_behind(virtual: Context) -> None:
    node = Node("node", context=virtual)
    for _ in range(50):
        rclpy.spin_once(node, timeout_sec=0)
    assert len(virtual._callbacks) < 10


def test_utilities_say_what_this_is() -> None:
    from robolink import utilities

    assert utilities.get_rmw_implementation_identifier() in utilities.get_available_rmw_implementations()
    assert utilities.remove_ros_args(["prog", "--ros-args", "-r", "a:=b", "--", "x"]) == ["prog", "x"]
    assert [utilities.timeout_sec_to_nsec(each) for each in (None, -1, 0, 1.5)] == [-1, -1, 0, 1_500_000_000]


@pytest.mark.parametrize("elsewhere", [False, True])
def test_a_callback_that_spins_without_an_end_is_told_what_it_holds_up(
    default: Context, elsewhere: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    node, woke = rclpy.create_node("node"), list[int]()

    def tick() -> None:
        rclpy.spin_once(node)
        woke.append(default.time.now() // 10**6)
        rclpy.shutdown()

    node.create_timer(0.1, tick)
    node.create_timer(0.45, lambda: None, callback_group=ReentrantCallbackGroup())
    rclpy.spin(node, SingleThreadedExecutor() if elsewhere else None)
    assert woke == [450]
    line, *more = capsys.readouterr().err.splitlines()
    assert "[node]: a callback spins and waits without a timeout_sec: a timer is ready, but cannot run" in line
    assert ["with ROS 2 it would then be in no executor any more" in each for each in more] == [True] * elsewhere


@pytest.mark.parametrize("group", [None, ReentrantCallbackGroup()])
def test_a_callback_that_spins_for_an_answer_is_told_of_the_service_that_it_holds_up(
    default: Context, group: ReentrantCallbackGroup | None, capsys: pytest.CaptureFixture[str]
) -> None:
    node, seen = rclpy.create_node("node"), list[object]()
    client = node.create_client(Trigger, "go")
    node.create_service(Trigger, "go", lambda _, response: response, callback_group=group)
    node.create_timer(0.15, lambda: None)  # is held up, too, and is no reason for a word
    node.create_timer(1.0, rclpy.shutdown, callback_group=ReentrantCallbackGroup())

    def ask() -> None:
        future = client.call_async(Trigger.Request())
        once.cancel()
        rclpy.spin_until_future_complete(node, future)
        seen.append(future.result())

    once = node.create_timer(0.1, ask)
    rclpy.spin(node)
    told = capsys.readouterr().err
    assert seen == ([None] if group is None else [Trigger.Response()])
    lines = [each.partition("timeout_sec: ")[2].partition(" before")[0] for each in told.splitlines()]
    assert lines == (["the service of /go is ready, but cannot run"] if group is None else [])


def test_a_callback_in_a_thread_that_spins_without_an_end_is_told_too(
    context: Context, capsys: pytest.CaptureFixture[str]
) -> None:
    executor, node, seen = MultiThreadedExecutor(2, context=context), Node("node", context=context), list[str]()
    publisher = node.create_publisher(Int32, "number", 10)
    node.create_subscription(Int32, "number", lambda _: executor.spin_once(), 10)
    executor.add_node(node)
    for _ in range(2):
        publisher.publish(Int32())

    def is_told() -> bool:
        seen.append(capsys.readouterr().err)
        return "the subscription of /number is ready, but cannot run" in "".join(seen)

    with executor:
        spin_until(executor, is_told)


@pytest.mark.parametrize("seconds", [0.0, 0.3])
def test_a_callback_that_spins_for_a_time_is_left_alone(
    default: Context, seconds: float, capsys: pytest.CaptureFixture[str]
) -> None:
    node, woke = rclpy.create_node("node"), list[int]()

    def tick() -> None:
        rclpy.spin_once(node, timeout_sec=seconds)
        woke.append(default.time.now() // 10**6)
        rclpy.shutdown()

    node.create_timer(0.1, tick)
    rclpy.spin(node)
    assert woke == [100 + int(seconds * 1000)]
    assert capsys.readouterr().err == ""
