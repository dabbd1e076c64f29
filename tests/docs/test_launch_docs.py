"""docs/reference/launch.md: it has every option and every key; its blocks are run by test_pages_run.py."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import msgspec
import typer.main

from robolink.cli.launching.launch import app
from robolink.launch.entry import Respawn, StartAfter
from robolink.launch.reading.description import (
    Argument,
    GroupDescription,
    IncludeDescription,
    LaunchDescription,
    NodeDescription,
)
from robolink.testing import System

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "launch.md").read_text(encoding="utf-8")
FILES = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)


def test_the_one_with_arguments_drives_as_fast_as_it_is_told(tmp_path: Path) -> None:
    (text,) = (each for each in FILES if "arguments:\n" in each)
    (tmp_path / "follow.yaml").write_text(text)
    with System(seed=1) as system:
        system.launch(tmp_path / "follow.yaml", {"speed": 0.5})
        system.expect("cmd_vel", lambda twist: twist.linear.x > 0.45, within=30.0)


def test_every_option_is_there() -> None:
    command: Any = typer.main.get_command(app)
    known = {name for each in command.params for name in each.opts}
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
