"""Workspaces of others: what was merely found is used only if it is the user's or root's, and nobody else may write."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.system.processes import own_command
from robolink.workspace import VARIABLE, built_in_workspace, find_node, trust, user_workspace, workspace_of

posix_only = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no owners by number and no mode bits")
EVIL = "print('a stranger runs')\n"


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A workspace, with the working directory below it."""
    for folder in ("nodes", "configs", "deep"):
        (tmp_path / folder).mkdir()
    (tmp_path / "nodes/world.py").write_text(EVIL)
    for each in (VARIABLE, trust.SAFE):
        monkeypatch.delenv(each, raising=False)
    monkeypatch.setenv(trust.REFUSED, "")
    monkeypatch.chdir(tmp_path / "deep")
    return tmp_path.resolve()


def test_ones_own_workspace_is_used(home: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert user_workspace() == home
    assert find_node("world").path == home / "nodes/world.py"
    assert capfd.readouterr().err == ""


@posix_only
@pytest.mark.parametrize("part", ["", "nodes", "configs"])
def test_what_everybody_may_write_is_not_used_and_that_is_said_once(
    home: Path, part: str, capfd: pytest.CaptureFixture[str]
) -> None:
    (home / part).chmod(0o777)
    for _ in range(3):
        assert find_node("world").path == built_in_workspace() / "nodes/world.py"
    [line] = capfd.readouterr().err.splitlines()
    assert f"the workspace {home} is not used: everybody may write to {home / part} (chmod o-w)" in line
    assert f"{trust.SAFE}={home}" in line


@posix_only
def test_a_folder_to_which_everybody_adds_is_no_workspace_even_if_sticky(home: Path) -> None:
    home.chmod(0o1777)
    assert workspace_of(home / "deep") is None


@posix_only
def test_what_stands_in_a_folder_where_all_may_replace_it_is_not_used(home: Path) -> None:
    inner = home / "deep/mine"
    for part in ("nodes", "configs"):
        (inner / part).mkdir(parents=True)
    inner.parent.chmod(0o777)
    assert trust.why_not(inner) == f"everybody may write to {inner.parent} (chmod o-w)"
    inner.parent.chmod(0o1777)  # as /tmp: each may replace their own only
    assert trust.why_not(inner) == ""


@posix_only
def test_a_group_that_may_write_is_the_owners_choice(home: Path) -> None:
    home.chmod(0o775)
    assert user_workspace() == home


@posix_only
def test_a_strangers_workspace_is_named_with_its_owner(home: Path) -> None:
    assert trust.why_not(home, trusted={home.stat().st_uid + 1}).startswith(f"{home} belongs to ")
    assert trust.why_not(home, trusted={home.stat().st_uid, 0}) == ""


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root can give a folder away")
def test_as_root_a_users_workspace_is_not_used_but_that_of_who_called_sudo(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("SUDO_UID", raising=False)
    getattr(os, "chown")(home, 54321, 54321)  # noqa: B009 - Windows has none
    assert user_workspace() is None
    assert trust.why_not(home) == f"{home} belongs to user 54321, neither to you nor to root"
    monkeypatch.setenv("SUDO_UID", "54321")
    assert user_workspace() == home


@posix_only
@pytest.mark.parametrize("safe", ["*", "{home}", "/elsewhere{sep}{home}"])
def test_what_the_user_calls_safe_is_used(home: Path, safe: str, monkeypatch: pytest.MonkeyPatch) -> None:
    home.chmod(0o777)
    monkeypatch.setenv(trust.SAFE, "/elsewhere")
    assert user_workspace() is None
    monkeypatch.setenv(trust.SAFE, safe.format(home=home, sep=os.pathsep))
    assert user_workspace() == home


@posix_only
def test_who_names_a_workspace_or_a_file_has_asked_for_it(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home.chmod(0o777)
    assert user_workspace(home) == home
    assert find_node("../nodes/world.py").path == home / "nodes/world.py"
    monkeypatch.setenv(VARIABLE, str(home))
    assert user_workspace() == home


@posix_only
def test_completion_says_nothing_in_the_middle_of_what_is_typed(
    home: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    home.chmod(0o777)
    monkeypatch.setenv("_ROBOLINK_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", "robolink run wor")
    monkeypatch.setenv("COMP_CWORD", "2")
    main([])
    found = capfd.readouterr()
    assert "world" in found.out
    assert found.err == ""


@pytest.mark.processes
def test_what_robolink_starts_imports_nothing_from_the_working_directory(home: Path) -> None:
    for name in ("typer", "msgspec", "numpy", "zenoh", "yaml", "robolink"):
        (home / f"deep/{name}.py").write_text(EVIL)
    done = subprocess.run([*own_command(), "world", "list"], capture_output=True, text=True, timeout=60, check=False)
    assert "corners" in done.stdout, done.stderr
    assert "stranger" not in done.stdout + done.stderr
    planned = "import sys; del sys.path[0]; from robolink.cli.main import main; sys.exit(main())"
    (home / "deep/mine.yaml").write_text("nodes:\n  - node: static_transform_publisher\n    args: [--help]\n")
    words = [sys.executable, "-c", planned, "--network", "off", "launch", "./mine.yaml"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60, check=False)
    assert "stranger" not in done.stdout + done.stderr
