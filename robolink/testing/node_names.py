"""Names of nodes under test: a node, its stand-in, or its name are equally good."""

from __future__ import annotations

from typing import Protocol, runtime_checkable


@runtime_checkable
class Named(Protocol):
    """Protocol of a node or its stand-in."""

    def get_fully_qualified_name(self) -> str:
        """Return the node's namespace and name."""


def full(node: str | Named) -> str:
    """Return the name of a node with its leading slash. Raises TypeError for any other object."""
    __tracebackhide__ = True
    if isinstance(node, str):
        return f"/{node.strip('/')}"
    if isinstance(node, Named) and not isinstance(node, type):
        return node.get_fully_qualified_name()
    raise TypeError(f"expected a node or its name, got {node!r}")
