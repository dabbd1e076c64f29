"""Sequential writers of bags: topics are created, then messages written to them."""

from __future__ import annotations

import weakref
from collections import deque
from pathlib import Path

from robolink.bag.storage.opening import STORAGES
from robolink.bag.storage_options import chunk_compression
from robolink.bag.topic import BagError
from robolink.bag.writer import BagWriter
from robolink.companions.rosbag2_py._compression_options import CompressionMode, CompressionOptions
from robolink.companions.rosbag2_py._message_definitions import described
from robolink.companions.rosbag2_py._storage import (
    ConverterOptions,
    MessageDefinition,
    StorageOptions,
    TopicMetadata,
    get_default_storage_id,
    topic_of,
)
from robolink.utilities import get_default_context

TICK_EVERY = 16
"""Messages between two looks at what is due."""
CACHE_SIZE = 100 * 1024 * 1024
"""Default size of a snapshot, in bytes."""


class SequentialWriter:
    """Writer of a bag. It ends with `close`, with the object, or with the program.

        writer = SequentialWriter()
        writer.open(StorageOptions("walk", "mcap"), ConverterOptions("", ""))
        writer.create_topic(TopicMetadata(0, "/chatter", "std_msgs/msg/String", "cdr"))
        writer.write("/chatter", serialize_message(String(data="hello")), clock.now().nanoseconds)

    Errors are BagErrors, which are RuntimeErrors.
    """

    def __init__(self) -> None:
        self._options: CompressionOptions | None = None
        self._writer: BagWriter | None = None
        self._numbers: dict[str, int] = {}
        self._snapshot: deque[tuple[str, bytes, int, int]] | None = None
        self._cached, self._cache_size, self._written = 0, CACHE_SIZE, 0

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions | None = None) -> None:
        """Make a bag. Raises BagError if its folder is there already, or for another serialization than cdr."""
        formats = converter_options or ConverterOptions()
        if {formats.input_serialization_format, formats.output_serialization_format} - {"", "cdr"}:
            raise BagError("messages of bags are cdr here: no other serialization can be converted")
        self.close()
        packing = self._options or CompressionOptions()
        mode = "" if packing.compression_mode == CompressionMode.NONE else packing.compression_mode.name.lower()
        profile, config = storage_options.storage_preset_profile, storage_options.storage_config_uri
        self._writer = BagWriter(
            Path(storage_options.uri).absolute(),  # the working directory may be another one when it is closed
            storage=storage_options.storage_id or get_default_storage_id(),
            compression=packing.compression_format if mode else chunk_compression(profile, config),
            compression_mode=mode,
            max_size=storage_options.max_bagfile_size,
            max_duration=storage_options.max_bagfile_duration,
            custom_data=storage_options.custom_data,
        )
        self._snapshot = deque() if storage_options.snapshot_mode else None
        self._cache_size = storage_options.max_cache_size or CACHE_SIZE
        self._numbers = {}
        get_default_context().on_shutdown(self._show)
        weakref.finalize(self, self._writer.close)  # most programs never close it: rosbag2's does so by itself, too

    def create_topic(self, topic_with_type: TopicMetadata, message_definition: MessageDefinition | None = None) -> None:
        """Add a topic. The definition of its type is found out if it is known here."""
        topic = topic_of(topic_with_type)
        if message_definition is None:
            topic = described(topic)
        else:
            topic = topic._replace(
                message_definition=message_definition.encoded_message_definition,
                definition_encoding=message_definition.encoding or "ros2msg",
                type_hash=topic.type_hash or message_definition.type_hash,
            )
        self._numbers[topic.name] = self._opened().add_topic(topic)

    def remove_topic(self, topic_with_type: TopicMetadata) -> None:
        """Refuse further messages of a topic."""
        self._numbers.pop(topic_with_type.name, None)

    def write(self, topic_name: str, message: bytes, time_stamp: int, send_timestamp: int | None = None) -> None:
        """Write a message.

        Args:
            topic_name: Its topic, which `create_topic` has added.
            message: The serialized message.
            time_stamp: Time at which it was received, in nanoseconds since 1970.
            send_timestamp: Time at which it was sent; the same if it is left out.

        Raises:
            BagError: if the writer is not open, or the topic not created.
        """
        writer = self._opened()
        if topic_name not in self._numbers:
            raise BagError(f"Failed to write on topic '{topic_name}'. Call create_topic() before first write.")
        sent = time_stamp if send_timestamp is None else send_timestamp
        if self._snapshot is not None:
            self._cache(self._snapshot, (topic_name, bytes(message), time_stamp, sent))
            return
        writer.write(self._numbers[topic_name], time_stamp, sent, 0, bytes(message))
        self._written += 1
        if self._written % TICK_EVERY == 0:
            writer.tick()

    def take_snapshot(self) -> bool:
        """Write what is in the cache, in snapshot mode; return whether there was anything."""
        writer = self._opened()
        if not self._snapshot:
            return False
        for topic, data, received, sent in self._snapshot:
            writer.write(self._numbers[topic], received, sent, 0, data)
        self._snapshot.clear()
        self._cached = 0
        writer.flush()
        return True

    def split_bagfile(self) -> None:
        """Begin the next file."""
        self._opened().split()

    def close(self) -> None:
        """Close the bag."""
        writer, self._writer = self._writer, None
        if writer is not None:
            writer.close()

    def _show(self) -> None:
        """Show readers all that was written: of a program in virtual time little more ends than its context."""
        if self._writer is not None:
            self._writer.flush()

    def _opened(self) -> BagWriter:
        if self._writer is None:
            raise BagError("Bag is not open. Call open() before writing.")
        return self._writer

    def _cache(self, cache: deque[tuple[str, bytes, int, int]], message: tuple[str, bytes, int, int]) -> None:
        cache.append(message)
        self._cached += len(message[1])
        while self._cached > self._cache_size:
            self._cached -= len(cache.popleft()[1])


class SequentialCompressionWriter(SequentialWriter):
    """Writer of a bag that is compressed by file or by message.

    Args:
        compression_options: How it is compressed; zstd by file unless they say otherwise.
    """

    def __init__(self, compression_options: CompressionOptions | None = None) -> None:
        super().__init__()
        self._options = compression_options or CompressionOptions("zstd", CompressionMode.FILE)


def get_registered_writers() -> set[str]:
    """Return the names of the storages that can be written."""
    return set(STORAGES)


def get_registered_compressors() -> set[str]:
    """Return the names of the compressions by file and by message."""
    return {"zstd"}


def get_registered_serializers() -> set[str]:
    """Return the names of the serialization formats."""
    return {"cdr"}
