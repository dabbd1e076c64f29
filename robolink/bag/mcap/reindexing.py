"""Repair of an MCAP file that has no end or is broken: all that is good goes into a new file, which replaces it."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import NamedTuple

from robolink.bag.mcap.disk import is_being_written
from robolink.bag.mcap.reader import Reader
from robolink.bag.mcap.records import McapError
from robolink.bag.mcap.writer import Writer
from robolink.system.files import put_in_place

PART = ".reindexed"
"""Suffix of the new file, until it is complete and replaces the old one."""


class Report(NamedTuple):
    """Result of a repair; sizes are in bytes."""

    path: Path
    messages: int
    channels: int
    size_before: int
    size_after: int
    was_whole: bool
    problems: tuple[str, ...]
    """Broken places, a line each; messages there are lost."""


def reindex(path: str | Path, *, compression: str | None = None) -> Report:
    """Make a file whole that was cut or is broken: an ordinary MCAP, with an index and without dead space.

    The new file is complete and on the disk before it replaces the old one, which stays as it is if anything fails.

    Args:
        path: Path of the file.
        compression: How its chunks are packed: ``""``, ``"zstd"`` or ``"lz4"``; None for as they are.

    Raises McapError if the file is not an MCAP, is being recorded now, or the new one cannot be written.
    """
    path = Path(path)
    with Reader(path) as reader:
        if is_being_written(path):
            raise McapError(f"{path}: it is being recorded now, and valid as it is: reindex it later")
        before = path.stat().st_size
        new = path.with_name(path.name + PART)
        try:
            new.unlink(missing_ok=True)  # of a repair that was killed
            messages = _copy(reader, new, reader.compression if compression is None else compression)
            after = new.stat().st_size
            was_whole, problems = reader.is_whole and not reader.problems, tuple(reader.problems)
            channels = len(reader.channels)
            reader.close()  # Windows replaces no open file
            put_in_place(new, path)
        except OSError as error:
            raise McapError(f"{path} cannot be replaced: {error.strerror or error}; it is as it was") from None
        finally:
            with contextlib.suppress(OSError):
                new.unlink(missing_ok=True)
    return Report(path, messages, channels, before, after, was_whole, problems)


def _copy(reader: Reader, path: Path, compression: str) -> int:
    """Write all that a reader finds into a new file, and return the number of messages."""
    count = 0
    never = float("inf")
    with Writer(
        path,
        profile=reader.profile,
        library=reader.library,
        compression=compression,
        flush_every=never,
        max_age=never,
        sync_every=0,
    ) as writer:
        schemas = {0: 0}
        for schema in reader.schemas.values():
            schemas[schema.id] = writer.add_schema(schema.name, schema.encoding, schema.data)
        channels = {
            each.id: writer.add_channel(schemas.get(each.schema, 0), each.topic, each.encoding, each.metadata)
            for each in reader.channels.values()
        }
        for attachment in reader.attachments:
            writer.add_attachment(attachment)
        for name, values in reader.metadata:
            writer.add_metadata(name, values)
        for each in reader.messages(in_log_order=False):
            writer.write(channels[each.channel], each.log_time, each.publish_time, each.sequence, each.data)
            count += 1
    return count
