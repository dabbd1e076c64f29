"""`launch --validate` tells all that is wrong in launch files at once, each with its place and only once."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given

from robolink.cli.main import main
from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError
from robolink.launch import read_launch_file
from robolink.launch.reading.entries import read_with_mistakes
from tests.launch.reading.test_launch_mistakes import FILE, INCLUDED, bad_files
from tests.support.launchfiles import make_workspace

MANY = """
namespace: r1
nodes:
- {node: mine, paramters: {speed: 1}}
- {node: wrld, count: 3, name: 'a{i}'}
- {node: world}
- {node: mine, respawn: sometimes}
groups:
- namespace: 1a
  nodes: [{node: mine}]
- namespace: g
  nodes:
  - {node: mine, args: a b}
  - {node: mine, name: '{nme}'}
include:
- {file: wrong}
- {file: robot}
"""


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROBOT", "r1")
    return make_workspace(tmp_path, monkeypatch, **INCLUDED)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The same for many tries."""
    with pytest.MonkeyPatch.context() as patch:
        yield make_workspace(tmp_path_factory.mktemp("any"), patch, **INCLUDED) / "configs"


def mistakes(home: Path, text: str) -> list[str]:
    """Give the places of all mistakes, and what they are about."""
    _, found = read_with_mistakes(home / "configs" / "lap.yaml", text=text)
    return [f"{Path(each.file).name}:{each.line}: {each.message.partition(': ')[0]}" for each in found]


def refusal(path: Path, text: str) -> DocumentError | None:
    """Give what launching would say; None for a good file."""
    try:
        read_launch_file(path, text=text)
    except DocumentError as error:
        return error
    return None


def test_each_part_has_its_own_mistake(home: Path) -> None:
    assert mistakes(home, MANY) == [
        "lap.yaml:2: namespace",
        "lap.yaml:4: nodes[0].paramters",
        "lap.yaml:5: nodes[1].node",
        "lap.yaml:7: nodes[3].respawn",
        "lap.yaml:9: groups[0].namespace",
        "lap.yaml:13: groups[1].nodes[0].args",
        "lap.yaml:14: groups[1].nodes[1].name",
        "lap.yaml:17: include[1].arguments.id",
        "wrong.yaml:2: nodes[0].node",
    ]


def test_what_nodes_have_to_do_with_each_other_comes_next(home: Path) -> None:
    text = """
nodes:
- {node: mine, start_after: wrld}
- {node: mine}
- {node: world, start_after: [main]}
"""
    assert mistakes(home, text) == [
        "lap.yaml:3: nodes[0].start_after",
        "lap.yaml:4: nodes[1].node",
        "lap.yaml:5: nodes[2].start_after[0]",
    ]


def test_what_is_switched_off_may_be_wrong(home: Path) -> None:
    assert mistakes(home, "nodes: [{node: wrld, if: false}, {node: mine}, {node: wrld}]") == [
        "lap.yaml:1: nodes[2].node"
    ]


def test_good_files_have_none(home: Path) -> None:
    text = "nodes: [{node: mine}, {node: world}]"
    entries, found = read_with_mistakes(home / "configs" / "lap.yaml", text=text)
    assert [each.name for each in entries] == ["mine", "world"]
    assert found == []


@pytest.mark.slow
@pytest.mark.parametrize(("text", "report"), bad_files())
def test_the_mistake_of_reading_is_among_them(home: Path, text: str, report: str) -> None:
    """What `launch` refuses `--validate` tells of, in the same words; what only planning refuses is told later."""
    path = home / "configs" / "lap.yaml"
    found = [str(each) for each in read_with_mistakes(path, text=text)[1]]
    error = refusal(path, text)
    assert (str(error) in found) if error is not None else found == []


@given(FILE)
def test_there_are_some_exactly_where_reading_fails(folder: Path, data: object) -> None:
    text = spell(data)  # type: ignore[arg-type]
    path = folder / "lap.yaml"
    entries, found = read_with_mistakes(path, text=text)
    error = refusal(path, text)
    if error is None:
        assert found == []
        assert [each.name for each in entries] == [each.name for each in read_launch_file(path, text=text)]
    else:
        assert (error.line, error.column) in [(each.line, each.column) for each in found]


def test_the_command_prints_a_line_for_each(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (home / "configs" / "lap.yaml").write_text("nodes:\n- {nod: mine}\n- {node: mine, count: no}\n- {node: gone}\n")
    assert main(["launch", "lap", "--validate"]) == 1
    out, err = capsys.readouterr()
    assert [each.split(": ")[1] for each in out.splitlines()] == ["nodes[0].nod", "nodes[1].count", "nodes[2].node"]
    assert err == "robolink: no node was looked into: that comes when its file is right\n"


@pytest.mark.processes
def test_a_circle_does_not_hide_what_else_is_wrong(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    node = "from robolink import Node\nclass Mine(Node):\n    def __init__(self):\n        super().__init__('mine')\n"
    (home / "nodes" / "mine.py").write_text(node)
    text = "nodes:\n- {node: mine, name: a, start_after: b}\n- {node: mine, name: b, start_after: a}\n"
    (home / "configs" / "lap.yaml").write_text(text + "- {node: mine, name: c, parameters: {d: 1}}\n")
    assert main(["launch", "lap", "--validate"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert [each.split(": ")[1] for each in lines] == ["nodes[0].start_after", "nodes[2].parameters.d"]
