"""Publish fields of the messages of a topic as messages of another type.

robolink run topic_tools relay_field /chatter /header std_msgs/Header '{stamp: now, frame_id: m.data}'
"""

from __future__ import annotations

from types import CodeType
from typing import Any

from robolink.companions.rosidl_runtime import set_message_fields
from robolink.counterparts.program import UsageError, spin_program
from robolink.counterparts.topic_tools.conversion import Conversion, Topics, compiled, parser_of
from robolink.documents import yamltext


def main(args: list[str] | None = None) -> None:
    """Convert messages until Ctrl-C."""
    spin_program(make, args)


def make(words: list[str]) -> Conversion:
    """Make the node of a command line."""
    parser = parser_of("relay_field")
    parser.add_argument("expression", help="fields of the output as YAML, with expressions on the message m")
    asked = parser.parse_args(words)
    fields = prepared(yamltext.plain(yamltext.compose(asked.expression, "EXPRESSION"), "EXPRESSION"))
    if not isinstance(fields, dict):
        raise UsageError("expected fields such as '{frame_id: m.data}'")

    def convert(message: Any, kind: type[Any]) -> Any:
        made = kind()
        now = node.get_clock().now().to_msg()
        for put in set_message_fields(made, filled(fields, message), expand_header_auto=True, expand_time_now=True):
            put(now)
        return made

    node = Conversion("relay_field", Topics(asked.input, asked.output_topic, asked.output_type), convert)
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


if __name__ == "__main__":
    main()
