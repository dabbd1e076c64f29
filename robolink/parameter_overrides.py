"""Values for parameters that come from outside a program, and the nodes that they are for."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache
from typing import NamedTuple, TypeAlias

Scalar: TypeAlias = "bool | int | float | str"
Value: TypeAlias = "Scalar | list[bool] | list[int] | list[float] | list[str]"
"""What a parameter can be given as text; an empty list stands for an array of any type."""


class Override(NamedTuple):
    """A parameter's value for all nodes whose full name fits the pattern, such as `/arm/*` or `/**`.

    In a pattern `*` stands for one token of a name and `**` for any number of them.
    """

    pattern: str
    name: str
    value: Value
    is_typed: bool = False
    """Whether it was typed on a command line, not read from a file."""

    def is_meant_for(self, full_node_name: str) -> bool:
        """Say whether a node should know it: it is for this node by name, or was typed for all of a program."""
        return (self.is_typed or "*" not in self.pattern) and self.is_for(full_node_name)

    def is_for(self, full_node_name: str) -> bool:
        """Say whether the pattern fits a node such as `/arm/driver`."""
        return _compiled(self.pattern).fullmatch(full_node_name) is not None


def overrides_for(overrides: Iterable[Override], full_node_name: str) -> dict[str, Value]:
    """Give the values for a node such as `/arm/driver`, by parameter name; later overrides win."""
    return {each.name: each.value for each in overrides if each.is_for(full_node_name)}


@lru_cache(maxsize=256)
def _compiled(pattern: str) -> re.Pattern[str]:
    wild = {"**": r"(?:/[^/]+)*", "*": r"/[^/]+"}
    tokens = pattern.removeprefix("/").split("/")
    return re.compile("".join(wild.get(token, "/" + re.escape(token)) for token in tokens))
