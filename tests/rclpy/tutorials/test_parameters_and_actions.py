"""ROS 2's tutorials on parameters in a class, events of parameters and actions with a type of one's own, in Python."""

from __future__ import annotations

import pytest

import robolink
from robolink.testing import System
from robolink.workspace import load_module
from tests.support.seen_by_commands import a_context_that_commands_see, spinning
from tests.support.tutorial_workspace import TutorialWorkspace

ENTRY = "minimal_param_node = python_parameters.python_parameters_node:main"


def said(system: System, name: str) -> list[str]:
    return [each.message for each in system.logs if each.name == name]


def test_a_parameter_in_a_class(ros2_ws: TutorialWorkspace, system: System) -> None:
    ros2_ws.create("python_parameters", ENTRY, options="--dependencies rclpy")
    system.start("python_parameters minimal_param_node")
    system.run(1.5)
    system.set_parameter("minimal_param_node", "my_parameter", "earth")
    system.run(2.0)
    assert said(system, "minimal_param_node") == ["Hello world!", "Hello earth!", "Hello world!"]


def test_a_parameter_is_given_by_a_launch_file(ros2_ws: TutorialWorkspace, system: System) -> None:
    ros2_ws.create("python_parameters", ENTRY, data="launch")
    system.launch("python_parameters python_parameters_launch.py")
    system.run(2.5)
    assert said(system, "custom_minimal_param_node") == ["Hello earth!", "Hello world!"]


def test_its_description_is_told(ros2_ws: TutorialWorkspace, monkeypatch: pytest.MonkeyPatch) -> None:
    package = ros2_ws.create("python_parameters", ENTRY)
    with a_context_that_commands_see(monkeypatch), robolink.init(args=[]):
        program = load_module(package / "python_parameters/python_parameters_node.py")
        with spinning(program.MinimalParam()):
            assert ros2_ws.ros2("ros2 param list /minimal_param_node").splitlines()[0] == "  my_parameter"
            assert ros2_ws.ros2("ros2 param describe /minimal_param_node my_parameter") == (
                "Parameter name: my_parameter\n  Type: string\n  Description: This parameter is mine!\n  Constraints:\n"
            )
            assert ros2_ws.ros2("ros2 param set /minimal_param_node my_parameter earth") == "Set parameter successful\n"


def test_events_of_parameters(ros2_ws: TutorialWorkspace, system: System) -> None:
    ros2_ws.create(
        "python_parameter_event_handler",
        "parameter_event_handler = python_parameter_event_handler.parameter_event_handler:main",
    )
    system.start("python_parameter_event_handler parameter_event_handler")
    system.run(0.5)
    system.set_parameter("node_with_parameters", "an_int_param", 43)
    system.expect_log("Received an update to parameter: an_int_param: 43")


def test_an_action(ros2_ws: TutorialWorkspace, system: System) -> None:
    ros2_ws.create("custom_action_interfaces")
    assert ros2_ws.ros2("ros2 interface show custom_action_interfaces/action/Fibonacci") == (
        "int32 order\n---\nint32[] sequence\n---\nint32[] partial_sequence\n"
    )
    server, client = ros2_ws.type("fibonacci_action_server.py"), ros2_ws.type("fibonacci_action_client.py")
    system.start(server)
    system.start(client)
    numbers = [0, 1, 1, 2, 3, 5, 8, 13, 21, 34, 55]
    system.expect_log(f"Result: array('i', {numbers})", within=15.0)
    assert said(system, "fibonacci_action_client") == [
        "Goal accepted :)",
        *(f"Received feedback: array('i', {numbers[:n]})" for n in range(3, 12)),
        f"Result: array('i', {numbers})",
    ]
    assert said(system, "fibonacci_action_server")[:2] == ["Executing goal...", "Feedback: array('i', [0, 1, 1])"]
    system.run(1.0)
    assert system.nodes == ["/fibonacci_action_server"]
