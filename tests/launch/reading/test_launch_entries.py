"""Launch files as people write them: arguments, includes, groups, copies and conditions come to what they mean."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.exceptions import DocumentError
from robolink.launch.entry import Respawn, StartAfter
from tests.support.launch_configs import entries


def test_a_fleet_of_included_robots(home: Path) -> None:
    found = entries(
        home,
        """
arguments: {robots: 2, mode: {default: fast, choices: [slow, fast]}}
nodes:
- node: world
groups:
- namespace: fleet
  groups:
  - namespace: r{i}
    count: "{robots}"
    include:
    - {file: robot, namespace: inner, arguments: {id: "0{i}", mode: "{mode}"}}
""",
        robots="3",
    )
    assert list(found) == ["world", *(f"fleet/r{i}/inner/driver_0{i}" for i in range(3))]
    last = found["fleet/r2/inner/driver_02"]
    assert last.full_name == "/fleet/r2/inner/driver_02"
    assert last.node.namespace == "/fleet/r2/inner"
    assert last.node.parameters == {"id": "02", "mode": "fast"}
    assert last.node.start_after == (StartAfter(node="/world"),)
    assert last.source is not None
    assert last.source.path == home / "nodes" / "mine.py"
    assert last.home == home


def test_what_a_group_says_holds_within_and_the_nearer_counts(home: Path) -> None:
    found = entries(
        home,
        """
groups:
- process: p
  respawn: on_failure
  env: {A: outer, B: outer}
  remappings: {scan: a, odom: b}
  parameters: {x: 1, y: {z: 1}}
  log_level: debug
  on_exit: ignore
  cpu: 1
  start_after: {topic: map}
  groups:
  - namespace: in
    respawn: {when: always, delay: 0.5}
    parameters: {y.z: 2}
    nodes:
    - {node: mine, name: a, env: {B: inner}, remappings: {scan: c}, parameters: {x: 3}, log_level: warn, cpu: [0, 1]}
    - {node: mine, name: b, process: "", respawn: never, start_after: [a, {service: go}, {topic: /clock}]}
  nodes:
  - {run: [python], name: helper}
""",
    )
    a, b, helper = found["in/a"].node, found["in/b"].node, found["helper"].node
    assert (a.process, a.log_level, a.on_exit, a.cpu) == ("p", "warn", "ignore", (0, 1))
    assert a.respawn == Respawn("always", delay=0.5)
    assert a.env == {"A": "outer", "B": "inner"}
    assert list(a.remappings.items()) == [("scan", "c"), ("odom", "b")]
    assert a.parameters == {"x": 3, "y.z": 2}
    assert found["in/a"].wide == {"y.z"}
    assert a.start_after == (StartAfter(topic="/in/map"),)
    assert (b.process, b.log_level, b.respawn.when) == ("", "debug", "never")
    waits = [StartAfter(topic="/in/map"), StartAfter(node="/in/a"), StartAfter(service="/in/go")]
    assert b.start_after == (*waits, StartAfter(topic="/clock"))
    assert (helper.process, helper.log_level, helper.parameters, helper.remappings) == ("", None, {}, {})
    assert (helper.env, helper.on_exit, helper.cpu) == ({"A": "outer", "B": "outer"}, "ignore", (1,))
    assert helper.start_after == (StartAfter(topic="/map"),)


def test_a_name_that_is_waited_for_is_the_nearest(home: Path) -> None:
    found = entries(
        home,
        """
nodes: [{node: mine}, {node: mine, name: base, namespace: r1}, {node: mine, name: a, start_after: r1/mine}]
groups:
- namespace: r1
  nodes:
  - {node: mine}
  - {node: mine, namespace: arm, name: b, start_after: [mine, /mine, base]}
  - {node: mine, namespace: /r2, name: c, start_after: mine}
""",
    )
    waits = {name: [each.node for each in entry.node.start_after] for name, entry in found.items()}
    assert waits["a"] == ["/r1/mine"]
    assert waits["r1/arm/b"] == ["/r1/mine", "/mine", "/r1/base"]
    assert waits["r2/c"] == ["/mine"]


SWITCHED_OFF = """
arguments: {sim: true}
nodes:
- {node: mine, start_after: [world, other, drive/Two, /drive/helper, drive/driver_{number}, lab/mine]}
- {node: world, if: "{sim}"}
- {node: world, name: other, if: "{sim}"}
- {node: mine, namespace: lab}
- {node: mine, namespace: lab/in, name: b, start_after: mine, if: "{sim}"}
groups:
- if: "{sim}"
  namespace: drive
  nodes:
  - {node: "program.py:Two"}
  - {node: "not_there{env:HOME_OF_NOBODY}"}
  - {node: no_such_package helper}
  - {run: [no_such_program]}
  include: [{file: robot, count: 2, arguments: {id: "{i}"}}, {file: nowhere}]
  groups: [{count: not_a_number}]
"""


def test_what_is_switched_off_is_not_waited_for(home: Path) -> None:
    text = SWITCHED_OFF.replace("{number}", "1")
    found = entries(home, text, sim="off")
    assert found["mine"].node.start_after == (StartAfter(node="/lab/mine"),)
    assert list(found) == ["mine", "lab/mine"]
    with pytest.raises(DocumentError, match=r"start_after\[4\]: no node of this system is called 'drive/driver_2'"):
        entries(home, text.replace("driver_1", "driver_2"), sim="off")
    with pytest.raises(DocumentError, match="the environment has no 'HOME_OF_NOBODY'"):
        entries(home, text, sim="on")


def test_what_is_switched_off_is_read_only_so_far(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.launch.reading.entries.MOST_PARTS", 100)
    with pytest.raises(DocumentError, match="more than 100 nodes, groups and includes"):
        entries(home, "nodes: [node: mine]\ngroups: [{if: off, count: 60, nodes: [{node: world, count: 60}]}]")


def test_classes_of_one_file_are_called_by_their_names(home: Path) -> None:
    text = """
nodes:
- {node: program.py:One, start_after: Two}
- {node: program.py:Two}
- {node: program.py:Two, name: given}
- {node: program.py, start_after: [given, One]}
- {node: program.py:One, namespace: r1}
"""
    found = entries(home, text)
    assert list(found) == ["One", "Two", "given", "program", "r1/program"]
    assert found["program"].node.start_after == (StartAfter(node="/given"), StartAfter(node="/One"))
    assert found["One"].node.name == ""
    with pytest.raises(DocumentError, match="two nodes are called 'One': give this one another `name`"):
        entries(home, text + "- {node: program.py:One}")


def test_null_says_nothing(home: Path) -> None:
    text = """
arguments: {n: {default: null}, mode:}
nodes: [{node: mine, name: "{n}", namespace: "{ n }", log_level: "{n}", respawn: "{n}", process: "{mode}", cpu: "{n}"}]
"""
    found = entries(home, text, mode="null")
    assert (list(found), found["mine"].node.name, found["mine"].node.process) == (["mine"], "", "")
    with pytest.raises(DocumentError, match="expected true or false, got nothing"):
        entries(home, 'arguments: {n: {default: null}}\nnodes: [{node: mine, if: "{n}"}]')


@pytest.mark.parametrize("word", ["true", "yes", "on", "On", "Y", "1", "'true'", "'{yes}'", "'{typed}'"])
def test_conditions_that_are_true(home: Path, word: str) -> None:
    text = f"arguments: {{yes: yes, typed: off}}\nnodes: [{{node: mine, if: {word}}}, {{node: world, unless: {word}}}]"
    assert list(entries(home, text, typed="on")) == ["mine"]


@pytest.mark.parametrize("word", ["false", "no", "off", "OFF", "n", "0"])
def test_conditions_that_are_false(home: Path, word: str) -> None:
    text = f"nodes: [{{node: mine, if: {word}}}]\ngroups: [{{unless: {word}, nodes: [node: world]}}]"
    assert list(entries(home, text)) == ["world"]


def test_what_is_not_wanted_may_be_impossible(home: Path) -> None:
    text = """
groups:
- if: off
  nodes: [{node: not_there, parameters: nor_this.yaml, name: "{env:NOR_THAT}"}]
include: [{file: nowhere, unless: on}]
nodes: [{run: [no_such_program], if: no}]
"""
    assert entries(home, text) == {}


def test_what_programs_get_is_as_it_is_written(home: Path) -> None:
    text = """
arguments: {version: 1.10}
nodes:
- node: mine
  env: {A: on, B: 012, C: 1e3, D: yes, E: , F: "{version}", G: 0x10, H: null, on: "{here}"}
  args: [012, 1.10, true, "{version}", "v{version}", {linear: 1}]
"""
    with pytest.raises(DocumentError, match=r"args\[5\]: expected a value, got mapping"):
        entries(home, text)
    node = entries(home, text.replace(", {linear: 1}", ", '{linear: 1}'"), version="2.50")["mine"].node
    here = str(home / "configs")
    assert node.env == {
        "A": "on",
        "B": "012",
        "C": "1e3",
        "D": "yes",
        "E": "",
        "F": "2.50",
        "G": "0x10",
        "H": "null",
        "on": here,
    }
    assert node.args == ["012", "1.10", "true", "2.50", "v2.50", "{linear: 1}"]


def test_what_ros_spells_otherwise_is_read_as_it_means_it(home: Path) -> None:
    found = entries(
        home,
        """
arguments: {again: true}
nodes:
- {node: mine, name: a, log_level: WARN, respawn: true}
- {node: mine, name: b, log_level: Debug, respawn: false}
groups:
- {log_level: ERROR, respawn: "{again}", nodes: [{node: mine, name: c}, {node: mine, name: d, respawn: on_failure}]}
""",
    )
    assert [each.node.log_level for each in found.values()] == ["warn", "debug", "error", "error"]
    assert [each.node.respawn.when for each in found.values()] == ["always", "never", "always", "on_failure"]


def test_braces_and_colons_that_are_meant_so_stay(home: Path) -> None:
    found = entries(
        home,
        """
arguments: {again, speed: 1}
nodes:
- node: mine
  name: m{again}
  args: ["a:b", a:b, '{"speed": {"x": 1}}', '{again} {']
  parameters: {nodes: [a:b], '{speed}': 2, empty: {}, shell: $(var, date: $(date)}
  env:
    SCRIPT: |
      f"{here}"
""",
        again="5",
    )
    assert found["m5"].node.args == ["a:b", "a:b", '{"speed": {"x": 1}}', "5 {"]
    assert found["m5"].node.parameters == {"nodes": ["a:b"], "1": 2, "shell": "$(var", "date": "$(date)"}
    assert found["m5"].node.env == {"SCRIPT": f'f"{home / "configs"}"\n'}


def test_an_argument_may_be_a_list_or_a_mapping(home: Path) -> None:
    text = """
arguments: {more: [--fast, 2.5], names: {default: {scan: lidar}}, gains: {default: {p: 1.0}}, cores: [0, 1]}
nodes: [{node: mine, args: "{more}", remappings: "{names}", parameters: "{gains}", cpu: "{cores}"}]
"""
    node = entries(home, text, more="[--slow, 3]")["mine"].node
    assert (node.args, node.remappings, node.parameters, node.cpu) == (
        *(["--slow", "3"], {"scan": "lidar"}, {"p": 1.0}),
        (0, 1),
    )


def test_what_is_merged_is_read_too(home: Path) -> None:
    text = "nodes: [&a {node: mine, name: a, env: {X: 012}, args: [012]}, {<<: *a, name: b, args: [013]}]"
    found = entries(home, text)
    assert [(each.node.env, each.node.args) for each in found.values()] == [
        ({"X": "012"}, ["012"]),
        ({"X": "012"}, ["013"]),
    ]
