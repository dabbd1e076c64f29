"""Files: safe reads of regular ones with a size limit, atomic writes of small ones, and paths as users write them.

A FIFO, a device or a socket may block for ever and is never read. Every file that is named by a stranger's file (an
included launch file, a map's image) is read by `read_plain` alone.
"""

from __future__ import annotations

import codecs
import contextlib
import errno
import os
import stat
import sys
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

_KINDS = {
    stat.S_IFIFO: "a FIFO",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFDIR: "a folder",
}
_FLAGS = os.O_RDONLY | getattr(os, "O_BINARY", 0) | getattr(os, "O_NOCTTY", 0) | getattr(os, "O_NONBLOCK", 0)
"""Flags of `os.open`. O_NONBLOCK: a FIFO that replaces the file after the check would block. Windows has none of it."""
LONGEST_SOURCE = 10_000_000
"""Largest Python file that is run, in bytes."""
_TRIES = 25
_PAUSE = 0.02
"""Seconds between two tries to replace a file that somebody has open."""


# Paths


def expanded(path: str | os.PathLike[str]) -> Path:
    """Return a path with `~` replaced by the home folder; as it is where that is not known, as for `~nobody-here`."""
    from pathlib import Path  # late: it takes a node's start 3 ms

    try:
        return Path(path).expanduser()
    except RuntimeError:
        return Path(path)


def is_file(path: Path) -> bool:
    """True if there is such a file, and this user may know of it; `Path.is_file` raises where that is not so."""
    try:
        return path.is_file()
    except (OSError, ValueError):  # a folder that may not be entered; a name that is too long, or none at all
        return False


# Reading


def read_plain(path: str | os.PathLike[str], most: int) -> bytes:
    """Read a whole file of at most `most` bytes.

    Raises OSError, whose `strerror` is the reason: also for a file that is not regular, which is not opened, and for
    one that is larger. Raises ValueError for an invalid path.
    """
    _check(os.stat(path), path)  # noqa: PTH116 - before it is opened, since opening alone makes some devices act
    with os.fdopen(os.open(path, _FLAGS), "rb", buffering=0) as file:
        found = os.fstat(file.fileno())
        _check(found, path)
        parts, left = [], most + 1 if found.st_size <= most else 0
        # Until the end: files of /proc say that they have 0 bytes, and others may grow meanwhile.
        while left > 0 and (part := os.read(file.fileno(), min(left, 2**20))):
            parts.append(part)
            left -= len(part)
    if left <= 0:
        raise OSError(errno.EFBIG, f"it is longer than {size(most)}", os.fspath(path))
    return b"".join(parts)


def decoded(raw: bytes, errors: str = "strict") -> str:
    """Decode the text of a file: UTF-8 with or without a byte order mark, or UTF-16 with one, as PowerShell writes it.

    Raises UnicodeDecodeError, unless `errors` says otherwise.
    """
    return raw.decode("utf-16" if raw[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE) else "utf-8-sig", errors)


def _check(found: os.stat_result, path: str | os.PathLike[str]) -> None:
    if not stat.S_ISREG(found.st_mode):
        kind = _KINDS.get(stat.S_IFMT(found.st_mode), "something else")
        raise OSError(errno.EINVAL, f"it is {kind}, and no file", os.fspath(path))


def size(count: int) -> str:
    """Format a number of bytes.

    >>> size(5_000_000), size(20_000)
    ('5 MB', '20 kB')
    """
    return f"{count / 1e6:g} MB" if count >= 1e6 else f"{count / 1e3:g} kB"


# Writing


def put_in_place(source: Path, target: Path) -> None:
    """Rename a file over another.

    On Windows that fails while somebody reads the other, a virus scanner say: it is tried for half a second.

    Raises:
        OSError: if it fails for good; both files are as they were then.
    """
    for _ in range(_TRIES if sys.platform == "win32" else 0):
        try:
            source.replace(target)
        except PermissionError:
            time.sleep(_PAUSE)
        else:
            return
    source.replace(target)


def write_whole(path: Path, data: bytes) -> None:
    """Write a file, in the place of one that is there. Raises OSError; what was there then stays as it was."""
    with _beside(path, data) as new:
        put_in_place(new, path)


def write_new(path: Path, data: bytes) -> None:
    """Write a file that is not there yet.

    Raises:
        FileExistsError: if something has its name, be it a link that leads nowhere.
        OSError: if it cannot be written; then it is not there.
    """
    with _beside(path, data) as new:
        if os.path.lexists(path):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(path))
        new.rename(path)


@contextlib.contextmanager
def _beside(path: Path, data: bytes) -> Iterator[Path]:
    """Write a file beside another for the block, which moves it; it is removed if it is there after that."""
    import secrets  # it takes a millisecond, and few processes write files

    new = path.with_name(f".{secrets.token_hex(8)}.new")  # short: the other's name may be as long as names can be
    try:
        new.write_bytes(data)
        yield new
    except OSError as error:
        error.filename, error.filename2 = str(path), None  # the name that one knows
        raise
    finally:
        with contextlib.suppress(OSError):
            new.unlink(missing_ok=True)
