"""Publish the messages of a topic on another one, but for X of every Y.

robolink run topic_tools drop scan 1 2
"""

from __future__ import annotations

from typing import Any

from robolink.counterparts.program import UsageError, spin_program
from robolink.counterparts.topic_tools.topic_tool import TopicTool, numbered

USAGE = "drop INTOPIC X Y [OUTTOPIC]"


class Drop(TopicTool):
    """A node that drops some messages. `options` are those of `TopicTool`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("drop", **options)

    def set_up(self) -> None:
        """Declare the topics and the numbers."""
        self.declare_topics("_drop")
        self._dropped = self.needed("X", "messages of every Y that are dropped", -1)
        self._of = self.needed("Y", "messages of which X are dropped", -1)
        if not 0 <= self._dropped <= self._of or self._of < 1:
            raise UsageError(f"expected 0 <= X <= Y and Y at least 1, got {self._dropped} and {self._of}")
        self._count = 0

    def on_message(self, payload: bytes) -> None:
        """Pass on a message, or drop it."""
        if self._count >= self._dropped:
            self.pass_on(payload)
        self._count = (self._count + 1) % self._of


def main(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""

    def make(words: list[str]) -> Drop:
        return Drop(parameters=numbered(words, USAGE, *KINDS, optional="output_topic"))

    spin_program(make, args)


KINDS: tuple[tuple[str, type[Any]], ...] = (("input_topic", str), ("X", int), ("Y", int))

if __name__ == "__main__":
    main()
