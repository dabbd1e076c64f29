"""Arguments of launch files: as people type them, as they were meant."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robolink.launch import read_launch_file
from robolink.launch.entry import ArgumentHelp
from robolink.launch.reading.arguments import arguments_of

TEXT = """
arguments:
  speed: 0.5
  id:
  label: {default: 1.10, description: What it is called.}
  mode: {default: "no", choices: [on, no, 2]}
  safe: true
  port: "8080"
  folder: "{here}/maps"
  file: {default: "{folder}/{mode}.yaml"}
  points: [1, 2]
  nothing: {default: null}
nodes:
- node: world
  name: n{id}
  parameters:
    speed: "{speed}"
    id: "{id}"
    label: "{label}-{speed}"
    mode: "{mode}"
    safe: "{safe}"
    port: "{port}"
    file: "{file}"
    points: "{points}"
"""


def parameters(tmp_path: Path, **given: str) -> dict[str, Any]:
    [entry] = read_launch_file(tmp_path / "lap.yaml", {"id": "1", **given}, text=TEXT)
    return entry.node.parameters


def test_defaults(tmp_path: Path) -> None:
    assert parameters(tmp_path) == {
        "speed": 0.5,
        "id": 1,
        "label": "1.10-0.5",
        "mode": "no",
        "safe": True,
        "port": "8080",
        "file": f"{tmp_path.resolve()}/maps/no.yaml",
        "points": [1, 2],
    }


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("speed", "1e3", 1000.0),
        ("speed", "012", 12),
        ("speed", "on", "on"),
        ("speed", "'1'", "1"),
        ("speed", "[1, 2]", [1, 2]),
        ("speed", "", ""),
        ("id", "007", 7),
        ("label", "2.50", "2.50-0.5"),
        ("mode", "2", 2),
        ("mode", "on", "on"),
        ("safe", "off", False),
        ("safe", "no", False),
        ("safe", "maybe", "maybe"),
        ("port", "9090", "9090"),
        ("file", "a: b", None),
        ("points", "3", 3),
    ],
)
def test_what_is_given_is_read_as_it_is_meant(tmp_path: Path, name: str, text: str, expected: object) -> None:
    if expected is None:  # a mapping, of which a parameter's name is made
        assert parameters(tmp_path, **{name: text})[f"{name}.a"] == "b"
        return
    found = parameters(tmp_path, **{name: text})[name]
    assert (type(found), found) == (type(expected), expected)


def test_a_number_in_a_name_is_as_it_was_typed(tmp_path: Path) -> None:
    [entry] = read_launch_file(tmp_path / "lap.yaml", {"id": "007"}, text=TEXT)
    assert entry.name == "n007"


def test_what_there_is_to_give_is_told(tmp_path: Path) -> None:
    found = {each.name: each for each in arguments_of(tmp_path / "lap.yaml", text=TEXT)}
    assert list(found) == ["speed", "id", "label", "mode", "safe", "port", "folder", "file", "points", "nothing"]
    assert found["id"] == ArgumentHelp("id", None, "", ())
    assert found["label"] == ArgumentHelp("label", "1.10", "What it is called.", ())
    assert found["mode"] == ArgumentHelp("mode", "no", "", ("on", "no", "2"))
    assert found["folder"].default == "{here}/maps"
    assert found["points"].default == "[1, 2]"
    assert found["nothing"].default == "null"
