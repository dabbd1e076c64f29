"""What programs written for rclpy silently rely on, a test for each: behaviours, not names."""

from __future__ import annotations

import array
import asyncio
import copy
import os
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import robolink as rclpy
from robolink import Future, Node
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.exceptions import EncodeError, ExternalShutdownException
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.impl.logging_severity import LoggingSeverity
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from robolink.interfaces.geometry_msgs.msg import PoseWithCovariance, TransformStamped, Twist, Vector3
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.sensor_msgs.msg import BatteryState, LaserScan
from robolink.interfaces.std_msgs.msg import Int32, MultiArrayLayout, String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.parameter import Parameter
from robolink.tf2 import Buffer
from robolink.time import Time
from tests.support.spins import done, numbers, spin_for

BARE = """
import robolink.compat
import rclpy
from rclpy.node import Node
rooms = "executors qos time logging parameter callback_groups duration clock node task exceptions".split()
assert [each for each in rooms if getattr(rclpy, each).__name__ != "robolink." + each] == []
assert rclpy.Parameter is rclpy.parameter.Parameter and rclpy.Context is rclpy.context.Context
assert rclpy.Future is rclpy.task.Future and rclpy.time.Duration is rclpy.duration.Duration
"""


@pytest.fixture
def node(executor: SingleThreadedExecutor) -> Node:
    made = Node("robot", context=executor.context)
    executor.add_node(made)
    return made


@pytest.fixture
def default(monkeypatch: pytest.MonkeyPatch) -> None:
    """The default context in memory."""
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://")


@pytest.mark.processes
def test_modules_are_attributes_after_a_bare_import() -> None:
    done = subprocess.run([sys.executable, "-c", BARE], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


# --- messages ---------------------------------------------------------------------------------------------------------


def test_sequences_of_numbers_are_arrays_and_those_of_others_lists() -> None:
    scan, pose = LaserScan(), PoseWithCovariance()
    scan.ranges = [each / 2 for each in range(6)]
    given = [3.0, 2.5, 0.5]
    scan.intensities = given
    given[0] = 7.0
    made: list[Any] = [scan.ranges, scan.intensities, pose.covariance, MultiArrayLayout().dim]
    assert [type(each) for each in made] == [array.array, array.array, np.ndarray, list]
    assert (scan.ranges.index(1.5), list(scan.ranges[2:4]), scan.ranges[-1]) == (3, [1.0, 1.5], 2.5)
    scan.ranges[0] = 9.0
    assert (scan.ranges[0], list(scan.intensities)) == (9.0, [3.0, 2.5, 0.5])


def test_messages_are_made_nested_and_by_keyword() -> None:
    twist = Twist(linear=Vector3(x=0.3))
    twist.angular.z = 0.5
    assert repr(Vector3(x=1.0)) == "geometry_msgs.msg.Vector3(x=1.0, y=0.0, z=0.0)"
    assert Twist.get_fields_and_field_types() == {"linear": "geometry_msgs/Vector3", "angular": "geometry_msgs/Vector3"}
    assert (twist.linear.x, twist) == (0.3, Twist(linear=Vector3(x=0.3), angular=Vector3(z=0.5)))
    with pytest.raises((TypeError, AssertionError), match="speed"):
        Twist(speed=0.3)  # type: ignore[call-arg]


def test_constants_are_the_classs() -> None:
    assert (GoalStatus.STATUS_SUCCEEDED, BatteryState.POWER_SUPPLY_STATUS_FULL) == (4, 4)
    assert Transition.TRANSITION_CONFIGURE == 1


def test_a_value_of_the_wrong_type_is_found_before_it_leaves(node: Node) -> None:
    publisher = node.create_publisher(Twist, "cmd_vel", 10)
    publisher.publish(Twist(linear=Vector3(x=1)))  # an int where a float belongs is one, as in rclpy since Jazzy
    with pytest.raises(EncodeError, match=r"Twist\.linear\.x: expected float64, got 'fast'"):
        publisher.publish(Twist(linear=Vector3(x="fast")))  # type: ignore[arg-type]


def test_a_message_can_be_changed_and_published_again(executor: SingleThreadedExecutor, node: Node) -> None:
    got, publisher = numbers(node, "number"), node.create_publisher(Int32, "number", 10)
    message = Int32()
    for message.data in range(3):
        publisher.publish(message)
    spin_for(executor, 0.1)
    assert got == [0, 1, 2]


# --- who hears, and when ----------------------------------------------------------------------------------------------


def test_a_node_hears_itself_and_only_where_somebody_spins(executor: SingleThreadedExecutor, node: Node) -> None:
    threads: list[threading.Thread] = []
    node.create_subscription(Int32, "number", lambda _: threads.append(threading.current_thread()), 10)
    node.create_publisher(Int32, "number", 10).publish(Int32())
    assert threads == []
    spinner = threading.Thread(target=spin_for, args=(executor, 0.1))
    spinner.start()
    spinner.join()
    assert threads == [spinner]


def test_spin_once_runs_one_callback_and_waits_for_it(executor: SingleThreadedExecutor, node: Node) -> None:
    got, publisher = numbers(node, "number"), node.create_publisher(Int32, "number", 10)
    for number in range(3):
        publisher.publish(Int32(data=number))
    for number in range(3):
        executor.spin_once()
        assert got == [*range(number + 1)]
    node.create_timer(3600.0, lambda: got.append(7))
    executor.spin_once()
    assert (got[-1], executor.context.time.steady()) == (7, 3600 * 10**9)


def test_a_rate_and_spin_once_in_one_thread(executor: SingleThreadedExecutor, node: Node) -> None:
    rate, woke = node.create_rate(10.0), []
    got, publisher = numbers(node, "number"), node.create_publisher(Int32, "number", 10)
    for number in range(3):
        publisher.publish(Int32(data=number))
        executor.spin_once(timeout_sec=0.05)
        rate.sleep()
        woke.append(executor.context.time.steady())
    assert (got, woke) == ([0, 1, 2], [100_000_000, 200_000_000, 300_000_000])


def test_a_constructor_may_spin_before_any_executor_is_there(default: None) -> None:
    class Asks(Node):
        def __init__(self) -> None:
            super().__init__("asks")
            self.create_service(SetBool, "switch", answer)
            future = self.create_client(SetBool, "switch").call_async(SetBool.Request(data=True))
            rclpy.spin_until_future_complete(self, future)
            self.answer = future.result()

    def answer(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.success = request.data
        return response

    rclpy.init(args=[])
    node = Asks()
    assert node.answer == SetBool.Response(success=True)
    got = numbers(node, "number")
    node.create_publisher(Int32, "number", 10).publish(Int32(data=7))
    with SingleThreadedExecutor() as executor:
        executor.add_node(node)
        executor.spin_once(timeout_sec=1.0)
    assert got == [7]


def test_coroutines_are_callbacks(executor: SingleThreadedExecutor, node: Node) -> None:
    ready, seen = Future[str](), list[str]()

    async def on_timer() -> None:
        timer.cancel()
        seen.append("waits")
        seen.append(await ready or "")

    async def serve(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.message = await ready or ""
        return response

    timer = node.create_timer(0.1, on_timer)
    node.create_service(SetBool, "switch", serve, callback_group=ReentrantCallbackGroup())
    answer = node.create_client(SetBool, "switch").call_async(SetBool.Request())
    spin_for(executor, 0.2)
    assert (seen, answer.done()) == (["waits"], False)
    ready.set_result("ready")
    assert done(executor, answer).message == "ready"
    assert seen == ["waits", "ready"]


def test_a_future_can_be_awaited_in_asyncio() -> None:
    future = Future[int]()

    async def main() -> int | None:
        asyncio.get_running_loop().call_later(0.001, future.set_result, 42)
        return await asyncio.wait_for(_awaited(future), 30)

    assert asyncio.run(main()) == 42


async def _awaited(future: Future[int]) -> int | None:
    return await future


# --- beginning and ending ---------------------------------------------------------------------------------------------


def test_shutdown_in_a_callback_ends_the_spin(default: None) -> None:
    rclpy.init(args=[])
    node = rclpy.create_node("node")
    node.create_timer(0.001, rclpy.shutdown)
    rclpy.spin(node)
    assert not rclpy.ok()
    rclpy.try_shutdown()


def test_init_is_a_context_manager(default: None) -> None:
    with rclpy.init(args=[]):
        assert rclpy.ok()
    assert not rclpy.ok()


@pytest.mark.parametrize("expected", [KeyboardInterrupt, ExternalShutdownException])
def test_an_interrupt_is_caught_by_either_name(default: None, expected: type[BaseException]) -> None:
    rclpy.init(args=[])
    node = rclpy.create_node("node")
    node.create_timer(0.001, node.context.interrupt)
    with pytest.raises(expected):
        rclpy.spin(node)


def test_logging_goes_on_after_shutdown(default: None, log_lines: list[Record]) -> None:
    rclpy.init(args=[])
    node = rclpy.create_node("node")
    node.destroy_node()
    rclpy.shutdown()
    node.get_logger().info("bye")
    rclpy.logging.get_logger("other").log("bye", LoggingSeverity.WARN, once=True)
    assert [each.message for each in log_lines] == ["bye", "bye"]


# --- parameters, and what else is taken for granted -------------------------------------------------------------------


def test_a_declared_parameter_is_live_and_an_empty_verdict_is_no(node: Node) -> None:
    speed = node.declare_parameter("speed", 0.5)
    assert speed.type_ == Parameter.Type.DOUBLE
    assert speed.get_parameter_value().double_value == 0.5
    node.add_on_set_parameters_callback(lambda _: SetParametersResult())
    (verdict,) = node.set_parameters([Parameter("speed", value=0.7)])
    assert (verdict.successful, node.get_parameter("speed").value) == (False, 0.5)


@pytest.mark.parametrize("latest", [Time, TimeMsg])
def test_time_zero_asks_tf2_for_the_latest(node: Node, latest: Callable[[], Any]) -> None:
    buffer = Buffer()
    for second in (1, 2):
        transform = TransformStamped(child_frame_id="robot")
        transform.header.frame_id, transform.header.stamp.sec = "map", second
        transform.transform.translation.x = float(second)
        buffer.set_transform(transform, "test")
    found = buffer.lookup_transform("map", "robot", latest())
    assert (found.transform.translation.x, found.header.stamp.sec) == (2.0, 2)


@pytest.mark.processes
def test_a_program_without_a_main_guard_is_named_by_its_function(tmp_path: Path) -> None:
    program = tmp_path / "talker.py"
    program.write_text("import rclpy\ndef main(args=None):\n    with rclpy.init(args=args):\n        print('ran')\n")
    command = [sys.executable, "-m", "robolink", "run", f"{program}:main"]
    environ = {**os.environ, "ROBOLINK_TRANSPORT": "memory://"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environ)
    assert (done.returncode, done.stdout, done.stderr) == (0, "ran\n", "")


def test_a_service_callback_gets_the_request_and_an_empty_response(
    executor: SingleThreadedExecutor, node: Node
) -> None:
    seen: list[Any] = []

    def serve(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        seen.append((request.data, response.message))
        return SetBool.Response(message="another one")

    node.create_service(SetBool, "switch", serve, callback_group=ReentrantCallbackGroup())
    answer = done(executor, node.create_client(SetBool, "switch").call_async(SetBool.Request(data=True)))
    assert (seen, answer.message) == ([(True, "")], "another one")


def test_a_string_may_hold_any_letter(executor: SingleThreadedExecutor, node: Node) -> None:
    got: list[str] = []
    node.create_subscription(String, "words", lambda each: got.append(each.data), 10)
    node.create_publisher(String, "words", 10).publish(String(data="olá ✓"))
    spin_for(executor, 0.1)
    assert got == ["olá ✓"]


class Status(DiagnosticStatus):
    """What diagnostic_updater has: a message with methods and attributes of its own."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        DiagnosticStatus.__init__(self, *args, **kwargs)
        self.calls = 0

    def add(self, key: str, value: str) -> None:
        self.calls += 1
        self.values.append(KeyValue(key=key, value=value))


def test_a_message_may_be_given_methods(executor: SingleThreadedExecutor, node: Node) -> None:
    got: list[Any] = []
    node.create_subscription(DiagnosticStatus, "one", got.append, 10)
    node.create_subscription(DiagnosticArray, "all", got.append, 10)
    status = Status(name="wheel", level=DiagnosticStatus.WARN)
    status.add("speed", "0")
    status = copy.deepcopy(status)
    assert (status.calls, status.message, isinstance(status, DiagnosticStatus)) == (1, "", True)
    node.create_publisher(DiagnosticStatus, "one", 10).publish(status)
    node.create_publisher(Status, "one", 10).publish(status)
    node.create_publisher(DiagnosticArray, "all", 10).publish(DiagnosticArray(status=[status]))
    spin_for(executor, 0.1)
    plain = DiagnosticStatus(name="wheel", level=b"\x01", values=[KeyValue(key="speed", value="0")])
    assert got == [plain, DiagnosticArray(status=[plain]), plain]
    with pytest.raises(TypeError, match="no field 'colour'"):
        Status(colour="red")
