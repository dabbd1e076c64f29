"""Bags as a source of plots: the topics of a recording, and its messages at the times at which they came."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from robolink.bag.playing.types import class_of
from robolink.bag.reader import Bag, open_bag
from robolink.cli.plot.record import PlotError
from robolink.cli.shared.output import tell
from robolink.exceptions import RobolinkError, nearest
from robolink.serialization import deserialize_message

Take = Callable[[Any, float], Any]
"""Function that gets a message, and the time in seconds at which it was recorded."""


class Recorded:
    """Topics of an open bag.

    Args:
        bag: The bag.
    """

    def __init__(self, bag: Bag) -> None:
        self._bag = bag
        self._topics = {each.name: each for each in bag.topics}

    @property
    def topics(self) -> list[str]:
        """Names of the topics that have messages."""
        return [name for name in self._topics if self._bag.counts.get(name)]

    def name_of(self, asked: str) -> str:
        """Return the full name of a topic. Raises PlotError if the bag does not have it."""
        name = "/" + asked.lstrip("/")
        if name not in self._topics:
            known = ", ".join(self.topics[:10])
            raise PlotError(f"{self._bag.path} has no topic {name}{nearest(name, self._topics)}; it has {known}")
        return name

    def type_of(self, name: str) -> type[Any]:
        """Return the message class of a topic. Raises PlotError if the bag does not say what it is."""
        found = class_of(self._topics[name])
        if found is None:
            raise PlotError(f"{name} is of {self._topics[name].type_name}, which is neither installed nor in the bag")
        return found

    def hear(self, topics: Mapping[str, tuple[type[Any], Take]]) -> None:
        """Call each topic's function with its messages, in the order of the recording."""
        broken: dict[str, str] = {}
        for each in self._bag.messages(list(topics)):
            kind, take = topics[each.topic]
            try:
                message = deserialize_message(bytes(each.data), kind)
            except RobolinkError as error:
                broken.setdefault(each.topic, f"robolink: {each.topic}: {error}; it is left out")
                continue
            take(message, each.log_time * 1e-9)
        for line in [*broken.values(), *(f"robolink: {each}" for each in self._bag.problems)]:
            tell(line)


@contextlib.contextmanager
def recorded(path: Path) -> Iterator[Recorded]:
    """Open a bag while the block runs. Raises BagError if nothing of it can be read."""
    with open_bag(path) as bag:
        yield Recorded(bag)
