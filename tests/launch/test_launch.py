"""What a launch file says becomes processes: commands, environments, rules, and who shares one."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.arguments.command_line import parse_arguments
from robolink.arguments.remapping import RemapKind, resolve_name
from robolink.documents.yamlfile import DocumentNotFoundError, spell
from robolink.exceptions import DocumentError
from robolink.impl.logging_severity import LoggingSeverity
from robolink.launch import plan, shared_process
from robolink.launch.entry import Entry
from robolink.launch.planning import core_errors, processes
from robolink.launch.reading.entries import read_launch_file
from robolink.supervisor import Process
from robolink.supervisor.policy import Restarts, Rules
from robolink.system.processes import own_command
from robolink.workspace import VARIABLE, built_in_workspace
from tests.support.launchfiles import NODES, make_workspace


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return make_workspace(tmp_path, monkeypatch)


def planned(home: Path, text: str, **given: str) -> list[Process]:
    return plan(home / "configs" / "lap.yaml", given, text=text)


def words(process: Process) -> list[str]:
    """What stands behind the words that start a robolink."""
    return list(process.argv[len(own_command()) :])


def test_a_node_is_run_with_all_that_is_said_of_it(home: Path) -> None:
    first, second, third = planned(
        home,
        """
arguments: {speed: 0.5}
nodes:
- node: world
  parameters: {world: corners}
- node: mine:main
  name: left
  namespace: robot1
  parameters: {gains: {p: 1.0, i: 2}, on: yes, names: [a, b], speed: "{speed}"}
  remappings: {scan: lidar/scan}
  args: [--fast, 3]
  env: {LEVEL: 3, WORD: on}
  log_level: debug
- node: nodes/mine.py
  interactive: true
  cpu: [0, 1]
""",
        speed="1.5",
    )
    assert [first.name, second.name, third.name] == ["world", "robot1/left", "mine"]
    assert [first.interactive, second.interactive, third.interactive] == [False, False, True]
    assert [first.cpu, third.cpu] == [(), (0, 1)]
    assert first.argv == [
        *(*own_command(), "run", str(built_in_workspace() / "nodes/world.py"), "--", "--ros-args"),
        *("-p", 'world:="corners"'),
    ]
    assert words(second)[1:6] == [f"{home}/nodes/mine.py:main", "--", "--fast", "3", "--ros-args"]
    assert first.env == {VARIABLE: str(home)}
    assert second.env == {VARIABLE: str(home), "LEVEL": "3", "WORD": "on"}
    arguments = parse_arguments(list(second.argv))
    assert arguments.node_name("mine") == "left"
    assert arguments.namespace("/", "left") == "/robot1"
    scan = resolve_name(arguments.remap_rules, RemapKind.TOPIC, "/robot1/scan", "left", "/robot1")
    assert scan == "/robot1/lidar/scan"
    assert arguments.log_levels == (("", LoggingSeverity.DEBUG),)
    assert arguments.overrides_for("/robot1/left") == {
        "gains.p": 1.0,
        "gains.i": 2,
        "on": "yes",
        "names": ["a", "b"],
        "speed": 1.5,
    }


def test_copies_are_numbered_in_all_that_is_said_of_them(home: Path) -> None:
    found = planned(
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
  args: ["{{i}}", "{linear: {x: 1}}"]
""",
    )
    assert [each.name for each in found] == ["r0/n0", "r1/n1", "r2/n2", "mine"]
    assert words(found[3])[2:] == ["--", "{i}", "{linear: {x: 1}}"]
    second = found[1]
    assert words(second)[2:6] == ["--", "1", "--name=a1", "2.5"]
    arguments = parse_arguments(list(second.argv))
    assert arguments.node_name("mine") == "n1"
    assert arguments.namespace("/", "n1") == "/r1"
    assert resolve_name(arguments.remap_rules, RemapKind.TOPIC, "/r1/scan", "n1", "/r1") == "/lidar_1"
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


def test_a_command_is_run_as_it_is(home: Path) -> None:
    [process] = planned(
        home, f"nodes: [{{run: ['{sys.executable}', -c, 1.10], args: [012], name: py, namespace: r, env: {{A: b}}}}]"
    )
    assert process == Process(
        "r/py", [sys.executable, "-c", "1.10", "012"], env={VARIABLE: str(home), "A": "b"}, rules=Rules(), cpu=()
    )


def test_what_becomes_of_a_process_is_ruled(home: Path) -> None:
    plain, patient, exact = planned(
        home,
        """
nodes:
- node: world
- {node: mine, respawn: always, on_exit: ignore}
- node: mine
  name: exact
  respawn: {when: on_failure, delay: 0.5, delay_max: 4, most: 2, within: 9}
  start_after: world
""",
    )
    assert plain.rules == Rules(Restarts("never"), "shutdown", held=False)
    assert patient.rules == Rules(Restarts("always", 1.0, 30.0, 5, 60.0), "ignore", held=False)
    assert exact.rules == Rules(Restarts("on_failure", 0.5, 4.0, 2, 9.0), "shutdown", True, frozenset({"world"}))


def test_nodes_that_name_a_process_share_it(home: Path) -> None:
    world, shared, other, single = planned(
        home,
        """
nodes:
- node: world
- {node: mine, count: 2, namespace: "r{i}", process: both, args: [a], env: {A: 1}, cpu: 0, log_level: warn}
- {node: mine, process: "other{i}", count: 1, respawn: always}
- node: mine:Mine
  name: last
  process: both
  parameters: {x: 1}
  remappings: {a: b}
  env: {A: 1}
  cpu: [0]
- {node: mine, name: world2}
""",
    )
    assert [each.name for each in (world, shared, other, single)] == ["world", "both", "other0", "world2"]
    assert shared.argv == [*own_command(), "run-together"]
    assert (shared.env, shared.cpu) == ({VARIABLE: str(home), "A": "1"}, (0,))
    file, level = str(home / "nodes" / "mine.py"), ["--log-level", "warn"]
    assert shared_process.read(shared.input) == [
        shared_process.Member("r0/mine", file, ["a", "--ros-args", "-r", "__ns:=/r0", *level]),
        shared_process.Member("r1/mine", file, ["a", "--ros-args", "-r", "__ns:=/r1", *level]),
        shared_process.Member("last", f"{file}:Mine", ["--ros-args", "-r", "__node:=last", "-p", "x:=1", "-r", "a:=b"]),
    ]
    assert shared_process.read(other.input) == [shared_process.Member("mine", file, [])]
    assert other.rules.respawn.when == "always"
    assert world.input == single.input == b""


def test_a_process_is_of_the_namespace_of_what_is_around(home: Path) -> None:
    (home / "configs" / "robot.yaml").write_text(
        "nodes: [{node: mine, process: control, count: 2, namespace: 'n{i}'}]\n"
        "groups: [{process: '/all', nodes: [{node: mine, name: x}]}]\n"
    )
    found = planned(
        home,
        """
include: [{file: robot, namespace: r1}, {file: robot, namespace: r2}]
groups:
- {namespace: "g{i}", count: 2, process: control, nodes: [node: mine], groups: [{namespace: in, nodes: [node: mine]}]}
- {namespace: r1, nodes: [{node: mine, process: arm/control}, {node: mine, name: b, process: /r1/control}]}
""",
    )
    members = {each.name: [member.name for member in shared_process.read(each.input)] for each in found}
    assert members == {
        "r1/control": ["r1/n0/mine", "r1/n1/mine", "r1/b"],
        "all": ["r1/x", "r2/x"],
        "r2/control": ["r2/n0/mine", "r2/n1/mine"],
        "g0/control": ["g0/mine", "g0/in/mine"],
        "g1/control": ["g1/mine", "g1/in/mine"],
        "r1/arm/control": ["r1/mine"],
    }


scalars: list[Any] = [
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(allow_nan=False),
    st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0{}")),
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
    assert words(process)[1] == str(home / "nodes" / "mine.py")
    [process] = plan(built_in_workspace() / "configs" / "any.yaml", text="nodes: [node: world]")
    assert words(process)[1] == str(elsewhere / "nodes" / "world.py")
    assert process.env == {VARIABLE: str(elsewhere)}


def test_a_launch_file_alone_finds_its_neighbours(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text("")
    (tmp_path / "sub").mkdir()
    monkeypatch.chdir(tmp_path / "sub")
    [process] = plan(tmp_path / "lap.yaml", text="nodes: [node: mine.py]")
    assert words(process)[1] == str((tmp_path / "mine.py").resolve())
    assert process.env == {}


def test_a_missing_launch_file_is_one_line(home: Path) -> None:
    with pytest.raises(DocumentNotFoundError, match=r"no file '.*lap.yaml'"):
        plan(home / "configs" / "lap.yaml")


INSTEAD = "which needs a process of its own: name its class,"
CIRCLE = """nodes:
- {node: mine, name: a, start_after: b}
- {node: mine, name: b, start_after: [world, c]}
- {node: world}
- {node: mine, name: c, process: p, start_after: a}
"""
BAD = [
    (
        "nodes:\n- {node: mine, process: world}\n- {node: world}",
        "2:25: nodes[0].process: 'world' is what a node is called that has its own process: give another name",
    ),
    ("nodes:\n- {node: mine, process: p/}", "2:25: nodes[0].process: '' "),
    ("nodes:\n- {node: mine, process: a-b/p}", "2:25: nodes[0].process: '/a-b' "),
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
    ("nodes:\n- {node: broken, process: p}", "2:10: nodes[0].node: {home}/nodes/broken.py:1:"),
    (
        "nodes:\n- {node: mine, process: p, cpu: 1}\n- {node: mine, name: b, process: p, cpu: 2}",
        "3:42: nodes[1].cpu: 'mine' runs in the same process, and has another `cpu`: a process has only one",
    ),
    (
        "nodes:\n- {node: mine, process: p, respawn: always}\n- {node: mine, name: b, process: p}",
        "3:3: nodes[1].respawn: 'mine' runs in the same process, and has another `respawn`",
    ),
    (
        "nodes:\n- {node: mine, process: p}\n- {node: mine, name: b, process: p, on_exit: ignore}",
        "3:46: nodes[1].on_exit: 'mine' runs in the same process, and has another `on_exit`",
    ),
    (
        "nodes:\n- {node: mine, process: p, env: {A: 1}}\n- {node: mine, name: b, process: p, env: {A: 2}}",
        "3:42: nodes[1].env: 'mine' runs in the same process, and has another `env`",
    ),
    (
        "nodes:\n- {node: mine, start_after: mine}",
        "2:29: nodes[0].start_after: it would wait for itself, or for a node of its own process",
    ),
    (
        "nodes:\n- {node: mine, process: p}\n- {node: mine, name: b, process: p, start_after: mine}",
        "3:50: nodes[1].start_after: it would wait for itself, or for a node of its own process",
    ),
    (
        CIRCLE,
        "2:38: nodes[0].start_after: nothing of it would ever start: a waits for b waits for p waits for a",
    ),
]


@pytest.mark.parametrize(("text", "report"), BAD)
def test_what_is_wrong_is_one_line_with_its_place(home: Path, text: str, report: str) -> None:
    with pytest.raises(DocumentError) as caught:
        planned(home, text)
    assert str(caught.value).startswith(f"{home}/configs/lap.yaml:" + report.format(home=home))
    assert "\n" not in str(caught.value)


def test_a_core_that_is_not_there_is_wrong(home: Path) -> None:
    entries = read_launch_file(home / "lap.yaml", text="nodes:\n- {node: world}\n- {node: mine, cpu: [0, 4095]}")
    [error] = core_errors(entries)
    assert str(error).startswith(f"{home}/lap.yaml:3:21: nodes[1].cpu: core 4095 is not there")


def test_nodes_of_two_workspaces_share_no_process(home: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    other = tmp_path_factory.mktemp("other")
    for folder in ("nodes", "configs"):
        (other / folder).mkdir()
    (other / "nodes" / "its.py").write_text(NODES["mine"])
    (other / "configs" / "its.yaml").write_text("nodes: [{node: its, process: p}]")
    with pytest.raises(DocumentError, match=r"its.yaml:1:16: .*'mine' runs in the same process, and is of another"):
        planned(home, f"nodes: [{{node: mine, process: p}}]\ninclude: [file: '{other}/configs/its.yaml']")


@pytest.mark.slow
def test_a_large_system_is_planned_without_comparing_each_node_with_all_others(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "nodes: [{node: world}, {node: mine, name: 'n{i}', count: 200, start_after: world}]"
    entries = read_launch_file(home / "configs" / "lap.yaml", {}, text=text)
    asked: list[str] = []

    def full_name(entry: Entry) -> str:
        asked.append(entry.name)
        return f"/{entry.name}"

    monkeypatch.setattr(Entry, "full_name", property(full_name))
    assert [each.rules.awaits for each in processes(entries)[1:]] == [frozenset({"world"})] * 200
    assert len(asked) < 10 * len(entries)


def test_arguments_for_which_no_command_line_has_room_come_as_input(home: Path) -> None:
    text = "<robot/>" * 40_000
    long, keyboard, short = planned(
        home,
        f"""
nodes:
- {{node: "mine:main", parameters: {{description: {text}}}}}
- {{node: mine, name: keyboard, interactive: true, parameters: {{description: {text}}}}}
- {{node: mine, name: short}}
""",
    )
    assert long.argv == [*own_command(), "run-together"]
    [member] = shared_process.read(long.input)
    assert member.args == ["--ros-args", "-p", f"description:={spell(text)}"]
    assert keyboard.input == short.input == b"", "it reads the keyboard"
    assert words(short)[0] == "run"
