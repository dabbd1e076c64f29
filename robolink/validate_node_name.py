"""Check of a node's name."""

from __future__ import annotations

from typing import Literal

from robolink.exceptions import InvalidNodeNameException
from robolink.text.names import MAX_NODE_NAME, NODE_NAME_RULES, find_problem


def validate_node_name(node_name: str) -> Literal[True]:
    """Return True if `node_name` is valid. Raises InvalidNodeNameException with the index of the bad character."""
    if not isinstance(node_name, str):
        raise TypeError(f"the name of a node must be a str, not {node_name!r}")
    problem = find_problem(node_name, NODE_NAME_RULES, MAX_NODE_NAME)
    if problem is None:
        return True
    raise InvalidNodeNameException(node_name, *problem)
