"""What is wrong with what a launch file says, as far as that shows without looking at its nodes' code."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar

from robolink.exceptions import DocumentError, NameValidationException, RobolinkError
from robolink.launch.copies import Copy
from robolink.launch.description import LaunchDescription
from robolink.parameter_file import parse_parameter_value
from robolink.remapping import parse_remap_rule
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name
from robolink.yamlfile import Document, spell

T = TypeVar("T")


def check(document: Document[LaunchDescription], copies: Iterable[Copy]) -> None:
    """Check names, parameters and remappings of the nodes, and who has the keyboard. Raises `DocumentError`."""
    found = list(copies)
    if not found:
        raise document.error(["nodes"], "there is no node to start")
    for each in found:
        _check_node(document, each)
    _check_terminal(document, found)


def flattened(
    parameters: dict[str, Any], prefix: str = "", steps: tuple[str, ...] = ()
) -> Iterator[tuple[str, tuple[str, ...], Any]]:
    """Yield (name, nested ones joined by dots; the steps to its place; value) for each parameter."""
    for name, value in parameters.items():
        if isinstance(value, dict):
            yield from flattened(value, f"{prefix}{name}.", (*steps, name))
        else:
            yield prefix + name, (*steps, name), value


def absolute(namespace: str) -> str:
    """Spell a namespace with the slash in front that may be left out."""
    return namespace if namespace.startswith("/") or not namespace else f"/{namespace}"


def _check_node(document: Document[LaunchDescription], copy: Copy) -> None:
    def check(look: Callable[[T], object], value: T, *steps: str, key: bool = False) -> None:
        try:
            look(value)
        except NameValidationException as error:
            raise document.error([*copy.place, *steps], f"'{error.name}' {error.error_msg}", key=key) from None
        except (RobolinkError, ValueError) as error:
            raise document.error([*copy.place, *steps], _reason_of(error), key=key) from None

    node, written = copy.node, copy.written
    if node.name:
        check(validate_node_name, node.name, "name")
    if node.namespace:
        check(validate_namespace, absolute(node.namespace), "namespace")
    if node.process:
        check(validate_node_name, node.process, "process")
    # Where something stands in the file is found by what is written there, not by what became of it.
    places = (steps for _, steps, _ in flattened(written.parameters))
    for steps, (name, _, value) in zip(places, flattened(node.parameters), strict=True):
        check(_check_parameter_name, name, "parameters", *steps, key=True)
        check(_check_parameter, value, "parameters", *steps)
    for place, (match, replacement) in zip(written.remappings, node.remappings.items(), strict=True):
        check(parse_remap_rule, f"{match}:={replacement}", "remappings", place, key=True)


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


def _reason_of(error: Exception) -> str:
    """Give what an error says, without the place that it has in a text that nobody wrote."""
    text = str(error)
    return text.split(": ", 1)[1] if isinstance(error, DocumentError) and text.startswith(":1:") else text


def _check_terminal(document: Document[LaunchDescription], copies: Iterable[Copy]) -> None:
    interactive = [each for each in copies if each.node.interactive]
    if len(interactive) > 1:
        place = [*interactive[1].place, "interactive"]
        raise document.error(place, "there is one keyboard, and another node has it")
    for each in interactive:
        if each.node.process:
            place = [*each.place, "interactive"]
            raise document.error(place, "a node with the keyboard cannot share a process: leave `process` out")
