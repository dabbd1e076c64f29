"""What a run leaves in its log folder, and that no trouble with it stops a system."""

from __future__ import annotations

import errno
import io
import os
import re
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.supervisor import Process, RunLogs, Supervisor
from robolink.supervisor.reporting import logs
from robolink.supervisor.reporting.logs import file_names, logs_home, remove_old_runs

posix_only = pytest.mark.skipif(sys.platform == "win32", reason="locks, links and rights are POSIX's")


def opened(home: Path, *names: str, label: str = "follow", troubles: list[str] | None = None) -> RunLogs:
    run = RunLogs(label, home)
    run.open(list(names), ([] if troubles is None else troubles).append)
    return run


def folder_of(run: RunLogs) -> Path:
    assert run.folder is not None
    return run.folder


def test_a_run_has_a_folder_and_each_process_its_lines_as_they_came(tmp_path: Path) -> None:
    run = opened(tmp_path / "log", "robot1/world", "b")
    run.line("robot1/world", b"\x1b[31mred\x1b[0m \xff\n")
    run.line("robot1/world", b"no end")
    run.say("b started")
    run.close()
    folder = folder_of(run)
    assert re.fullmatch(r"\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d_follow", folder.name)
    assert (folder / "robot1-world.log").read_bytes() == b"\x1b[31mred\x1b[0m \xff\nno end\n"
    assert (folder / "b.log").read_bytes() == b""
    assert re.fullmatch(r"[\d-]+ [\d:.]+ b started\n", (folder / "launch.log").read_text())


@posix_only
def test_only_the_user_may_read_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(logs, "LARGEST", 3)
    before = os.umask(0)
    try:
        run = opened(tmp_path / "new" / "log", "a")
        run.line("a", b"long\n")
        run.line("a", b"the next file\n")
        run.close()
    finally:
        os.umask(before)
    folder = folder_of(run)
    rights = {each.name: oct(each.stat().st_mode & 0o777) for each in (folder.parent, folder, *folder.iterdir())}
    assert rights == {
        "log": "0o700",
        folder.name: "0o700",
        **dict.fromkeys(["launch.log", "a.log", "a.log.old"], "0o600"),
    }


@pytest.mark.parametrize(
    ("environ", "home"),
    [
        ({"ROS_LOG_DIR": "/ros", "ROBOLINK_LOG_DIR": "/own"}, Path("/own")),
        ({"ROS_LOG_DIR": "/ros", "ROBOLINK_LOG_DIR": ""}, Path("/ros")),
        ({}, Path.home() / ".robolink" / "log"),
        ({"ROS_LOG_DIR": "~/logs"}, Path.home() / "logs"),
    ],
)
def test_where_logs_are_kept(environ: dict[str, str], home: Path) -> None:
    assert logs_home(environ) == home


def test_two_runs_of_one_second_have_two_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("time.strftime", lambda text, *at: "2026-01-02_03-04-05_follow")
    runs = [opened(tmp_path) for _ in range(3)]
    assert [folder_of(run).name.removeprefix("2026-01-02_03-04-05_") for run in runs] == [
        "follow",
        "follow_2",
        "follow_3",
    ]
    for run in runs:
        run.close()


@posix_only
def test_latest_leads_to_the_newest_run_and_replaces_no_file(tmp_path: Path) -> None:
    first, second = opened(tmp_path, label="one"), opened(tmp_path, label="two")
    assert (tmp_path / "latest").resolve() == folder_of(second).resolve()
    (tmp_path / "latest").unlink()
    (tmp_path / "latest").write_text("mine")
    third = opened(tmp_path, label="three")
    assert (tmp_path / "latest").read_text() == "mine"
    for run in (first, second, third):
        run.close()


def make_run(home: Path, name: str) -> Path:
    (home / name).mkdir()
    (home / name / "launch.log").write_text("")
    return home / name


@posix_only
def test_old_runs_are_removed_but_nothing_else_and_none_that_goes_on(tmp_path: Path) -> None:
    for year in range(2001, 2010):
        make_run(tmp_path, f"{year}-01-01_00-00-00_follow")
    make_run(tmp_path, "2000-01-01-00-00-00-123456-host-4711")  # a run of ROS 2's launch
    (tmp_path / "2000-01-01_00-00-00_mine").mkdir()
    (tmp_path / "2000-01-01_00-00-00_mine" / "notes.txt").touch()
    (tmp_path / "2000-01-02_00-00-00_killed").mkdir()  # as it was made
    goes_on = opened(tmp_path)
    folder_of(goes_on).rename(tmp_path / "1999-01-01_00-00-00_long")
    remove_old_runs(tmp_path, 3)
    kept = {each.name[:10] for each in tmp_path.iterdir() if not each.is_symlink()}
    assert kept == {"1999-01-01", "2000-01-01", "2007-01-01", "2008-01-01", "2009-01-01"}
    assert len(list(tmp_path.glob("2000*"))) == 2
    goes_on.close()
    remove_old_runs(tmp_path, 3)
    assert not (tmp_path / "1999-01-01_00-00-00_long").exists()


def test_opening_a_run_removes_old_ones(tmp_path: Path) -> None:
    for year in range(2001, 2010):
        make_run(tmp_path, f"{year}-01-01_00-00-00_follow")
    run = RunLogs("follow", tmp_path, most=2)
    run.open([], print)
    run.close()
    assert sorted(each.name[:10] for each in tmp_path.iterdir() if each.name != "latest") == [
        "2009-01-01",
        folder_of(run).name[:10],
    ]


def test_a_folder_that_cannot_be_made_is_told_once(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    troubles: list[str] = []
    run = opened(tmp_path / "file" / "log", "a", troubles=troubles)
    run.line("a", b"x\n")
    run.say("y")
    run.close()
    assert troubles == [f"no logs are kept: {tmp_path}/file/log is not a folder: name one by ROBOLINK_LOG_DIR"]
    assert run.folder is None


class Full(io.RawIOBase):
    """A file on a disk that has room for some bytes."""

    def __init__(self, room: int) -> None:
        self.room = room
        self.kept = b""

    def write(self, data: object) -> int:
        taken = bytes(memoryview(data)[: self.room])  # type: ignore[arg-type]
        if not taken:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        self.room -= len(taken)
        self.kept += taken
        return len(taken)


def test_a_full_disk_is_told_once_and_ends_the_logs(tmp_path: Path) -> None:
    troubles: list[str] = []
    run = opened(tmp_path, "a", "b", troubles=troubles)
    run._files["a"].file.close()
    full = Full(7)
    run._files["a"].file = full  # type: ignore[assignment]
    for _ in range(3):
        run.line("a", b"12345\n")
        run.line("b", b"more\n")
    run.close()
    assert full.kept == b"12345\n1"
    assert [each.partition(" (")[0] for each in troubles] == [
        f"no more logs are kept: [Errno {errno.ENOSPC}] {os.strerror(errno.ENOSPC)}"
    ]
    assert (folder_of(run) / "b.log").read_text() == "more\n"


def test_a_file_that_grows_too_large_begins_anew_and_keeps_what_was_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(logs, "LARGEST", 10)
    run = opened(tmp_path, "a")
    for index in range(6):
        run.line("a", b"line %d\n" % index)
    run.close()
    folder = folder_of(run)
    assert (folder / "a.log.old").read_text() == "line 2\nline 3\n"
    assert (folder / "a.log").read_text() == "line 4\nline 5\n"


SPECIAL = ["launch", "Launch", "con", "NUL.x", "a/b", "a-b", "A-B", "..", "x" * 300]
names = st.text(max_size=5) | st.sampled_from(SPECIAL)


@given(st.lists(names, unique=True, max_size=8))
def test_every_process_has_a_file_of_its_own_on_any_file_system(given_names: list[str]) -> None:
    found = file_names(given_names)
    assert list(found) == given_names
    assert len({each.casefold() for each in [*found.values(), "launch.log"]}) == len(found) + 1
    for each in found.values():
        assert re.fullmatch(r"[A-Za-z0-9_-]{1,110}\.log", each)
        assert each.casefold() not in ("con.log", "nul.log")


@pytest.mark.processes
def test_a_run_that_fails_says_where_its_logs_are(tmp_path: Path) -> None:
    output = io.StringIO()
    run = RunLogs("follow", tmp_path)
    crash = Process("a", [sys.executable, "-c", "print('hi')\nraise SystemExit(3)"])
    assert Supervisor([crash], output=output, logs=run).run() == 3
    assert output.getvalue().splitlines()[-1] == f"[launch] logs: {run.folder}"
    assert (folder_of(run) / "a.log").read_text() == "hi\n"
    told = (folder_of(run) / "launch.log").read_text()
    for words in ("a started, pid ", "a ended with exit code 3", "exit code 3"):
        assert words in told


@pytest.mark.processes
def test_a_run_that_ends_well_says_nothing_of_them(tmp_path: Path) -> None:
    output = io.StringIO()
    assert Supervisor([Process("a", [sys.executable, "-c", ""])], output=output, logs=RunLogs("a", tmp_path)).run() == 0
    assert output.getvalue() == "[launch] a has ended\n"
