"""Fake bag of a recording: it keeps what is written, and can be made slow or full."""

from __future__ import annotations

import errno
import threading
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from robolink.bag.topic import BagTopic


class Written(NamedTuple):
    topic: str
    log_time: int
    publish_time: int
    sequence: int
    data: bytes


class FakeBag:
    """Bag in memory. `room` is the number of messages after which the disk is full."""

    def __init__(self, room: int = 10**9) -> None:
        self.topics: list[BagTopic] = []
        self.files: list[list[Written]] = [[]]
        self.room, self.closed = room, False
        self.open_gate = threading.Event()
        """Writing waits until this is set."""
        self.open_gate.set()
        self.on_split: Callable[[Path, Path], object] = lambda closed, opened: None
        self._changed = threading.Condition()

    @property
    def messages(self) -> list[Written]:
        return [each for file in self.files for each in file]

    def add_topic(self, topic: BagTopic) -> int:
        with self._changed:
            names = [each.name for each in self.topics]
            if topic.name in names:
                self.topics[names.index(topic.name)] = topic
            else:
                self.topics.append(topic)
            self._changed.notify_all()
            return [each.name for each in self.topics].index(topic.name)

    def write(self, topic: int, log_time: int, publish_time: int, sequence: int, data: bytes | memoryview) -> None:
        assert self.open_gate.wait(30)
        if len(self.messages) >= self.room:
            raise OSError(errno.ENOSPC, "No space left on device", "bag_0.mcap")
        with self._changed:
            self.files[-1].append(Written(self.topics[topic].name, log_time, publish_time, sequence, bytes(data)))
            self._changed.notify_all()

    def tick(self) -> None:
        pass

    def split(self) -> None:
        self.files.append([])
        count = len(self.files)
        self.on_split(Path(f"bag_{count - 2}"), Path(f"bag_{count - 1}"))

    def close(self) -> str:
        self.closed = True
        return "metadata"

    def of(self, topic: str) -> list[Written]:
        return [each for each in self.messages if each.topic == topic]

    def wait_for(self, topic: str, count: int) -> list[Written]:
        """Wait until so many messages of a topic are there."""
        with self._changed:
            assert self._changed.wait_for(lambda: len(self.of(topic)) >= count, 30), self.of(topic)
        return self.of(topic)

    def wait_for_topic(self, name: str) -> BagTopic:
        with self._changed:
            assert self._changed.wait_for(lambda: name in [each.name for each in self.topics], 30), self.topics
        return next(each for each in self.topics if each.name == name)
