"""Registry of running launchers: a small file for each, in a folder that only its user can open."""

from __future__ import annotations

import contextlib
import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import msgspec

from robolink.exceptions import RobolinkError
from robolink.system import clocks

LONGEST_FOLDER = 70
"""Longest path of the folder, in characters: a socket's path must stay below 104 on macOS, 108 on Linux."""
_UNFINISHED = 60.0
"""Age in seconds at which an unreadable registration counts as abandoned."""
_BEGIN = "launch-"


class RuntimeFolderError(RobolinkError, OSError):
    """The registry's folder cannot be used; the text names it and the reason."""


class Registration(msgspec.Struct, frozen=True):
    """Registration of a launcher: its identity, its address, and the shared key of the control socket.

    `address` is the path of a socket, or a port of 127.0.0.1. `registered` counts in UNIX seconds.
    """

    pid: int
    name: str
    file: str
    address: str | int
    key: str
    registered: float
    nodes: tuple[str, ...] = ()
    """Full names of the nodes that it starts at once."""
    domain: int = 0
    """Domain of these nodes."""


def runtime_folder() -> Path:
    """Return the folder of this user, created if it is missing. Raises `RuntimeFolderError`.

    It is `robolink` in XDG_RUNTIME_DIR (Windows: LOCALAPPDATA); if that is not this user's, `robolink-UID` in the
    temporary folder, which nobody else may own or open: whoever can read a registration can stop the launcher.
    """
    folder = _place()
    try:
        with contextlib.suppress(FileExistsError):
            folder.mkdir(mode=0o700)
        _check(folder)
    except RuntimeFolderError:
        raise
    except OSError as error:
        raise RuntimeFolderError(f"{folder} cannot be used: {error.strerror or error}") from None
    return folder


def _place() -> Path:
    if sys.platform == "win32":
        given = os.environ.get("LOCALAPPDATA", "")
        return Path(given, "robolink-run") if given else Path(tempfile.gettempdir(), "robolink-run")
    given = os.environ.get("XDG_RUNTIME_DIR", "")
    own = Path(given, "robolink")
    if own.is_absolute() and len(str(own)) <= LONGEST_FOLDER and _is_ours(own.parent):
        return own
    short = [each for each in (tempfile.gettempdir(), "/tmp") if len(each) <= LONGEST_FOLDER - 20]
    return Path(short[0], f"robolink-{os.getuid()}")


def _is_ours(folder: Path) -> bool:
    """True if a folder exists that this user may write: after `su`, XDG_RUNTIME_DIR may still be another user's."""
    if sys.platform == "win32":
        return True
    try:
        return folder.stat().st_uid == os.getuid() and os.access(folder, os.W_OK | os.X_OK)
    except OSError:
        return False


def _check(folder: Path) -> None:
    if sys.platform != "win32":
        found = folder.lstat()
        if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid():
            raise RuntimeFolderError(f"{folder} is not a folder of this user: remove it")
        if found.st_mode & 0o077:
            raise RuntimeFolderError(f"{folder} can be opened by others: chmod 700 it")


def new_place(folder: Path) -> Path:
    """Return an unused path, without suffix, for the registration of this launcher."""
    return folder / f"{_BEGIN}{os.getpid()}-{os.urandom(4).hex()}"


def register(place: Path, registration: Registration) -> None:
    """Write a registration atomically, readable for this user only."""
    unfinished = place.with_suffix(".part")
    descriptor = os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "wb") as file:
        file.write(msgspec.json.encode(registration))
    unfinished.replace(place.with_suffix(".json"))


def files_at(place: Path) -> list[Path]:
    """Return the files that a launcher may leave there, in the order to remove them.

    The registration itself is last: if the removal is interrupted, the next launcher finds it and goes on.
    """
    return [place.with_suffix(suffix) for suffix in (".sock", ".part", ".json")]


def unregister(place: Path) -> None:
    """Remove all files of a registration, as far as they exist."""
    for each in files_at(place):
        with contextlib.suppress(OSError):  # also when somebody has made a folder of it, or closed ours to us
            each.unlink()


def registrations(folder: Path) -> Iterator[tuple[Path, Registration]]:
    """Yield each registration with its place. A launcher may be dead by now: only a connection shows that.

    Files of launchers that were killed before they had registered are removed.
    """
    found = {each.with_suffix("") for each in folder.glob(f"{_BEGIN}*")}
    for place in sorted(found):
        try:
            text = place.with_suffix(".json").read_bytes()
            yield place, msgspec.json.decode(text, type=Registration)
        except (OSError, msgspec.DecodeError, UnicodeDecodeError):
            if not _has_owner(place) or _age(place) > _UNFINISHED:
                unregister(place)


def _has_owner(place: Path) -> bool:
    """True if the process whose id is in the name of a place exists."""
    pid = place.name.removeprefix(_BEGIN).partition("-")[0]
    return pid.isdecimal() and has_process(int(pid))


def _age(place: Path) -> float:
    """Return the age of the newest file there, in seconds; 0 if they have just gone."""
    times = []
    for each in place.parent.glob(f"{place.name}.*"):
        try:
            times.append(each.lstat().st_mtime)
        except OSError:
            continue
    return clocks.time_of_day() - max(times) if times else 0.0


def has_process(pid: int) -> bool:
    """True if there is a process with this id."""
    if sys.platform == "win32":
        import psutil

        return psutil.pid_exists(pid)
    try:
        os.kill(pid, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return True
