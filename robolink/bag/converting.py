"""Conversion of bags: one or several are written anew with other topics, files, compression or storage."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from robolink.bag.merging import merged_messages, merged_topics
from robolink.bag.reader import Bag
from robolink.bag.selection import EVERYTHING, Selection
from robolink.bag.topic import BagMessage, BagTopic
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
        wanted = {name for each in targets for name in each.numbers}
        for message in merged_messages(inputs, wanted):
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
