"""Construction of a node from its class, with an error that explains why a class cannot be constructed."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.workspace.load import NodeLoadError

if TYPE_CHECKING:
    from robolink.node import Node


def make_node(node_class: Callable[[], Node]) -> Node:
    """Return a new node. Raises NodeLoadError for a class that needs arguments, or does not construct its base."""
    check_needs_nothing(node_class)
    node = node_class()
    if not hasattr(node, "_owner_"):
        name = type(node).__name__
        raise NodeLoadError(f"{name}.__init__ must call super().__init__('{name.lower()}') before all else")
    return node


def check_needs_nothing(found: Callable[[], Any]) -> None:
    """Raise NodeLoadError for a class or function that needs arguments: nobody is there to give them."""
    try:
        needed = [
            each.name
            for each in inspect.signature(found).parameters.values()
            if each.default is each.empty and each.kind not in (each.VAR_POSITIONAL, each.VAR_KEYWORD)
        ]
    except (TypeError, ValueError):  # a signature that Python cannot tell
        return
    if needed:
        name, listed = getattr(found, "__name__", str(found)), ", ".join(f"'{each}'" for each in needed)
        if isinstance(found, type) and "__init__" not in vars(found):
            raise NodeLoadError(_without_init(found))
        if isinstance(found, type):
            name, otherwise = f"{name}.__init__", ", or write a main() that makes the node"
        else:
            name, otherwise = f"{name}()", f", as in {name}({needed[0]}=None)"
        raise NodeLoadError(f"{name} needs {listed}: give a default value{otherwise}")


def _without_init(found: type) -> str:
    """Return what is wrong with a class that has no `__init__` of its own: perhaps a name that is nearly that."""
    near = next((each for each in vars(found) if each.strip("_") in ("init", "int") and each != "__init__"), "")
    meant = f": {near} is to be __init__, with two _ on each side" if near else ", which gives the node its name"
    return f"{found.__name__} has no __init__ of its own{meant}"
