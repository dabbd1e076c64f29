"""Settings of a run: parameters that override those of a launch file, and the seed of numpy's generator."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import msgspec

from robolink.arguments.parameter_file import parse_parameter_value
from robolink.exceptions import NotFoundError, RobolinkError
from robolink.launch import Entry
from robolink.text.names import meant

if TYPE_CHECKING:
    from robolink.launch.entry import Stage, System
    from robolink.node import Node
    from robolink.supervisor.director import Director, Request

T = TypeVar("T")
ASSIGN = ":="


class SettingError(RobolinkError, ValueError):
    """A parameter on the command line is not of the form NODE.PARAMETER:=VALUE."""


def parse_settings(texts: Iterable[str]) -> dict[str, Any]:
    """Parse `node.parameter:=value` into values by `node.parameter`; values are YAML.

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
    """Return entries of a launch file with parameters set.

    Args:
        entries: Entries of a launch file; they are not changed.
        values: Values by node and parameter: `{"wall_follower.speed": 0.2}`. A node is called as the launch file calls
            it; a name alone also means the nodes of that name in all namespaces.

    Returns:
        All entries, in their order.

    Raises:
        NotFoundError: with the nearest name, if a node is not there.
    """
    changed = list(entries)
    for place, value in values.items():
        changed = _with_parameter(changed, place, value)
    return changed


def with_settings(system: System, values: Mapping[str, Any], foreseen: Callable[[], list[Entry]]) -> System:
    """Return a system with parameters set, also those of nodes that its launch file starts later.

    Args:
        system: The system; it is not changed.
        values: Values by node and parameter, as for `with_parameters`.
        foreseen: Returns all entries that the launch file will start, as far as that is known.

    Returns:
        The system with these values.

    Raises:
        NotFoundError: with the nearest name, if a node is not there.
    """
    if system.direct is None or not values:
        return system._replace(entries=with_parameters(system.entries, values))
    with_parameters(foreseen(), values)

    def known(entries: Sequence[Entry]) -> list[Entry]:
        names = [each.name for each in entries]
        fitting = {place: each for place, each in values.items() if meant(place.lstrip("/").partition(".")[0], names)}
        return with_parameters(entries, fitting)

    made = system.direct

    def direct(stage: Stage[T]) -> Director[T]:
        return made(_Adjusted(stage, known))

    return system._replace(entries=known(system.entries), direct=direct)


class _Adjusted(Generic[T]):
    """Stage that changes entries before it plans them."""

    def __init__(self, stage: Stage[T], adjust: Callable[[list[Entry]], list[Entry]]) -> None:
        self._stage, self._adjust = stage, adjust

    def plan(self, entries: list[Entry]) -> Sequence[T]:
        """Return the processes in which the changed entries run."""
        return self._stage.plan(self._adjust(entries))

    def with_node(self, act: Callable[[Node], object]) -> None:
        """Call `act` with the launcher's own node."""
        self._stage.with_node(act)

    def post(self, act: Callable[[float], Sequence[Request[T]]]) -> None:
        """Call `act` where the director is asked."""
        self._stage.post(act)


def _with_parameter(entries: list[Entry], place: str, value: Any) -> list[Entry]:
    node, _, parameter = place.lstrip("/").partition(".")
    names = [each.name for each in entries]
    found = meant(node, names)
    if not found:
        raise NotFoundError("node", node, names, "the launch file")
    return [_changed(each, parameter, value) if each.name in found else each for each in entries]


def _changed(entry: Entry, parameter: str, value: Any) -> Entry:
    parameters = {**entry.node.parameters, parameter: value}
    node = msgspec.structs.replace(entry.node, parameters=parameters)
    return replace(entry, node=node, wide=entry.wide - {parameter})


@contextmanager
def numpy_seeded(seed: int) -> Iterator[None]:
    """Seed numpy's global generator inside a `with`, as a host does Python's; restore its state after it."""
    import numpy as np  # in any case: a node may import it later

    before = np.random.get_state()
    np.random.seed(seed)
    try:
        yield
    finally:
        np.random.set_state(before)
