"""What programs read of launch actions under the mangled names of ROS 2's own private attributes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from robolink.launch.ros.launch import LaunchContext, LaunchDescription
from robolink.launch.ros.launch.actions import (
    EmitEvent,
    ExecuteProcess,
    GroupAction,
    IncludeLaunchDescription,
    OpaqueFunction,
    RegisterEventHandler,
    Shutdown,
    TimerAction,
)
from robolink.launch.ros.launch.conditions import IfCondition, UnlessCondition
from robolink.launch.ros.launch.event_handlers import OnShutdown
from robolink.launch.ros.launch.events import Shutdown as ShutdownEvent
from robolink.launch.ros.launch.sources import PythonLaunchDescriptionSource
from robolink.launch.ros.launch.substitutions import LaunchConfiguration
from robolink.launch.ros.launch.utilities import perform_substitutions
from robolink.launch.ros.launch_ros.actions import ComposableNodeContainer, LoadComposableNodes, Node, SetParameter
from robolink.launch.ros.launch_ros.descriptions import ComposableNode, Parameter
from robolink.launch.ros.launch_ros.utilities import evaluate_parameters

CONTEXT = LaunchContext()


def text(substitutions: Any) -> str:
    """The text of these substitutions."""
    return perform_substitutions(CONTEXT, list(substitutions))


def node(**given: Any) -> Any:
    """A node's action."""
    return Node(package="p", executable="e", name="n", namespace="s", **given)


def test_parameters_of_a_node_are_evaluated_from_its_action() -> None:
    context = LaunchContext()
    context.launch_configurations["robot"] = "ada"
    action = node(parameters=[{"robot": LaunchConfiguration("robot"), "rate": 5.0}])
    (parameters,) = evaluate_parameters(context, action._Node__parameters)
    assert parameters == {"robot": "ada", "rate": 5.0}


def test_a_node_shows_what_it_was_made_of() -> None:
    action = node(remappings=[("a", "b")], arguments=["-x"], ros_arguments=["-y"])
    assert (action._Node__package, action._Node__node_executable) == ("p", "e")
    assert (action._Node__node_name, action._Node__node_namespace) == ("n", "s")
    assert (action._Node__arguments, action._Node__ros_arguments) == (["-x"], ["-y"])
    assert [(text(match), text(new)) for match, new in action._Node__remappings] == [("a", "b")]


def test_a_node_shows_what_it_became(tmp_path: Path) -> None:
    action = node(parameters=[{"a": 1}, str(tmp_path / "b.yaml"), Parameter("c", 3)], remappings=[("a", "b")])
    unknown = (Node.UNSPECIFIED_NODE_NAME, Node.UNSPECIFIED_NODE_NAMESPACE)
    assert (action._Node__expanded_node_name, action._Node__expanded_node_namespace) == unknown
    assert (action._Node__expanded_parameter_arguments, action._Node__expanded_remappings) == (None, None)
    action._perform_substitutions(CONTEXT)
    assert (action._Node__expanded_node_name, action._Node__expanded_node_namespace) == ("n", "/s")
    (written, *others) = action._Node__expanded_parameter_arguments
    assert yaml.safe_load(Path(written[0]).read_text()) == {"/s/n": {"ros__parameters": {"a": 1}}}
    assert (written[1], others) == (True, [(str(tmp_path / "b.yaml"), True), ("c:=3", False)])
    assert action._Node__expanded_remappings == [("a", "b")]
    assert list(action._Node__extensions.values()) == []


def test_what_a_program_sets_counts() -> None:
    action = node()
    action._Node__node_name = "other"
    action._perform_substitutions(CONTEXT)
    assert action.node_name == "/s/other"


def test_a_process_shows_how_it_is_started() -> None:
    end = Shutdown()
    action: Any = ExecuteProcess(cmd=["a"], output="both", respawn=True, respawn_delay=2.0, shell=True, on_exit=[end])
    assert action._ExecuteLocal__respawn is True
    assert action._ExecuteLocal__respawn_delay == 2.0
    assert action._ExecuteLocal__shell is True
    assert action._ExecuteLocal__on_exit == [end]
    assert text(action._ExecuteLocal__output) == "both"
    assert action._ExecuteLocal__process_description is action.process_description


def test_an_action_shows_its_condition() -> None:
    condition: Any = IfCondition(LaunchConfiguration("sim"))
    action = node(condition=condition)
    assert action._Action__condition is condition
    (variable,) = condition._IfCondition__predicate_expression
    assert text(variable.variable_name) == "sim"
    unless: Any = UnlessCondition("true")
    assert text(unless._UnlessCondition__predicate_expression) == "true"


def _noted(context: LaunchContext, first: int, *, second: int) -> None: ...


@pytest.mark.parametrize(
    ("action", "name", "expected"),
    [
        (OpaqueFunction(function=_noted, args=[1], kwargs={"second": 2}), "_OpaqueFunction__function", _noted),
        (OpaqueFunction(function=_noted, args=[1], kwargs={"second": 2}), "_OpaqueFunction__args", [1]),
        (OpaqueFunction(function=_noted, args=[1], kwargs={"second": 2}), "_OpaqueFunction__kwargs", {"second": 2}),
        (GroupAction([], scoped=False), "_GroupAction__actions", []),
        (GroupAction([], scoped=False), "_GroupAction__scoped", False),
        (GroupAction([], forwarding=False), "_GroupAction__forwarding", False),
        (TimerAction(period=2.0, actions=[]), "_TimerAction__period", 2.0),
        (TimerAction(period=2.0, actions=[]), "_TimerAction__actions", []),
    ],
)
def test_actions_show_their_parts(action: Any, name: str, expected: Any) -> None:
    assert getattr(action, name) == expected


def test_an_included_description_shows_its_file_and_arguments() -> None:
    source: Any = PythonLaunchDescriptionSource("a.launch.py")
    action: Any = IncludeLaunchDescription(source, launch_arguments={"sim": "true"}.items())
    assert dict(action._IncludeLaunchDescription__launch_arguments) == {"sim": "true"}
    assert action._IncludeLaunchDescription__launch_description_source is source
    assert text(source._LaunchDescriptionSource__location) == "a.launch.py"


def test_events_and_handlers_are_shown() -> None:
    handler, event = OnShutdown(on_shutdown=[]), ShutdownEvent(reason="over")
    registered: Any = RegisterEventHandler(handler)
    emitted: Any = EmitEvent(event=event)
    assert registered._RegisterEventHandler__event_handler is handler
    assert emitted._EmitEvent__event is event


def test_components_are_shown() -> None:
    part = ComposableNode(package="p", plugin="p::C")
    container: Any = ComposableNodeContainer(
        name="c", namespace="", package="rclcpp_components", executable="c", composable_node_descriptions=[part]
    )
    load: Any = LoadComposableNodes(target_container=container, composable_node_descriptions=[part])
    assert container._ComposableNodeContainer__composable_node_descriptions == [part]
    assert load._LoadComposableNodes__composable_node_descriptions == [part]
    assert load._LoadComposableNodes__target_container is container


def test_a_parameter_for_all_nodes_is_shown() -> None:
    action: Any = SetParameter("use_sim_time", True)
    assert [(text(name), value) for name, value in action._SetParameter__param_dict.items()] == [("use_sim_time", True)]


def test_a_class_of_a_program_inherits_them() -> None:
    class Own(Node):
        pass

    action: Any = Own(executable="e")
    assert action._Node__node_executable == "e"
    assert not hasattr(action, "_Own__node_executable")


def test_a_description_is_walked_by_them() -> None:
    description = LaunchDescription([node(parameters=[{"a": 1}]), GroupAction([node(parameters=[{"a": 2}])])])
    first, group = description.entities
    found: list[Any] = [first, *group._GroupAction__actions]  # type: ignore[attr-defined]
    assert [evaluate_parameters(CONTEXT, each._Node__parameters) for each in found] == [({"a": 1},), ({"a": 2},)]
