"""Where running launchers leave word of themselves: a small file for each, in a folder that only its user can open."""

from __future__ import annotations

import contextlib
import os
import stat
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import msgspec

from robolink.exceptions import RobolinkError

LONGEST_FOLDER = 70
"""Characters; the path of a socket must stay below 104 on macOS, 108 on Linux."""
_UNFINISHED = 60.0
"""Seconds after which what is no readable registration is nobody's any more."""
_BEGIN = "launch-"


class RuntimeFolderError(RobolinkError, OSError):
    """The folder in which launchers leave word cannot be used; the text names it and says why."""


class Registration(msgspec.Struct, frozen=True):
    """What a launcher leaves word of: who it is, where it listens, and the key with which both sides prove themselves.

    `address` is the path of a socket, or a port of 127.0.0.1. `registered` counts in UNIX seconds.
    """

    pid: int
    name: str
    file: str
    address: str | int
    key: str
    registered: float


def runtime_folder() -> Path:
    """Give the folder of this user, made if it is not there. Raises `RuntimeFolderError`.

    `robolink` in XDG_RUNTIME_DIR (Windows: LOCALAPPDATA); where that is none of ours, `robolink-UID` in the temporary
    folder, which nobody else may own or open: whoever can read a registration can stop the launcher.
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
    """Whether a folder is there that is ours to write: after `su`, XDG_RUNTIME_DIR may still be another user's."""
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
            raise RuntimeFolderError(f"{folder} is no folder of this user: remove it")
        if found.st_mode & 0o077:
            raise RuntimeFolderError(f"{folder} can be opened by others: chmod 700 it")


def new_place(folder: Path) -> Path:
    """Give the path, without its suffix, at which this launcher leaves word: no other has used it."""
    return folder / f"{_BEGIN}{os.getpid()}-{os.urandom(4).hex()}"


def register(place: Path, registration: Registration) -> None:
    """Leave word at once and whole, for this user alone."""
    unfinished = place.with_suffix(".part")
    descriptor = os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "wb") as file:
        file.write(msgspec.json.encode(registration))
    unfinished.replace(place.with_suffix(".json"))


def files_at(place: Path) -> list[Path]:
    """Give the files that a launcher may leave there, in the order to remove them.

    The word itself is last: whoever is killed on the way leaves what the next launcher finds, and clears.
    """
    return [place.with_suffix(suffix) for suffix in (".sock", ".part", ".json")]


def unregister(place: Path) -> None:
    """Remove all that was left there; what is gone already is gone."""
    for each in files_at(place):
        with contextlib.suppress(OSError):  # also when somebody has made a folder of it, or closed ours to us
            each.unlink()


def registrations(folder: Path) -> Iterator[tuple[Path, Registration]]:
    """Give each launcher that has left word, with its place: whether it still runs only asking it can tell.

    What those have left behind who were killed before they had left word is cleared.
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
    """Whether there is a process of the number that stands in a place's name."""
    pid = place.name.removeprefix(_BEGIN).partition("-")[0]
    return pid.isdecimal() and has_process(int(pid))


def _age(place: Path) -> float:
    """Give the seconds since the youngest file was written there; 0 when they have just gone."""
    times = []
    for each in place.parent.glob(f"{place.name}.*"):
        try:
            times.append(each.lstat().st_mtime)
        except OSError:
            continue
    return time.time() - max(times) if times else 0.0


def has_process(pid: int) -> bool:
    """Whether there is a process of this number."""
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
