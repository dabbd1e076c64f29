"""Parameter overrides: values that come from outside a program, and the nodes that they are for."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple, TypeAlias

Scalar: TypeAlias = "bool | int | float | str"
Value: TypeAlias = "Scalar | list[bool] | list[int] | list[float] | list[str]"
"""Value of a parameter that was given as text; an empty list stands for an array of any type."""


class Override(NamedTuple):
    """Value of a parameter for all nodes whose full name fits a pattern, such as `/arm/*` or `/**`.

    In a pattern `*` stands for one token of a name and `**` for any number of them.
    """

    pattern: str
    name: str
    value: Value
    is_typed: bool = False
    """True if it was typed on a command line, not read from a file."""

    def is_meant_for(self, full_node_name: str) -> bool:
        """True if a node should know it: it is for this node by name, or was typed for all of a program."""
        return (self.is_typed or "*" not in self.pattern) and self.is_for(full_node_name)

    def is_for(self, full_node_name: str) -> bool:
        """True if the pattern fits a node such as `/arm/driver`."""
        return _fits(self.pattern, full_node_name)

    def is_for_child(self, full_node_name: str) -> bool:
        """True if it is for a node that one such as `/r1/controller_server` may make itself.

        These are known by a name that is that of their namespace, too: `/r1/local_costmap/local_costmap`.
        """
        namespace, _, name = self.pattern.rpartition("/")
        around = f"{full_node_name.rpartition('/')[0]}/"
        return "*" not in name and namespace == f"{around}{name}"


def by_first_pattern(overrides: Iterable[Override]) -> list[Override]:
    """Sort the overrides of one command line as rcl keeps them: by patterns, in the order in which each first appears.

    So a file's value for a node by name, after its `/**`, wins over a later `-p` for all nodes.
    """
    groups: dict[str, list[Override]] = {}
    for each in overrides:
        groups.setdefault(each.pattern, []).append(each)
    return [each for group in groups.values() for each in group]


def overrides_for(overrides: Iterable[Override], full_node_name: str) -> dict[str, Value]:
    """Return the values for a node such as `/arm/driver`, by parameter name; later overrides win."""
    return {each.name: each.value for each in overrides if each.is_for(full_node_name)}


def _fits(pattern: str, name: str) -> bool:
    """True if a pattern fits, in steps of at most its tokens times the name's: `**` is tried nowhere twice."""
    tokens = name.removeprefix("/").split("/")
    reached = {0}  # after how many tokens of the name the pattern may stand
    for token in pattern.removeprefix("/").split("/"):
        if token == "**":
            reached = set(range(min(reached, default=len(tokens) + 1), len(tokens) + 1))
        else:
            reached = {at + 1 for at in reached if at < len(tokens) and token in ("*", tokens[at])}
    return len(tokens) in reached
