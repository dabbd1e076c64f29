"""Builders of message types for tests: from texts, and from type descriptions."""

from collections.abc import Callable
from typing import Any

from robolink.interfaces import find
from robolink.message.building import build
from robolink.message.definition import parse
from robolink.message.description import (
    FieldDescription,
    TypeDescription,
)


def find_full(name: str) -> Any:
    return find(name, name.split("/")[1])


def built(text: str, type_name: str = "my_msgs/msg/Foo", resolve: Callable[[str], Any] = find_full) -> Any:
    return build(parse(text, type_name, "Foo"), resolve)


def field(
    name: str, type_id: int, capacity: int = 0, string_capacity: int = 0, nested: str = "", **more: Any
) -> FieldDescription:
    return FieldDescription(name, type_id, capacity, string_capacity, nested, **more)


def of(*fields: FieldDescription, name: str = "a/msg/B", **referenced: Any) -> TypeDescription:
    types = tuple(TypeDescription(f"a/msg/{short}", fields) for short, fields in referenced.items())
    return TypeDescription(name, fields, types)


def named(types: dict[str, Any]) -> Any:
    """Types whose names are no keywords that Python could write."""
    return types
