"""Options of a plugin of Nav2's servers: a dataclass whose fields are parameters, read from a node."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, TypeVar

from robolink.exceptions import RobolinkError, nearest
from robolink.node import Node
from robolink.parameters.descriptors import described

OptionsT = TypeVar("OptionsT")

MOST = 1e6
"""Largest size of a number."""


class PluginError(RobolinkError, ValueError):
    """Parameters with which a plugin cannot be made; the text names the parameter and the values that it may have."""


def read_options(node: Node, name: str, kind: type[OptionsT], words: Mapping[str, str]) -> OptionsT:
    """Declare the fields of a dataclass as parameters `NAME.FIELD` of a node, and return it with their values.

    Args:
        node: The node.
        name: Name of the plugin.
        kind: The dataclass; its defaults are the parameters' own.
        words: Description of each field.
    """
    values = {}
    for field in fields(kind):  # type: ignore[arg-type]
        default: Any = field.default
        bounds = () if isinstance(default, (bool, str)) else (-type(default)(MOST), type(default)(MOST))
        parameter = f"{name}.{field.name}"
        if not node.has_parameter(parameter):
            node.declare_parameter(parameter, default, described(words[field.name], *bounds))
        values[field.name] = node.get_parameter(parameter).value
    return kind(**values)


def plugin_of(node: Node, name: str, default: str, known: Mapping[str, Any]) -> str:
    """Return the plugin that the parameter `NAME.plugin` says, with `::` in its name.

    Raises:
        PluginError: if it is not among the `known` ones.
    """
    parameter = f"{name}.plugin"
    if not node.has_parameter(parameter):
        node.declare_parameter(parameter, default, described("kind of this plugin"))
    plugin = str(node.get_parameter(parameter).value).replace("/", "::")
    if plugin not in known:
        raise PluginError(
            f"{parameter}: expected one of {', '.join(known)}, got '{plugin}'{nearest(plugin, known)}; "
            f"change it, or take '{name}' out of the list of plugins"
        )
    return plugin


def names_of(node: Node, parameter: str, default: list[str], words: str) -> list[str]:
    """Declare a parameter that lists names of plugins, and return them; an empty one lists none."""
    if not node.has_parameter(parameter):
        node.declare_parameter(parameter, default, described(words))
    found: Any = node.get_parameter(parameter).value or []
    return [each for each in found if each]
