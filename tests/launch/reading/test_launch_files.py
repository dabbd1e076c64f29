"""Files that a launch file names, found wherever it is launched: commands, nodes, parameter files and includes."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from robolink.exceptions import DocumentError, NotFoundError
from robolink.launch import read_launch_file
from robolink.launch.planning import plan
from robolink.system.processes import own_command
from robolink.workspace import VARIABLE, built_in_workspace, list_launches
from tests.support.launch_configs import entries


def test_a_command_is_found_before_anything_starts(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(home))
    text = "nodes: [{run: [robolink, topic, list]}, {run: [python, '{here}/x.py', 5], name: tool, namespace: a}]"
    found = entries(home, text)
    assert found["robolink"].node.run == [*own_command(), "topic", "list"]
    tool = found["a/tool"]
    assert tool.node.run == [sys.executable, f"{home / 'configs'}/x.py", "5"]
    assert (tool.source, tool.home) == (None, home)


def test_files_are_looked_for_around_the_launch_file_wherever_one_is(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    trials, elsewhere = home / "trials", home / "elsewhere"
    for folder in (trials, elsewhere, elsewhere / "nodes", elsewhere / "configs"):
        folder.mkdir()
    for file in (trials / "probe.py", elsewhere / "probe.py", elsewhere / "nodes" / "mine.py"):
        file.write_text("")
    (elsewhere / "configs" / "robot.yaml").write_text("nodes: [node: probe.py]")
    monkeypatch.chdir(elsewhere)
    text = "nodes: [node: probe.py, node: nodes/mine.py]\ninclude: [{file: configs/robot.yaml, arguments: {id: 1}}]"
    text += "\ngroups: [nodes: [node: world]]"
    found = read_launch_file(trials / "lap.yaml", text=text)
    assert [each.name for each in found] == ["probe", "mine", "driver_1", "world"]
    assert [each.source and each.source.path for each in found][:2] == [trials / "probe.py", home / "nodes" / "mine.py"]


def test_a_node_may_be_an_executable_of_a_package(home: Path) -> None:
    folder = home / "src" / "rover"
    (folder / "rover").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>rover</name></package>")
    (folder / "setup.py").write_text(
        "setup(entry_points={'console_scripts': ['drive = rover.driver:main']}, packages=['rover'])"
    )
    (folder / "rover" / "driver.py").write_text("def main(): pass\n")
    found = entries(home, "nodes: [{node: rover drive}, {node: tf2_ros static_transform_publisher, name: tf}]")
    assert list(found) == ["drive", "tf"]
    assert [each.source.spec.rpartition("/")[2] for each in found.values() if each.source] == [
        "driver.py:main",
        "static_transform_publisher.py",
    ]
    with pytest.raises(DocumentError, match=r"no node named 'drive' in .*; package rover has one: 'rover drive'$"):
        entries(home, "nodes: [node: drive]")


def test_parameter_files_are_read_for_each_node(home: Path) -> None:
    text = """
nodes:
- {node: mine, count: 2, namespace: "r{i}", parameters: [gains.yaml, {extra: "{i}"}]}
- {node: world, parameters: [{gain: 7, speed: 1}, configs/gains.yaml]}
"""
    found = entries(home, text)
    assert found["r0/mine"].node.parameters == {"gain": 2.5, "careful": True, "extra": 0}
    assert found["r0/mine"].wide == {"careful"}
    assert found["r1/mine"].node.parameters == {"gain": 1, "careful": True, "extra": 1}
    assert found["world"].node.parameters == {"gain": 1, "careful": True, "speed": 1}


def test_a_file_for_a_group_need_not_be_for_all_of_it(home: Path) -> None:
    (home / "configs" / "one.yaml").write_text("/r0/mine:\n  ros__parameters: {a: 1}\n")
    text = "groups: [{parameters: one.yaml, nodes: [{node: mine, count: 2, namespace: 'r{i}'}]}]"
    found = entries(home, text)
    assert (found["r0/mine"].node.parameters, found["r1/mine"].node.parameters) == ({"a": 1}, {})


def test_an_error_about_an_entry_is_where_the_thing_is_said(home: Path) -> None:
    text = """
groups:
- process: p
  parameters: {a: {b: 1}}
  count: 1
  nodes:
  - node: mine
    remappings: {"x{i}": y}
    parameters: [gains.yaml, {"c{i}": 2}]
    start_after: [world]
- nodes: [node: world]
"""
    entry = entries(home, text)["mine"]

    def place(*steps: str | int, key: bool = False) -> str:
        return (
            str(entry.error(list(steps), "x", key=key)).replace("\\", "/").removeprefix(f"{home.as_posix()}/configs/")
        )

    assert place("process") == "lap.yaml:3:12: groups[0].process: x"
    assert place("parameters", "a.b") == "lap.yaml:4:23: groups[0].parameters.a.b: x"
    assert place("parameters", "gain") == "lap.yaml:9:18: groups[0].nodes[0].parameters[0]: x"
    assert place("parameters", "c0") == "lap.yaml:9:39: groups[0].nodes[0].parameters[1].c{i}: x"
    assert place("remappings", "x0", key=True) == "lap.yaml:8:18: groups[0].nodes[0].remappings.x{i}: x"
    assert place("start_after") == "lap.yaml:10:19: groups[0].nodes[0].start_after[0]: x"
    assert place("node") == "lap.yaml:7:11: groups[0].nodes[0].node: x"
    assert place("cpu") == "lap.yaml:7:5: groups[0].nodes[0].cpu: x"


def test_included_files_look_around_themselves(home: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    elsewhere = make_other_workspace(tmp_path_factory.mktemp("elsewhere"))
    text = f"""
nodes: [node: mine]
include:
- {{file: "{elsewhere.as_posix()}/configs/other.yaml", namespace: o}}
- {{file: wander, namespace: w}}
"""
    found = entries(home, text)
    assert {name: each.home for name, each in found.items()} == {
        "mine": home,
        "o/mine": elsewhere,
        "w/world": home,
        "w/reactive_controller": home,
    }
    assert found["o/mine"].node.parameters == {"here": str(elsewhere / "configs"), "a": 5}
    assert found["o/mine"].source != found["mine"].source


def make_other_workspace(folder: Path) -> Path:
    for part in ("nodes", "configs"):
        (folder / part).mkdir()
    (folder / "nodes" / "mine.py").write_text("")
    (folder / "configs" / "own.yaml").write_text("mine: {ros__parameters: {a: 4}}\n/o/mine: {ros__parameters: {a: 5}}")
    text = "nodes: [{node: mine, parameters: [{here: '{here}'}, own.yaml]}]"
    (folder / "configs" / "other.yaml").write_text(text)
    return folder.resolve()


def test_a_workspace_that_is_none_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    with pytest.raises(NotFoundError, match="no workspace folder named"):
        read_launch_file(tmp_path / "lap.yaml", workspace=tmp_path / "none", text="nodes: [node: world]")


@pytest.mark.parametrize("path", list_launches(workspace=built_in_workspace()), ids=lambda path: path.stem)
def test_the_launch_files_that_come_with_robolink_are_read(path: Path) -> None:
    assert read_launch_file(path)


def test_a_file_names_the_network_of_all_its_nodes(home: Path) -> None:
    text = 'network: "{where}"\narguments: {where: lan}\nnodes: [node: world]'
    assert entries(home, text)["world"].network == "lan"
    assert {each.network for each in read_launch_file(home / "configs/a.yaml", {"where": "robot"}, text=text)} == {
        "robot"
    }
    assert entries(home, "nodes: [node: world]")["world"].network == ""


def test_a_system_has_one_network(home: Path) -> None:
    (home / "configs/part.yaml").write_text("network: lan\nnodes: [node: world]")
    assert entries(home, "include: [file: part]")["world"].network == "lan"
    assert entries(home, "network: lan\ninclude: [file: part]")["world"].network == "lan"
    with pytest.raises(DocumentError, match=r"part\.yaml:1:10: network: the files around it say 'off', and a system"):
        entries(home, "network: off\ninclude: [file: part]")


def test_the_network_is_a_variable_of_each_process(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROBOLINK_NETWORK", raising=False)
    text = "network: lan\nnodes: [node: world]"
    (process,) = plan(home / "configs/a.yaml", text=text)
    assert process.env["ROBOLINK_NETWORK"] == "lan"
    monkeypatch.setenv("ROBOLINK_NETWORK", "off")
    (process,) = plan(home / "configs/a.yaml", text=text)
    assert "ROBOLINK_NETWORK" not in process.env
