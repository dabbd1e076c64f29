"""Reading of bags: one in its files, and several merged by time."""

from __future__ import annotations

import contextlib
import heapq
import stat
import tempfile
from collections.abc import Callable, Collection, Iterable, Iterator
from pathlib import Path
from types import TracebackType

from robolink.bag import zstd
from robolink.bag.folder import contents
from robolink.bag.metadata import BagMetadata, FileInformation, metadata_of
from robolink.bag.storage.base import StorageReader
from robolink.bag.storage.opening import storage_reader
from robolink.bag.topic import BagError, BagMessage, BagTopic

MOST_OPEN = 64
"""Most files of one bag that stay open between two readings."""


class Bag:
    """Recorded messages, of one or of several files.

    `metadata`, `topics` and `counts` describe what can be read, also where `metadata.yaml` is missing, damaged or
    older than the files. `problems` has a line for each part that cannot be read; reading may add to them.

    Args:
        path: The bag's folder, or one storage file.
        ignores_metadata: True to look at the files alone, whatever metadata.yaml says.

    Raises:
        BagError: if nothing of it can be read.
    """

    def __init__(self, path: str | Path, *, ignores_metadata: bool = False) -> None:
        self.path = Path(path)
        try:
            found = contents(self.path, ignores_metadata=ignores_metadata)
        except OSError as error:  # a folder that may not be looked into
            raise BagError(f"{self.path} cannot be read: {error.strerror or error}") from None
        self.problems = found.problems
        self._resources = contextlib.ExitStack()
        self._scratch: Path | None = None
        self._keeps_open = len(found.files) <= MOST_OPEN
        self._files: list[_File] = []
        with contextlib.ExitStack() as undo:
            undo.callback(self.close)
            self._open_files(found.files)
            self.metadata = self._describe(found.metadata)
            undo.pop_all()
        self.topics = [topic for topic, _ in self.metadata.topics_with_message_count]
        self.counts: dict[str, int] = {}
        for topic, count in self.metadata.topics_with_message_count:
            self.counts[topic.name] = self.counts.get(topic.name, 0) + count

    @property
    def start_time(self) -> int:
        """Time of the first message, in nanoseconds since 1970; 0 without messages."""
        return self.metadata.starting_time

    @property
    def end_time(self) -> int:
        """Time of the last message, in nanoseconds since 1970; 0 without messages."""
        return self.metadata.end_time

    @property
    def compression(self) -> str:
        """Compression of the messages: '', zstd or lz4, of whole files, of messages or of chunks."""
        return self.metadata.compression_format or next((each.compression for each in self._files), "")

    @property
    def is_whole(self) -> bool:
        """False if the recorder of one of its files was killed."""
        return all(each.is_whole for each in self._files)

    def messages(
        self,
        topics: Collection[str] | None = None,
        start: int | None = None,
        end: int | None = None,
        *,
        reverse: bool = False,
    ) -> Iterator[BagMessage]:
        """Yield the messages of all files in the order of their log times.

        A file that turns out to be damaged ends there, with a line in `problems`; the others go on.

        Args:
            topics: Names of the topics; None is all.
            start: Earliest log time, in nanoseconds since 1970.
            end: Log time before which messages must be.
            reverse: True for the latest first.
        """
        selected = None if topics is None else frozenset(topics)
        filled = [each for each in self._files if each.has_between(start, end)]
        for group in _overlapping(filled, reverse=reverse):
            streams = [self._of_file(each, selected, start, end, reverse=reverse) for each in group]
            if len(streams) == 1:
                yield from streams[0]
            else:
                yield from heapq.merge(*streams, key=_log_time, reverse=reverse)

    def close(self) -> None:
        """Close all files."""
        for each in self._files:
            each.close()
        self._resources.close()

    def __enter__(self) -> Bag:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _open_files(self, paths: Iterable[Path]) -> None:
        errors: list[str] = []
        for path in paths:
            try:
                self._files.append(_File(path, self._open(path)))
            except BagError as error:
                errors.append(str(error))
            else:
                self._release(self._files[-1])
        if not self._files:
            raise BagError(errors[0] if len(errors) == 1 else f"{errors[0]} (and {len(errors) - 1} more files)")
        self.problems += errors

    def _open(self, path: Path) -> StorageReader:
        if self._scratch is None and path.name.endswith(zstd.ENDING):
            self._scratch = Path(
                self._resources.enter_context(
                    tempfile.TemporaryDirectory(prefix="robolink-bag-", ignore_cleanup_errors=True)
                )
            )
        return storage_reader(path, self._scratch)

    def _release(self, file: _File) -> None:
        """Note what a file's reader has found to be broken, and close it if there are many."""
        if file.reader is not None:
            known = set(self.problems)
            self.problems += [each for each in file.reader.problems if each not in known]
        if not self._keeps_open:
            file.close()

    def _of_file(
        self, file: _File, topics: frozenset[str] | None, start: int | None, end: int | None, *, reverse: bool
    ) -> Iterator[BagMessage]:
        try:
            if file.reader is None:
                file.reader = self._open(file.path)
            found = file.reader.messages(topics, start, end, reverse=reverse)
            yield from self._unpacked(found, file.path) if self._packs_messages else found
        except BagError as error:
            self.problems.append(str(error))
        finally:
            self._release(file)

    def _unpacked(self, messages: Iterator[BagMessage], path: Path) -> Iterator[BagMessage]:
        """Decompress messages; one that cannot be is left out, and the others go on."""
        zstd.check()
        for each in messages:
            try:
                data = zstd.decompress(each.data, f"{path}: a message of {each.topic}")
            except BagError as error:
                problem = f"{error}; it is left out"
                self.problems += [] if problem in self.problems else [problem]
            else:
                yield each._replace(data=data)

    @property
    def _packs_messages(self) -> bool:
        return self.metadata.compression_mode == "message"

    def _describe(self, stored: BagMetadata | None) -> BagMetadata:
        """Return metadata of what there is: sums and counts of the files, the rest from what is stored."""
        # A killed recorder leaves a metadata.yaml that is older than its files, or none.
        copies = [each.stored for each in self._files if each.stored is not None]
        known = stored or (copies[-1] if copies else BagMetadata(version=0))
        total = sum(each.message_count for each in self._files)
        # Its counts, where the sums agree: sqlite3 would have to count by reading everything.
        if stored is not None and total == stored.message_count and _names_all(stored, self._files):
            topics = _with_definitions(stored.topics_with_message_count, self._files)
        else:
            topics = self._counted()
        described = metadata_of(
            topics,
            [each.information for each in self._files],
            version=known.version,
            bag_size=_size(self.path) or sum(each.size for each in self._files),
            storage_identifier=self._files[0].identifier,
            compression_format=known.compression_format,
            compression_mode=known.compression_mode,
            custom_data=known.custom_data,
            ros_distro=known.ros_distro,
        )
        described.message_count = sum(count for _, count in topics)
        return described

    def _counted(self) -> list[tuple[BagTopic, int]]:
        """Return all topics with the numbers of their messages, as they are in the files."""
        sums: dict[tuple[str, str], tuple[BagTopic, int]] = {}
        for file in self._files:
            if file.reader is None:
                file.reader = self._open(file.path)
            counts = file.reader.counts()
            file.information.message_count = sum(counts)
            for topic, count in zip(file.topics, counts, strict=True):
                key = topic.name, topic.type_name
                sums[key] = topic, count + (sums[key][1] if key in sums else 0)
            self._release(file)
        return list(sums.values())


def open_bag(path: str | Path, *, ignores_metadata: bool = False) -> Bag:
    """Open a bag to read; see `Bag` for the arguments. Raises BagError if nothing of it can be read."""
    return Bag(path, ignores_metadata=ignores_metadata)


class _File:
    """File of a bag: what is known of it, and its reader while it is open."""

    def __init__(self, path: Path, reader: StorageReader) -> None:
        self.path, self.reader = path, reader if reader is not None else None
        self.identifier, self.topics, self.stored = reader.identifier, reader.topics, reader.metadata
        self.compression, self.is_whole = reader.compression, reader.is_whole
        self.message_count = reader.message_count
        self.start_time, self.end_time = reader.start_time, reader.end_time
        self.size = path.stat().st_size
        span = reader.end_time - reader.start_time
        self.information = FileInformation(path.name, reader.start_time, span, reader.message_count)

    reader: StorageReader | None

    def has_between(self, start: int | None, end: int | None) -> bool:
        """True if it may have messages from `start` to before `end`."""
        if not self.message_count:
            return False
        return (start is None or self.end_time >= start) and (end is None or self.start_time < end)

    def close(self) -> None:
        """Close the reader."""
        if self.reader is not None:
            self.reader.close()
            self.reader = None


def _size(folder: Path) -> int:
    """Return the size of all files in a folder, as rosbag2 counts it; 0 for a file."""
    size = 0
    for each in folder.iterdir() if folder.is_dir() else ():
        with contextlib.suppress(OSError):  # a recorder deletes and renames files meanwhile
            status = each.stat()
            size += status.st_size if stat.S_ISREG(status.st_mode) else 0
    return size


def _overlapping(files: list[_File], *, reverse: bool) -> list[list[_File]]:
    """Group files whose times overlap: only those must be merged, and open at the same time."""
    groups: list[list[_File]] = []
    latest = 0
    for each in sorted(files, key=lambda file: file.start_time):
        if groups and each.start_time <= latest:
            groups[-1].append(each)
        else:
            groups.append([each])
        latest = max(latest, each.end_time)
    return groups[::-1] if reverse else groups


def _log_time(message: BagMessage) -> int:
    return message.log_time


def _names_all(stored: BagMetadata, files: Iterable[_File]) -> bool:
    named = {(topic.name, topic.type_name) for topic, _ in stored.topics_with_message_count}
    return all((topic.name, topic.type_name) in named for each in files for topic in each.topics)


def _with_definitions(topics: list[tuple[BagTopic, int]], files: Iterable[_File]) -> list[tuple[BagTopic, int]]:
    """Return topics of metadata.yaml with the definitions of their types, which only the files have."""
    known = {topic.type_name: topic for each in files for topic in each.topics if topic.message_definition}
    return [(_with_definition(topic, known.get(topic.type_name)), count) for topic, count in topics]


def _with_definition(topic: BagTopic, known: BagTopic | None) -> BagTopic:
    if known is None:
        return topic
    return topic._replace(
        message_definition=known.message_definition,
        definition_encoding=known.definition_encoding,
        type_hash=topic.type_hash or known.type_hash,
    )


def merged_topics(bags: Iterable[Bag], takes: Callable[[str, str], bool], advice: str) -> dict[str, BagTopic]:
    """Return the topics of bags by name, each with all QoS profiles that were offered.

    Args:
        bags: The bags.
        takes: Function of a topic's name and type that returns whether it counts.
        advice: End of the error's text: what can be done about a topic of two types.

    Raises:
        BagError: if a name has two types: a message tells only its topic's name.
    """
    found: dict[str, BagTopic] = {}
    for bag in bags:
        for topic in bag.topics:
            if not takes(topic.name, topic.type_name):
                continue
            known = found.setdefault(topic.name, topic)
            if difference := topic.difference(known):
                raise BagError(f"{bag.path}: {difference}: {advice}")
            fresh = tuple(each for each in topic.offered_qos if each not in known.offered_qos)
            found[topic.name] = known._replace(
                offered_qos=known.offered_qos + fresh,
                message_definition=known.message_definition or topic.message_definition,
                type_hash=known.type_hash or topic.type_hash,
            )
    return found


def merged_messages(
    bags: Iterable[Bag],
    names: Collection[str],
    start: int | None = None,
    end: int | None = None,
    *,
    reverse: bool = False,
) -> Iterator[BagMessage]:
    """Yield the messages of bags in the order of their log times.

    Args:
        bags: The bags.
        names: Names of the topics.
        start: Earliest log time, in nanoseconds since 1970.
        end: Log time before which messages must be.
        reverse: True for the latest first.
    """
    streams = [each.messages(names, start, end, reverse=reverse) for each in bags]
    if len(streams) == 1:
        return streams[0]
    return heapq.merge(*streams, key=lambda message: message.log_time, reverse=reverse)
