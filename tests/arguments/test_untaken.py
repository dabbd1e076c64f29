"""Sections of parameter files that no node takes are told of, where their names are misspelt or all are in vain."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from robolink.arguments.overrides import Override
from robolink.arguments.undeclared import untaken
from robolink.context import Context
from robolink.executors import SingleThreadedExecutor
from robolink.node import Node

Captured = pytest.CaptureFixture[str]


def told(sections: str, names: str) -> list[str]:
    return list(untaken([Override(each, "a", 1) for each in sections.split()], names.split()))


MEANT = "'batery' is not the name of a node that gets it (did you mean 'battery'?)"


@pytest.mark.parametrize(
    ("sections", "names", "lines"),
    [
        ("/battery", "/battery", []),
        ("/batery", "/battery", [MEANT]),
        ("/** /batery", "/battery", [MEANT]),
        ("/camera", "/battery", ["'camera' is not the name of a node that gets it ('battery')"]),
        ("/** /camera", "/battery", []),
        ("/battery /camera", "/battery", []),
        ("/left_arm /right_arm", "/left_arm", []),
        ("/left /rihgt", "/left /right", ["'rihgt' is not the name of a node that gets it (did you mean 'right'?)"]),
        ("/ns/battery", "/battery", ["'ns/battery' is not the name of a node that gets it (did you mean 'battery'?)"]),
        ("/*/battery", "/battery", []),
        ("/** /robot1/arm /robot2/arm", "/robot3/arm", []),
        ("/** /battary /bat /batery", "/battery", [MEANT]),
        ("", "/battery", []),
    ],
)  # fmt: skip
def test_a_section_is_told_of_where_its_name_is_wrong(sections: str, names: str, lines: list[str]) -> None:
    assert told(sections, names) == lines


def test_of_many_sections_in_vain_the_first_are_named() -> None:
    *lines, last = told(" ".join(f"/camera{number}" for number in range(1000)), "/battery")
    assert lines == [f"'camera{number}' is not the name of a node that gets it ('battery')" for number in range(3)]
    assert last == "997 other sections are for no node that gets it, either"


def test_a_thousand_nodes_are_looked_up_at_once() -> None:
    names = " ".join(f"/n{number}" for number in range(1000))
    begin = time.process_time()
    assert told(f"/** {names}", names) == []
    assert time.process_time() - begin < 0.5


def test_a_node_that_spins_tells_of_it_once(context: Context, capsys: Captured, tmp_path: Path) -> None:
    file = tmp_path / "p.yaml"
    file.write_text("batery: {ros__parameters: {a: 1}}\n")
    node = Node("battery", context=context, cli_args=["--ros-args", "--params-file", str(file)])
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    node.create_timer(0.01, executor.shutdown)
    executor.spin()
    context.given_parameters.warn_of_typos([node])
    assert capsys.readouterr().err.count(MEANT) == 1
