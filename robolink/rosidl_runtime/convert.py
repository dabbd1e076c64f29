"""A message as YAML, as values between commas, and as a dictionary."""

from __future__ import annotations

from collections import OrderedDict
from typing import Any

from robolink.message import FieldType, message_type
from robolink.message.show import Style, as_csv, as_yaml, shown_data


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Give a message as YAML, with a line break at its end.

    Texts and sequences longer than `truncate_length` end in '...'; `no_arr` and `no_str` only describe them;
    `flow_style` writes {a: [1, 2]}. Raises MessageError for what is no message.
    """
    return as_yaml(_message(msg), Style(truncate_length, not no_arr, not no_str, flow_style)) + "\n"


def message_to_csv(msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """Give the values of all fields, also those deep inside, with commas between them; the rest as above."""
    return as_csv(_message(msg), Style(truncate_length, not no_arr, not no_str))


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Give a message as dictionaries, lists and scalars, its fields in their order; the rest as above."""
    style = Style(truncate_length, not no_arr, not no_str)
    ordered: OrderedDict[str, Any] = _ordered(shown_data(_message(msg), style))
    return ordered


def get_message_slot_types(msg: Any) -> OrderedDict[str, FieldType]:
    """Give each field's name and its type."""
    return OrderedDict(message_type(msg if isinstance(msg, type) else type(msg)).__ros_fields__)


def _message(msg: Any) -> Any:
    message_type(type(msg))
    return msg


def _ordered(data: Any) -> Any:
    if isinstance(data, dict):
        return OrderedDict((name, _ordered(each)) for name, each in data.items())
    return [_ordered(each) for each in data] if isinstance(data, list) else data
