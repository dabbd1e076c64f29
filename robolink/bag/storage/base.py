"""Interfaces of a storage: the reader of one file of a bag, and its writer."""

from __future__ import annotations

import abc
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import NamedTuple

from robolink.bag.metadata import BagMetadata
from robolink.bag.topic import BagMessage, BagTopic


class StorageReader(abc.ABC):
    """Reader of one file. Its methods raise BagError for damaged data.

    Args:
        path: The file.
    """

    identifier = ""
    """rosbag2's name of the storage."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.topics: list[BagTopic] = []
        self.message_count = 0
        self.start_time = self.end_time = 0
        """Times of the first and the last message, in nanoseconds since 1970; 0 without messages."""
        self.metadata: BagMetadata | None = None
        """Metadata of the whole bag, where the file has a copy."""
        self.compression = ""
        """Compression of the file's chunks: '', zstd or lz4."""
        self.is_whole = True
        """False for a file whose writer was killed."""

    @property
    def problems(self) -> list[str]:
        """One line for each part that cannot be read, as far as it was tried: what is in there is left out."""
        return []

    @abc.abstractmethod
    def counts(self) -> list[int]:
        """Return the number of messages of each of `topics`; it may read the whole file."""

    @abc.abstractmethod
    def messages(
        self, topics: Collection[str] | None, start: int | None, end: int | None, *, reverse: bool = False
    ) -> Iterator[BagMessage]:
        """Yield messages in the order of their log times.

        Args:
            topics: Names of the topics; None is all.
            start: Earliest log time, in nanoseconds since 1970.
            end: Log time before which messages must be.
            reverse: True for the latest first.
        """

    @abc.abstractmethod
    def close(self) -> None:
        """Close the file."""


class Written(NamedTuple):
    """Messages of a file that is written: number by topic, in the order of `add_topic`, and first and last log time."""

    counts: list[int]
    start_time: int
    end_time: int


class StorageWriter(abc.ABC):
    """Writer of one file."""

    identifier = ""
    """rosbag2's name of the storage."""
    ending = ""
    """Ending of the file's name, with the dot."""
    summary_size = 0
    """Bytes of the index at the file's end, which is written again and again; 0 where there is none."""

    @property
    @abc.abstractmethod
    def size(self) -> int:
        """Bytes that were written so far, for splits."""

    @property
    @abc.abstractmethod
    def written(self) -> Written:
        """Messages that were written so far; times are 0 without any."""

    @abc.abstractmethod
    def add_topic(self, topic: BagTopic) -> int:
        """Add a topic, and return the number by which `write` knows it."""

    @abc.abstractmethod
    def write(self, topic: int, log_time: int, publish_time: int, sequence: int, data: bytes | memoryview) -> None:
        """Write a message of the topic numbered `topic`; times in nanoseconds since 1970."""

    @abc.abstractmethod
    def tick(self) -> None:
        """Do what is due: called often while messages are written."""

    @abc.abstractmethod
    def flush(self) -> None:
        """Make all that was written visible to readers."""

    @abc.abstractmethod
    def close(self, metadata: BagMetadata | None) -> None:
        """Close the file, with a copy of the bag's metadata in it."""
