"""Readers and writers of bags, and what is known of a bag without reading it."""

from __future__ import annotations

import re
import sys
import weakref
from collections import deque
from collections.abc import Iterator
from pathlib import Path

from robolink.bag.converting import reindex
from robolink.bag.information import SORTS, details_of, info_text, topic_names
from robolink.bag.output_options import chunk_compression
from robolink.bag.reader import Bag, open_bag
from robolink.bag.selection import SERVICE_EVENT
from robolink.bag.storage.opening import STORAGES
from robolink.bag.topic import BagError, BagMessage, BagTopic, message_definition
from robolink.bag.writer import BagWriter
from robolink.companions.rosbag2_py._storage import (
    BagMetadata,
    CompressionMode,
    CompressionOptions,
    ConverterOptions,
    MessageDefinition,
    ReadOrder,
    ReadOrderSortBy,
    StorageFilter,
    StorageOptions,
    TopicMetadata,
    get_default_storage_id,
    metadata_from,
    metadata_to,
    topic_of,
    topics_to,
)
from robolink.companions.rosidl_runtime import get_message
from robolink.exceptions import RobolinkError
from robolink.message import type_hash
from robolink.utilities import get_default_context


def described(topic: BagTopic) -> BagTopic:
    """Return a topic with the definition and the hash of its type, if it is known here."""
    try:
        cls = get_message(topic.type_name)
        text, hash_ = message_definition(cls), topic.type_hash or type_hash(cls)
    except (RobolinkError, ImportError, AttributeError, ValueError):  # what get_message raises for an unknown type
        return topic
    return topic._replace(message_definition=text, type_hash=hash_)


class SequentialReader:
    """Reader of a bag, from its first message to its last.

        reader = SequentialReader()
        reader.open(StorageOptions("walk"), ConverterOptions())
        while reader.has_next():
            topic, data, stamp = reader.read_next()

    It reads compressed bags, too. Errors are BagErrors, which are RuntimeErrors.
    """

    def __init__(self) -> None:
        self._bag: Bag | None = None
        self._filter = StorageFilter()
        self._order = ReadOrder()
        self._first: int | None = None
        self._last: int | None = None
        self._position: int | None = None
        self._done: list[BagMessage] = []
        self._messages: Iterator[BagMessage] = iter(())
        self._next: BagMessage | None = None

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions | None = None) -> None:
        """Open a bag. Raises BagError if there is none, or if the program wants another serialization than cdr."""
        requested = converter_options.output_serialization_format if converter_options else ""
        if requested not in {"", "cdr"}:
            raise BagError(f"messages of bags are cdr here, not '{requested}'")
        self.close()
        self._bag = open_bag(Path(storage_options.uri))
        weakref.finalize(self, self._bag.close)  # rosbag2's reader has no `close`
        self._first = storage_options.start_time_ns if storage_options.start_time_ns >= 0 else None
        self._last = storage_options.end_time_ns if storage_options.end_time_ns >= 0 else None
        self._filter, self._order = StorageFilter(), ReadOrder()
        self._begin(None)

    def open_uri(self, uri: str) -> None:
        """Open a bag by its path."""
        self.open(StorageOptions(uri))

    def close(self) -> None:
        """Close the bag."""
        if self._bag is not None:
            self._bag.close()
        self._bag, self._next, self._messages = None, None, iter(())

    def set_read_order(self, read_order: ReadOrder) -> bool:
        """Set the order, and begin at its first message; False for times of publishing, which rosbag2 lacks, too."""
        if read_order.sort_by == ReadOrderSortBy.PublishedTimestamp:
            return False
        self._opened()
        self._order = read_order
        self._begin(None)
        return True

    def has_next(self) -> bool:
        """Return whether there is one more message."""
        self._opened()
        return self._next is not None

    def read_next(self) -> tuple[str, bytes, int]:
        """Return topic, serialized message and time of reception in nanoseconds. Raises BagError at the end."""
        self._opened()
        message = self._next
        if message is None:
            raise BagError("Bag is at end. No next message.")
        if message.log_time != self._position:
            self._position, self._done = message.log_time, []
        self._done.append(message)
        self._next = next(self._messages, None)
        return message.topic, bytes(message.data), message.log_time

    def get_metadata(self) -> BagMetadata:
        """Return the metadata of the bag."""
        return metadata_to(self._opened().metadata)

    def get_all_topics_and_types(self) -> list[TopicMetadata]:
        """Return the topics of the bag."""
        return topics_to(self._opened().topics)

    def get_all_message_definitions(self) -> list[MessageDefinition]:
        """Return the definitions of the types that the bag has, one for each type."""
        found = {
            each.type_name: MessageDefinition(
                each.type_name, each.definition_encoding, each.message_definition, each.type_hash
            )
            for each in self._opened().topics
        }
        return list(found.values())

    def set_filter(self, storage_filter: StorageFilter) -> None:
        """Go on with some topics only. Raises BagError for an expression that is none."""
        self._opened()
        for text in _regexes(storage_filter):
            try:
                re.compile(text)
            except re.error as error:
                raise BagError(f"'{text[:100]}' is not a regular expression: {error}") from None
        self._filter = storage_filter
        self._begin(self._position, self._done)

    def reset_filter(self) -> None:
        """Go on with all topics."""
        self.set_filter(StorageFilter())

    def seek(self, timestamp: int) -> None:
        """Go to a time, in nanoseconds since 1970; the filter stays."""
        self._opened()
        self._begin(timestamp)

    def _opened(self) -> Bag:
        if self._bag is None:
            raise BagError("Bag is not open. Call open() before reading.")
        return self._bag

    def _begin(self, position: int | None, done: list[BagMessage] | None = None) -> None:
        """Begin at a time, without the messages of that very time which are `done`."""
        bag, reverse = self._opened(), self._order.reverse
        requested = {each.name for each in bag.topics if _takes(self._filter, each.name)}
        start, end = self._first, None if self._last is None else self._last + 1
        if position is not None and reverse:
            end = position + 1 if end is None else min(end, position + 1)
        elif position is not None:
            start = position if start is None else max(start, position)
        self._position, self._done = position, list(done or ())
        found = bag.messages(requested, start, end, reverse=reverse)
        self._messages = _without(found, self._done) if self._done else found
        self._next = next(self._messages, None)


class SequentialCompressionReader(SequentialReader):
    """Reader of a bag that is compressed by file or by message; SequentialReader reads those, too."""


def get_registered_readers() -> set[str]:
    """Return the names of the storages that can be read."""
    return set(STORAGES)


def _without(messages: Iterator[BagMessage], done: list[BagMessage]) -> Iterator[BagMessage]:
    left = list(done)
    for each in messages:
        if left and each in left:
            left.remove(each)
        else:
            yield each


def _takes(chosen: StorageFilter, name: str) -> bool:
    """True for a topic that a filter lets through."""
    is_event = name.endswith(SERVICE_EVENT)
    regex, excluded = _regexes(chosen)
    if name in (chosen.exclude_service_events if is_event else chosen.exclude_topics):
        return False
    if excluded and re.fullmatch(excluded, name):
        return False
    if not (chosen.topics or chosen.services_events or regex):
        return True
    return name in chosen.topics or name in chosen.services_events or bool(regex and re.fullmatch(regex, name))


def _regexes(chosen: StorageFilter) -> tuple[str, str]:
    return chosen.regex or chosen.topics_regex, chosen.regex_to_exclude or chosen.topics_regex_to_exclude


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
        """Write the messages in the cache, in snapshot mode; return whether there was anything."""
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


class Reindexer:
    """Maker of metadata.yaml from the files of a bag; files of killed recorders are made whole."""

    def reindex(self, storage_options: StorageOptions) -> None:
        """Reindex the bag of these options. Raises BagError (a RuntimeError) if there is none."""
        reindex(Path(storage_options.uri))


class Info:
    """Reader and printer of a bag's metadata."""

    def read_metadata(self, uri: str, storage_id: str = "") -> BagMetadata:
        """Return the metadata of a bag; its files tell the storage. Raises BagError (a RuntimeError)."""
        with open_bag(Path(uri)) as bag:
            return metadata_to(bag.metadata)

    def print_output(self, metadata_info: BagMetadata, sorting_method: str = "name") -> None:
        """Print the summary of `ros2 bag info`."""
        _print(info_text(metadata_from(metadata_info), sorting_method))

    def print_output_topic_name_only(self, metadata_info: BagMetadata, sorting_method: str = "name") -> None:
        """Print the names of the topics, a line each."""
        for name in topic_names(metadata_from(metadata_info), sorting_method):
            _print(name)

    def print_output_verbose(self, uri: str, metadata_info: BagMetadata, sorting_method: str = "name") -> None:
        """Print the summary of `ros2 bag info -v`, which reads the whole bag."""
        with open_bag(Path(uri)) as bag:
            details = details_of(bag)
        _print(info_text(metadata_from(metadata_info), sorting_method, details))

    def get_sorting_methods(self) -> set[str]:
        """Return the names of the orders."""
        return set(SORTS)


def _print(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
