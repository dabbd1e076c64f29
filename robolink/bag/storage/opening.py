"""Choice of a storage: by the first bytes of a file for reading, by its name for writing."""

from __future__ import annotations

import tempfile
from pathlib import Path

from robolink.bag import zstd
from robolink.bag.metadata import BagMetadata
from robolink.bag.storage import mcap_file, sqlite
from robolink.bag.storage.base import StorageReader, StorageWriter
from robolink.bag.topic import BagError
from robolink.exceptions import nearest
from robolink.system.terminal import shown

STORAGES = {"mcap": ".mcap", "sqlite3": ".db3"}
"""rosbag2's names of the storages, each with the ending of its files."""
ENDINGS = (*STORAGES.values(), *(each + zstd.ENDING for each in STORAGES.values()))
"""Endings of the names of files that a bag can have."""

_ROS_1 = b"#ROSBAG"


def storage_reader(path: Path, scratch: Path | None = None) -> StorageReader:
    """Open a file of a bag, whatever its name.

    Args:
        path: The file.
        scratch: Folder for the decompressed copy of a file that is compressed as a whole.

    Raises:
        BagError: for a file that is missing, empty, damaged, or of another format.
    """
    head = _head(path)
    if head.startswith(mcap_file.MAGIC):
        return mcap_file.McapReader(path)
    if head.startswith(sqlite.MAGIC):
        return sqlite.SqliteReader(path)
    if head.startswith(zstd.MAGIC) and scratch is not None:
        return _unpacked(path, Path(tempfile.mkdtemp(dir=scratch)) / path.name.removesuffix(zstd.ENDING))
    raise BagError(f"{path} {_what_else(head)}")


def _unpacked(path: Path, target: Path) -> StorageReader:
    """Open the decompressed copy of a file; errors name the file itself."""

    def check(head: bytes) -> None:
        if not head.startswith((mcap_file.MAGIC, sqlite.MAGIC)):
            raise BagError(f"{path} {_what_else(head)}")

    zstd.decompress_file(path, target, check)
    try:
        reader = storage_reader(target)
    except BagError as error:
        raise BagError(str(error).replace(str(target), str(path))) from None
    reader.path = path
    return reader


def storage_writer(path: Path, storage: str, compression: str, metadata: BagMetadata) -> StorageWriter:
    """Create a file of a bag.

    Args:
        path: The file, which must not exist.
        storage: mcap or sqlite3.
        compression: Compression of chunks within the file, which MCAP alone has: '', zstd or lz4.
        metadata: Metadata of the bag when the file begins.

    Raises:
        BagError: for an unknown storage.
        OSError: if the file cannot be made.
    """
    check_storage(storage)
    if storage == "mcap":
        return mcap_file.McapWriter(path, compression, metadata)
    return sqlite.SqliteWriter(path)


def check_storage(storage: str) -> None:
    """Raise BagError for a storage that there is not."""
    if storage not in STORAGES:
        raise BagError(f"no storage named '{shown(storage)}'{nearest(storage, STORAGES)}: there are mcap and sqlite3")


def _head(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            return file.read(16)
    except FileNotFoundError:
        raise BagError(f"no file '{path}'") from None
    except OSError as error:
        raise BagError(f"{path} cannot be read: {error.strerror}") from None


def _what_else(head: bytes) -> str:
    if not head:
        return "is empty: nothing was written to it, or the disk was full"
    if head.startswith(_ROS_1):
        return "is a bag of ROS 1: rosbags-convert (pip install rosbags) makes one of ROS 2 from it"
    if not any(head):
        return "begins with zeros: its disk lost power, or it was never copied as a whole"
    return "is neither an MCAP file nor a sqlite3 database"
