"""Functions about namespaces, remappings and names of nodes (`launch_ros.utilities`)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from robolink.launch.ros.launch.bases import LaunchArgumentError, LaunchContext, SomeSubstitutionsType, Substitution
from robolink.launch.ros.launch.utilities import normalize_to_list_of_substitutions
from robolink.launch.ros.launch_ros.parameters import (
    evaluate_parameter_dict,
    evaluate_parameters,
    normalize_parameter_dict,
    normalize_parameters,
    to_parameters_list,
)

__all__ = [
    "add_node_name",
    "evaluate_parameter_dict",
    "evaluate_parameters",
    "get_node_name_count",
    "is_namespace_absolute",
    "is_root_namespace",
    "make_namespace_absolute",
    "normalize_parameter_dict",
    "normalize_parameters",
    "normalize_remap_rule",
    "normalize_remap_rules",
    "prefix_namespace",
    "to_parameters_list",
]

RemapRule = tuple[Sequence[Substitution], Sequence[Substitution]]
"""Names of a remapping, each as substitutions that are one text."""
SomeRemapRule = tuple[SomeSubstitutionsType, SomeSubstitutionsType]
_COUNTS = "unique_ros_node_names"
"""Local of the context in which they are counted, as in ROS 2."""


def is_root_namespace(ns: str) -> bool:
    """Return whether the namespace `ns` is the root."""
    return ns == "/"


def is_namespace_absolute(ns: str) -> bool:
    """Return whether the namespace `ns` begins with a slash."""
    return ns.startswith("/")


def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """Return a namespace within the one around it; one with a slash in front stays as it is.

    Args:
        base_ns: The namespace around, None for an unknown one.
        ns: The namespace, None for an unknown one.

    >>> prefix_namespace("/fleet", "ada"), prefix_namespace("/fleet", "/ada"), prefix_namespace(None, "ada/")
    ('/fleet/ada', '/ada', 'ada')
    """
    if ns is None or not base_ns or is_namespace_absolute(ns):
        whole = base_ns if ns is None else ns
    else:
        whole = f"{base_ns.rstrip('/')}/{ns}"
    return whole if whole is None or is_root_namespace(whole) else whole.rstrip("/")


def make_namespace_absolute(ns: str | None) -> str | None:
    """Return the namespace `ns` with a slash in front; None for None."""
    return ns if ns is None or is_namespace_absolute(ns) else f"/{ns}"


def normalize_remap_rule(remap_rule: SomeRemapRule) -> RemapRule:
    """Return `remap_rule`, a pair of two names, with each name as substitutions.

    Raises LaunchArgumentError for what is not a pair.
    """
    if not isinstance(remap_rule, tuple) or len(remap_rule) != 2:
        raise LaunchArgumentError(f"a remapping is a pair of two names, got {remap_rule!r:.60}")
    match, replacement = map(normalize_to_list_of_substitutions, remap_rule)
    return tuple(match), tuple(replacement)


def normalize_remap_rules(remap_rules: Iterable[SomeRemapRule]) -> Iterator[RemapRule]:
    """Yield each of `remap_rules` as `normalize_remap_rule` returns it. Raises LaunchArgumentError."""
    yield from map(normalize_remap_rule, remap_rules)


def given_remappings(remap_rules: Iterable[Any]) -> tuple[Any, ...]:
    """Return the `remap_rules` of an action, each as `normalize_remap_rule` returns it.

    A list of two is a pair here, and what comes from a module that is not here fails only when it is used.

    Raises:
        LaunchArgumentError: for what is not a pair.
    """
    return tuple(
        each
        if isinstance(each, Substitution)
        else normalize_remap_rule(tuple(each) if isinstance(each, list) else each)
        for each in remap_rules
    )


def add_node_name(context: LaunchContext, node_name: str) -> None:
    """Count one more node with the full name `node_name` in `context`."""
    counts = context.get_locals_as_dict().get(_COUNTS)
    if counts is None:
        counts = defaultdict(int)
        context.extend_globals({_COUNTS: counts})
    counts[node_name] += 1


def get_node_name_count(context: LaunchContext, node_name: str) -> int:
    """Return how many nodes with the full name `node_name` were started with `context`."""
    counts: dict[str, int] = context.get_locals_as_dict().get(_COUNTS, {})
    return counts.get(node_name, 0)
