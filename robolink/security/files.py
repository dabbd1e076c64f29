"""Files of a keystore: keys that only their owner reads, whole at every moment, and links that Windows copies."""

from __future__ import annotations

import contextlib
import functools
import os
import stat
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from robolink.exceptions import SecurityError
from robolink.system.files import put_in_place, read_plain

LARGEST = 1_000_000
"""Largest file of a keystore that is read, in bytes."""

PRIVATE, PUBLIC = 0o600, 0o644
"""Modes of keys, and of everything else."""


def write(path: Path, content: bytes, mode: int = PUBLIC) -> None:
    """Write a file under another name, with its mode from the first byte on, and put it in place.

    On Windows modes say nothing: a file is as private there as the folder that it is in.
    """
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    with contextlib.suppress(FileNotFoundError):
        draft.unlink()
    number = os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), mode)
    try:
        with os.fdopen(number, "wb") as file:
            file.write(content)
        put_in_place(draft, path)
    except BaseException:
        with contextlib.suppress(OSError):
            draft.unlink()
        raise


@contextlib.contextmanager
def alone(folder: Path) -> Iterator[None]:
    """Keep other commands out of a folder that is there, while a `with` lasts; they wait for their turn."""
    if sys.platform == "win32":  # a file that is gone once nobody has it open: a folder has no lock there
        import msvcrt

        number = os.open(folder / ".lock", os.O_RDWR | os.O_CREAT | os.O_TEMPORARY)
        lock = functools.partial(msvcrt.locking, number, msvcrt.LK_LOCK, 1)  # gives up after 10 s
    else:
        import fcntl

        number = os.open(folder, os.O_RDONLY)
        lock = functools.partial(fcntl.flock, number, fcntl.LOCK_EX)
    try:
        with contextlib.suppress(OSError):  # a file system without locks
            lock()
        yield
    finally:
        os.close(number)


def make_folder(path: Path, mode: int = 0o755) -> None:
    """Make a folder and those above it; the mode is its own."""
    path.mkdir(parents=True, exist_ok=True)
    if sys.platform != "win32":
        path.chmod(mode)


def link(target: Path, path: Path) -> None:
    """Make `path` a link to `target`, relative to it, as in SROS2's keystores; where there are no links, a copy.

    A file that is its own target stays: such are those of the enclave `/`.
    """
    if path == target:
        return
    if path.is_symlink() or path.exists():
        path.unlink()
    try:
        path.symlink_to(os.path.relpath(target, path.parent))
    except OSError:  # Windows: links need a right that few users have
        import shutil  # late: 15 ms of each session's start

        shutil.copyfile(target, path)


def read(path: Path) -> bytes:
    """Return the content of a file of a keystore; raises SecurityError that names the file and the reason."""
    try:
        return read_plain(path, LARGEST)
    except (OSError, ValueError) as error:
        why = "is not there" if isinstance(error, FileNotFoundError) else f"cannot be read: {_reason(error)}"
        raise SecurityError(f"{path} {why}") from None


def exposure(path: Path) -> str:
    """Return the others who may read or change a key, and the remedy; '' where nobody may. Windows cannot say."""
    if sys.platform == "win32":
        return ""
    try:
        found = path.stat()
    except OSError:
        return ""
    if not found.st_mode & (stat.S_IRWXG | stat.S_IRWXO):
        return ""
    return f"{path} may be read or changed by others (mode {stat.S_IMODE(found.st_mode):04o}): chmod 600 {path}"


def changeable(paths: Iterable[Path]) -> list[Path]:
    """Return those files and folders that others than their owner may change. Windows cannot say: none.

    A group is the owner's own if it has its name, as users of Debian and Ubuntu have. In a folder with the sticky bit
    others may make files, but replace none.
    """
    return [] if sys.platform == "win32" else [path for path in paths if _is_changeable(path)]


def _is_changeable(path: Path) -> bool:
    try:
        found = path.stat()
    except OSError:
        return False
    if stat.S_ISDIR(found.st_mode) and found.st_mode & stat.S_ISVTX:
        return False
    by_group = found.st_mode & stat.S_IWGRP and not _is_own_group(found.st_uid, found.st_gid)
    return bool(found.st_mode & stat.S_IWOTH or by_group)


@functools.cache
def _is_own_group(user: int, group: int) -> bool:
    """True if a group is that of one user alone."""
    if sys.platform == "win32":
        return False
    import grp  # late: neither is on Windows
    import pwd

    try:
        name, found = pwd.getpwuid(user).pw_name, grp.getgrgid(group)
    except KeyError:
        return False
    return found.gr_name == name and not {*found.gr_mem} - {name}


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
