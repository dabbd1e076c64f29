"""docs/reference/simulate.md names options and keys that are there, and faults fit; test_pages_run.py runs blocks."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import msgspec
import pytest
import typer.main

from robolink.cli.launching.simulate import app
from robolink.faults.description import ClockFault, Crash, MessageFault, Partition
from robolink.faults.file import check_nodes, read_faults
from robolink.launch import read_launch_file
from robolink.simulate import simulate
from robolink.workspace import find_faults, find_launch
from tests.support.simulations import workspace

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "simulate.md").read_text(encoding="utf-8")


def test_the_options_that_it_names_are_there() -> None:
    command: Any = typer.main.get_command(app)
    known = {name for each in command.params for name in each.opts if name.startswith("--")}
    said = set(re.findall(r"`(?:robolink simulate )?(--[a-z-]+)", PAGE))
    assert len(said) >= 6
    assert said - known == {"--help"}


def test_it_has_every_key() -> None:
    kinds: list[type[msgspec.Struct]] = [MessageFault, Partition, Crash, ClockFault]
    keys = {each.encode_name for kind in kinds for each in msgspec.structs.fields(kind)}
    assert {each for each in keys if not re.search(rf"\b{each}\b(:|`)", PAGE)} == set()


@pytest.mark.slow
@pytest.mark.parametrize("faults", ["rough", "radio"])
@pytest.mark.parametrize(
    "system",
    [
        *("follow", "wander", "lab", "goto", "square", "walker", "first_nodes", "talk"),
        *(pytest.param(each, marks=pytest.mark.annex("nav2")) for each in ("navigate", "map_it")),
    ],
)
def test_the_faults_that_come_along_fit_any_system(system: str, faults: str, tmp_path: Path) -> None:
    workspace(tmp_path)
    entries = read_launch_file(tmp_path / "configs/talk.yaml" if system == "talk" else find_launch(system))
    document = read_faults(find_faults(faults))
    check_nodes(document, [each.name for each in entries])
    result = simulate(entries, duration=21.0, seed=1, faults=document.value)
    assert result.failures == []
    assert system == "walker" or sum(each.lost + each.late for each in result.faults) > 0  # it has one node
