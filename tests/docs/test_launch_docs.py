"""docs/launch.md: its launch files can be launched, its commands have these options, and it knows every key."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import msgspec
import pytest
import typer.main

from robolink.cli.launching.launch import app
from robolink.launch.looking.validate import validate
from robolink.launch.planning import processes
from robolink.launch.reading.description import (
    Argument,
    GroupDescription,
    IncludeDescription,
    LaunchDescription,
    NodeDescription,
    Respawn,
    StartAfter,
)
from robolink.launch.reading.entries import read_launch_file
from robolink.testing import System

PAGE = (Path(__file__).parents[2] / "docs" / "launch.md").read_text(encoding="utf-8")
FILES = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
COMMANDS = [line for block in re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL) for line in block.splitlines()]


@pytest.mark.parametrize("text", FILES)
def test_its_launch_files_can_be_launched(text: str) -> None:
    assert processes(read_launch_file(Path(__file__).parents[2] / "configs" / "docs.yaml", text=text))


@pytest.mark.processes
def test_the_one_with_most_in_it_has_no_mistake() -> None:
    [text] = [each for each in FILES if "arguments:\n" in each]
    report = validate(read_launch_file(Path("docs.yaml"), text=text))
    assert report == ([], [])


def test_the_one_with_arguments_drives_as_fast_as_it_is_told(tmp_path: Path) -> None:
    (text,) = (each for each in FILES if "arguments:\n" in each)
    (tmp_path / "follow.yaml").write_text(text)
    with System(seed=1) as system:
        system.launch(tmp_path / "follow.yaml", {"speed": 0.5})
        system.expect("cmd_vel", lambda twist: twist.linear.x > 0.45, within=30.0)


def test_its_commands_have_these_options() -> None:
    command: Any = typer.main.get_command(app)
    known = {name for each in command.params for name in each.opts}
    used = {flag for line in COMMANDS for flag in re.findall(r"(?<= )--?[a-z][a-z-]*", line.partition("#")[0])}
    assert used <= known
    assert all(line.startswith("robolink launch ") for line in COMMANDS)
    unsaid = {name for name in known if name.startswith("--") and name not in PAGE}
    assert {each for each in unsaid if "completion" not in each} == set()


def test_every_key_is_there() -> None:
    said = set(re.findall(r"[a-z_]+(?=:)", "".join(FILES))) | set(re.findall(r"`([a-z_]+)`", PAGE))
    kinds: list[type[msgspec.Struct]] = [
        LaunchDescription,
        NodeDescription,
        GroupDescription,
        IncludeDescription,
        Argument,
        Respawn,
        StartAfter,
    ]
    keys = {each.encode_name for kind in kinds for each in msgspec.structs.fields(kind)}
    assert keys - said - {"service"} == set()
