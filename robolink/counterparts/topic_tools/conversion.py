"""Base of the nodes that make other messages of what they hear, by expressions of Python on the message `m`.

The expressions are the user's own text, in the user's own shell, as those of `robolink topic echo --filter`.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable
from types import CodeType
from typing import Any, NamedTuple

from robolink.counterparts.program import UsageError
from robolink.counterparts.topic_tools.topic_tool import Source, TopicTool
from robolink.interfaces import find
from robolink.serialization import deserialize_message


class Topics(NamedTuple):
    """Input and output of a conversion; `kind` is the type of the output, such as ``std_msgs/Header``."""

    source: str
    sink: str
    kind: str


class Conversion(TopicTool):
    """A node that publishes what a function makes of each message.

    Args:
        name: Beginning of the node's name, before the number of the process.
        topics: Input and output.
        convert: Function of a message and the class of the output; returns a message.
        options: Those of `TopicTool`.

    Raises:
        NotFoundError: if there is no such type.
    """

    def __init__(self, name: str, topics: Topics, convert: Callable[[Any, type[Any]], Any], **options: Any) -> None:
        self._topics, self._convert = topics, convert
        self._class: type[Any] = find(topics.kind, "msg")
        super().__init__(f"{name}_{os.getpid()}", **options)

    def set_up(self) -> None:
        """Set the topics."""
        self.input_topic, self.output_topic = self._topics.source, self._topics.sink

    def output_class(self, source: Source) -> type[Any]:
        """Return the class that was asked for."""
        return self._class

    def on_message(self, payload: bytes) -> None:
        """Convert a message, and publish the other one; log why that fails."""
        if self.source is None or self.sink is None:
            return
        try:
            message = deserialize_message(payload, self.source.message_class)
            self.sink.publish(self._convert(message, self._class))
        except Exception as error:  # noqa: BLE001 - expressions raise whatever they want; bytes may be cut
            self._tell(f"a message cannot be converted: {type(error).__name__}: {' '.join(str(error).split())[:300]}")


def compiled(text: str) -> CodeType:
    """Return the code of an expression. Raises UsageError."""
    try:
        return compile(text.strip(), "<expression>", "eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        reason = " ".join(str(getattr(error, "msg", error)).split())
        raise UsageError(f"no expression of Python: {reason}: {text.strip()[:200]}") from None


def parser_of(program: str) -> argparse.ArgumentParser:
    """Return a parser for the arguments that both conversions have."""
    parser = argparse.ArgumentParser(program)
    parser.add_argument("input", help="topic to listen to")
    parser.add_argument("output_topic", help="topic to publish on")
    parser.add_argument("output_type", help="type of the output, such as std_msgs/Float64")
    parser.add_argument(
        "--wait-for-start", action="store_true", help="of no effect: it waits for the input in any case"
    )
    return parser
