"""A launch file becomes processes; whatever is wrong in it is one line with its place, before anything starts."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.arguments import parse_arguments
from robolink.exceptions import DocumentError
from robolink.launch import plan, read_launch_file
from robolink.supervisor import Process
from robolink.workspace import VARIABLE, built_in_workspace
from robolink.yamlfile import DocumentNotFoundError, spell


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "nodes").mkdir()
    (tmp_path / "configs").mkdir()
    (tmp_path / "nodes" / "mine.py").write_text("from robolink import Node\nclass Mine(Node): pass\n")
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path.resolve()


def planned(home: Path, text: str) -> list[Process]:
    return plan(home / "configs" / "lap.yaml", text=text)


def test_each_node_becomes_a_process(home: Path) -> None:
    first, second, third = planned(
        home,
        """
nodes:
- node: world
  parameters: {world: corners}
- node: mine:main
  name: left
  namespace: robot1
  parameters: {gains: {p: 1.0, i: 2}, on: yes, names: [a, b]}
  remappings: {scan: lidar/scan}
  args: [--fast, 3]
- node: nodes/mine.py
  interactive: true
""",
    )
    assert [first.name, second.name, third.name] == ["world", "robot1/left", "mine"]
    assert [first.interactive, second.interactive, third.interactive] == [False, False, True]
    assert first.argv == [
        *(sys.executable, "-m", "robolink", "run", str(built_in_workspace() / "nodes/world.py"), "--", "--ros-args"),
        *("-p", 'world:="corners"'),
    ]
    assert second.argv[4:9] == [f"{home}/nodes/mine.py:main", "--", "--fast", "3", "--ros-args"]
    assert first.env == second.env == {VARIABLE: str(home)}
    arguments = parse_arguments(list(second.argv))
    assert arguments.node_name("mine") == "left"
    assert arguments.namespace("/", "left") == "/robot1"
    assert arguments.remap_topic("/robot1/scan", "left", "/robot1") == "/robot1/lidar/scan"
    assert arguments.overrides_for("/robot1/left") == {
        "gains.p": 1.0,
        "gains.i": 2,
        "on": "yes",
        "names": ["a", "b"],
    }


scalars: list[Any] = [
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(allow_nan=False),
    st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0")),
]


@given(st.one_of(*scalars, *map(st.lists, scalars)))
def test_every_parameter_arrives_as_it_is(value: Any) -> None:
    text = f"nodes: [{{node: world, parameters: {{x: {spell(value)}}}}}]"
    [process] = plan(built_in_workspace() / "configs" / "lap.yaml", text=text)
    arrived = parse_arguments(list(process.argv)).overrides_for("/world")["x"]
    assert repr(arrived) == repr(value)


def test_nan_arrives_too(home: Path) -> None:
    [process] = planned(home, "nodes: [{node: world, parameters: {x: .nan}}]")
    arrived = parse_arguments(list(process.argv)).overrides_for("/world")["x"]
    assert isinstance(arrived, float)
    assert math.isnan(arrived)


def test_the_launch_files_own_workspace_comes_first(
    home: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    for folder in ("nodes", "configs"):
        (elsewhere / folder).mkdir()
    (elsewhere / "nodes" / "mine.py").write_text("")
    (elsewhere / "nodes" / "world.py").write_text("")
    monkeypatch.chdir(elsewhere)
    [process] = planned(home, "nodes: [node: mine]")
    assert process.argv[4] == str(home / "nodes" / "mine.py")
    [process] = plan(built_in_workspace() / "configs" / "any.yaml", text="nodes: [node: world]")
    assert process.argv[4] == str(elsewhere / "nodes" / "world.py")
    assert process.env == {VARIABLE: str(elsewhere)}


def test_a_launch_file_alone_finds_its_neighbours(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text("")
    (tmp_path / "sub").mkdir()
    monkeypatch.chdir(tmp_path / "sub")
    [process] = plan(tmp_path / "lap.yaml", text="nodes: [node: mine.py]")
    assert process.argv[4] == str((tmp_path / "mine.py").resolve())
    assert process.env == {}


BAD = [
    ("", "1:1: expected mapping, got nothing"),
    ("nodes:", "1:7: nodes: expected list, got nothing"),
    ("nodes: []", "1:8: nodes: there is no node to start"),
    ("nods: []", "1:1: nods: unknown key 'nods' (did you mean 'nodes'?)"),
    ("nodes:\n- {}", "2:3: nodes[0]: missing key 'node'"),
    ("nodes:\n- world", "2:3: nodes[0]: expected mapping, got 'world'"),
    ("nodes:\n- nod: world", "2:3: nodes[0].nod: unknown key 'nod' (did you mean 'node'?)"),
    (
        "nodes:\n- node: wrl",
        "2:9: nodes[0].node: no node named 'wrl' in {home} or robolink itself (did",
    ),
    (
        "nodes:\n- node: nodes/min.py",
        "2:9: nodes[0].node: no file named 'nodes/min.py' (did you mean",
    ),
    ("nodes:\n- node: [a]", "2:9: nodes[0].node: expected str, got list"),
    (
        "nodes:\n- node: mine\n- node: mine",
        "3:9: nodes[1].node: two nodes are called 'mine': give",
    ),
    (
        "nodes:\n- {node: mine, name: a}\n- {node: world, name: a}",
        "3:23: nodes[1].name: two nodes are called 'a': give",
    ),
    (
        "nodes:\n- {node: mine, namespace: a}\n- {node: mine, namespace: /a}",
        "3:10: nodes[1].node: two nodes are called 'a/mine': give",
    ),
    (
        "nodes:\n- {node: mine, name: a/b}",
        "2:22: nodes[0].name: 'a/b' must not contain characters other than letters, digits and '_'",
    ),
    (
        "nodes:\n- {node: mine, namespace: /1}",
        "2:27: nodes[0].namespace: '/1' must not start with",
    ),
    ("nodes:\n- {node: mine, parameters: [a]}", "2:28: nodes[0].parameters: expected mapping, got list"),
    (
        "nodes:\n- {node: mine, parameters: {a: }}",
        "2:31: nodes[0].parameters.a: a parameter cannot be null",
    ),
    (
        "nodes:\n- {node: mine, parameters: {a: [1, x]}}",
        "2:32: nodes[0].parameters.a: a list holds one type",
    ),
    ("nodes:\n- {node: mine, parameters: {a: {b: [[1]]}}}", "2:36: nodes[0].parameters.a.b: a list cannot hold a list"),
    ("nodes:\n- {node: mine, parameters: {a: [{}]}}", "2:32: nodes[0].parameters.a: a list cannot hold a mapping"),
    (
        "nodes:\n- {node: mine, parameters: {a: 99999999999999999999}}",
        "2:32: nodes[0].parameters.a: 99999999999999999999 is",
    ),
    ("nodes:\n- {node: mine, parameters: {a b: 1}}", "2:29: nodes[0].parameters.a b: 'a b' is no name for a parameter"),
    ("nodes:\n- {node: mine, remappings: {a: 1}}", "2:32: nodes[0].remappings.a: expected str, got '1'"),
    (
        "nodes:\n- {node: mine, remappings: {'a b': c}}",
        "2:29: nodes[0].remappings.a b: topic name 'a b' must not contain characters",
    ),
    ("nodes:\n- {node: mine, args: {a: 1}}", "2:22: nodes[0].args: expected list, got mapping"),
    ("nodes:\n- {node: mine, args: [[a]]}", "2:23: nodes[0].args[0]: expected "),
    ("nodes:\n- {node: mine, interactive: on}", "2:29: nodes[0].interactive: expected bool, got 'on'"),
    (
        "nodes:\n- {node: mine, interactive: true}\n- {node: world, interactive: true}",
        "3:30: nodes[1].interactive: there is one keyboard, and another node has it",
    ),
    ("nodes: *a", "1:8: found undefined alias 'a'"),
    ("nodes:\n\t- node: a", "2:1: a tab where only spaces may stand"),
]


@pytest.mark.parametrize(("text", "report"), BAD)
def test_what_is_wrong_is_one_line_with_its_place(home: Path, text: str, report: str) -> None:
    with pytest.raises(DocumentError) as caught:
        planned(home, text)
    assert str(caught.value).startswith(f"{home}/configs/lap.yaml:" + report.format(home=home))
    assert "\n" not in str(caught.value)


def test_a_missing_launch_file_is_one_line(home: Path) -> None:
    with pytest.raises(DocumentNotFoundError, match=r"no file '.*lap.yaml'"):
        plan(home / "configs" / "lap.yaml")


@given(
    st.recursive(
        st.none() | st.integers() | st.text(),
        lambda inside: (
            st.lists(inside)
            | st.dictionaries(
                st.sampled_from(["nodes", "node", "name", "parameters", "remappings", "args"]) | st.text(), inside
            )
        ),
    )
)
def test_any_data_is_read_or_refused_in_one_line(data: Any) -> None:
    try:
        document = read_launch_file("lap.yaml", text=spell(data))
    except DocumentError as error:
        report = str(error)
    else:
        report = f"lap.yaml: {len(document.value.nodes)} nodes"
    assert report.startswith("lap.yaml:")
    assert "\n" not in report
