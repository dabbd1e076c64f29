"""Read a launch file: what it may say, and what is wrong with what it says."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from typing import Any, TypeAlias, TypeVar

import msgspec

from robolink.exceptions import DocumentError, NameValidationException, RobolinkError
from robolink.parameter_file import parse_parameter_value
from robolink.remapping import parse_remap_rule
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name
from robolink.yamlfile import Document, read, spell

T = TypeVar("T")
Place: TypeAlias = "list[str | int]"


class NodeDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """One node of a system, in a process of its own.

    `node` is a name, a file or FILE:function; a relative file is one of the launch file's workspace. An
    `interactive` node has the terminal's keyboard. `args` are the program's own arguments.
    """

    node: str
    name: str = ""
    namespace: str = ""
    parameters: dict[str, Any] = {}
    remappings: dict[str, str] = {}
    args: list[str | int | float] = []
    interactive: bool = False


class LaunchDescription(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A system: the nodes to start."""

    nodes: list[NodeDescription]


def read_launch_file(path: str | os.PathLike[str], *, text: str | None = None) -> Document[LaunchDescription]:
    """Read a launch file (or `text` in its place) and check all that can be checked without looking at nodes.

    Raises `DocumentError` with `file:line:column`.
    """
    document = read(path, LaunchDescription, text=text)
    if not document.value.nodes:
        raise document.error(["nodes"], "there is no node to start")
    for index, node in enumerate(document.value.nodes):
        _check(document, ["nodes", index], node)
    _check_terminal(document)
    return document


def parameters_of(node: NodeDescription) -> Iterator[tuple[str, str]]:
    """Yield a node's parameters as names, nested ones joined by dots, and values spelled in one line of YAML."""
    for name, _, value in _flattened(node.parameters, "", []):
        yield name, spell(value)


def absolute(namespace: str) -> str:
    """Spell a namespace with the slash in front that may be left out."""
    return namespace if namespace.startswith("/") or not namespace else f"/{namespace}"


def _check(document: Document[LaunchDescription], place: Place, node: NodeDescription) -> None:
    def check(look: Callable[[T], object], value: T, *steps: str, key: bool = False) -> None:
        try:
            look(value)
        except NameValidationException as error:
            raise document.error([*place, *steps], f"'{error.name}' {error.error_msg}", key=key) from None
        except (RobolinkError, ValueError) as error:
            raise document.error([*place, *steps], reason_of(error), key=key) from None

    if node.name:
        check(validate_node_name, node.name, "name")
    if node.namespace:
        check(validate_namespace, absolute(node.namespace), "namespace")
    for name, steps, value in _flattened(node.parameters, "", ["parameters"]):
        check(_check_parameter_name, name, *steps, key=True)
        check(_check_parameter, value, *steps)
    for match, replacement in node.remappings.items():
        check(parse_remap_rule, f"{match}:={replacement}", "remappings", match, key=True)


def _flattened(parameters: dict[str, Any], prefix: str, steps: list[str]) -> Iterator[tuple[str, list[str], Any]]:
    """Yield (dotted name, steps to its place, value) for each parameter."""
    for name, value in parameters.items():
        if isinstance(value, dict):
            yield from _flattened(value, f"{prefix}{name}.", [*steps, name])
        else:
            yield prefix + name, [*steps, name], value


def _check_parameter_name(name: str) -> None:
    if not name or any(each in ":*" or each.isspace() for each in name):
        raise ValueError(f"'{name}' is no name for a parameter")


def _check_parameter(value: Any) -> None:
    """Refuse what would arrive at the node as something else, or not at all."""
    for item in value if isinstance(value, list) else [value]:
        if item is None:
            raise ValueError("a parameter cannot be null")
        if isinstance(item, int) and not -(2**63) <= item < 2**63:
            raise ValueError(f"{item} is more than a 64-bit integer holds")
    parse_parameter_value(spell(value), "")


def reason_of(error: Exception) -> str:
    """Give what an error says, without the place that it has in a text that nobody wrote."""
    text = str(error)
    return text.split(": ", 1)[1] if isinstance(error, DocumentError) and text.startswith(":1:") else text


def _check_terminal(document: Document[LaunchDescription]) -> None:
    interactive = [index for index, node in enumerate(document.value.nodes) if node.interactive]
    if len(interactive) > 1:
        raise document.error(["nodes", interactive[1], "interactive"], "there is one keyboard, and another node has it")
