"""Conversion of bags into others, and the repair of those whose recorder was killed."""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from robolink.bag import mcap
from robolink.bag.folder import storage_files
from robolink.bag.metadata import FILE_NAME, BagMetadata, read_metadata, write_metadata
from robolink.bag.reader import Bag, merged_messages, merged_topics, open_bag
from robolink.bag.selection import EVERYTHING, Selection
from robolink.bag.storage.sqlite import SqliteReader, SqliteWriter
from robolink.bag.topic import BagError, BagMessage, BagTopic
from robolink.bag.writer import BagWriter

TICK_EVERY = 64
"""Messages between two looks at what is due."""


class Output(NamedTuple):
    """Bag that a conversion writes.

    Args:
        path: Its folder, which must not exist.
        storage: mcap or sqlite3.
        selection: Topics that it gets.
        compression: '', zstd or lz4.
        compression_mode: '' (chunks of an MCAP), file or message.
        max_size: Size of a file, in bytes, at which the next begins; 0 is never.
        max_duration: Recorded time of a file, in seconds, at which the next begins; 0 is never.
        start: Earliest time of a message, in nanoseconds since 1970; None is any.
        end: Latest time of a message.
        custom_data: Texts for metadata.yaml, besides those of the inputs.
    """

    path: Path
    storage: str = "mcap"
    selection: Selection = EVERYTHING
    compression: str = ""
    compression_mode: str = ""
    max_size: int = 0
    max_duration: float = 0.0
    start: int | None = None
    end: int | None = None
    custom_data: dict[str, str] = {}


def convert(
    inputs: Sequence[Bag], outputs: Sequence[Output], progress: Callable[[int], object] = lambda done: None
) -> list[int]:
    """Write bags from bags, merged in the order of their log times, and return the number of messages of each.

    Args:
        inputs: Bags to read.
        outputs: Bags to write.
        progress: Called now and then with the number of messages that were read.

    Raises:
        BagError: for an output that is there already, or cannot be as it is asked for.
        OSError: if one cannot be written.
    """
    chosen = [each.selection for each in outputs]
    topics = merged_topics(
        inputs,
        lambda name, kind: any(each.takes(name, kind) for each in chosen),
        "convert the bags one by one, or exclude it",
    )
    with contextlib.ExitStack() as stack:
        targets = [_Target(each, topics.values(), inputs, stack) for each in outputs]
        done = 0
        selected = {name for each in targets for name in each.numbers}
        for message in merged_messages(inputs, selected):
            for target in targets:
                target.take(message)
            done += 1
            if done % TICK_EVERY == 0:
                for target in targets:
                    target.writer.tick()
                progress(done)
        progress(done)
    return [each.writer.message_count for each in targets]


class _Target:
    """Output while it is written."""

    def __init__(
        self, output: Output, topics: Iterable[BagTopic], inputs: Sequence[Bag], stack: contextlib.ExitStack
    ) -> None:
        custom = {key: value for each in inputs for key, value in each.metadata.custom_data.items()}
        self.output = output
        self.writer = stack.enter_context(
            BagWriter(
                output.path,
                storage=output.storage,
                compression=output.compression,
                compression_mode=output.compression_mode,
                max_size=output.max_size,
                max_duration=output.max_duration,
                custom_data={**custom, **output.custom_data},
                ros_distro=next((each.metadata.ros_distro for each in inputs if each.metadata.ros_distro), ""),
            )
        )
        self.numbers = {
            each.name: self.writer.add_topic(each)
            for each in topics
            if output.selection.takes(each.name, each.type_name)
        }

    def take(self, message: BagMessage) -> None:
        """Write a message, if the output wants it."""
        number = self.numbers.get(message.topic)
        start, end = self.output.start, self.output.end
        is_early = start is not None and message.log_time < start
        is_late = end is not None and message.log_time > end
        if number is not None and not (is_early or is_late):
            self.writer.write(number, message.log_time, message.publish_time, message.sequence, message.data)


_END, _PART = 32 << 20, 64 << 10
"""Bytes at the end of a file that are looked at for a hole, and the smallest hole that counts."""

OnProgress = Callable[[str], object]
"""Function that is called with a line about what was done."""


def reindex(path: str | Path, tell: OnProgress = lambda line: None) -> BagMetadata:
    """Mend a bag in its place, and return its metadata.

    What metadata.yaml alone knows (custom data, the distribution, how the files are compressed) is kept if it can be
    read. A file that cannot be read at all stays as it is, and is told.

    Args:
        path: Folder of the bag, or one storage file, which alone is then made whole.
        tell: Called with each line about what was done.

    Raises:
        BagError: if there is no bag, or nothing of it can be read.
        OSError: if it cannot be written.
    """
    folder = Path(path)
    files = storage_files(folder) if folder.is_dir() else [folder]
    if not files:
        raise BagError(f"{folder} is not a bag: there is no .mcap and no .db3 file in it")
    for each in files:
        _mend(each, tell)
    if not folder.is_dir():
        with open_bag(folder) as bag:
            return bag.metadata
    metadata = _described(folder, tell)
    write_metadata(folder, metadata)
    return metadata


def _described(folder: Path, tell: OnProgress) -> BagMetadata:
    """Return metadata of the files that are in a folder, whatever its metadata.yaml names."""
    old = None
    with contextlib.suppress(BagError):
        old = read_metadata(folder) if (folder / FILE_NAME).exists() else None
    with open_bag(folder, ignores_metadata=True) as bag:
        for problem in bag.problems:
            tell(problem)
        metadata = bag.metadata
    if old is not None:
        metadata.custom_data = old.custom_data or metadata.custom_data
        metadata.ros_distro = old.ros_distro or metadata.ros_distro
        metadata.compression_mode = old.compression_mode or metadata.compression_mode
        metadata.compression_format = old.compression_format or metadata.compression_format
    return metadata


def _mend(path: Path, tell: OnProgress) -> None:
    try:
        with path.open("rb") as file:
            head = file.read(16)
    except OSError as error:
        raise BagError(f"{path} cannot be read: {error.strerror}") from None
    if head.startswith(b"\x89MCAP"):
        _mend_mcap(path, tell)
    elif head.startswith(b"SQLite format 3\0"):
        _mend_sqlite(path, tell)


def _mend_mcap(path: Path, tell: OnProgress) -> None:
    """Make an MCAP file whole, and give back the room that a killed recorder had reserved in it."""
    try:
        with mcap.open_mcap(path) as reader:
            needs_it = not reader.is_whole or bool(reader.problems)
        if not (needs_it or _has_hole(path)):
            return
        report = mcap.reindex(path)
    except mcap.McapError as error:
        tell(str(error))
        return
    for problem in report.problems:
        tell(f"{path}: {problem}")
    tell(f"{path}: {report.messages} messages, {report.size_before} bytes before and {report.size_after} now")


def _has_hole(path: Path) -> bool:
    """True if the end of a file has a part of zeros: room for what a recorder would have written."""
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - _END))
        return any(not any(part) for part in iter(lambda: file.read(_PART), b""))


def _mend_sqlite(path: Path, tell: OnProgress) -> None:
    """Let sqlite3 finish what the log of a killed writer holds, and make a damaged file whole from what can be read."""
    if any(path.with_name(path.name + each).exists() for each in ("-wal", "-journal")):
        with contextlib.suppress(sqlite3.Error), contextlib.closing(sqlite3.connect(path)) as database:
            database.execute("PRAGMA journal_mode = DELETE")
    try:
        reader = SqliteReader(path)
    except BagError as error:
        tell(str(error))
        return
    with contextlib.closing(reader):
        reader.counts()  # reads all of it
        if not reader.is_damaged:
            return
        partial = path.with_name(f".{path.name}.partial")
        partial.unlink(missing_ok=True)
        _copy(reader, partial)
        for problem in reader.problems:
            tell(problem)
    saved = path.with_name(f"{path.name}.damaged")
    path.replace(saved)
    partial.replace(path)
    tell(f"{path} is whole again; the damaged file is {saved.name}")


def _copy(reader: SqliteReader, target: Path) -> None:
    """Write the readable messages of a file into another."""
    writer = SqliteWriter(target)
    try:
        numbers = {each.name: writer.add_topic(each) for each in reader.topics}
        for each in reader.messages(None, None, None):
            writer.write(numbers[each.topic], each.log_time, each.publish_time, 0, each.data)
    finally:
        writer.close(reader.metadata)
