"""Log files of a system: a folder for each run, a file for each process, with log rotation.

A folder is called by its time and what was launched (`2026-11-21_14-05-59_follow`), `latest` links to the newest. In
it `launch.log` has the launcher's own lines, with their times, and NAME.log the raw output of a process.
Nobody but the user may read them (on Windows the rights of the folder above count): nodes print what was sent to them.
Old runs are removed; one that goes on is known by a lock on its launch.log.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import sys
import threading
import time
from collections.abc import Callable, Mapping
from io import FileIO
from pathlib import Path
from typing import BinaryIO

from robolink.system import clocks

MOST_RUNS = 30
"""Newest runs whose folders stay, so that nobody has to clear up."""
LARGEST = 50_000_000
"""Size in bytes at which a file is rotated to NAME.log.old: a process has twice as much at most."""
OWN_FILE = "launch.log"
_RUN = re.compile(r"\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d_.*")
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d|launch)", re.IGNORECASE)
"""File names that are devices on Windows, and the launcher's own."""


def logs_home(environ: Mapping[str, str] = os.environ) -> Path:
    """Return the folder of all runs: $ROBOLINK_LOG_DIR, or $ROS_LOG_DIR, or ~/.robolink/log.

    Raises RuntimeError for a user that has no home.
    """
    return Path(environ.get("ROBOLINK_LOG_DIR") or environ.get("ROS_LOG_DIR") or "~/.robolink/log").expanduser()


class RunLogs:
    """Log files of one run; nothing is written before `open`.

    A full disk or a folder that cannot be written ends the logging, never the system: `on_trouble` is called once.

    Args:
        label: Name of what runs, for the folder's name.
        home: Folder of all runs; None is `logs_home()`.
        most: Number of runs that stay; older ones are removed.
    """

    def __init__(self, label: str, home: Path | None = None, *, most: int = MOST_RUNS) -> None:
        self.folder: Path | None = None
        """Folder of this run; None before there is one."""
        self._label = re.sub(r"[^\w.-]+", "-", label, flags=re.ASCII)[:60] or "launch"
        self._home = home
        self._most = most
        self._files: dict[str, _File] = {}
        self._own: _File | None = None
        self._lock = threading.Lock()
        self._on_trouble: Callable[[str], object] = lambda text: None

    def open(self, names: list[str], on_trouble: Callable[[str], object]) -> None:
        """Create the folder and a file for each of the processes `names`; remove old runs.

        `on_trouble` is called with the reason if logs cannot be written.
        """
        self._on_trouble = on_trouble
        try:
            home = self._home or logs_home()
            folder = _new_folder(home, time.strftime(f"%Y-%m-%d_%H-%M-%S_{self._label}"))
            self._own = _File(folder / OWN_FILE)
            _lock(self._own.file)
            self._files = {name: _File(folder / each) for name, each in file_names(names).items()}
            self.folder = folder
        except (OSError, RuntimeError) as error:
            self._give_up(f"no logs are kept: {error}")
            return
        _point_to(folder)
        remove_old_runs(home, self._most)

    def add(self, name: str) -> None:
        """Create the file of one more process, `name`, once the folder is there."""
        if self.folder is None or self._own is None:
            return
        try:
            file = file_names([*self._files, name])[name]
            self._files = {**self._files, name: _File(self.folder / file)}
        except OSError as error:
            self._give_up(f"no more logs are kept: {error} ({self.folder})")

    def line(self, name: str, line: bytes) -> None:
        """Write a `line` of the process `name`; called from one thread for each process."""
        self._write(self._files.get(name), line if line.endswith(b"\n") else line + b"\n")

    def say(self, text: str) -> None:
        """Write `text` as a line of the launcher's own."""
        now = clocks.time_of_day()
        stamp = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(now)) + f".{int(now % 1 * 1000):03}"
        self._write(self._own, f"{stamp} {text}\n".encode(errors="replace"))

    def close(self) -> None:
        """Close the files; later lines are dropped."""
        with self._lock:
            files = [*self._files.values(), *([] if self._own is None else [self._own])]
            self._files, self._own = {}, None
        for file in files:
            file.close()

    def _write(self, file: _File | None, line: bytes) -> None:
        try:
            if file is not None:
                file.write(line)
        except ValueError:  # closed meanwhile
            return
        except OSError as error:
            self._give_up(f"no more logs are kept: {error} ({self.folder})")

    def _give_up(self, text: str) -> None:
        with self._lock:
            tell, self._on_trouble = self._on_trouble, lambda text: None
        self.close()
        tell(text)


class _File:
    """Unbuffered log file that is rotated when it is too large."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._size = 0
        self.file = _private(path)

    def write(self, line: bytes) -> None:
        if self._size > LARGEST:
            self._begin_anew()
        rest = memoryview(line)
        while rest:
            rest = rest[self.file.write(rest) :]
        self._size += len(line)

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self.file.close()

    def _begin_anew(self) -> None:
        self.file.close()
        try:
            self._path.replace(self._path.with_name(f"{self._path.name}.old"))
        except PermissionError:  # on Windows, while somebody reads it: then what was is lost, not what comes
            if sys.platform != "win32":
                raise
        self.file, self._size = _private(self._path), 0


def _private(path: Path) -> FileIO:
    """Open an empty file that only the user may read, without a moment in which others may."""
    return FileIO(path, "w", opener=lambda name, flags: os.open(name, flags, 0o600))


def file_names(names: list[str]) -> dict[str, str]:
    """Return the file name of each process; all differ, from the launcher's too, on any file system."""
    given: dict[str, str] = {}
    taken = {OWN_FILE}
    for name in names:
        stem = re.sub(r"[^\w-]+", "-", name, flags=re.ASCII).strip("-")[:100] or "process"
        stem = f"{stem}_" if _RESERVED.fullmatch(stem) else stem
        chosen, serial = f"{stem}.log", 2
        while chosen.casefold() in taken:
            chosen, serial = f"{stem}_{serial}.log", serial + 1
        given[name] = chosen
        taken.add(chosen.casefold())
    return given


def remove_old_runs(home: Path, most: int) -> None:
    """Remove all but the newest runs; other folders and runs that still go on stay.

    An empty folder is what a launcher leaves that was killed as it made it.
    """
    with contextlib.suppress(OSError):
        runs = sorted(each for each in home.iterdir() if _RUN.fullmatch(each.name) and not each.is_symlink())
        for run in runs[: max(0, len(runs) - most)]:
            if (run / OWN_FILE).is_file() and not _is_locked(run / OWN_FILE):
                shutil.rmtree(run, ignore_errors=True)
            else:
                with contextlib.suppress(OSError):  # no empty one
                    run.rmdir()


def _new_folder(home: Path, name: str) -> Path:
    try:
        home.mkdir(0o700, parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise NotADirectoryError(f"{home} is not a folder: name one by ROBOLINK_LOG_DIR") from None
    for serial in range(1, 1000):
        folder = home / (name if serial == 1 else f"{name}_{serial}")
        with contextlib.suppress(FileExistsError):
            folder.mkdir(0o700)
            return folder
    raise FileExistsError(f"{home / name} is there, and so are a thousand more of this second")


def _point_to(folder: Path) -> None:
    """Link `latest` to a folder, where the system has symbolic links and nothing else has that name."""
    link = folder.parent / "latest"
    unfinished = folder.parent / f".latest-{os.getpid()}"
    if link.exists() and not link.is_symlink():
        return
    with contextlib.suppress(OSError):
        unfinished.symlink_to(folder.name, target_is_directory=True)
        if sys.platform == "win32":  # a link to a folder is a folder there, which nothing can replace
            link.unlink(missing_ok=True)
        unfinished.replace(link)


def _lock(file: BinaryIO) -> None:
    """Lock a file for as long as it is open; on Windows an open file cannot be removed anyway."""
    if sys.platform != "win32":
        import fcntl

        with contextlib.suppress(OSError):  # a file system without locks
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _is_locked(path: Path) -> bool:
    if sys.platform != "win32":
        import fcntl

        try:
            with path.open("rb") as file:
                fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except OSError:
            return True
    return False
