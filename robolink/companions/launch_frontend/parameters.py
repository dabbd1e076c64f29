"""Parameters in XML and YAML launch files: `param` elements with values, files, or further parameters inside."""

from __future__ import annotations

from typing import Any

from robolink.companions.launch_frontend.entity import Entity, Text, Value
from robolink.companions.launch_ros.parameter_descriptions import ParameterFile, ParameterValue
from robolink.exceptions import nearest

TYPES: dict[str, Any] = {
    "str": str,
    "string": str,
    "int": int,
    "integer": int,
    "float": float,
    "double": float,
    "bool": bool,
    "boolean": bool,
    "list_of_str": list[str],
    "list_of_int": list[int],
    "list_of_float": list[float],
    "list_of_bool": list[bool],
}
"""Types that an attribute `type` may name."""


def parameters_in(entity: Entity) -> list[Any]:
    """Return what the `param` elements of a node, `entity`, stand for, as the parameters of an action."""
    return [_parameter(each) for each in entity.inside("param")]


def value_of(entity: Entity) -> Any:
    """Return the `value` of an element, `entity`, as that of a parameter. Raises DocumentError."""
    value = entity.attributes.get("value")
    if value is None:
        raise entity.error("'value' is missing")
    separator, kind = entity.texts("value-sep") or entity.texts("value_sep"), entity.texts("type")
    if separator and isinstance(value, Text):
        value = [Text(each.strip()) for each in value.text.split(separator)]
    found = _one(entity, value)
    if kind is None or kind == "auto":
        return found
    if kind not in TYPES:
        raise entity.error(f"no type is called '{kind}'{nearest(kind, TYPES)}")
    return ParameterValue(found, value_type=TYPES[kind])


def _parameter(entity: Entity) -> Any:
    entity.check(("name", "value", "value-sep", "value_sep", "type", "from", "allow_substs"), ("param",))
    file = entity.optional("from")
    if file is not None:
        return ParameterFile(file, allow_substs=entity.optional("allow_substs") or False)
    name = entity.plain("name")
    if any(entity.inside("param")):
        return {name: _merged(entity)}
    return {tuple(entity.parsed(name)): value_of(entity)}


def _merged(entity: Entity) -> dict[Any, Any]:
    merged: dict[Any, Any] = {}
    for each in entity.inside("param"):
        inner = _parameter(each)
        if not isinstance(inner, dict):
            raise each.error("a file stands in no other parameter")
        merged.update(inner)
    return merged


def _one(entity: Entity, value: Value) -> Any:
    if isinstance(value, list):
        return [_one(entity, each) for each in value]
    parsed = entity.parsed(value.text)
    is_text = not value.is_plain and "$(" not in value.text
    return value.text if is_text else parsed or ""
