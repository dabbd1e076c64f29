"""The ROS 2 tutorials for Python run unchanged under `robolink run`, in processes of their own that talk to each other.

Each tutorial has a domain of its own and starts while the test of the one before runs; each test waits for what it is
about.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.commands import Command
from tests.domains import free_domain

pytestmark = pytest.mark.processes

WORKSPACE = Path(__file__).parent / "tutorials"

TUTORIALS: Mapping[str, tuple[tuple[str, ...], ...]] = {
    "topics": (("publisher",), ("subscriber",), ("waiter",)),
    "services": (("add_server",), ("add_client", "41", "1")),
    "interfaces": (("custom_client",), ("custom_server",)),
    "parameters": (("minimal_param", "--ros-args", "-p", "my_parameter:=earth"), ("param_monitor",)),
    "actions": (("fibonacci_client",), ("fibonacci_server",), ("fibonacci_cancel",)),
    "turtles": (
        ("turtle",),
        ("turtle_broadcaster", "--ros-args", "-r", "__node:=broadcaster1", "-p", "turtlename:=turtle1"),
        ("turtle_broadcaster", "--ros-args", "-r", "__node:=broadcaster2", "-p", "turtlename:=turtle2"),
        ("fixed_frame_broadcaster",),
        ("turtle_listener", "--ros-args", "-p", "target_frame:=turtle1"),
    ),
    "static": (("static_listener",), ("static_broadcaster", "mystaticturtle", "0", "0", "1", "0", "0", "1.5707963")),
    "lifecycle": (("lifecycle_talker",), ("lifecycle_client",)),
    "composition": (("composed",),),
    "qos": (("qos_talker",),),
    "logging": (("logging_demo", "--ros-args", "--log-level", "logger_usage_demo:=debug"),),
}
"""By tutorial: its programs and their arguments."""


class Tutorial:
    """The running programs of a tutorial, in the order of the table."""

    def __init__(self, stack: ExitStack, name: str) -> None:
        self._stack = stack
        self.domain = stack.enter_context(free_domain())
        self.programs: list[Command] = []
        for program in TUTORIALS[name]:
            self.start(*program)

    def start(self, *program: str) -> Command:
        """Run another program."""
        command = Command(self.domain, "run", "--workspace", str(WORKSPACE), *program, merged=True)
        self.programs.append(self._stack.enter_context(command))
        return command

    def end(self) -> None:
        """Press Ctrl-C wherever one still runs: all of them end quietly."""
        for each in self.programs:
            if each.process.poll() is None:
                each.interrupt()
        assert [each.end() for each in self.programs] == [0] * len(self.programs)
        assert [line for each in self.programs for line in each.lines if "Traceback" in line.text] == []


class Tutorials:
    """The tutorials by name; with the one that is asked for, the next is started."""

    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self._started: dict[str, Tutorial] = {}

    def __getitem__(self, name: str) -> Tutorial:
        names = [*TUTORIALS]
        for each in names[names.index(name) :][:2]:
            if each not in self._started:
                self._started[each] = Tutorial(self._stack, each)
        return self._started[name]


@pytest.fixture(scope="module")
def tutorials() -> Iterator[Tutorials]:
    with ExitStack() as stack:
        yield Tutorials(stack)


def said(command: Command) -> str:
    """All that it printed."""
    return "\n".join(line.text for line in command.lines)


def test_the_programs_know_nothing_of_robolink() -> None:
    for path in (WORKSPACE / "nodes").glob("*.py"):
        imported = {
            name.partition(".")[0]
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Import | ast.ImportFrom)
            for name in (
                [node.module or ""] if isinstance(node, ast.ImportFrom) else [each.name for each in node.names]
            )
        }
        assert "robolink" not in imported
        assert "rclpy" in imported


def test_a_publisher_and_a_subscriber(tutorials: Tutorials) -> None:
    publisher, subscriber, waiter = tutorials["topics"].programs
    publisher.wait_for('[minimal_publisher]: Publishing: "Hello World: 0"')
    for _ in range(3):
        subscriber.wait_for('[minimal_subscriber]: I heard: "Hello World: ')
    waiter.wait_for("[waiter]: True: Hello World")
    waiter.wait_for("[waiter]: False: None")
    assert waiter.end() == 0
    tutorials["topics"].end()


def test_a_service_and_its_client(tutorials: Tutorials) -> None:
    server, client = tutorials["services"].programs
    client.wait_for("[minimal_client_async]: Result of add_two_ints: for 41 + 1 = 42")
    server.wait_for("Incoming request")
    server.wait_for("a: 41 b: 1")
    assert client.end() == 0
    tutorials["services"].end()


def test_interfaces_of_ones_own(tutorials: Tutorials) -> None:
    client, _ = tutorials["interfaces"].programs
    assert client.end() == 0
    for line in ("Answered: 6", "The sum is 6", "A sphere at x=1.0 of radius 6.0"):
        assert f"[custom_client]: {line}" in said(client)
    tutorials["interfaces"].end()


def test_parameters(tutorials: Tutorials) -> None:
    node, monitor = tutorials["parameters"].programs
    node.wait_for("[minimal_param_node]: Hello earth!")
    node.wait_for("[minimal_param_node]: Hello world!")
    monitor.wait_for("Received an update to parameter: my_parameter: world")
    with Command(
        tutorials["parameters"].domain, "param", "set", "/node_with_parameters", "an_int_param", "43"
    ) as setter:
        assert setter.end() == 0
    monitor.wait_for("Received an update to parameter: an_int_param: 43")
    tutorials["parameters"].end()


def test_an_action_server_and_its_clients(tutorials: Tutorials) -> None:
    client, server, cancels = tutorials["actions"].programs
    client.wait_for("[fibonacci_action_client]: Goal accepted :)")
    for sequence in ("[0, 1, 1]", "[0, 1, 1, 2]", "[0, 1, 1, 2, 3]", "[0, 1, 1, 2, 3, 5]"):
        client.wait_for(f"Received feedback: {sequence}")
    client.wait_for("Result: [0, 1, 1, 2, 3, 5]")
    cancels.wait_for("Goal successfully canceled")
    server.wait_for("Goal canceled")
    assert (client.end(), cancels.end()) == (0, 0)
    tutorials["actions"].end()


def test_a_turtle_follows_another_by_tf2(tutorials: Tutorials) -> None:
    turtle, *_, listener = tutorials["turtles"].programs
    listener.wait_for("[turtle_tf2_frame_listener]: Successfully spawned turtle2")
    turtle.wait_for("the second turtle has reached the first")
    with Command(tutorials["turtles"].domain, "topic", "echo", "--once", "/tf", "--filter", CARROT) as echo:
        assert echo.end() == 0
    tutorials["turtles"].end()


CARROT = "m.transforms[0].child_frame_id == 'carrot1'"


def test_a_static_broadcaster(tutorials: Tutorials) -> None:
    listener, _ = tutorials["static"].programs
    listener.wait_for("[static_listener]: At z=1.0")
    listener.wait_for("[static_listener]: The point is at y=2.0, z=1.0")
    assert listener.end() == 0
    tutorials["static"].end()


def test_a_lifecycle_node_and_its_client(tutorials: Tutorials) -> None:
    talker, client = tutorials["lifecycle"].programs
    for line in ("True: inactive", "True: active", "data_callback: Lifecycle HelloWorld #", "True: inactive"):
        client.wait_for(f"[lc_client]: {line}")
    client.wait_for("[lc_client]: True: unconfigured")
    client.wait_for("[lc_client]: True: finalized")
    for name in ("on_configure", "on_activate", "on_deactivate", "on_cleanup", "on_shutdown"):
        talker.wait_for(f"[lc_talker]: {name}() is called.")
    assert client.end() == 0
    tutorials["lifecycle"].end()


def test_nodes_and_executors_in_one_process(tutorials: Tutorials) -> None:
    (composed,) = tutorials["composition"].programs
    composed.wait_for("[listener]: I heard: [Hello World: 1]")
    composed.wait_for("[listener]: I heard: [Hello World: 9]")
    tutorials["composition"].end()
    assert "[asks]: Answered: triggered" in said(composed)


def test_quality_of_service(tutorials: Tutorials) -> None:
    (talker,) = tutorials["qos"].programs
    talker.wait_for("Published the map")
    listener = tutorials["qos"].start("qos_listener", "-n", "5")
    assert listener.end() == 0
    heard = [line.text.partition("]: ")[2] for line in listener.lines]
    assert ("I heard: [Map 1]" in heard, "I heard: [Map 2]" in heard, "I heard: [Map 3]" in heard) == (
        False,
        True,
        True,
    )
    assert (len([each for each in heard if "Scan" in each]), heard[-1]) == (3, "Enough")
    tutorials["qos"].end()


def test_logging(tutorials: Tutorials) -> None:
    (demo,) = tutorials["logging"].programs
    demo.wait_for("That was all")
    tutorials["logging"].end()
    levels = [line.text.partition("]")[0].removeprefix("[") for line in demo.lines[:10]]
    assert levels == ["INFO", "INFO", "DEBUG", "ERROR", "INFO", "DEBUG", "WARN", "INFO", "DEBUG", "WARN"]
    assert (said(demo).count("only log once"), said(demo).count("Modulo"), said(demo).count("Not to be seen")) == (
        1,
        1,
        0,
    )
