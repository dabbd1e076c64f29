"""Whatever is wrong in a launch file is one line with its place, before anything starts."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError
from robolink.launch import plan, read_launch_file
from robolink.launch.entry import Respawn, StartAfter
from robolink.launch.reading.description import GroupDescription, IncludeDescription, LaunchDescription, NodeDescription
from tests.support.launchfiles import make_workspace

INCLUDED = {
    "robot": "arguments: {id: , speed: {default: 1.0, choices: [1.0, 2.0]}}\nnodes: [{node: mine, name: 'm{id}'}]\n",
    "wrong": "nodes:\n- node: min\n",
    "tabs": "nodes:\n\t- node: mine\n",
    "circle": "include: [file: round]\n",
    "round": "include: [file: circle.yaml]\n",
    "deep": "nodes: [node: mine]\ninclude:\n- file: wrong.yaml\n",
    "gains": "other:\n  ros__parameters: {a: 1}\nthird:\n  ros__parameters: {b: 1}\n",
    "flat": "speed: 1.0\n",
}
ARROW = "--> "


def bad_files() -> list[tuple[str, str]]:
    """Give the launch files of the table, each with what it is told; `# ...` begins a group of them."""
    table = (Path(__file__).parents[2] / "data" / "bad_launch_files.txt").read_text(encoding="utf-8")
    found = []
    for block in table.split("\n\n"):
        lines = [each for each in block.strip("\n").split("\n") if not each.startswith("# ")]
        found.append(("\n".join(lines[:-1]), lines[-1].removeprefix(ARROW)))
    return found


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROBOT", "r1")
    return make_workspace(tmp_path, monkeypatch, **INCLUDED)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows knows programs by their names")
def test_a_script_that_may_not_be_executed_is_told_so(home: Path) -> None:
    with pytest.raises(DocumentError, match=r"run\[0\]: '.*/robot.yaml' may not be executed: chmod \+x it"):
        plan(home / "configs" / "lap.yaml", text="nodes: [{run: ['{here}/robot.yaml']}]")


@pytest.mark.parametrize(("text", "report"), bad_files())
def test_what_is_wrong_is_one_line_with_its_place(home: Path, text: str, report: str) -> None:
    with pytest.raises(DocumentError) as caught:
        plan(home / "configs" / "lap.yaml", text=text)
    expected = report.replace("<home>", home.as_posix())
    if not expected.startswith(home.as_posix()):
        expected = f"{home.as_posix()}/configs/lap.yaml:{expected}"
    assert str(caught.value).replace("\\", "/") == expected


def test_there_are_many_of_them() -> None:
    assert len(bad_files()) > 150


GIVEN = [
    ({"sped": "1"}, "configs/lap.yaml:1:12: arguments.sped: no argument is called 'sped' (did you mean 'speed'?)"),
    ({"speed": "4"}, "configs/lap.yaml:1:20: arguments.speed: 'speed' is one of 1, 2, got '4'"),
    ({"speed": ""}, "configs/lap.yaml:1:20: arguments.speed: 'speed' is one of 1, 2, got ''"),
    ({"speed": "[1"}, "speed:=[1 is not YAML: expected ',' or ']', but got the end of the text"),
]


@pytest.mark.parametrize(("given_ones", "report"), GIVEN)
def test_what_is_given_is_one_line_too(home: Path, given_ones: dict[str, str], report: str) -> None:
    text = "arguments: {speed: {default: 1, choices: [1, 2]}}\nnodes: [node: mine]"
    with pytest.raises(DocumentError) as caught:
        read_launch_file(home / "configs" / "lap.yaml", given_ones, text=text)
    assert str(caught.value).replace("\\", "/").removeprefix(f"{home.as_posix()}/").startswith(report)


def test_a_file_without_arguments_says_so(home: Path) -> None:
    with pytest.raises(DocumentError, match=r"arguments.a: no argument is called 'a': it has none$"):
        read_launch_file(home / "configs" / "lap.yaml", {"a": "1"}, text="nodes: [node: mine]")


@pytest.mark.parametrize(
    "key", ["nodes: [{node: %s}]", "include: [{file: %s}]", "nodes: [{node: mine, parameters: %s}]"]
)
def test_a_name_that_no_file_can_have_is_one_line(home: Path, key: str) -> None:
    with pytest.raises(DocumentError) as caught:
        read_launch_file(home / "configs" / "lap.yaml", text=key % ("nodes/" + "x" * 5000 + ".py"))
    assert len(str(caught.value)) < len(str(home)) + 400


def test_files_that_multiply_are_refused(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.launch.reading.entries.MOST_PARTS", 100)
    text = "groups:\n- count: 20\n  groups:\n  - count: 20\n    nodes: [{node: mine, if: false}]"
    with pytest.raises(DocumentError, match=r"more than 100 nodes, groups and includes$"):
        read_launch_file(home / "configs" / "lap.yaml", text=text)


KEYS = sorted(
    {
        field
        for struct in (
            *(GroupDescription, IncludeDescription, LaunchDescription, NodeDescription),
            *(Respawn, StartAfter),
        )
        for field in struct.__struct_encode_fields__
    }
)
ANYTHING = st.recursive(
    st.none() | st.integers(-3, 3) | st.floats() | st.text(max_size=5) | st.sampled_from(["{i}", "{a}", "on", "robot"]),
    lambda inside: (
        st.lists(inside, max_size=3) | st.dictionaries(st.sampled_from(KEYS) | st.text(max_size=3), inside, max_size=3)
    ),
    max_leaves=5,
)


def mostly(good: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    """Make good values, and once in a while anything."""
    return st.integers(0, 19).flatmap(lambda number: good if number else ANYTHING)


def of(needed: dict[str, st.SearchStrategy[Any]], **others: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    """Make mappings with what is needed and some of the others."""
    return mostly(st.fixed_dictionaries(needed, optional=others))


NAME = st.sampled_from(["mine", "world", "n{i}", "r{a}", "x"])
WORD = st.sampled_from(["on", "off", "{a}", "{here}", "", "0", "012"])
PARAMETERS = st.dictionaries(NAME, st.integers() | WORD, max_size=2) | st.just("gains.yaml")
AWAITED = NAME | of({"topic": NAME}) | of({"node": NAME})
SHARED = {
    "namespace": NAME,
    "parameters": PARAMETERS | st.lists(PARAMETERS, max_size=2),
    "env": st.dictionaries(NAME, WORD, max_size=2),
    "respawn": st.sampled_from(["never", "on_failure"]) | of({}, delay=st.floats(0, 9), most=st.integers(1, 3)),
    "start_after": AWAITED | st.lists(AWAITED, max_size=2),
    "if": st.sampled_from(["on", "{a}", True, "0", "no"]),
    "count": st.integers(1, 3) | st.sampled_from(["{a}", "{i}"]),
    "process": NAME,
    "cpu": st.integers(0, 3) | st.just("{i}"),
    "log_level": st.sampled_from(["info", "WARN"]),
    "remappings": st.dictionaries(NAME, NAME, max_size=2),
}
NODE = of(
    {"node": st.sampled_from(["mine", "world", "{here}/../nodes/mine.py"]), "name": NAME}, args=st.lists(WORD), **SHARED
)
INCLUDE = of({"file": st.sampled_from(["robot", "round", "deep"])}, arguments=of({"id": WORD}), namespace=NAME)
HELD = {"include": st.lists(INCLUDE, max_size=1)}
GROUP = of({"nodes": st.lists(NODE, min_size=1, max_size=2)}, **SHARED, **HELD)
ARGUMENT = st.integers(0, 3) | of({"default": WORD}, choices=st.lists(WORD), description=WORD)
FILE = of(
    {"nodes": st.lists(NODE, min_size=1, max_size=2), "arguments": of({"a": ARGUMENT}, b=ARGUMENT)},
    description=NAME,
    groups=st.lists(GROUP, max_size=2),
    **HELD,
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("any") / "configs"
    folder.mkdir()
    for name, text in INCLUDED.items():
        (folder / f"{name}.yaml").write_text(text)
    (folder.parent / "nodes").mkdir()
    (folder.parent / "nodes" / "mine.py").write_text("")
    return folder


def check_is_read_or_refused(folder: Path, text: str) -> None:
    report = f"{folder}: read"
    try:
        entries = read_launch_file(folder / "lap.yaml", text=text)
    except DocumentError as error:
        report = str(error)
    else:
        assert len({each.name for each in entries}) == len(entries)
    assert report.startswith(str(folder))
    assert "\n" not in report


@given(FILE)
def test_what_is_nearly_a_launch_file_is_read_or_refused_in_one_line(folder: Path, data: Any) -> None:
    check_is_read_or_refused(folder, spell(data))


@given(ANYTHING)
def test_any_data_is_read_or_refused_in_one_line(folder: Path, data: Any) -> None:
    check_is_read_or_refused(folder, spell(data))


@given(st.text(st.characters(exclude_categories=["Cs"])))
def test_any_text_is_read_or_refused_in_one_line(folder: Path, text: str) -> None:
    check_is_read_or_refused(folder, text)
