"""docs/bags.md: its commands have these options, and its programs run on a bag."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import typer.main

from robolink.bag.reader import open_bag
from robolink.cli.bag import app
from tests.support.bags import ten_messages, write

PAGE = (Path(__file__).parents[2] / "docs" / "bags.md").read_text(encoding="utf-8")
COMMANDS = [line for block in re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL) for line in block.splitlines()]
PROGRAMS = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
VERBS: Any = typer.main.get_command(app).commands  # type: ignore[attr-defined]


@pytest.mark.parametrize("line", [each for each in COMMANDS if each.startswith("robolink bag ")])
def test_a_command_has_these_options(line: str) -> None:
    verb = line.split()[2]
    known = {name for each in VERBS[verb].params for name in each.opts}
    assert set(re.findall(r"(?<= )--?[a-z][a-z-]*", line)) <= known


def test_every_verb_is_there() -> None:
    said = {line.split()[2] for line in COMMANDS if line.startswith("robolink bag ")}
    assert {each for each in VERBS if each != "list" and not VERBS[each].hidden} - said <= {"play", "record", "burst"}


@pytest.mark.processes
@pytest.mark.parametrize("program", [each for each in PROGRAMS if '"walk"' in each])
def test_a_program_reads_a_bag(program: str, tmp_path: Path) -> None:
    write(tmp_path / "walk", ten_messages())
    words = [sys.executable, "-c", f"import robolink.compat\n{program}"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
    assert done.stderr == ""
    assert [line.count("hello") for line in done.stdout.splitlines()] == [1] * 6


@pytest.mark.processes
@pytest.mark.parametrize("program", [each for each in PROGRAMS if '"drive"' in each])
def test_a_program_records_a_bag(program: str, tmp_path: Path) -> None:
    words = [sys.executable, "-c", f"import robolink.compat\n{program}"]
    environ = os.environ | {"ROBOLINK_TRANSPORT": "memory"}
    done = subprocess.run(words, cwd=tmp_path, env=environ, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr, done.stdout.strip().isdigit()) == (0, "", True)
    with open_bag(tmp_path / "drive") as bag:
        assert bag.is_whole
