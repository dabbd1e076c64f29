"""Node parameters of a launch file: given by name, by parameter files, or by both."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from robolink.arguments.overrides import Override
from robolink.arguments.parameter_file import parse_parameter_value, read_parameter_file
from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError
from robolink.launch import lookup
from robolink.launch.reading import limits
from robolink.launch.reading.section import Place, Section
from robolink.launch.reading.substitution import Step
from robolink.system.terminal import shown
from robolink.workspace.find import YAML

_TOO_MANY = f"more than {limits.MOST_PARAMETERS:,} parameters for one node"


class Given(NamedTuple):
    """Given parameters, each with its place; `file` is the parameter file they were read from."""

    overrides: list[tuple[Override, Place]]
    file: Path | None = None
    place: Place | None = None


class Parameter(NamedTuple):
    """A parameter's value for one node; `is_wide` where it was given to more than this node."""

    value: Any
    place: Place
    is_wide: bool


def given_in(section: Section, home: Path | None) -> list[Given]:
    """Read the `parameters` of a section, parameter files included.

    Raises `DocumentError` with the place in the launch file, or in the parameter file.
    """
    said = section.get("parameters", {})
    if isinstance(said, list):
        return [_given(section, each, ("parameters", index), home) for index, each in enumerate(said)]
    return [_given(section, said, ("parameters",), home)]


def parameters_for(full_name: str, given: Iterable[Given], own: Iterable[Given]) -> dict[str, Parameter]:
    """Return the parameters of a node by name, nested names joined by dots; the last one given wins.

    `own` are the node's own, `given` those of the groups around it. Raises `DocumentError` for a file that the node
    itself names and that has parameters for other nodes only.
    """
    found: dict[str, Parameter] = {}
    for each in given:
        found.update((o.name, Parameter(o.value, at, is_wide=True)) for o, at in each.overrides if o.is_for(full_name))
    for each in own:
        fitting = [(o, at) for o, at in each.overrides if o.is_for(full_name)]
        if each.overrides and not fitting and each.file is not None and each.place is not None:
            raise each.place.error(_nothing_for(full_name, each))
        for override, at in fitting:
            is_wide = each.file is not None and "*" in override.pattern
            found[override.name] = Parameter(override.value, at, is_wide)
    if len(found) > limits.MOST_PARAMETERS:
        raise next(reversed(found.values())).place.error(_TOO_MANY)
    return found


def _given(section: Section, said: Any, steps: tuple[Step, ...], home: Path | None) -> Given:
    place = Place(section, steps)
    if isinstance(said, dict):
        _check_ros_spelling(said, place)
        return Given(list(_inline(said, place)))
    try:
        file = lookup.parameter_file(said, home, section.file.folder)
        overrides = _read(file)
    except DocumentError:  # it says where in the parameter file
        raise
    except lookup.NOT_FOUND as error:
        raise section.error(steps, lookup.reason_of(error)) from None
    return Given([(each, place) for each in overrides], file, place)


def _inline(said: dict[str, Any], place: Place) -> Iterator[tuple[Override, Place]]:
    known: set[str] = set()
    flat = list(_flattened(said))
    if len(flat) > limits.MOST_PARAMETERS:
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
    if isinstance(value, str):
        return
    try:
        parse_parameter_value(spell(value), "")
    except DocumentError as error:  # its place is one in a text that nobody wrote
        raise place.error(error.message) from None


def _check_ros_spelling(said: dict[str, Any], place: Place) -> None:
    if len(place.steps) > 1 and said.keys() == {"from"} and str(said["from"]).endswith(YAML):
        raise place.error(f"a parameter file is given by its name: write {shown(said['from'])}")
    if len(place.steps) > 1 and said.keys() == {"name", "value"}:
        name = shown(str(said["name"]))
        raise place.error(f"parameters are given as {{name: value}}: write {{{name}: {shown(spell(said['value']))}}}")


@functools.lru_cache(maxsize=8)
def _read_at(file: Path, changed: int) -> tuple[Override, ...]:
    return tuple(read_parameter_file(file))


def _read(file: Path) -> tuple[Override, ...]:
    """Read a parameter file. Cached: a hundred copies of a node read it once."""
    return _read_at(file, file.stat().st_mtime_ns)


def _nothing_for(full_name: str, given: Given) -> str:
    sections = list(dict.fromkeys(each.pattern for each, _ in given.overrides))[:3]
    file = given.file.name if given.file else ""
    return f"{file} has nothing for {full_name}, only for {', '.join(sections)}: if the node is that one, `name` it so"
