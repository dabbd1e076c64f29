"""launch_ros as a library: parameters, names and remappings of nodes, without a launch."""

from __future__ import annotations

from pathlib import Path
from typing import Any, List  # noqa: UP035 - as programs for ROS 2 name list types

import pytest
import yaml

from robolink.launch.ros.launch import LaunchContext
from robolink.launch.ros.launch.conditions import IfCondition
from robolink.launch.ros.launch.substitutions import SubstitutionFailure, TextSubstitution
from robolink.launch.ros.launch_ros.actions import Node, PushROSNamespace, SetParameter, SetRemap, SetROSLogDir
from robolink.launch.ros.launch_ros.components import get_composable_node_load_request
from robolink.launch.ros.launch_ros.descriptions import ComposableNode, Parameter, ParameterFile, ParameterValue
from robolink.launch.ros.launch_ros.substitutions import Parameter as ParameterSubstitution
from robolink.launch.ros.launch_ros.utilities import (
    add_node_name,
    evaluate_parameters,
    get_node_name_count,
    make_namespace_absolute,
    normalize_parameters,
    normalize_remap_rule,
    prefix_namespace,
    to_parameters_list,
)
from tests.support.ros_launch import read


def text(value: str) -> TextSubstitution:
    """A substitution by this text."""
    return TextSubstitution(text=value)


def evaluated(value: Any) -> Any:
    """What a parameter with this value becomes."""
    ((found,),) = (each.values() for each in evaluate_parameters(LaunchContext(), normalize_parameters([{"p": value}])))
    return found


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("1", "1"),
        (text("1"), 1),
        (text("1e5"), "1e5"),
        (text(""), ""),
        (b"ab", b"ab"),
        ([1, 2.5], (1.0, 2.5)),
        (["1", "x: y"], ("1", "x: y")),
        ([text("a"), "b"], "ab"),
        ([[text("1")], [text("2")]], (1, 2)),
        ([True, [text("on")]], (True, True)),
        (text("[a, b]"), ("a", "b")),
        (ParameterValue(text("[1, 2]"), value_type=str), "[1, 2]"),
        (ParameterValue(text("[1, 2]"), value_type=List[int]), [1, 2]),  # noqa: UP006
    ],
)
def test_values_are_evaluated_as_in_ros(value: Any, expected: Any) -> None:
    found = evaluated(value)
    assert (found, type(found)) == (expected, type(expected))


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ([1, "a"], "Expected a non-empty sequence of bool, int, float or str, all of one type, got [1, 'a']"),
        (text("[1, 2.0]"), "got [1, 2.0]: write 1.0 for 1"),
        (text("{a: 1}"), "Allowed value types are bool, int, float, str and lists of one of them, got dict"),
        (text("a: b: c"), "Unable to parse 'a: b: c' as YAML: mapping values are not allowed here; ParameterValue("),
        ([], "an empty list has no type"),
        ({1}, "a parameter is a plain value, a list or substitutions, got set"),
    ],
)
def test_other_values_are_refused_with_the_parameters_name(value: Any, words: str) -> None:
    with pytest.raises(TypeError) as caught:
        evaluated({"inner": value})
    assert str(caught.value).startswith("parameter 'p.inner': ")
    assert words in str(caught.value)


def test_nested_names_are_joined_and_files_are_paths() -> None:
    normal = normalize_parameters([{"a": {(text("b"), "c"): 1}}, "/x.yaml", Parameter("n", text("2"))])
    mapping, path, parameter = evaluate_parameters(LaunchContext(), normal)
    assert (mapping, path) == ({"a.bc": 1}, Path("/x.yaml"))
    assert parameter.evaluate(LaunchContext()) == ("n", 2)
    with pytest.raises(TypeError, match="parameters are a list"):
        normalize_parameters({"a": 1})  # type: ignore[arg-type]


def test_a_parameter_has_its_last_value() -> None:
    parameter = Parameter("n", text("[1, 2]"))
    assert [each.text for each in parameter.value] == ["[1, 2]"]
    assert parameter.evaluate(LaunchContext()) == (parameter.name, parameter.value) == ("n", [1, 2])
    with pytest.raises(TypeError):
        Parameter("n", "1", value_type=int)
    with pytest.raises(ValueError, match="expected a value of YAML"):
        Parameter("n", text("[1, a]")).evaluate(LaunchContext())


def test_a_file_with_substitutions_is_copied_until_cleanup(tmp_path: Path) -> None:
    context = LaunchContext()
    context.launch_configurations["word"] = "hi"
    (tmp_path / "a.yaml").write_text("/**: {ros__parameters: {word: $(var word)}}")
    file = ParameterFile(str(tmp_path / "a.yaml"), allow_substs=True)
    written = file.evaluate(context)
    assert yaml.safe_load(written.read_text()) == {"/**": {"ros__parameters": {"word": "hi"}}}
    assert file.param_file == written
    file.cleanup()
    assert not written.exists()
    assert isinstance(file.param_file, list)
    assert ParameterFile(tmp_path / "a.yaml").evaluate(context) == tmp_path / "a.yaml"


def test_sections_of_files_become_parameters_of_their_node(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text(
        "/**: {ros__parameters: {x: 1, z: 0}}\n/ns: {node: {ros__parameters: {x: 2, list: [1.5]}}}\n"
    )
    (tmp_path / "flat.yaml").write_text("y: {deep: true}\n")
    given = [tmp_path / "a.yaml", tmp_path / "flat.yaml", {"t": ("a", "b")}]
    found = to_parameters_list(LaunchContext(), "node", "/ns", given)
    shown = [(each.name, each.type_.name, each.value) for each in found]
    assert [each[:2] for each in shown] == [
        ("x", "INTEGER"), ("z", "INTEGER"), ("list", "DOUBLE_ARRAY"), ("y.deep", "BOOL"), ("t", "STRING_ARRAY"),
    ]  # fmt: skip
    assert (shown[0][2], shown[4][2]) == (2, ["a", "b"])
    with pytest.warns(UserWarning, match="node name not provided"):
        assert len(to_parameters_list(LaunchContext(), "", None, given[:1])) == 2


@pytest.mark.parametrize(
    ("around", "own", "whole"),
    [
        (None, None, None),
        (None, "", "/"),
        ("/a", None, "/a"),
        ("a", "b/", "/a/b"),
        ("/", "b", "/b"),
        ("/a", "/b", "/b"),
        ("/a", "/", "/"),
    ],
)
def test_namespaces_are_joined(around: str | None, own: str | None, whole: str | None) -> None:
    assert make_namespace_absolute(prefix_namespace(around, own)) == whole


def test_remappings_are_pairs() -> None:
    match, replacement = normalize_remap_rule((("a", "b"), text("c")))
    assert ([each.perform(LaunchContext()) for each in match], len(replacement)) == (["a", "b"], 1)
    for wrong in (["a", "b"], ("a",), "ab"):
        with pytest.raises(TypeError, match="a remapping is a pair"):
            normalize_remap_rule(wrong)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a remapping is a pair"):
        Node(package="p", executable="e", remappings=[{"a": "b"}])  # type: ignore[list-item]


@pytest.mark.parametrize(
    ("pushed", "name", "namespace", "full", "is_full"),
    [
        (None, None, None, "<node_namespace_unspecified>/<node_name_unspecified>", False),
        (None, "n", None, "<node_namespace_unspecified>/n", False),
        ("a", None, "b", "/a/b/<node_name_unspecified>", False),
        ("a", "n", None, "/a/n", True),
        (None, "n", "", "/n", True),
    ],
)
def test_a_nodes_name_is_known_as_far_as_it_is_given(
    pushed: str | None, name: str | None, namespace: str | None, full: str, is_full: bool
) -> None:
    context = LaunchContext()
    node = Node(package="p", executable="e", name=name, namespace=namespace)
    with pytest.raises(RuntimeError, match="known once it is executed"):
        assert node.node_name
    if pushed is not None:
        PushROSNamespace(pushed).execute(context)
    node.execute(context)
    assert (node.node_name, node.is_node_name_fully_specified()) == (full, is_full)
    assert get_node_name_count(context, full) == is_full


def test_the_command_line_has_what_ros_hands_over() -> None:
    context = LaunchContext()
    SetRemap("x", "y").execute(context)
    SetParameter("set", "2").execute(context)
    node = Node(
        package="p",
        executable="e",
        name="n",
        namespace="ns",
        parameters=[{"k": [1, 2]}, Parameter("q", text("3"))],
        remappings=[("a", ["b", text("c")])],
        arguments=["--fast", text("4")],
        ros_arguments=["--log-level", "info"],
    )
    node._perform_substitutions(context)
    words = [
        "".join(part.perform(context) for part in word) for word in node.cmd if isinstance(word[0], TextSubstitution)
    ]
    file = words.pop(words.index("--params-file") + 1)
    assert words == [
        *("--fast", "4", "--ros-args", "--log-level", "info", "--ros-args", "-r", "-r", "-p", "set:=2"),
        *("--params-file", "-p", "q:=3", "-r", "x:=y", "-r", "a:=bc"),
    ]
    assert yaml.safe_load(Path(file).read_text()) == {"/ns/n": {"ros__parameters": {"k": [1, 2]}}}
    assert node.expanded_remapping_rules == [("x", "y"), ("a", "bc")]


def test_what_is_set_for_nodes_is_in_the_context() -> None:
    context = LaunchContext()
    context.environment["ROS_LOG_DIR"] = "/logs"
    SetParameter("n", [text("1"), "0"]).execute(context)
    SetParameter("n", "7").execute(context)
    SetROSLogDir("mine").execute(context)
    assert context.launch_configurations["global_params"] == [("n", 10), ("n", "7")]
    assert ParameterSubstitution("n").perform(context) == "10"
    assert context.environment["ROS_LOG_DIR"] == str(Path("/logs/mine"))
    with pytest.raises(SubstitutionFailure, match=r"namespace 'x y'"):
        PushROSNamespace("x y").execute(context)


def test_a_component_becomes_a_request() -> None:
    context = LaunchContext()
    PushROSNamespace("q").execute(context)
    SetRemap("x", "y").execute(context)
    SetParameter("set", "2").execute(context)
    described = ComposableNode(
        package=["a", "b"],
        plugin="c::D",
        name=text("n"),
        namespace="b",
        parameters=[{"gain": 1.5}],
        remappings=[("f", "g")],
        extra_arguments=[{"use_intra_process_comms": True}],
    )
    request = get_composable_node_load_request(described, context)
    assert request is not None
    assert (request.package_name, request.plugin_name, request.node_name) == ("ab", "c::D", "n")
    assert (request.node_namespace, request.remap_rules) == ("/q/b", ["x:=y", "f:=g"])
    assert [each.name for each in request.parameters] == ["set", "gain"]
    assert [each.value.bool_value for each in request.extra_arguments] == [True]
    off = ComposableNode(package="a", plugin="b", condition=IfCondition("false"))
    assert get_composable_node_load_request(off, context) is None


def test_names_that_several_nodes_have_are_counted_and_told(package: Path) -> None:
    context = LaunchContext()
    assert get_node_name_count(context, "/a") == 0
    add_node_name(context, "/a")
    assert get_node_name_count(context, "/a") == 1
    node = 'Node(package="bot", executable="talker", name="one", namespace="ns"),\n'
    line = "there are now at least 2 nodes with the name /ns/one created within this launch context"
    assert read(package, node * 2).notes == [line]
    assert read(package, node.replace(', namespace="ns"', "") * 2).notes == []
