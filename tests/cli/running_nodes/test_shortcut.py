"""What a launcher asks of its processes is read without typer, and means what it means with it."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.cli.main import _parsed
from robolink.cli.running_nodes import runner
from robolink.cli.running_nodes.shortcut import shortcut

WORDS = st.sampled_from(["talker", "my/node.py:Talker", "demo_nodes_py", "a b", "x:=1", "--", "-r", "--two", "", "-"])
NEEDLESS = {"typer", "click", "rich", "yaml", "numpy", "asyncio", "logging", "ctypes", "importlib.metadata", "psutil"}
"""Modules that neither a node needs to start nor a list of topics; the fork server alone needs ctypes."""

LATER = st.lists(st.sampled_from(["--ros-args", "-r", "__node:=a", "-p", "x:=1", "--", "-"]), max_size=4)


def asked_by(act: Any, monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """What the runner is asked for."""
    asked: list[object] = []

    def run(*arguments: object) -> int:
        asked.append(arguments)
        return 0

    with monkeypatch.context() as patched:
        patched.setattr(runner, "run", run)
        assert act() == 0
    return asked


@given(st.lists(WORDS, max_size=4), LATER)
def test_it_reads_what_the_parser_reads(words: list[str], later: list[str]) -> None:
    with pytest.MonkeyPatch.context() as monkeypatch:
        short = shortcut(["run", *words, *later])
        if short is not None:
            parsed = asked_by(lambda: _parsed(["run", *words, *later]), monkeypatch)
            assert asked_by(short, monkeypatch) == parsed


@pytest.mark.parametrize(
    "words", [[], ["-p", "x:=1", "talker"], ["talker", "-p", "x:=1"], ["--list"], ["--", "talker"]]
)
def test_options_are_left_to_the_parser(words: list[str]) -> None:
    assert shortcut(["run", *words]) is None


@pytest.mark.parametrize("command", ["topic", "launch", "run-together x"])
def test_so_are_other_commands(command: str) -> None:
    assert shortcut(command.split()) is None


def test_what_a_launcher_writes_is_read_here(monkeypatch: pytest.MonkeyPatch) -> None:
    words = ["run", "/a/talker.py", "--", "fast", "--ros-args", "-r", "__node:=a"]
    short = shortcut(words)
    assert short is not None
    asked = runner.NodeCommand("/a/talker.py", ["fast"], 0)
    assert asked_by(short, monkeypatch) == [(asked, ["--ros-args", "-r", "__node:=a"], None)]
    assert gc.isenabled()


@pytest.mark.processes
def test_a_node_is_run_without_what_it_does_not_need(tmp_path: Any) -> None:
    script = tmp_path / "script.py"
    script.write_text("import gc, sys\ndef main():\n    print(gc.isenabled(), *sys.modules)\n")
    command = [sys.executable, "-m", "robolink", "run", f"{script}:main"]
    shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    assert shown[0] == "True"
    assert "robolink.node" in shown
    needless = NEEDLESS | {"subprocess", "tempfile"}
    if sys.version_info < (3, 11):
        needless.discard("subprocess")  # Python's own uuid needs it there, and msgspec needs that
    assert not needless & set(shown)


@pytest.mark.processes
def test_topics_are_listed_without_what_that_does_not_need() -> None:
    command = "import sys; from robolink.cli.main import main; main(['topic', 'list']); print(*sys.modules)"
    environ = {**os.environ, "ROBOLINK_TRANSPORT": "memory"}
    shown = subprocess.run([sys.executable, "-c", command], capture_output=True, text=True, check=True, env=environ)
    modules = shown.stdout.splitlines()[-1].split()
    assert "robolink.cli.topic.listing" in modules
    assert not NEEDLESS & set(modules)
