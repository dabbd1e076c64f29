"""Options of compressed bags, and the names of their modes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum


class CompressionMode(IntEnum):
    """Unit of compression: nothing, the whole file once it is closed, or each message."""

    NONE = 0
    FILE = 1
    MESSAGE = 2


@dataclass
class CompressionOptions:
    """Options of a SequentialCompressionWriter.

    Args:
        compression_format: zstd, or '' for none.
        compression_mode: Unit of compression.
        compression_queue_size: Without effect: nothing waits to be compressed.
        compression_threads: Without effect.
        thread_priority: Without effect.
    """

    compression_format: str = ""
    compression_mode: CompressionMode = CompressionMode.NONE
    compression_queue_size: int = 0
    compression_threads: int = 0
    thread_priority: int | None = None


def compression_mode_from_string(compression_mode: str) -> CompressionMode:
    """Return the mode of a name, in any case; NONE for an unknown one, as rosbag2 does."""
    return CompressionMode.__members__.get(compression_mode.upper(), CompressionMode.NONE)


def compression_mode_to_string(compression_mode: CompressionMode) -> str:
    """Return the name of a mode, in capitals."""
    return CompressionMode(compression_mode).name
