"""Settings that nodes inherit from the groups and includes around them, with the parameters that files give."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from robolink.arguments.overrides import Override
from robolink.arguments.parameter_file import parse_parameter_value, read_parameter_file
from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError
from robolink.launch import lookup
from robolink.launch.reading.description import GroupDescription, NodeDescription
from robolink.launch.reading.section import Place, Section
from robolink.system.terminal import shown
from robolink.workspace.find import YAML

MOST_PARAMETERS = 10_000
"""Most parameters of a node."""

_TOO_MANY = f"more than {MOST_PARAMETERS:,} parameters for one node"
_SETTINGS = ("process", "respawn", "on_exit", "log_level", "enclave", "cpu")


class Placed(NamedTuple):
    """A value and its place in a file."""

    value: Any
    place: Place


class Given(NamedTuple):
    """Given parameters, each with its place; `file` is the parameter file they were read from."""

    overrides: list[tuple[Override, Place]]
    file: Path | None = None
    place: Place | None = None


Settings: TypeAlias = "Mapping[str, Placed]"


@dataclass(frozen=True)
class Inherited:
    """Settings in effect at a node: its own and those inherited; the innermost wins.

    `namespace` is '' or begins with a slash. `given` are the parameters of all groups, outermost first.
    """

    namespace: str = ""
    settings: Settings = field(default_factory=dict)
    remappings: Settings = field(default_factory=dict)
    env: Settings = field(default_factory=dict)
    given: tuple[Given, ...] = ()
    awaited: tuple[Placed, ...] = ()

    def within(self, section: Section, group: GroupDescription, given: Iterable[Given]) -> Inherited:
        """Return the settings within a group, which gives its nodes parameters."""
        return replace(self._joined(section, group, self.inside(group.namespace)), given=(*self.given, *given))

    def with_node(self, section: Section, node: NodeDescription) -> Inherited:
        """Return the settings of a node, without its parameters."""
        return self._joined(section, node, self.namespace)

    def _joined(self, section: Section, own: NodeDescription | GroupDescription, around: str) -> Inherited:
        """Return the settings with those of a section added, whose `process` is in the namespace `around`."""
        settings = {key: Placed(getattr(own, key), Place(section, (key,))) for key in _SETTINGS if key in section}
        if own.process:  # not in the node's own namespace: copies of a node can share a process
            name = own.process if own.process.startswith("/") else f"{around}/{own.process}"
            settings["process"] = Placed(name.removeprefix("/"), Place(section, ("process",)))
        outer = {name: each for name, each in self.remappings.items() if name not in own.remappings}
        return Inherited(
            self.inside(own.namespace),
            {**self.settings, **settings},
            {**_placed(section, "remappings", own.remappings), **outer},  # the first that fits a name wins
            {**self.env, **_placed(section, "env", own.env)},
            self.given,
            (*self.awaited, *_awaited(section, own.start_after)),
        )

    def moved_to(self, namespace: str) -> Inherited:
        """Return the same settings in another namespace."""
        return replace(self, namespace=namespace)

    def inside(self, namespace: str) -> str:
        """Join the namespace of a section to the enclosing ones; one with a slash in front is absolute."""
        if not namespace:
            return self.namespace
        joined = namespace if namespace.startswith("/") else f"{self.namespace}/{namespace}"
        return "" if joined == "/" else joined


def _placed(section: Section, key: str, values: Mapping[str, Any]) -> dict[str, Placed]:
    return {name: Placed(value, Place(section, (key, name))) for name, value in values.items()}


def _awaited(section: Section, awaited: Any) -> list[Placed]:
    if isinstance(awaited, list):
        return [Placed(each, Place(section, ("start_after", index))) for index, each in enumerate(awaited)]
    return [Placed(awaited, Place(section, ("start_after",)))]


# Parameters


class Parameter(NamedTuple):
    """A parameter's value for one node; `is_wide` where it was given to more than this node."""

    value: Any
    place: Place
    is_wide: bool


def given_in(section: Section, home: Path | None) -> list[Given]:
    """Read the `parameters` of a section, parameter files included.

    Raises `DocumentError` with the place in the launch file, or in the parameter file.
    """
    data = section.get("parameters", [])
    if isinstance(data, list):
        return [_given(Place(section, ("parameters", index)), each, home) for index, each in enumerate(data)]
    return [_given(Place(section, ("parameters",)), data, home)]


def _given(place: Place, data: Any, home: Path | None) -> Given:
    if isinstance(data, dict):
        _check_ros_spelling(data, place)
        return Given(list(_inline(data, place)))
    try:
        file = lookup.parameter_file(data, home, place.section.file.folder)
        overrides = _read_at(file, file.stat().st_mtime_ns)
    except DocumentError:  # it says where in the parameter file
        raise
    except lookup.NOT_FOUND as error:
        raise place.error(lookup.reason_of(error)) from None
    return Given([(each, place) for each in overrides], file, place)


@functools.lru_cache(maxsize=8)  # a hundred copies of a node read it once
def _read_at(file: Path, changed: int) -> tuple[Override, ...]:
    return tuple(read_parameter_file(file))


def _inline(data: dict[str, Any], place: Place) -> Iterator[tuple[Override, Place]]:
    known: set[str] = set()
    flat = list(_flattened(data))
    if len(flat) > MOST_PARAMETERS:
        raise place.error(_TOO_MANY)
    for name, steps, value in flat:
        at = Place(place.section, (*place.steps, *steps))
        if "ros__parameters" in steps:
            is_of_files = "`ros__parameters` and what stands above it are for parameter files"
            raise at.error(f"{is_of_files}: write {{{shown(steps[-1])}: {shown(spell(value))}}}", key=True)
        if name in known:
            raise at.error(f"parameter '{shown(name)}' is given twice", key=True)
        if not name or any(each in ":*=" or each.isspace() or not each.isprintable() for each in name):
            raise at.error(f"'{shown(name)}' is not a name for a parameter", key=True)
        known.add(name)
        _check_value(value, at)
        yield Override("/**", name, value), at


def _flattened(
    parameters: dict[str, Any], prefix: str = "", steps: tuple[str, ...] = ()
) -> Iterator[tuple[str, tuple[str, ...], Any]]:
    """Yield (name, nested ones joined by dots; the steps to its place; value) for each parameter."""
    for name, value in parameters.items():
        if isinstance(value, dict):
            yield from _flattened(value, f"{prefix}{name}.", (*steps, name))
        else:
            yield prefix + name, (*steps, name), value


def _check_value(value: Any, place: Place) -> None:
    """Raise `DocumentError` for a value that would arrive at the node as something else, or not at all."""
    for item in value if isinstance(value, list) else [value]:
        if item is None:
            raise place.error("a parameter cannot be null: give a value, or leave it out")
        if isinstance(item, int) and not -(2**63) <= item < 2**63:
            raise place.error(f"{item} is more than a 64-bit integer holds")
    if isinstance(value, list):
        try:
            parse_parameter_value(spell(value), "")
        except DocumentError as error:  # its place is one in a text that nobody wrote
            raise place.error(error.message) from None


def _check_ros_spelling(data: dict[str, Any], place: Place) -> None:
    if len(place.steps) > 1 and data.keys() == {"from"} and str(data["from"]).endswith(YAML):
        raise place.error(f"a parameter file is given by its name: write {shown(data['from'])}")
    if len(place.steps) > 1 and data.keys() == {"name", "value"}:
        name = shown(str(data["name"]))
        raise place.error(f"parameters are given as {{name: value}}: write {{{name}: {shown(spell(data['value']))}}}")


def parameters_for(full_name: str, given: Iterable[Given], own: Iterable[Given]) -> dict[str, Parameter]:
    """Return the parameters of a node by name, nested names joined by dots; the last one given wins.

    `own` are the node's own, `given` those of the groups around it. Raises `DocumentError` for a file that the node
    itself names and that has parameters for other nodes only. Those of a file for nodes that the node may make itself
    are called `/local_costmap/local_costmap:width`.
    """
    found: dict[str, Parameter] = {}
    for each in given:
        found.update(_for_children(full_name, each))
        found.update((o.name, Parameter(o.value, at, is_wide=True)) for o, at in each.overrides if o.is_for(full_name))
    for each in own:
        fitting = [(o, at) for o, at in each.overrides if o.is_for(full_name)]
        if each.overrides and not fitting and each.file is not None and each.place is not None:
            raise each.place.error(_nothing_for(full_name, each.file, each.overrides))
        found.update(_for_children(full_name, each))
        for override, at in fitting:
            is_wide = each.file is not None and "*" in override.pattern
            found[override.name] = Parameter(override.value, at, is_wide)
    if len(found) > MOST_PARAMETERS:
        raise next(reversed(found.values())).place.error(_TOO_MANY)
    return found


def _for_children(full_name: str, given: Given) -> Iterator[tuple[str, Parameter]]:
    """Yield the parameters of a file for nodes that the program of a node may make, called `/child/child:name`."""
    for override, at in given.overrides if given.file is not None else ():
        if override.is_for_child(full_name):
            yield f"{override.pattern}:{override.name}", Parameter(override.value, at, is_wide=True)


def _nothing_for(full_name: str, file: Path, overrides: Iterable[tuple[Override, Place]]) -> str:
    sections = ", ".join(list(dict.fromkeys(each.pattern for each, _ in overrides))[:3])
    return f"{file.name} has nothing for {full_name}, only for {sections}: if the node is that one, `name` it so"
