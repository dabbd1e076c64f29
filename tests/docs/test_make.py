"""tools/make.py and the Makefile: what each command installs, in which steps, and what an older Python is told."""

from __future__ import annotations

import ast
import importlib.util
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "tools" / "make.py"
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
Captured = pytest.CaptureFixture[str]


class Commands(list[list[str]]):
    """Notes commands in place of running them, and what had been told before each; one fails where `fails` says so."""

    def __init__(self, fails: int, capsys: Captured) -> None:
        super().__init__()
        self.told: list[str] = []
        self._fails, self._capsys = fails, capsys

    def __call__(self, command: list[str]) -> int:
        self.append(command)
        self.told.append(self._capsys.readouterr().out)
        return int(len(self) == self._fails)


@pytest.fixture
def make() -> ModuleType:
    spec = importlib.util.spec_from_file_location("make_without_make", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def commands(make: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> Callable[..., Commands]:
    """What runs commands now: it makes a virtual environment's Python, and nothing else."""

    def noting(fails: int = 0) -> Commands:
        noted = Commands(fails, capsys)
        monkeypatch.setattr(make, "run", noted)
        return noted

    monkeypatch.setattr("ensurepip.version", lambda: "25.1")
    return noting


def with_python(make: ModuleType, venv: Path) -> None:
    make.python_of(venv).parent.mkdir(parents=True)
    make.python_of(venv).touch()


def installed(make: ModuleType, venv: Path, *words: str) -> list[str]:
    python = str(make.python_of(venv))
    return [python, "-c", make.QUIETLY, "pip", "install", "--quiet", "--disable-pip-version-check", *words]


def test_a_demo_installs_what_it_needs_and_no_tools_and_tells_each_step(
    make: ModuleType, commands: Callable[..., Commands], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(make, "ROOT", tmp_path)
    (tmp_path / "pyproject.toml").touch()
    venv, noted = tmp_path / ".venv", commands()
    venv.mkdir()
    assert make.main(["demo"]) == 0
    assert noted == [
        [sys.executable, "-c", make.QUIETLY, "venv", str(venv)],
        installed(make, venv, "--editable", "."),
        [str(make.python_of(venv)), "-m", "robolink", "launch", "wander", "--view"],
    ]
    assert [text.count("\n") for text in noted.told] == [1, 1, 1]
    assert all(text.startswith("robolink: ") for text in noted.told)
    with_python(make, venv)
    noted.clear()
    assert make.main(["test", "-x"]) == 0  # the rest comes when something asks for it, into what there is
    assert noted[:-1] == [installed(make, venv, "--editable", ".", "--group", "dev")]
    assert noted[-1][1:] == [*make.COMMANDS["test"], "-x"]
    noted.clear()
    assert make.main(["demo"]) == 0
    assert len(noted) == 1


def test_who_has_the_tools_has_all_that_a_demo_needs(
    make: ModuleType, commands: Callable[..., Commands], tmp_path: Path
) -> None:
    noted = commands()
    assert make.main(["--venv", str(tmp_path), "install-test"]) == 0
    assert noted[1:] == [installed(make, tmp_path, "--editable", ".", "--group", "dev")]
    assert make.main(["--venv", str(tmp_path), "install-demo"]) == 0
    assert len(noted) == 2


def test_a_newer_pyproject_is_installed_anew(
    make: ModuleType, commands: Callable[..., Commands], tmp_path: Path
) -> None:
    with_python(make, tmp_path)
    (tmp_path / ".demo").touch()
    os.utime(tmp_path / ".demo", (1, 1))
    noted = commands()
    assert make.main(["--venv", str(tmp_path), "install-demo"]) == 0
    assert noted == [installed(make, tmp_path, "--editable", ".")]


@pytest.mark.parametrize(
    ("brought", "stage", "needed"),
    [("21.2.4", "demo", "pip>=21.3"), ("24.0", "demo", ""), ("24.0", "test", "pip>=25.1"), ("25.1", "test", "")],
)
def test_a_pip_that_is_too_old_is_replaced_first(
    make: ModuleType,
    commands: Callable[..., Commands],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    brought: str,
    stage: str,
    needed: str,
) -> None:
    noted = commands()
    monkeypatch.setattr("ensurepip.version", lambda: brought)
    assert make.main(["--venv", str(tmp_path), f"install-{stage}"]) == 0
    group = ["--group", "dev"] if stage == "test" else []
    expected = [installed(make, tmp_path, "--editable", ".", *group)]
    assert noted[1:] == [*([installed(make, tmp_path, needed)] if needed else []), *expected]


@pytest.mark.parametrize(
    ("platform", "version", "folder", "is_editable"),
    [
        ("win32", (3, 12, 1), "josé", False),
        ("win32", (3, 13, 0), "josé", True),
        ("win32", (3, 12, 1), "jose", True),
        ("linux", (3, 12, 1), "josé", True),
    ],
)
def test_a_clone_whose_path_python_would_misread_is_installed_as_a_copy(
    make: ModuleType,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    platform: str,
    version: tuple[int, ...],
    folder: str,
    is_editable: bool,
) -> None:
    monkeypatch.setattr(make, "ROOT", Path("C:/Users", folder, "robolink"))
    monkeypatch.setattr("ensurepip.version", lambda: "24.0")
    with monkeypatch.context() as patch:
        patch.setattr(sys, "platform", platform)
        patch.setattr(sys, "version_info", version)
        [*_, (_, command)] = make.steps("demo", tmp_path)
    assert (command[-2:] == ["--editable", "."]) == is_editable
    assert command[-1] == "."


@pytest.mark.parametrize("platform", ["win32", "win-arm64"])
def test_a_python_without_wheels_is_told_which_one_to_install(
    make: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: Captured, platform: str
) -> None:
    monkeypatch.setattr("sysconfig.get_platform", lambda: platform)
    assert make.main(["--venv", str(tmp_path), "install-demo"]) == 1
    assert "no wheels; install the 64-bit (x64) Python from python.org" in capsys.readouterr().err
    monkeypatch.setattr("sysconfig.get_platform", lambda: "win-amd64")
    assert make.lacking("demo", "{}") == ""


def test_what_does_not_install_is_not_run(
    make: ModuleType, commands: Callable[..., Commands], tmp_path: Path, capsys: Captured
) -> None:
    noted = commands(fails=2)
    assert make.main(["--venv", str(tmp_path), "demo"]) == 1
    assert len(noted) == 2
    assert not (tmp_path / ".demo").exists()
    assert capsys.readouterr().err == "robolink is not installed: the step above failed\n"


INTERRUPTED_STEP = """
import os, signal, sys
assert sys.argv[1:] == ["install", "all"], sys.argv
os.kill(os.getpid(), signal.SIGINT)
"""


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="a process of Windows cannot send itself a Ctrl-C alone")
def test_an_interrupted_installation_shows_no_traceback_and_says_how_it_goes_on(
    make: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "interrupted.py").write_text(INTERRUPTED_STEP)
    monkeypatch.setattr(make, "ROOT", tmp_path)
    (tmp_path / "pyproject.toml").touch()
    step = make.quietly(sys.executable, "interrupted", "install", "all")
    monkeypatch.setattr(make, "steps", lambda name, venv: [("installing", step)])
    assert make.main(["--venv", str(tmp_path), "install-demo"]) == 130
    told = capfd.readouterr()
    assert told.out == "robolink: installing\n"
    assert told.err == "\nrobolink is not installed yet: the same command goes on with it\n"
    assert not (tmp_path / ".demo").exists()


@pytest.mark.parametrize(("words", "advice"), [("install-demo", "make demo PYTHON="), ("demo", " tools/make.py demo")])
def test_an_older_python_is_told_before_anything_is_done(
    words: str,
    advice: str,
    make: ModuleType,
    commands: Callable[..., Commands],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Captured,
) -> None:
    noted = commands()
    monkeypatch.setattr(sys, "version_info", (3, 9, 2))
    monkeypatch.setattr(make, "runs", "python3.12".__eq__)
    assert make.main(["--venv", str(tmp_path), words]) == 1
    err = capsys.readouterr().err
    assert err.startswith(f"robolink needs Python 3.10 or newer, and {sys.executable} is 3.9.2; here is a newer one: ")
    assert (err.count("\n"), "python3.12" in err, advice in err, noted) == (1, True, True, [])
    monkeypatch.setattr(make, "runs", lambda name: False)
    assert make.main(["--venv", str(tmp_path), words]) == 1
    assert "install one from python.org" in capsys.readouterr().err


def test_a_python_without_venv_is_told(
    make: ModuleType,
    commands: Callable[..., Commands],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Captured,
) -> None:
    noted = commands()
    monkeypatch.setitem(sys.modules, "venv", None)
    assert make.main(["--venv", str(tmp_path), "install-demo"]) == 1
    assert "apt install python3-venv" in capsys.readouterr().err
    assert noted == []


def test_an_older_python_can_read_it() -> None:
    tree = ast.parse(SCRIPT.read_text(encoding="utf-8"), feature_version=(3, 6))
    froms = {each.module for each in ast.walk(tree) if isinstance(each, ast.ImportFrom)}
    assert froms == {"pathlib", "typing"}  # not __future__, whose annotations are younger than 3.6


def test_wrong_use_says_what_there_is(make: ModuleType, capsys: Captured) -> None:
    for words in (["tset"], [], ["install-install-demo"], ["--venv"]):
        assert make.main(words) == 2
        assert capsys.readouterr().err == "usage: python tools/make.py demo | test | docs\n"


# --- The Makefile -----------------------------------------------------------------------------------------------------


def test_the_makefile_says_the_same(make: ModuleType) -> None:
    parallel = re.search(r"^PARALLEL \?= (.*)$", MAKEFILE, re.MULTILINE)
    assert parallel is not None
    assert make.COMMANDS["test"] == ["-m", "pytest", *parallel[1].split()]
    assert "$(BIN)/robolink launch wander --view\n" in MAKEFILE


@pytest.mark.processes
@pytest.mark.skipif(shutil.which("make") is None, reason="there is no make")
@pytest.mark.parametrize(
    ("target", "first", "last"),
    [
        ("demo", "install-demo", "robolink launch wander --view"),
        ("test", "install-test", "-k one"),
        ("lint", "install-test", "ruff format --check ."),
        ("docs", "install-docs", "python -m tools.docs_site"),
    ],
)
def test_each_target_installs_only_what_it_needs(target: str, first: str, last: str, tmp_path: Path) -> None:
    words = ["make", "--dry-run", "--no-print-directory", target, f"VENV={tmp_path}", "PYTHON=python9", "ARGS=-k one"]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True)
    lines = done.stdout.splitlines()
    assert lines[0] == f"python9 tools/make.py --venv {tmp_path} {first}"
    assert lines[-1].endswith(last)
    (tmp_path / ".demo").touch()
    (tmp_path / ".ready").touch()
    (tmp_path / ".docs").touch()
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == lines[1:]
