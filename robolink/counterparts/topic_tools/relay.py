"""Publish all messages of a topic on another one.

robolink run topic_tools relay scan front/scan
"""

from __future__ import annotations

from typing import Any

from robolink.counterparts.program import spin_program
from robolink.counterparts.topic_tools.topic_tool import TopicTool, numbered

USAGE = "relay INTOPIC [OUTTOPIC]"


class Relay(TopicTool):
    """A node that passes on all messages. `options` are those of `TopicTool`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("relay", **options)

    def set_up(self) -> None:
        """Declare the topics."""
        self.declare_topics("_relay")


def main(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""

    def make(words: list[str]) -> Relay:
        return Relay(parameters=numbered(words, USAGE, ("input_topic", str), optional="output_topic"))

    spin_program(make, args)


if __name__ == "__main__":
    main()
