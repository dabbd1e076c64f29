"""Compression of chunks: zstd and LZ4 frames, by packages that are imported when a file needs them."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable
from typing import Any

from robolink.bag.limits import refusal_of_piece
from robolink.bag.mcap.records import Buffer, Malformed, McapError

COMPRESSIONS = ("", "zstd", "lz4")
"""Names of MCAP's compressions; '' is none."""
LEVEL = 1
"""Level of zstd: the fastest of the usual ones, since a recorder shares the computer with a robot's programs."""
MODULES = {"zstd": ("compression.zstd", "backports.zstd"), "lz4": ("lz4.frame",)}
"""Modules that can, the first that is there: Python has zstd itself from 3.14 on."""
LARGEST_PART = 64 << 20
"""Most that is unpacked of a chunk without an end, in bytes."""


class MissingCompressionError(McapError):
    """A compression whose package is not installed."""


@functools.cache
def _module(name: str) -> Any:
    for each in MODULES[name]:
        try:
            return importlib.import_module(each)
        except ImportError:
            continue
    package = MODULES[name][-1].removesuffix(".frame")
    raise MissingCompressionError(f"compression '{name}' needs a package that is not here: pip install {package}")


def compressor(name: str) -> Callable[[bytes], bytes]:
    """Return the function that packs a chunk's data.

    Raises McapError for a name that is none of MCAP's, and MissingCompressionError.
    """
    if name not in COMPRESSIONS:
        raise McapError(f"no compression '{name}': MCAP has zstd and lz4, and '' for none")
    if not name:
        return bytes
    module = _module(name)
    compress: Callable[..., bytes] = module.compress
    return functools.partial(compress, level=LEVEL) if name == "zstd" else compress


def unpack(name: str, packed: Buffer, size: int) -> Buffer:
    """Return a chunk's data, which is `size` bytes.

    Raises Malformed if it is not, or claims more than its packed size is good for, and MissingCompressionError.
    """
    if reason := refusal_of_piece(len(packed), size):
        raise Malformed(reason)
    found: Buffer
    if not name:
        found = packed
    elif name == "zstd":
        found = _decompressed(_module(name).ZstdDecompressor(), packed, size)
    elif name == "lz4":
        found = _decompressed(_module(name).LZ4FrameDecompressor(), packed, size)
    else:
        raise Malformed(f"its compression is '{name}', which MCAP does not have")
    if len(found) != size:
        raise Malformed(f"it unpacks to {len(found)} bytes instead of {size}")
    return found


def unpack_partly(name: str, packed: bytes) -> bytes:
    """Return what there is of a chunk's data whose end is missing. Raises MissingCompressionError."""
    if name == "zstd":
        decompressor = _module(name).ZstdDecompressor()
    elif name == "lz4":
        decompressor = _module(name).LZ4FrameDecompressor()
    else:
        return b"" if name else packed
    try:
        return _decompressed(decompressor, packed, LARGEST_PART)
    except Malformed:
        return b""


def _decompressed(decompressor: Any, packed: Buffer, size: int) -> bytes:
    """Unpack at most one byte more than there should be, so that a hostile file fills no memory."""
    try:
        found: bytes = decompressor.decompress(packed, size + 1)
    except Exception as error:  # noqa: BLE001 - each package has errors of its own
        raise Malformed(f"it does not unpack ({error})") from None
    return found
