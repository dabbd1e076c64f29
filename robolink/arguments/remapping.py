"""Remap rules: other names for nodes, topics and services, given from outside a program."""

from __future__ import annotations

import re
from collections.abc import Iterable
from enum import Flag

import msgspec

from robolink.exceptions import NameValidationException, nearest
from robolink.expand_topic_name import expand_topic_name
from robolink.system.patterns import late
from robolink.validate_full_topic_name import validate_full_topic_name
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name
from robolink.validate_topic_name import validate_topic_name


class RemapKind(Flag):
    """Kind of name that a rule replaces."""

    NODE = 1
    NAMESPACE = 2
    TOPIC = 4
    SERVICE = 8


class RemapRule(msgspec.Struct, frozen=True):
    """Remap rule: `match` becomes `replacement`, in the node called `node` only, or in all if that is None.

    `match` is empty in rules for node names and namespaces.
    """

    kind: RemapKind
    match: str
    replacement: str
    node: str | None = None


_RULE = late(
    r"(?:(?P<node>[A-Za-z_][A-Za-z0-9_]*):(?!=|//))?"  # `rostopic://` names no node, `camera:/image` does
    r"(?:(?P<scheme>rostopic|rosservice)://)?"
    r"(?P<match>.*?):=(?P<replacement>.*)",
    re.DOTALL,
)
# As rcl reads rules: narrower than topics are, which may have {node} in them, two underscores, or be ~ alone.
_NAME = late(r"(?:~?/)?[A-Za-z_][A-Za-z0-9_]*(?:/[A-Za-z_][A-Za-z0-9_]*)*")
_SCHEMES = {
    None: RemapKind.TOPIC | RemapKind.SERVICE,
    "rostopic": RemapKind.TOPIC,
    "rosservice": RemapKind.SERVICE,
}
_NODE_KEYS = {"__node": RemapKind.NODE, "__name": RemapKind.NODE, "__ns": RemapKind.NAMESPACE}


def parse_remap_rule(text: str) -> RemapRule:
    """Read `from:=to`, `node:from:=to`, `__node:=name`, `__ns:=/namespace`, `rostopic://from:=to`.

    Raises `ValueError` with a one-line reason for anything else.
    """
    parts = _RULE.fullmatch(text)
    if parts is None:
        raise ValueError("expected from:=to, such as scan:=lidar/scan")
    match, replacement = parts["match"], parts["replacement"]
    if "__" in (parts["node"] or ""):
        raise ValueError(f"a node's name in a rule has no two underscores in a row: '{parts['node']}'")
    kind = _NODE_KEYS.get(match) if parts["scheme"] is None else None
    try:
        if kind is None:
            kind = _SCHEMES[parts["scheme"]]
            _check_names(match, replacement)
            return RemapRule(kind, match, replacement, parts["node"])
        (validate_node_name if kind is RemapKind.NODE else validate_namespace)(replacement)
        return RemapRule(kind, "", replacement, parts["node"])
    except NameValidationException as error:
        raise ValueError(f"{error.name_type} '{error.name}' {error.error_msg}") from None


def _check_names(match: str, replacement: str) -> None:
    if match.startswith("__"):
        raise ValueError(f"no name to remap is called '{match}'{nearest(match, _NODE_KEYS)}")
    if "*" in match:
        raise ValueError(f"wildcards are not supported: '{match}'")
    for name in (match, replacement):
        expand_topic_name(name, "node", "/")
        if _NAME.fullmatch(name) is None:
            raise ValueError(f"expected a name such as scan, /lidar/scan or ~/scan, got '{name}'")
        if "__" in name:
            raise ValueError(f"names in a rule have no two underscores in a row: '{name}'")


def remap_node(rules: Iterable[RemapRule], kind: RemapKind, node_name: str) -> str | None:
    """Return the new name (or namespace) of a node, or None if no rule is for it."""
    fitting = (rule for rule in rules if rule.kind is kind and rule.node in (None, node_name))
    return next((rule.replacement for rule in fitting), None)


def remap_name(rules: Iterable[RemapRule], kind: RemapKind, full_name: str, node_name: str, namespace: str) -> str:
    """Return the new full name of a node's topic or service: the first rule that matches decides.

    Both sides of a rule are expanded with the node's name and namespace, which must be valid.
    """
    for rule in rules:
        if kind not in rule.kind or rule.node not in (None, node_name):
            continue
        if expand_topic_name(rule.match, node_name, namespace) == full_name:
            return expand_topic_name(rule.replacement, node_name, namespace)
    return full_name


def resolve_name(rules: Iterable[RemapRule], kind: RemapKind, name: str, node_name: str, namespace: str) -> str:
    """Expand the name of a topic (or service), remap it, and check what came out.

    Raises `InvalidTopicNameException` (`InvalidServiceNameException` where the kind is SERVICE).
    """
    is_service = kind is RemapKind.SERVICE
    validate_topic_name(name, is_service=is_service)
    full_name = remap_name(rules, kind, expand_topic_name(name, node_name, namespace), node_name, namespace)
    validate_full_topic_name(full_name, is_service=is_service)
    return full_name
