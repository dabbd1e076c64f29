"""Types that attributes of XML and YAML launch files name."""

from __future__ import annotations

import typing
from typing import Any, List  # noqa: UP035 - ROS 2 names its list types by it

from robolink.exceptions import nearest
from robolink.launch.ros.launch.frontend.entity import Entity
from robolink.launch.ros.launch.typed_values import ValueTypeError, is_typing_list
from robolink.system.terminal import shown

__all__ = [
    "check_is_list_entity",
    "get_data_type_from_identifier",
]

TYPES: dict[str, Any] = {
    "str": str,
    "int": int,
    "float": float,
    "bool": bool,
    "list_of_str": List[str],  # noqa: UP006
    "list_of_int": List[int],  # noqa: UP006
    "list_of_float": List[float],  # noqa: UP006
    "list_of_bool": List[bool],  # noqa: UP006
    "yaml": None,
}
"""Types that an attribute `type` may name."""
OTHER_TYPES = {"double": "float", "string": "str", "integer": "int", "boolean": "bool"}


def check_is_list_entity(data_type: Any) -> bool:
    """Return whether `data_type` is a list type of elements."""
    items = typing.get_args(data_type) if is_typing_list(data_type) else ()
    return any(isinstance(each, type) and issubclass(each, Entity) for each in items)


def get_data_type_from_identifier(type_identifier: str) -> Any:
    """Return the type that `type_identifier` names; None for `yaml`. Raises ValueTypeError for a name of none."""
    if type_identifier not in TYPES:
        other = OTHER_TYPES.get(type_identifier, ", ".join(TYPES))
        hint = nearest(type_identifier, TYPES) or f": {other}"
        raise ValueTypeError(f"no type is called '{shown(type_identifier)}'{hint}")
    return TYPES[type_identifier]
