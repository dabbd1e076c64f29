"""robolink new: what it makes is run, in this process and once as a user runs it."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.workspace import VARIABLE

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_without_a_noun_it_shows_them(capsys: Captured) -> None:
    assert main(["new"]) == 2
    told = capsys.readouterr().err
    assert all(each in told for each in ("project", "node", "world"))


def test_it_lists_what_it_made_and_what_is_next(here: Path, capsys: Captured) -> None:
    assert main(["new", "project", "demo"]) == 0
    out = capsys.readouterr().out
    assert f"made {Path('demo/nodes/explorer.py')}\n" in out
    assert out.endswith("next:\n  cd demo\n  robolink simulate demo    # or: launch demo\n  python -m pytest\n")


def test_without_pytest_it_says_how_to_get_it(here: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert main(["new", "project", "demo"]) == 0
    assert capsys.readouterr().out.endswith("  pip install pytest\n  python -m pytest\n")


@pytest.mark.parametrize("path", [".", "./", "../here", "inside/.."])
def test_who_is_there_already_is_not_sent_there(
    here: Path, path: str, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    (here / "here").mkdir()
    monkeypatch.chdir(here / "here")
    assert main(["new", "project", path]) == (0 if path != "inside/.." else 1)
    out, err = capsys.readouterr()
    assert "next:\n  robolink simulate here    # or: launch here\n" in out if not err else "'..' is not a name" in err
    assert "cd " not in out


@pytest.mark.parametrize(
    ("path", "typed"), [("./demo/", "demo"), ("my work/demo", "'my work/demo'"), ("-a/demo", "./-a/demo")]
)
@pytest.mark.skipif(sys.platform == "win32", reason="the quotes of a POSIX shell")
def test_a_path_is_shown_as_a_shell_takes_it(here: Path, path: str, typed: str, capsys: Captured) -> None:
    assert main(["new", "project", "--", path]) == 0
    assert f"next:\n  cd {typed}\n" in capsys.readouterr().out
    assert main(["new", "node", "talker", "--workspace", path]) == 0
    (folder,) = shlex.split(typed)
    assert shlex.split(capsys.readouterr().out.splitlines()[-1]) == [
        *("python", "-m", "pytest"),
        f"{folder}/tests/test_talker.py",
    ]


def test_a_project_needs_a_name(here: Path, capsys: Captured) -> None:
    assert main(["new", "project", ""]) == 1
    assert capsys.readouterr().err.startswith("robolink: '' is not a name for a project: ")
    assert list(here.iterdir()) == []


def test_a_node_and_a_world_in_a_project(here: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    assert main(["new", "project", "demo"]) == 0
    monkeypatch.chdir(here / "demo")
    capsys.readouterr()
    assert main(["new", "node", "talker"]) == 0
    assert "robolink run talker\n" in capsys.readouterr().out
    assert main(["new", "world", "kitchen"]) == 0
    assert "world:=kitchen\n" in capsys.readouterr().out
    assert main(["world", "check", "kitchen"]) == 0


def test_what_is_wrong_is_one_line(here: Path, capsys: Captured) -> None:
    assert main(["new", "node", "2nd"]) == 1
    assert capsys.readouterr().err.startswith("robolink: '2nd' is not a name for a node: ")


@pytest.mark.processes
def test_a_new_project_passes_its_own_tests(here: Path) -> None:
    assert main(["new", "project", "demo"]) == 0
    assert main(["new", "node", "talker", "--workspace", "demo"]) == 0
    environment = {each: value for each, value in os.environ.items() if not each.startswith("PYTEST_")}
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"],
        cwd=here / "demo",
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "3 passed" in done.stdout
