"""Safe reading of regular files, with a size limit: never a FIFO, a device or a socket, which may block for ever.

Every file that is named by a stranger's file (a map's image, an included launch file) is read by this alone.
"""

from __future__ import annotations

import codecs
import errno
import os
import stat
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


def read_plain(path: str | os.PathLike[str], most: int) -> bytes:
    """Read a whole file of at most `most` bytes.

    Raises OSError, whose `strerror` is the reason: also for a file that is not regular, which is not opened, and for
    one that is larger. Raises ValueError for an invalid path.
    """
    _check(Path(path).stat(), path)  # before it is opened, since opening alone makes some devices act
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
