"""Parameters in XML and YAML launch files: `param` elements with values, files, or further parameters inside."""

from __future__ import annotations

from typing import Any

import yaml

from robolink.companions.launch.bases import LaunchError
from robolink.companions.launch.typed_values import as_node_reads, checked, coerced, item_type
from robolink.companions.launch.utilities import TextSubstitution
from robolink.companions.launch_frontend.entity import Entity
from robolink.companions.launch_ros.parameter_descriptions import ParameterFile, ParameterValue
from robolink.exceptions import nearest
from robolink.system.terminal import shown

TYPES: dict[str, Any] = {
    "str": str,
    "int": int,
    "float": float,
    "bool": bool,
    "list_of_str": list[str],
    "list_of_int": list[int],
    "list_of_float": list[float],
    "list_of_bool": list[bool],
    "yaml": None,
}
"""Types that an attribute `type` may name."""
OTHER_TYPES = {"double": "float", "string": "str", "integer": "int", "boolean": "bool"}


def parameters_in(entity: Entity) -> list[Any]:
    """Return what the `param` elements of a node, `entity`, stand for, as the parameters of an action."""
    return [_parameter(each) for each in entity.inside("param")]


def value_of(entity: Entity) -> ParameterValue:
    """Return the `value` of an element, `entity`, as that of a parameter. Raises DocumentError."""
    if "value" not in entity.attributes:
        raise entity.error("'value' is missing")
    kind = _kind(entity)
    try:
        value = _typed(entity, kind) if entity.is_typed else _coerced(entity, kind)
    except LaunchError as error:
        raise entity.error(str(error)) from None
    found = [_plain(entity, each, kind) for each in value] if isinstance(value, list) else _plain(entity, value, kind)
    return ParameterValue(found, value_type=kind)


def _kind(entity: Entity) -> Any:
    """Return the type that `type` names; None leaves it to YAML."""
    name = entity.texts("type")
    if name is not None and name not in TYPES:
        hint = nearest(name, TYPES) or f": {OTHER_TYPES[name]}" if name in OTHER_TYPES else f": {', '.join(TYPES)}"
        raise entity.error(f"no type is called '{shown(name)}'{hint}")
    return TYPES[name or "yaml"]


def _typed(entity: Entity, kind: Any) -> Any:
    """Return a value of YAML, which has its type; texts may hold substitutions. Raises LaunchError for another type."""
    value = entity.attributes["value"]
    texts = [each for each in value if not isinstance(each, str)] if isinstance(value, list) else value
    if isinstance(value, str) or texts == []:
        return value
    checked(texts, value)
    inner = item_type(kind)
    wanted = kind if inner is None else list
    if kind is not None and not isinstance(value, wanted):
        raise LaunchError(f"'value' is of type {entity.texts('type')}, got {value!r:.40}")
    if inner is not None and not all(isinstance(each, inner) for each in texts):
        raise LaunchError(f"'value' is a {entity.texts('type')}, got {value!r:.40}")
    return value


def _coerced(entity: Entity, kind: Any) -> Any:
    """Return a value of XML as its type has it; texts stay what they are if they do not spell one."""
    text = str(entity.attributes["value"])
    separator = entity.texts("value-sep")
    if separator:
        inner = item_type(kind)
        if kind is not None and inner is None:
            raise LaunchError(f"'value' is of type {entity.texts('type')}, and 'value-sep' makes a list")
        return [_read(each, inner) for each in text.split(separator)]
    if "$(" in text and item_type(kind) is None and kind is not None:
        return text
    return _read(text, kind)


def _read(text: str, kind: Any) -> Any:
    """Return `text` as YAML reads it; a list may hold texts with substitutions. Raises LaunchError."""
    if kind is not None and item_type(kind) is None:
        return coerced(text, kind)
    try:
        value = yaml.safe_load(text) if text else text
    except (yaml.YAMLError, ValueError, RecursionError):
        return text
    inner = item_type(kind)
    if inner is not None and not isinstance(value, list):
        raise LaunchError(f"expected a list of {inner.__name__}, got '{shown(text)}'")
    if not isinstance(value, list):
        return checked(value, text)
    plain = [each for each in value if not isinstance(each, str)]
    checked(plain if plain else value, text)
    if inner is not None and not all(isinstance(each, (str, inner)) for each in value):
        raise LaunchError(
            f"expected a list of {inner.__name__}, got '{shown(text)}'"
            + (": write 1.0 for 1" if inner is float else "")
        )
    return value


def _parameter(entity: Entity) -> Any:
    if "from" in entity.attributes:
        entity.check(("from", "allow_substs"))
        return ParameterFile(entity.needed("from"), allow_substs=entity.optional("allow_substs", bool) or False)
    name = tuple(entity.needed("name"))
    if entity.children:
        entity.check(("name",), ("param",))
        return {name: _merged(entity)}
    entity.check(("name", "value", "type") if entity.is_typed else ("name", "value", "value-sep", "type"))
    return {name: value_of(entity)}


def _merged(entity: Entity) -> dict[Any, Any]:
    merged: dict[Any, Any] = {}
    for each in entity.inside("param"):
        inner = _parameter(each)
        if not isinstance(inner, dict):
            raise each.error("a file stands in no other parameter")
        merged.update(inner)
    return merged


def _parsed(entity: Entity, value: Any) -> Any:
    """Return a text with its substitutions, a text without any as it is, and any other value."""
    if not isinstance(value, str) or not value:
        return value
    parts = entity.parsed(value)
    return parts[0].text if len(parts) == 1 and isinstance(parts[0], TextSubstitution) else parts


def _plain(entity: Entity, value: Any, kind: Any) -> Any:
    """Return a value with its substitutions; a text of no type is what the node reads."""
    found = _parsed(entity, value)
    return as_node_reads(found) if kind is None else found
