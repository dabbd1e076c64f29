"""The recipes for a verb, a sensor and a message package: what they show is all it takes, in a copy of the tree."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tools.docs_site.markdown import Block, blocks

ROOT = Path(__file__).parents[2]
RECIPES = ROOT / "docs/development/recipes.md"
COPIED = ("robolink", "nodes", "configs", "interfaces", "tests", "tools", "docs/reference", "docs/development")
APPENDED = ", at the end"


def recipe(heading: str) -> list[Block]:
    """The blocks of a recipe that have a title: each is a file to write or to change."""
    sections = dict(re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", RECIPES.read_text(encoding="utf-8"), re.M | re.S))
    return [each for each in blocks(sections[heading]) if each.title]


def follow(block: Block, tree: Path) -> str:
    """Do what a block of a recipe says; the file that it touches."""
    name = block.title.removesuffix(APPENDED)
    file = tree / name
    before = file.read_text(encoding="utf-8") if file.exists() else ""
    assert bool(before) == (block.language == "diff" or block.title.endswith(APPENDED)), name
    file.parent.mkdir(parents=True, exist_ok=True)
    if block.language == "diff":
        lines = block.text.splitlines(keepends=True)
        old, new = ("".join(each[1:] for each in lines if each[0] in kept) for kept in (" ", " +"))
        assert before.count(old) == 1, f"{name}: the lines around the change are not there"
        file.write_text(before.replace(old, new), encoding="utf-8")
    else:
        file.write_text(f"{before}\n\n{block.text}" if before else block.text, encoding="utf-8")
    return name


def run(tree: Path, *words: str) -> str:
    environ = {**os.environ, "PYTHONPATH": str(tree)}
    found = subprocess.run([sys.executable, *words], cwd=tree, env=environ, capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr
    return found.stdout


def run_tests(tree: Path, *words: str) -> None:
    run(tree, "-m", "pytest", "-q", "-p", "no:cacheprovider", *words)  # exit code 5 if there is none


@pytest.fixture
def tree(tmp_path: Path) -> Iterator[Path]:
    """A copy of the tree. Not by links: what a recipe's tool writes would be written in this tree as well."""
    for name in COPIED:
        ignored = shutil.ignore_patterns("__pycache__", "node_modules")
        shutil.copytree(ROOT / name, tmp_path / name, ignore=ignored)
    shutil.copyfile(ROOT / "pyproject.toml", tmp_path / "pyproject.toml")
    yield tmp_path
    shutil.rmtree(tmp_path, ignore_errors=True)


@pytest.mark.processes
@pytest.mark.slow
def test_a_verb_takes_three_files(tree: Path) -> None:
    touched = {follow(each, tree) for each in recipe("Add a verb to the command line")}
    assert len(touched) <= 3
    files = ("tests/cli/topic/test_topic_graph.py", "tests/text/test_foreign_text.py")
    run_tests(tree, *files, "-k", "nodes_lists_who_uses_a_topic or tried_or_excused or topic-nodes")
    assert "List the nodes that use a topic." in run(tree, "-m", "robolink", "topic", "--help")


@pytest.mark.processes
@pytest.mark.slow
def test_a_sensor_takes_two_files(tree: Path) -> None:
    touched = {follow(each, tree) for each in recipe("Add a sensor")}
    assert len(touched) == 2
    schema = "configs/worlds/world.schema.json"
    (tree / schema).unlink()
    run(tree, "-m", "robolink", "world", "schema", "-o", schema)
    files = ("tests/testing/test_contracts.py", "tests/cli/world/test_world_commands.py")
    run_tests(tree, *files, "-k", "compass or (schema and not worlds_that_come)")


@pytest.mark.processes
@pytest.mark.slow
def test_a_message_package_takes_two_files(tree: Path) -> None:
    touched = {follow(each, tree) for each in recipe("Add a message package")}
    assert len(touched) <= 2
    run(tree, "tools/interface_stubs.py")
    run_tests(tree, "tests/interfaces/test_interfaces.py", "-k", "hash or fresh or package")
    shown = run(tree, "-m", "robolink", "interface", "show", "demo_msgs/msg/Level")
    assert shown == "# How full a tank is, from 0 to 1.\nfloat64 level\n"
    program = "import robolink.compat; from demo_msgs.msg import Level; print(Level(level=0.5))"
    assert run(tree, "-c", program) == "demo_msgs.msg.Level(level=0.5)\n"
