"""The JSON schemas of launch files and faults files: they come along, take what reading takes, and refuse the rest."""

from __future__ import annotations

import importlib
import re
from pathlib import Path
from typing import Any

import pytest

from robolink.cli.main import main
from robolink.documents.yamlfile import parse
from robolink.faults.file import MEANINGS as faults_meanings
from robolink.faults.file import faults_schema
from robolink.launch.reading.description import MEANINGS as launch_meanings
from robolink.launch.reading.description import launch_schema
from robolink.sim.schema import MEANINGS as world_meanings
from robolink.sim.schema import world_schema

ROOT = Path(__file__).parents[2]
CONFIGS = ROOT / "configs"
PAGE = (ROOT / "docs" / "reference" / "launch.md").read_text(encoding="utf-8")
SHOWN = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)


def validator(schema: dict[str, Any]) -> Any:
    jsonschema = importlib.import_module("jsonschema")  # by name, since it has no types
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


LAUNCH, FAULTS = validator(launch_schema()), validator(faults_schema())


def problems(which: Any, text: str) -> list[str]:
    return [each.message for each in which.iter_errors(parse(text))]


@pytest.mark.parametrize(
    ("verb", "path"), [("launch", "launch.schema.json"), ("simulate", "faults/faults.schema.json")]
)
def test_the_schemas_that_come_along_are_the_present_ones(
    verb: str, path: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([verb, "--schema"]) == 0
    assert capsys.readouterr().out == (CONFIGS / path).read_text(encoding="utf-8"), f"robolink {verb} --schema > {path}"


@pytest.mark.parametrize("path", sorted(CONFIGS.glob("*.yaml")), ids=lambda path: path.stem)
def test_launch_files_that_come_along_fit(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.startswith("# yaml-language-server: $schema=launch.schema.json\n")
    assert problems(LAUNCH, text) == []


@pytest.mark.parametrize("path", sorted((CONFIGS / "faults").glob("*.yaml")), ids=lambda path: path.stem)
def test_faults_files_that_come_along_fit(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.startswith("# yaml-language-server: $schema=faults.schema.json\n")
    assert problems(FAULTS, text) == []


@pytest.mark.parametrize("number", range(len(SHOWN)))
def test_launch_files_of_the_page_fit(number: int) -> None:
    assert problems(LAUNCH, SHOWN[number]) == []


@pytest.mark.parametrize(
    "text",
    [
        "nodes: [{node: world, count: '{n}', cpu: '{core}', respawn: '{when}', interactive: '{keys}'}]",
        "arguments: {speed: {default: 1}, far: }\nnodes: [{node: world, if: '{far}'}]",
    ],
)
def test_an_argument_may_stand_for_any_value(text: str) -> None:
    assert problems(LAUNCH, text) == []


@pytest.mark.parametrize(
    "text",
    [
        "node: world",
        "nodes: [{nod: world}]",
        "nodes: [{node: world, count: -1}]",
        "nodes: [{node: world, respawn: sometimes}]",
        "nodes: [{node: world, respawn: {delay: -1}}]",
        "nodes: [{node: world, start_after: {topc: scan}}]",
        "groups: [{nodes: {node: world}}]",
        "include: [{namespace: ada}]",
        "arguments: {speed: {defualt: 1}}",
    ],
)
def test_mistakes_in_launch_files_are_found(text: str) -> None:
    assert problems(LAUNCH, text)


@pytest.mark.parametrize(
    "text", ["messages: [{loss: 2}]", "crashes: [{node: a}]", "partitons: []", "clocks: [{node: a, drift: 1}]"]
)
def test_mistakes_in_faults_files_are_found(text: str) -> None:
    assert problems(FAULTS, text)


@pytest.mark.parametrize("schema", [launch_schema(), faults_schema(), world_schema()], ids=lambda each: each["title"])
def test_every_key_says_what_it_means_where_the_mouse_is(schema: dict[str, Any]) -> None:
    parts = {"": schema, **schema["definitions"]}
    keys = {f"{name}.{key}": value for name, part in parts.items() for key, value in part.get("properties", {}).items()}
    assert len(keys) > 20
    assert [key for key, value in keys.items() if not value.get("description", "").endswith(".")] == []
    assert [name for name, part in parts.items() if not part.get("description")] == []


def test_descriptions_are_of_keys_that_are_there() -> None:
    for schema, meanings in (
        (launch_schema(), launch_meanings),
        (faults_schema(), faults_meanings),
        (world_schema(), world_meanings),
    ):
        parts = {schema.get("title", ""): schema, **schema["definitions"]}
        keys = {key for part in parts.values() for key in part.get("properties", {})}
        names = {f"{name}.{key}" for name, part in schema["definitions"].items() for key in part.get("properties", {})}
        whole = ("LaunchDescription", "FaultsDescription", "WorldDescription")
        assert [key for key in meanings if key.partition(".")[2] in keys and key.startswith(whole)]
        assert [key for key in meanings if not key.startswith(whole) and key not in keys | names] == []
