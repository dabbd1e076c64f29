"""Parameters that were given to a program and that no node declares are told of, once, and no others are."""

from __future__ import annotations

import gc
from pathlib import Path

import pytest

from robolink import Context, Node
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record

FILE = """
/**: {ros__parameters: {for_whom_it_may_concern: 1}}
/robot: {ros__parameters: {sped: 1.0}}
/other: {ros__parameters: {spede: 1.0}}
"""


class Robot(Node):
    """Declares one parameter."""

    def __init__(self, context: Context, name: str = "robot") -> None:
        super().__init__(name, context=context)
        self.declare_parameter("speed", 0.5)


def run(*arguments: str, spins: bool = True, declares: str = "") -> None:
    """Run a robot with these ROS arguments to its end; it declares a further parameter while it spins."""
    context = Context(transport="memory")
    context.init(["--ros-args", *arguments])
    with context, SingleThreadedExecutor(context=context) as executor:
        node = Robot(context)
        executor.add_node(node)
        if declares:
            node.create_timer(0.0, lambda: node.declare_parameter(declares, 1))
        node.create_timer(0.0, context.interrupt)
        if spins:
            with pytest.raises(KeyboardInterrupt):
                executor.spin()


def told(lines: list[Record]) -> list[tuple[str, str]]:
    return [(each.name, each.message) for each in lines]


def test_a_misspelt_name_is_told_when_the_node_spins(log_lines: list[Record]) -> None:
    run("-p", "spede:=3.0", "-p", "robot:spee:=1.0", "-p", "speed:=2.0")
    assert told(log_lines) == [
        ("robot", "parameter 'spede' was given, but no node declared it (did you mean 'speed'?)"),
        ("robot", "parameter 'spee' was given, but no node declared it (did you mean 'speed'?)"),
    ]
    log_lines.clear()
    run("-p", "spede:=3.0")
    assert told(log_lines) == [
        ("robot", "parameter 'spede' was given, but no node has declared it so far (did you mean 'speed'?)")
    ]


def test_what_is_like_nothing_is_told_at_the_end(log_lines: list[Record]) -> None:
    run("-p", "colour:=red")
    run("-p", "spede:=1.0", spins=False)
    assert told(log_lines) == [
        ("robot", "parameter 'colour' was given, but no node declared it"),
        ("robot", "parameter 'spede' was given, but no node declared it (did you mean 'speed'?)"),
    ]


def test_what_another_node_may_declare_is_not_told(log_lines: list[Record]) -> None:
    run("--wide-param", "colour:=red", "--wide-param", "spede:=1.0")
    assert told(log_lines) == []


def test_what_is_declared_late_is_not_told(log_lines: list[Record]) -> None:
    run("-p", "colour:=1", declares="colour")
    assert told(log_lines) == []


def test_what_a_node_declared_that_nobody_refers_to_any_more_is_not_told(log_lines: list[Record]) -> None:
    """As that of a program which is interrupted before it spins: its node goes before the context does."""
    context = Context(transport="memory")
    context.init(["--ros-args", "-p", "speed:=1.0"])
    with context:
        Robot(context)
        gc.collect()
    assert told(log_lines) == []


def test_a_file_is_told_of_what_it_has_for_this_node_by_name(log_lines: list[Record], tmp_path: Path) -> None:
    file = tmp_path / "params.yaml"
    file.write_text(FILE)
    run("--params-file", str(file), spins=False)
    assert told(log_lines) == [("robot", "parameter 'sped' was given, but no node declared it (did you mean 'speed'?)")]


def test_one_node_that_declares_it_is_enough(log_lines: list[Record]) -> None:
    context = Context(transport="memory")
    context.init(["--ros-args", "-p", "speed:=1.0"])
    with context:
        Node("first", context=context)
        Robot(context, "second").destroy_node()
        Node("third", context=context)
    assert told(log_lines) == []


def test_an_error_that_ends_the_program_says_enough(log_lines: list[Record]) -> None:
    context = Context(transport="memory")
    context.init(["--ros-args", "-p", "colour:=1"])
    with pytest.raises(ZeroDivisionError), context:
        Robot(context).create_timer(1 / 0, print)
    assert told(log_lines) == []


def test_a_name_that_only_another_node_declares_does_not_suggest_itself(log_lines: list[Record]) -> None:
    context = Context(transport="memory")
    context.init(["--ros-args", "-p", "robot:colour:=1"])
    with context, SingleThreadedExecutor(context=context) as executor:
        nodes = [Robot(context), Robot(context, "other")]
        nodes[1].declare_parameter("colour", 2)
        for node in nodes:
            executor.add_node(node)
        nodes[0].create_timer(0.0, context.interrupt)
        with pytest.raises(KeyboardInterrupt):
            executor.spin()
    assert told(log_lines) == [("robot", "parameter 'colour' was given, but no node declared it")]
