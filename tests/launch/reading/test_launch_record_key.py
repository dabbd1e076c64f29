"""The key `record` of a launch file: which bag it asks for."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.cli.launching.launch import BY_DATE
from robolink.cli.main import main
from robolink.exceptions import DocumentError
from robolink.launch.reading.arguments import record_of
from robolink.launch.reading.entries import read_launch_file
from tests.support.simulations import workspace

NODES = "nodes: [{run: [python]}]"


@pytest.mark.parametrize(
    ("line", "folder"),
    [
        ("", None),
        ("record: false", None),
        ("record: no", None),
        ("record:", None),
        ("record: true", ""),
        ("record: on", ""),
        ("record: bags/lap", "bags/lap"),
        ("record: '{here}/lap'", f"{Path.cwd()}/lap"),
    ],
)
def test_a_bag_is_asked_for(line: str, folder: str | None) -> None:
    text = f"{line}\n{NODES}"
    assert record_of("lab.yaml", text=text) == folder
    assert len(read_launch_file("lab.yaml", text=text)) == 1


@pytest.mark.parametrize(("given", "folder"), [({}, None), ({"bag": "true"}, ""), ({"bag": "lap"}, "lap")])
def test_an_argument_decides(given: dict[str, str], folder: str | None) -> None:
    text = 'arguments: {bag: false}\nrecord: "{bag}"\n' + NODES
    assert record_of("lab.yaml", given, text=text) == folder


@pytest.mark.parametrize("line", ["record: [a]", "record: 2.5", "record: ''", "record: {folder: a}"])
def test_what_is_no_folder_is_a_mistake_with_its_place(line: str) -> None:
    with pytest.raises(DocumentError, match=r"lab\.yaml:1:9: record: expected true, false or the folder of a bag"):
        read_launch_file("lab.yaml", text=f"{line}\n{NODES}")


def test_a_node_has_no_such_key() -> None:
    with pytest.raises(DocumentError, match="it is said of a launch file, not of a node"):
        read_launch_file("lab.yaml", text="nodes: [{run: [python], record: true}]")


@pytest.mark.parametrize(
    ("words", "record"),
    [([], "lap"), (["--record"], ""), (["--record=other"], "other"), ([f"--record={BY_DATE}"], "")],
)
def test_the_command_line_has_precedence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: list[str], record: str
) -> None:
    ran: list[object] = []

    def launch(*_: object, **given: object) -> int:
        ran.append(given["record"])
        return 0

    monkeypatch.setattr("robolink.launch.command.launch", launch)
    folder = workspace(tmp_path, kept="record: lap\nnodes:\n  - node: talker\n")
    assert main(["launch", str(folder / "configs" / "kept.yaml"), *words]) == 0
    assert ran == [record]
