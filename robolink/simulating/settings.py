"""Change what a launch file says before it is run: parameters of its nodes; and the seed of numpy's chance."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import msgspec

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.launch import Entry
from robolink.names import meant
from robolink.parameter_file import parse_parameter_value

ASSIGN = ":="


class SettingError(RobolinkError, ValueError):
    """A parameter that is set on the command line is not said as NODE.PARAMETER:=VALUE."""


def parse_settings(texts: Iterable[str]) -> dict[str, Any]:
    """Read `node.parameter:=value` into values by `node.parameter`; values are YAML.

    Raises `SettingError`, and `DocumentError` for a value that none can be.
    """
    return dict(map(_parsed, texts))


def _parsed(text: str) -> tuple[str, Any]:
    place, assigned, value = text.partition(ASSIGN)
    node, dot, parameter = place.partition(".")
    if not (assigned and node and dot and parameter):
        raise SettingError(f"--set: expected NODE.PARAMETER:=VALUE, got '{text}'")
    return place, parse_parameter_value(value, f"--set {place}")


def with_parameters(entries: Sequence[Entry], values: Mapping[str, Any]) -> list[Entry]:
    """Set parameters, given as `{"wall_follower.speed": 0.2}`.

    A node is called as the launch file calls it; a name alone also means the nodes of that name in all namespaces.
    Raises `NotFoundError` with the nearest name for a node that is not there.
    """
    changed = list(entries)
    for place, value in values.items():
        changed = _with_parameter(changed, place, value)
    return changed


def _with_parameter(entries: list[Entry], place: str, value: Any) -> list[Entry]:
    node, _, parameter = place.lstrip("/").partition(".")
    names = [each.name for each in entries]
    found = meant(node, names)
    if not found:
        raise NotFoundError("node", node, names, "the launch file")
    return [_changed(each, parameter, value) if each.name in found else each for each in entries]


def _changed(entry: Entry, parameter: str, value: Any) -> Entry:
    parameters = {**entry.node.parameters, parameter: value}
    return replace(entry, node=msgspec.structs.replace(entry.node, parameters=parameters))


@contextmanager
def numpy_seeded(seed: int) -> Iterator[None]:
    """Seed numpy's own generator for a while, as a host does Python's."""
    import numpy as np  # in any case: a node may import it later

    before = np.random.get_state()
    np.random.seed(seed)
    try:
        yield
    finally:
        np.random.set_state(before)
