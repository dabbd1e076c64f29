"""A launch file becomes processes; whatever is wrong in it is one line with its place, before anything starts."""

from __future__ import annotations

import contextlib
import math
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.arguments import parse_arguments
from robolink.exceptions import DocumentError
from robolink.launch import plan, read_launch_file, together
from robolink.launch.substitution import SubstitutionError, filled
from robolink.supervisor import Process
from robolink.workspace import VARIABLE, built_in_workspace
from robolink.yamlfile import DocumentNotFoundError, spell

FILES = {
    "mine": "from robolink import Node\nclass Mine(Node): pass\n",
    "script": "import rclpy\nrclpy.init()\n",
    "program": "class Other: pass\nclass One(Node): pass\nclass Two(Node): pass\ndef start(): pass\ndef main(): pass\n",
    "broken": "class",
}


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "nodes").mkdir()
    (tmp_path / "configs").mkdir()
    for name, text in FILES.items():
        (tmp_path / "nodes" / f"{name}.py").write_text(text)
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


def test_copies_are_numbered_in_all_that_is_said_of_them(home: Path) -> None:
    processes = planned(
        home,
        """
nodes:
- node: mine
  count: 3
  name: n{i}
  namespace: /r{i}
  parameters: {id: "{i}", label: "no {i} of {{i}}", deep: {ids: ["{i}", 7], "j{i}": 1.5}, on: true}
  remappings: {"/r{i}/scan": "/lidar_{i}"}
  args: ["{i}", "--name=a{i}", 2.5]
- node: mine
  args: ["{i}"]
""",
    )
    assert [each.name for each in processes] == ["r0/n0", "r1/n1", "r2/n2", "mine"]
    assert processes[3].argv[5:] == ["--", "{i}", "--ros-args"]
    second = processes[1]
    assert second.argv[5:9] == ["--", "1", "--name=a1", "2.5"]
    arguments = parse_arguments(list(second.argv))
    assert arguments.node_name("mine") == "n1"
    assert arguments.namespace("/", "n1") == "/r1"
    assert arguments.remap_topic("/r1/scan", "n1", "/r1") == "/lidar_1"
    assert arguments.overrides_for("/r1/n1") == {
        "id": 1,
        "label": "no 1 of {i}",
        "deep.ids": [1, 7],
        "deep.j1": 1.5,
        "on": True,
    }


def test_one_copy_is_a_copy_too(home: Path) -> None:
    [process] = planned(home, "nodes: [{node: mine, count: 1, name: 'a{i}', interactive: true}]")
    assert (process.name, process.interactive) == ("a0", True)


def test_nodes_that_name_a_process_share_it(home: Path) -> None:
    world, shared, other, single = planned(
        home,
        """
nodes:
- node: world
- {node: mine, count: 2, namespace: "r{i}", process: both, args: [a]}
- {node: mine, process: "other{i}", count: 1}
- {node: mine:Mine, name: last, process: both, parameters: {x: 1}, remappings: {a: b}}
- {node: mine, name: world2}
""",
    )
    assert [each.name for each in (world, shared, other, single)] == ["world", "both", "other0", "world2"]
    assert shared.argv == [sys.executable, "-m", "robolink", "run-together"]
    assert shared.env == {VARIABLE: str(home)}
    file = str(home / "nodes" / "mine.py")
    assert together.read(shared.input) == [
        together.Member("r0/mine", file, ["a", "--ros-args", "-r", "__ns:=/r0"]),
        together.Member("r1/mine", file, ["a", "--ros-args", "-r", "__ns:=/r1"]),
        together.Member("last", f"{file}:Mine", ["--ros-args", "-r", "__node:=last", "-p", "x:=1", "-r", "a:=b"]),
    ]
    assert together.read(other.input) == [together.Member("mine", file, ["--ros-args"])]
    assert world.input == single.input == b""


@given(st.text(st.characters(exclude_categories=["Cs"])))
def test_any_text_is_filled_or_refused(text: str) -> None:
    doubled = text.replace("{", "{{").replace("}", "}}")
    assert filled([doubled], {"i": 3}, []) == [text]
    assert filled({doubled: "{i}"}, {"i": 3}, []) == {text: 3}
    if not {*"{}"} & {*text}:
        assert filled(text, {"i": 3}, []) == text
    elif "{i}" not in text:
        with contextlib.suppress(SubstitutionError):
            assert filled(text, {"i": 3}, []) != text


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


INSTEAD = "which needs a process of its own: name its class,"
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
    ("nodes:\n- {node: mine, count: 0}", "2:23: nodes[0].count: expected int >= 1, got '0'"),
    ("nodes:\n- {node: mine, count: 10001}", "2:23: nodes[0].count: expected int <= 10000, got '10001'"),
    ("nodes:\n- {node: mine, count: two}", "2:23: nodes[0].count: expected int, got 'two'"),
    (
        "nodes:\n- {node: mine, count: 2}",
        "2:23: nodes[0].count: two of the copies are called 'mine': put {{i}} into `name` or `namespace`",
    ),
    (
        "nodes:\n- {node: mine, count: 12, name: 'a{i}', namespace: r}\n- {node: mine, name: a11, namespace: /r}",
        "3:22: nodes[1].name: two nodes are called 'r/a11': give",
    ),
    (
        "nodes:\n- {node: mine, count: 2, name: 'a{i}', args: [x, 'b{j}']}",
        "2:50: nodes[0].args[1]: nothing is called '{{j}}' here, only {{i}}; '{{{{' and '}}}}' are braces",
    ),
    (
        "nodes:\n- {node: mine, count: 2, name: 'a{i}', parameters: {b: {c: ['{']}}}",
        "2:61: nodes[0].parameters.b.c[0]: a lone '{{': write '{{{{' for one",
    ),
    (
        "nodes:\n- {node: mine, count: 2, name: 'a{i}', parameters: {'{i}': 1, '1': 2}}",
        "2:63: nodes[0].parameters.1: another key is '1', too",
    ),
    (
        "nodes:\n- {node: mine, count: 2, name: 'a{i}', remappings: {'{i}b': c}}",
        "2:53: nodes[0].remappings.{{i}}b: topic name '0b' must not start with",
    ),
    (
        "nodes:\n- {node: mine, count: 2, name: 'a{i}', parameters: {'x {i}': c}}",
        "2:53: nodes[0].parameters.x {{i}}: 'x 0' is no name for a parameter",
    ),
    (
        "nodes:\n- {node: mine, count: 2, name: '{i}'}",
        "2:32: nodes[0].name: '0' must not start with",
    ),
    (
        "nodes:\n- {node: mine, count: 2, name: 'a{i}', interactive: true}",
        "2:53: nodes[0].interactive: there is one keyboard, and another node has it",
    ),
    (
        "nodes:\n- {node: mine, process: a b}",
        "2:25: nodes[0].process: 'a b' must not contain characters other than",
    ),
    (
        "nodes:\n- {node: mine, process: p, interactive: true}",
        "2:41: nodes[0].interactive: a node with the keyboard cannot share a process: leave `process` out",
    ),
    (
        "nodes:\n- {node: mine, process: world}\n- {node: world}",
        "2:25: nodes[0].process: 'world' is what a node is called that has its own process: give another name",
    ),
    (
        "nodes:\n- {node: script, process: p}",
        "2:10: nodes[0].node: script.py is run by a script, which needs a process of its own: leave `process` out",
    ),
    (
        "nodes:\n- {node: program, process: p}",
        f"2:10: nodes[0].node: program.py is run by a main(), {INSTEAD} program.py:One or program.py:Two, or leave",
    ),
    (
        "nodes:\n- {node: 'program:start', process: p}",
        "2:10: nodes[0].node: program.py is run by a function (start), which needs a process of its own: name its",
    ),
    (
        "nodes:\n- {node: broken, process: p}",
        "2:10: nodes[0].node: {home}/nodes/broken.py:1:",
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
                st.sampled_from(["nodes", "node", "name", "parameters", "remappings", "args", "count", "process"])
                | st.text(),
                inside,
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
