"""Sequential readers of bags: message after message, with filters and seeking."""

from __future__ import annotations

import re
import weakref
from collections.abc import Iterator
from pathlib import Path

from robolink.bag.reader import Bag, open_bag
from robolink.bag.selection import SERVICE_EVENT
from robolink.bag.storage.opening import STORAGES
from robolink.bag.topic import BagError, BagMessage
from robolink.companions.rosbag2_py._storage import (
    BagMetadata,
    ConverterOptions,
    MessageDefinition,
    ReadOrder,
    ReadOrderSortBy,
    StorageFilter,
    StorageOptions,
    TopicMetadata,
    metadata_to,
    topics_to,
)


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
        wanted = converter_options.output_serialization_format if converter_options else ""
        if wanted not in {"", "cdr"}:
            raise BagError(f"messages of bags are cdr here, not '{wanted}'")
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
        wanted = {each.name for each in bag.topics if _takes(self._filter, each.name)}
        start, end = self._first, None if self._last is None else self._last + 1
        if position is not None and reverse:
            end = position + 1 if end is None else min(end, position + 1)
        elif position is not None:
            start = position if start is None else max(start, position)
        self._position, self._done = position, list(done or ())
        found = bag.messages(wanted, start, end, reverse=reverse)
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
