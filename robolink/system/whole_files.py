"""Atomic writes of small files: each is there as a whole or not at all, also on a full disk and after a kill."""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import sys
import time
from collections.abc import Iterator
from pathlib import Path

_TRIES = 25
_PAUSE = 0.02
"""Seconds between two tries to replace a file that somebody has open."""


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
