"""Values of parameters on the command line: YAML in, text, JSON and parameter files out."""

from __future__ import annotations

import functools
from collections.abc import Iterable
from typing import Any

from robolink.arguments.parameter_file import PARAMETERS_KEY, parse_parameter_value, parse_scalar
from robolink.exceptions import DocumentError
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor, ParameterValue
from robolink.parameter import (
    PARAMETER_SEPARATOR_STRING,
    Parameter,
    parameter_value_to_python,
)
from robolink.system.terminal import fit, is_fit

Type = Parameter.Type

# What ros2 calls the types, and what it writes before a value.
NAMES = {
    Type.NOT_SET: "not set",
    Type.BOOL: "boolean",
    Type.INTEGER: "integer",
    Type.DOUBLE: "double",
    Type.STRING: "string",
    Type.BYTE_ARRAY: "byte array",
    Type.BOOL_ARRAY: "boolean array",
    Type.INTEGER_ARRAY: "integer array",
    Type.DOUBLE_ARRAY: "double array",
    Type.STRING_ARRAY: "string array",
}


def type_name(number: int) -> str:
    """Return ros2's name of a type; an unknown number as it is."""
    return NAMES[Type(number)] if number in NAMES else f"unknown ({number})"


def label(number: int) -> str:
    """Return the label before a value: ``Double value is:``.

    >>> label(Type.STRING_ARRAY)
    'String values are:'
    """
    name = type_name(number).capitalize()
    scalar = name.removesuffix(" array")
    return f"{name} value is:" if scalar == name else f"{scalar} values are:"


def plain(value: ParameterValue) -> Any:
    """Return a value as JSON and YAML have it; bytes as numbers."""
    found = parameter_value_to_python(value)
    return [each[0] for each in found] if value.type == Type.BYTE_ARRAY else found


def read(text: str, descriptor: ParameterDescriptor | None) -> ParameterValue:
    """Return the value of a text that was typed, for a parameter of this descriptor if that is known.

    A text that is not a single value of YAML is a string. Where the parameter's type is fixed, the value takes it if it
    can: 1 is a double then, and 123 a string.
    """
    try:
        value: Any = parse_parameter_value(text)
    except DocumentError:
        value = text
    is_string = descriptor is not None and not descriptor.dynamic_typing and descriptor.type == Type.STRING
    return fitting(text if is_string and not isinstance(value, str) else value, descriptor)


def fitting(value: Any, descriptor: ParameterDescriptor | None) -> ParameterValue:
    """Return a plain value with the type that the descriptor fixes, if it can have it; else with its own."""
    type_ = Type.from_parameter_value(value)
    if descriptor is not None and not descriptor.dynamic_typing:
        requested = descriptor.type
        if requested == Type.DOUBLE and type_ is Type.INTEGER:
            value = float(value)
        elif requested == Type.DOUBLE_ARRAY and type_ is Type.INTEGER_ARRAY:
            value = [float(each) for each in value]
        elif requested == Type.BYTE_ARRAY and type_ is Type.INTEGER_ARRAY and all(0 <= each < 256 for each in value):
            value = [bytes([each]) for each in value]
        if requested in NAMES and Type(requested).check(value):
            return Parameter("", Type(requested), value).get_parameter_value()
    return Parameter("", value=value).get_parameter_value()


def as_file(node: str, values: dict[str, Any]) -> str:
    """Return plain values as the text of a parameter file; the dots of names become levels."""
    import yaml

    document = {node: {PARAMETERS_KEY: nested(values)}}
    text = yaml.dump(document, Dumper=_dumper(), default_flow_style=False, allow_unicode=True, width=2**31 - 1)
    return fit(str(text).removesuffix("\n"))


def nested(values: dict[str, Any]) -> dict[str, Any]:
    """Return ``a.b`` below ``a``, unless that is a parameter itself, or a name has a part that is empty."""
    tree: dict[str, Any] = {}
    for name, value in values.items():
        parts = name.split(PARAMETER_SEPARATOR_STRING)
        above = {PARAMETER_SEPARATOR_STRING.join(parts[:at]) for at in range(1, len(parts))}
        if above & values.keys() or not all(parts):
            tree[name] = value
            continue
        place = tree
        for part in parts[:-1]:
            place = place.setdefault(part, {})
        place[parts[-1]] = value
    return tree


@functools.cache
def _dumper() -> Any:
    import yaml

    class Dumper(yaml.SafeDumper):
        """YAML writer that also quotes texts which only ROS 2 would read as something else, such as ``1e3``."""

        def ignore_aliases(self, data: Any) -> bool:
            """Return True: a value that occurs twice is written twice, since ROS 2 knows no aliases."""
            return True

    def text_node(dumper: yaml.SafeDumper, text: str) -> yaml.ScalarNode:
        is_text = parse_scalar(text) == text
        style = '"' if not is_fit(text) else None if is_text else "'"  # within double quotes escapes are read back
        return dumper.represent_scalar("tag:yaml.org,2002:str", text, style=style)

    Dumper.add_representer(str, text_node)
    return Dumper


def in_json(values: Iterable[tuple[str, ParameterValue]]) -> dict[str, Any]:
    """Return values by name, as `plain` has them."""
    return {name: plain(value) for name, value in values}
