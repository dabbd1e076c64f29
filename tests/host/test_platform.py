"""Contexts and executors of hosted programs are of the same classes as everywhere, with a platform of the program's."""

from __future__ import annotations

import json

import pytest

from robolink import Context, Node, logging
from robolink.executors import SingleThreadedExecutor
from robolink.host.driver import HostDriver
from robolink.host.pace import HostTime
from robolink.running.defaults import get_defaults
from robolink.transport.memory import MemoryTransport
from tests.support.hosts import Stage

SCRIPT = """
import json
import rclpy
from rclpy.executors import SingleThreadedExecutor

class Own(rclpy.Context):
    pass

class OwnExecutor(SingleThreadedExecutor):
    pass

rclpy.init()
context = Own()
context.init()
node = rclpy.create_node("own", context=context)
executors = [SingleThreadedExecutor(), SingleThreadedExecutor(context=context), OwnExecutor(context=context)]
ticks = []
node.create_timer(0.1, lambda: ticks.append(1))
executors[{index}].add_node(node)
executors[{index}].spin_until_future_complete(rclpy.task.Future(), timeout_sec=1.05)
kinds = [type(each).__qualname__ for each in (rclpy.Context(), context, *executors)]
node.get_logger().info(json.dumps([kinds, len(ticks), context.transport.session_id]))
"""


@pytest.mark.parametrize("index", [1, 2])
def test_a_program_sees_no_other_classes_and_those_of_its_own_are_hosted_too(
    stage: Stage, log: list[str], index: int
) -> None:
    program = stage.start("script", SCRIPT.replace("{index}", str(index)), "--ros-args", "-r", "__ns:=/lab")
    stage.host.run(5.0)
    assert (program.error, program.returncode) == (None, 0)
    kinds, ticks, session = json.loads(log[0])
    assert kinds == ["Context", "Own", "SingleThreadedExecutor", "SingleThreadedExecutor", "OwnExecutor"]
    assert ticks == 10
    assert session
    assert stage.host.now == 5.0


def test_a_class_derived_from_context_takes_the_programs_time_session_and_command_line(stage: Stage) -> None:
    stage.start("script", SCRIPT.replace("{index}", "1") + "rclpy.spin(node)", "--ros-args", "-r", "__ns:=/lab")
    stage.host.run(3.0)
    program = stage.host.programs["script"]
    own = next(each for each in program.contexts if type(each).__name__ == "Own")
    assert isinstance(own.time, HostTime)
    assert isinstance(own.transport, MemoryTransport)
    assert own.transport.bus is stage.host.bus
    assert [each.get_namespace() for each in program.nodes] == ["/lab"]


def test_only_the_plain_executor_is_run_by_the_host(stage: Stage) -> None:
    logging.set_console_handler(None)
    assert get_defaults().program is None
    with Context(transport="memory://platform") as context, SingleThreadedExecutor(context=context) as executor:
        assert executor._driver is None
        assert context.make_driver(executor) is None
    made: list[bool] = []

    class Maker(Node):
        def __init__(self) -> None:
            super().__init__("maker")
            own = type("Own", (SingleThreadedExecutor,), {})
            made.extend(isinstance(each()._driver, HostDriver) for each in (SingleThreadedExecutor, own))

    stage.host.start_node(Maker)
    assert made == [True, False]
