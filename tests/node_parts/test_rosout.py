"""Log lines on /rosout."""

from __future__ import annotations

import pytest

from robolink import Context, Node, logging
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.rcl_interfaces.msg import Log
from tests.support.spins import spin_for


@pytest.fixture
def lines(virtual: Context, executor: SingleThreadedExecutor) -> list[Log]:
    logging.set_console_handler(None)
    ear, got = Node("ear", context=virtual, enable_rosout=False), list[Log]()
    ear.create_subscription(Log, "/rosout", got.append, 100)
    executor.add_node(ear)
    return got


def test_a_line_says_where_it_was_written(virtual: Context, executor: SingleThreadedExecutor, lines: list[Log]) -> None:
    node = Node("node", namespace="/left", context=virtual)
    virtual.time.sleep(3_000_000_007)
    node.get_logger().warning("careful")
    spin_for(executor, 0.1)
    (line,) = lines
    assert (line.name, line.msg, line.level) == ("left.node", "careful", 30)
    assert (line.stamp.sec, line.stamp.nanosec) == (3, 7)
    assert line.file.endswith("test_rosout.py")
    assert line.function == "test_a_line_says_where_it_was_written"
    assert line.line > 0


def test_children_and_other_names(virtual: Context, executor: SingleThreadedExecutor, lines: list[Log]) -> None:
    node = Node("node", context=virtual)
    node.get_logger().get_child("part").info("mine")
    logging.get_logger("stranger").info("not mine")
    logging.get_logger("node_2").info("not mine")
    node.get_logger().debug("not wanted")
    spin_for(executor, 0.1)
    assert [(line.name, line.msg) for line in lines] == [("node.part", "mine")]


def test_rosout_can_be_turned_off(virtual: Context, executor: SingleThreadedExecutor, lines: list[Log]) -> None:
    by_argument = Node("one", context=virtual, enable_rosout=False)
    by_command_line = Node("two", context=virtual, cli_args=["--ros-args", "--disable-rosout-logs"])
    for node in (by_argument, by_command_line):
        node.get_logger().info("quiet")
    spin_for(executor, 0.1)
    assert lines == []
    assert by_argument.count_publishers("/rosout") == 0


def test_logging_goes_on_after_the_end(virtual: Context, executor: SingleThreadedExecutor, lines: list[Log]) -> None:
    node, other = Node("node", context=virtual), Node("other", context=virtual)
    logger = node.get_logger()
    node.destroy_node()
    assert logger.info("after the node")
    other.get_logger().info("still here")
    spin_for(executor, 0.1)
    assert [line.msg for line in lines] == ["still here"]
    virtual.shutdown()
    assert logger.info("after the context")
    assert other.get_logger().info("after the context")


def test_who_comes_late_gets_the_lines_of_before(virtual: Context, executor: SingleThreadedExecutor) -> None:
    from robolink.qos import qos_profile_rosout_default

    logging.set_console_handler(None)
    early, late, got = Node("early", context=virtual), Node("late", context=virtual), list[Log]()
    early.get_logger().info("early")
    executor.add_node(late)
    late.create_subscription(Log, "/rosout", got.append, qos_profile_rosout_default)
    spin_for(executor, 0.1)
    assert [line.msg for line in got] == ["early"]
