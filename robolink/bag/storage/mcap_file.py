"""Storage in MCAP files, the default of rosbag2 since Iron: channels as topics, schemas as their types."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Iterator
from pathlib import Path

from robolink.bag.mcap import McapError, Reader, Writer, open_mcap
from robolink.bag.metadata import BagMetadata, parse_metadata, spell_metadata
from robolink.bag.qos import profiles_or_none, text_of
from robolink.bag.storage.base import StorageReader, StorageWriter, Written
from robolink.bag.topic import BagError, BagMessage, BagTopic

MAGIC = b"\x89MCAP"
RECORD = "rosbag2"
"""Name of the metadata record in which rosbag2 keeps a copy of the bag's metadata."""


class McapReader(StorageReader):
    """Reader of an .mcap file, also of one whose writer was killed. Raises BagError if nothing of it can be read."""

    identifier = "mcap"

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        with _errors(path):
            self._reader: Reader = open_mcap(path)
        self._numbers: dict[int, int] = {}
        seen: dict[tuple[str, str], int] = {}
        for channel in self._reader.channels.values():
            schema = self._reader.schemas.get(channel.schema)
            key = channel.topic, schema.name if schema else ""
            if key not in seen:
                seen[key] = len(self.topics)
                text = schema.data.decode("utf-8", "replace") if schema else ""
                self.topics.append(
                    BagTopic(
                        *key,
                        channel.encoding,
                        channel.metadata.get("topic_type_hash", ""),
                        profiles_or_none(channel.metadata.get("offered_qos_profiles", "")),
                        text,
                        (schema.encoding if schema else "") or "ros2msg",
                    )
                )
            self._numbers[channel.id] = seen[key]
        self.metadata = self._stored()
        self._complete_hashes()
        statistics = self._reader.statistics
        self.message_count = statistics.message_count
        self.start_time, self.end_time = statistics.start_time, statistics.end_time
        self.compression, self.is_whole = self._reader.compression, self._reader.is_whole

    def _stored(self) -> BagMetadata | None:
        for name, values in reversed(self._reader.metadata):
            if name == RECORD and "serialized_metadata" in values:
                with contextlib.suppress(BagError):  # a copy: what counts is metadata.yaml, and the messages
                    return parse_metadata(values["serialized_metadata"])
        return None

    def _complete_hashes(self) -> None:
        """Take hashes of types that channels lack from the bag's metadata: rosbags keeps them there alone."""
        known = self.metadata.topics_with_message_count if self.metadata else []
        hashes = {(topic.name, topic.type_name): topic.type_hash for topic, _ in known}
        self.topics = [
            topic if topic.type_hash else topic._replace(type_hash=hashes.get((topic.name, topic.type_name), ""))
            for topic in self.topics
        ]

    @property
    def problems(self) -> list[str]:
        """One line for each broken place that was found."""
        return [f"{self.path}: {each}" for each in self._reader.problems]

    def counts(self) -> list[int]:
        """Return the number of messages of each of `topics`."""
        found = [0] * len(self.topics)
        for channel, count in self._reader.statistics.counts.items():
            if channel in self._numbers:
                found[self._numbers[channel]] += count
        return found

    def messages(
        self, topics: Collection[str] | None, start: int | None, end: int | None, *, reverse: bool = False
    ) -> Iterator[BagMessage]:
        """Yield messages in the order of their log times."""
        names = {id_: self.topics[number].name for id_, number in self._numbers.items()}
        selected = None if topics is None else [id_ for id_, name in names.items() if name in topics]
        with _errors(self.path):
            for each in self._reader.messages(selected, start, end, reverse=reverse):
                yield BagMessage(names[each.channel], each.data, each.log_time, each.publish_time, each.sequence)

    def close(self) -> None:
        """Close the file."""
        self._reader.close()


class McapWriter(StorageWriter):
    """Writer of an .mcap file, which is valid at every moment.

    Args:
        path: The file, which must not exist.
        compression: Compression of its chunks: '', zstd or lz4.
        metadata: Metadata of the bag when the file begins.
    """

    identifier = "mcap"
    ending = ".mcap"

    def __init__(self, path: Path, compression: str, metadata: BagMetadata) -> None:
        self._path = path
        with _errors(path):
            self._writer = Writer(path, compression=compression)
        self._schemas: dict[tuple[str, str], int] = {}
        self._channels: list[int] = []
        self._keep(metadata)
        # What runs is `bag.mcap.writer.Writer.write`: the method below, which calls it, is 3 % of what a message costs.
        self.write = self._writer.write  # type: ignore[method-assign,assignment]

    @property
    def size(self) -> int:
        """Bytes that were written so far."""
        return self._writer.size

    @property
    def summary_size(self) -> int:  # type: ignore[override]
        """Bytes of the index, which is written with each flush."""
        return self._writer.summary_size

    @property
    def written(self) -> Written:
        """Messages that were written so far."""
        _, counts, start, end = self._writer.statistics
        return Written([counts.get(each, 0) for each in self._channels], start, end)

    def add_topic(self, topic: BagTopic) -> int:
        """Add a channel for a topic, and its schema if it is new; return the channel's number."""
        key = topic.type_name, topic.message_definition
        if key not in self._schemas:
            encoding = topic.definition_encoding if topic.message_definition else ""
            self._schemas[key] = self._writer.add_schema(
                topic.type_name, encoding, topic.message_definition.encode("utf-8", "replace")
            )
        metadata = {"offered_qos_profiles": text_of(topic.offered_qos), "topic_type_hash": topic.type_hash}
        schema, encoding = self._schemas[key], topic.serialization_format
        self._channels.append(self._writer.add_channel(schema, topic.name, encoding, metadata))
        return self._channels[-1]

    def write(self, topic: int, log_time: int, publish_time: int, sequence: int, data: bytes | memoryview) -> None:
        """Write a message."""
        self._writer.write(topic, log_time, publish_time, sequence, data)

    def tick(self) -> None:
        """Show readers what is due."""
        self._writer.tick()

    def flush(self) -> None:
        """Show readers everything."""
        self._writer.flush()

    def close(self, metadata: BagMetadata | None) -> None:
        """Close the file, with a copy of the bag's metadata."""
        if metadata is not None:
            self._keep(metadata)
        self._writer.close()

    def _keep(self, metadata: BagMetadata) -> None:
        self._writer.add_metadata(RECORD, {"serialized_metadata": spell_metadata(metadata)})


@contextlib.contextmanager
def _errors(path: Path) -> Iterator[None]:
    try:
        yield
    except McapError as error:
        text = str(error)
        raise BagError(text if str(path) in text else f"{path}: {text}") from None
