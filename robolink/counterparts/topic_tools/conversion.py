"""Nodes that make other messages of what they hear, by expressions of Python on the message `m`.

The expressions are the user's own text, in the user's own shell, as those of `robolink topic echo --filter`.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import importlib
import os
from collections.abc import Callable
from types import CodeType
from typing import Any, NamedTuple

from robolink.companions.rosidl_runtime import set_message_fields
from robolink.counterparts.program import UsageError, spin_program
from robolink.counterparts.topic_tools.topic_tool import Source, TopicTool
from robolink.documents import yamltext
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


def run_transform(args: list[str] | None = None) -> None:
    """Convert messages until Ctrl-C."""
    spin_program(transform, args)


def transform(words: list[str]) -> Conversion:
    """Make the node of a command line."""
    parser = parser_of("transform")
    parser.add_argument("expression", nargs="?", default="m", help="Python's expression on the message m")
    parser.add_argument("-i", "--import", dest="modules", nargs="+", default=["numpy"], help="modules of it")
    parser.add_argument("--field", default="", help="field that m is, such as orientation.x")
    options = parser.parse_args(words)
    code, names = compiled(options.expression), {each: _module(each) for each in options.modules}
    path = [each for each in options.field.split(".") if each]

    def convert(message: Any, kind: type[Any]) -> Any:
        m = functools.reduce(getattr, path, message)
        return eval(code, {**names, "m": m})  # noqa: S307 - the user's own text, in their own shell

    return Conversion("transform", Topics(options.input, options.output_topic, options.output_type), convert)


def _module(name: str) -> Any:
    from robolink import compat  # late: its import takes names already

    compat.activate()
    try:
        module = importlib.import_module(name)
    except ImportError as error:
        raise UsageError(f"--import {name}: {error}") from None
    with contextlib.suppress(ImportError):  # a package of messages, whose `msg` an expression needs
        importlib.import_module(f"{name}.msg")
    return module


def run_relay_field(args: list[str] | None = None) -> None:
    """Convert messages until Ctrl-C."""
    spin_program(relay_field, args)


def relay_field(words: list[str]) -> Conversion:
    """Make the node of a command line."""
    parser = parser_of("relay_field")
    parser.add_argument("expression", help="fields of the output as YAML, with expressions on the message m")
    options = parser.parse_args(words)
    fields = prepared(yamltext.plain(yamltext.compose(options.expression, "EXPRESSION"), "EXPRESSION"))
    if not isinstance(fields, dict):
        raise UsageError("expected fields such as '{frame_id: m.data}'")

    def convert(message: Any, kind: type[Any]) -> Any:
        made = kind()
        now = node.get_clock().now().to_msg()
        for put in set_message_fields(made, filled(fields, message), expand_header_auto=True, expand_time_now=True):
            put(now)
        return made

    node = Conversion("relay_field", Topics(options.input, options.output_topic, options.output_type), convert)
    return node


def prepared(value: Any) -> Any:
    """Return data in which texts that are expressions on `m` are code; others stay what they are."""
    if isinstance(value, dict):
        return {key: prepared(each) for key, each in value.items()}
    if isinstance(value, list):
        return [prepared(each) for each in value]
    try:
        code = compiled(value) if isinstance(value, str) else value
    except UsageError:
        return value
    return code if not isinstance(code, CodeType) or "m" in code.co_names else value


def filled(value: Any, message: Any) -> Any:
    """Return data with the values of its expressions."""
    if isinstance(value, dict):
        return {key: filled(each, message) for key, each in value.items()}
    if isinstance(value, list):
        return [filled(each, message) for each in value]
    if isinstance(value, CodeType):
        return eval(value, {"m": message})  # noqa: S307 - the user's own text, in their own shell
    return value
