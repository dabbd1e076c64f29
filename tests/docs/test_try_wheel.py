"""tools/try_wheel.py: it tries every extra and every way to install, and a command that ends otherwise fails."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from robolink.cli.shared.commands import NOUNS
from tests.docs.test_release import LOWEST
from tools import try_wheel

Captured = pytest.CaptureFixture[str]
SAID = '01_walk.py /mine /cmd_vel 1 passed size="1.0 1 1"'


class Typed(list[list[str]]):
    """Notes commands in place of running them; those with `fails` in them end with 3."""

    def __init__(self, fails: str = "nothing of this name", says: str = SAID) -> None:
        super().__init__()
        self.fails, self.says = fails, says

    def __call__(self, command: list[str], **options: Any) -> subprocess.CompletedProcess[bytes]:
        self.append(command)
        code = 3 if self.fails in command else int("check" in command and "learn" in command)
        return subprocess.CompletedProcess(command, code, self.says.encode())


@pytest.fixture
def dist(tmp_path: Path) -> Path:
    for name in ("robolink-1.0-py3-none-any.whl", "robolink-1.0.tar.gz"):
        (tmp_path / name).touch()
    return tmp_path


def test_each_extra_and_each_step_is_of_robolink() -> None:
    assert sorted(try_wheel.EXTRAS) == sorted(LOWEST["USERS"])
    assert set(try_wheel.WAYS) == {"pip", "sdist", "uv", "pipx", "all", *LOWEST["USERS"]}
    words = [step.words.split() for way in try_wheel.WAYS.values() for step in way.steps]
    assert {each[1] for each in words if each[0] == "robolink"} - {"--version"} <= set(NOUNS)
    assert {each[0] for each in words} == {"robolink", "python"}


def test_every_way_has_an_environment_of_its_own(dist: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    typed = Typed()
    monkeypatch.setattr(subprocess, "run", typed)
    constraints = ["--constraints", "lowest.txt"]
    assert try_wheel.main([str(dist), "--ways", "every", "--python", "a", "--python", "b", *constraints]) == 0
    made = [each[3] for each in typed if each[1:3] == ["-m", "venv"]]
    assert len(made) == len(set(made)) == 2 * len(try_wheel.WAYS)
    wheel = str(dist / "robolink-1.0-py3-none-any.whl")
    installed = [each[-1] for each in typed if each[1:2] == ["install"] or each[1:4] == ["-m", "pip", "install"]]
    assert {wheel, f"{wheel}[all]", f"{wheel}[xacro]", str(dist / "robolink-1.0.tar.gz")} <= set(installed)
    assert [each for each in typed if each[1:] == ["tool", "install", "--python", "b", wheel]]
    assert next(each for each in typed if "-c" in each)[5:7] == ["-c", str(Path("lowest.txt").absolute())]
    assert capsys.readouterr().out.endswith("all went well\n")


@pytest.mark.parametrize("typed", [Typed(fails="view"), Typed(says="nothing")])
def test_what_ends_or_speaks_otherwise_is_told(
    typed: Typed, dist: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr(subprocess, "run", typed)
    assert try_wheel.main([str(dist), "--python", "python3"]) == 1
    out = capsys.readouterr().out
    assert "it should have been exit" in out
    assert typed.says in out
    assert out.endswith("failed: pip with python3\n")
    assert ["pytest"] not in typed  # it ends at the first


@pytest.mark.processes
def test_a_robot_that_is_launched_is_seen_to_move(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The trial's own commands and files, with the robolink of the tests."""
    trial = try_wheel.Try("here", tmp_path, tmp_path, sys.executable, "", tmp_path)
    trial.programs.mkdir(parents=True)
    program = shutil.which("robolink", path=str(Path(sys.executable).parent))
    assert program is not None
    (trial.programs / Path(program).name).symlink_to(program)
    steps = (try_wheel.Step("robolink run during.py topic list", says="/odom"),)
    monkeypatch.setitem(try_wheel.WAYS, "here", try_wheel.Way(lambda trial: [], steps))
    assert try_wheel.tried(trial) == 0
