"""Zstandard compression, imported late: Python's own from 3.14, `backports.zstd` before."""

from __future__ import annotations

import importlib
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from robolink.bag.topic import BagError

MAGIC = b"\x28\xb5\x2f\xfd"
"""First bytes of compressed data; no CDR message begins so."""
LARGEST = 1 << 30
"""Most bytes of one message: a hostile one of a few kilobytes would unpack to more than the memory has."""
ENDING = ".zstd"
"""Ending that rosbag2 appends to the names of compressed files."""


def compress(data: bytes | memoryview) -> bytes:
    """Return `data` compressed. Raises BagError where there is no zstd."""
    packed: bytes = _module().compress(data, 1)
    return packed


def decompress(data: bytes | memoryview, what: str) -> bytes:
    """Return a message decompressed.

    Raises BagError, naming `what` it is, for damaged data, for more than LARGEST bytes, or where there is no zstd.
    """
    zstd = _module()
    plain, rest = bytearray(), bytes(data)
    try:
        while True:
            frame = zstd.ZstdDecompressor()
            plain += frame.decompress(rest, LARGEST + 1 - len(plain))
            if len(plain) > LARGEST:
                raise BagError(f"{what} cannot be decompressed: it is larger than {LARGEST:,} bytes")
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
        BagError: for damaged data, or if the copy cannot be written.
    """
    zstd = _module()
    try:
        with zstd.open(path, "rb") as packed:
            head = packed.read(16)
            check_head(head)
            with target.open("wb") as plain:
                plain.write(head)
                shutil.copyfileobj(packed, plain, 1 << 20)
    except (zstd.ZstdError, EOFError) as error:
        raise BagError(f"{path} cannot be decompressed: {error}") from None
    except OSError as error:
        reason = error.strerror or error
        raise BagError(f"{path} cannot be decompressed: {reason} (into {target.parent})") from None


def _module() -> Any:
    try:
        return importlib.import_module("compression.zstd" if sys.version_info >= (3, 14) else "backports.zstd")
    except ImportError:
        raise BagError("zstd is not installed here: pip install backports.zstd") from None
