"""Conversion of a message to YAML, comma-separated values, and dictionaries."""

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
    """Return a message as YAML, with a line break at its end.

    Args:
        msg: The message.
        truncate_length: Longest text or sequence that is not cut; a longer one ends in '...'. None cuts nothing.
        no_arr: True only describes sequences.
        no_str: True only describes texts.
        flow_style: True writes {a: [1, 2]} instead of blocks.

    Raises:
        MessageError: if `msg` is not a message.
    """
    return as_yaml(_message(msg), Style(truncate_length, not no_arr, not no_str, flow_style)) + "\n"


def message_to_csv(msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """Return the values of all fields, nested ones too, separated by commas.

    Args:
        msg: The message.
        truncate_length: Longest text or sequence that is not cut; a longer one ends in '...'. None cuts nothing.
        no_arr: True only describes sequences.
        no_str: True only describes texts.

    Raises:
        MessageError: if `msg` is not a message.
    """
    return as_csv(_message(msg), Style(truncate_length, not no_arr, not no_str))


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Return a message as dictionaries, lists and scalars, its fields in their order.

    Args:
        msg: The message.
        truncate_length: Longest text or sequence that is not cut; a longer one ends in '...'. None cuts nothing.
        no_arr: True only describes sequences.
        no_str: True only describes texts.

    Raises:
        MessageError: if `msg` is not a message.
    """
    style = Style(truncate_length, not no_arr, not no_str)
    ordered: OrderedDict[str, Any] = _ordered(shown_data(_message(msg), style))
    return ordered


def get_message_slot_types(msg: Any) -> OrderedDict[str, FieldType]:
    """Return the type of each field of `msg`, a message or its class, by name."""
    return OrderedDict(message_type(msg if isinstance(msg, type) else type(msg)).__ros_fields__)


def _message(msg: Any) -> Any:
    message_type(type(msg))
    return msg


def _ordered(data: Any) -> Any:
    if isinstance(data, dict):
        return OrderedDict((name, _ordered(each)) for name, each in data.items())
    if isinstance(data, list):
        return [_ordered(each) for each in data]
    return data.decode("latin-1") if isinstance(data, bytes) else data
