"""Zstandard compression, imported late: Python's own from 3.14, `backports.zstd` before."""

from __future__ import annotations

import importlib
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from robolink.bag.limits import most_of_file, most_of_piece
from robolink.bag.topic import BagError

MAGIC = b"\x28\xb5\x2f\xfd"
"""First bytes of compressed data; no CDR message begins so."""
ENDING = ".zstd"
"""Ending that rosbag2 appends to the names of compressed files."""


def compress(data: bytes | memoryview) -> bytes:
    """Return `data` compressed. Raises BagError where there is no zstd."""
    packed: bytes = _module().compress(data, 1)
    return packed


def decompress(data: bytes | memoryview, what: str) -> bytes:
    """Return a message decompressed.

    Raises BagError, naming `what` it is, for damaged data, for more bytes than its size is good for, or where there is
    no zstd.
    """
    zstd = _module()
    plain, rest = bytearray(), bytes(data)
    most = most_of_piece(len(rest))
    try:
        while True:
            frame = zstd.ZstdDecompressor()
            plain += frame.decompress(rest, most + 1 - len(plain))
            if len(plain) > most:
                raise BagError(f"{what} cannot be decompressed: it is more than {most:,} bytes")
            if not frame.eof:
                raise BagError(f"{what} cannot be decompressed: its end is missing")
            rest = frame.unused_data
            if not rest:
                break
    except (zstd.ZstdError, MemoryError) as error:
        raise BagError(f"{what} cannot be decompressed: {error}") from None
    return bytes(plain)


def check() -> None:
    """Raise BagError where there is no zstd."""
    _module()


def compress_file(path: Path) -> Path:
    """Replace a file by its compressed copy, whose name ends in `.zstd`, and return that."""
    target = path.with_name(path.name + ENDING)
    partial = target.with_name(f".{target.name}.partial")
    with path.open("rb") as plain, _module().open(partial, "wb", level=1) as packed:
        shutil.copyfileobj(plain, packed, 1 << 20)
    partial.replace(target)
    path.unlink()
    return target


def decompress_file(path: Path, target: Path, check_head: Callable[[bytes], object]) -> None:
    """Write the decompressed content of a file to another.

    Args:
        path: The compressed file.
        target: File to make.
        check_head: Called with the first bytes, before the rest is unpacked: it raises for what is not wanted.

    Raises:
        BagError: for damaged data, for more than its size is good for or the disk has room for, or if the copy cannot
            be written.
    """
    zstd = _module()
    most = most_of_file(path.stat().st_size)
    try:
        with zstd.open(path, "rb") as packed:
            head = packed.read(16)
            check_head(head)
            with target.open("wb") as plain:
                plain.write(head)
                room = shutil.disk_usage(target.parent).free // 2
                words = "are unpacked of such a file" if most <= room else "have room here"
                refusal = f"{path} cannot be decompressed: {min(most, room):,} bytes at most {words}"
                shutil.copyfileobj(_Limited(packed, min(most, room) - len(head), refusal), plain, 1 << 20)
    except (zstd.ZstdError, EOFError) as error:
        raise BagError(f"{path} cannot be decompressed: {error}") from None
    except OSError as error:
        reason = error.strerror or error
        raise BagError(f"{path} cannot be decompressed: {reason} (into {target.parent})") from None


class _Limited:
    """File that is read up to a limit; `refusal` is the text of the BagError beyond it."""

    def __init__(self, file: Any, left: int, refusal: str) -> None:
        self._file, self._left, self._refusal = file, left, refusal

    def read(self, size: int = -1, /) -> bytes:
        """Return the next bytes. Raises BagError beyond the limit."""
        part: bytes = self._file.read(size)
        self._left -= len(part)
        if self._left < 0:
            raise BagError(self._refusal)
        return part


def _module() -> Any:
    try:
        return importlib.import_module("compression.zstd" if sys.version_info >= (3, 14) else "backports.zstd")
    except ImportError:
        raise BagError("zstd is not installed here: pip install backports.zstd") from None
