"""The logger services: levels of loggers, read and set from elsewhere."""

from __future__ import annotations

from robolink import Context, Node, logging
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.rcl_interfaces.msg import LoggerLevel
from robolink.interfaces.rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from robolink.logging_service import NO_LEVEL
from tests.support.spins import done


def test_levels_are_set_and_read(virtual: Context, executor: SingleThreadedExecutor) -> None:
    robot = Node("robot", namespace="/lab", context=virtual, enable_logger_service=True)
    asker = Node("asker", context=virtual)
    executor.add_node(robot)
    executor.add_node(asker)
    setter = asker.create_client(SetLoggerLevels, "/lab/robot/set_logger_levels")
    getter = asker.create_client(GetLoggerLevels, "/lab/robot/get_logger_levels")
    wanted = [LoggerLevel(name=name, level=level) for name, level in (("lab.robot", 10), ("x", 11), ("y" * 10_000, 50))]
    results = done(executor, setter.call_async(SetLoggerLevels.Request(levels=wanted))).results
    assert [(each.successful, each.reason) for each in results] == [(True, ""), (False, NO_LEVEL), (True, "")]
    assert robot.get_logger().get_effective_level() == logging.LoggingSeverity.DEBUG
    levels = done(executor, getter.call_async(GetLoggerLevels.Request(names=["lab.robot", "x", "nobody"]))).levels
    assert [(each.name, each.level) for each in levels] == [("lab.robot", 10), ("x", 0), ("nobody", 0)]


def test_a_node_serves_them_only_when_asked(context: Context) -> None:
    with Node("robot", context=context) as node:
        assert node.count_services("~/get_logger_levels") == 0
