"""The folder in which launchers leave word is its user's alone; a launcher without one runs all the same."""

from __future__ import annotations

import os
import stat
import tempfile
from pathlib import Path

import pytest

from robolink.supervisor.control import server
from robolink.supervisor.control.registry import Registration, RuntimeFolderError, runtime_folder
from robolink.supervisor.control.server import Control
from tests.support.launchers import FakeSupervisor, files_in, posix_only


@posix_only
def test_nobody_else_can_read_what_is_left(launched: Control, folder: Path) -> None:
    for each in (folder / "robolink").iterdir():
        assert stat.S_IMODE(each.stat().st_mode) == 0o600
    assert stat.S_IMODE((folder / "robolink").stat().st_mode) == 0o700


@posix_only
def test_a_launcher_without_a_folder_says_so_once_and_runs(
    supervisor: FakeSupervisor, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "robolink").write_text("in the way")
    with Control(supervisor, name="follow"):
        pass
    (said,) = supervisor.said
    assert said == (
        "no other shell can ask for the status, restart or stop: "
        f"{folder / 'robolink'} is not a folder of this user: remove it"
    )


def test_a_launcher_that_cannot_write_leaves_nothing_and_says_so(
    supervisor: FakeSupervisor, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def register_on_a_full_disk(place: Path, registration: Registration) -> None:
        place.with_suffix(".part").write_text("{")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(server, "register", register_on_a_full_disk)
    with Control(supervisor, name="follow"):
        assert files_in(folder) == []
    (said,) = supervisor.said
    assert said.endswith("No space left on device")


@posix_only
def test_a_folder_of_another_user_is_refused(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(folder))
    (folder / "robolink-12345").mkdir(mode=0o700)
    with pytest.raises(RuntimeFolderError, match="robolink-12345 is not a folder of this user"):
        runtime_folder()


@posix_only
def test_a_folder_that_others_may_open_is_refused(folder: Path) -> None:
    (folder / "robolink").mkdir(mode=0o755)
    (folder / "robolink").chmod(0o755)
    with pytest.raises(RuntimeFolderError, match="can be opened by others: chmod 700 it"):
        runtime_folder()


@posix_only
def test_a_link_in_its_place_is_refused(folder: Path, tmp_path: Path) -> None:
    (folder / "robolink").symlink_to(tmp_path)
    with pytest.raises(RuntimeFolderError, match="is not a folder of this user"):
        runtime_folder()


@posix_only
@pytest.mark.parametrize("given_folder", ["", ".", "/nowhere/at/all", "/tmp/" + 80 * "x"])
def test_without_a_runtime_folder_it_is_the_temporary_one(
    given_folder: str, monkeypatch: pytest.MonkeyPatch, folder: Path
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", given_folder)
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(folder))
    assert runtime_folder().parent == folder
    assert stat.S_IMODE(runtime_folder().stat().st_mode) == 0o700
