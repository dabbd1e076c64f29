"""Reader of world files, with all their mistakes by line and column.

description = load_world("configs/worlds/corners.yaml")
"""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from robolink.documents import yamlfile
from robolink.documents.mistakes import MOST_REPORTED, first_mistakes
from robolink.documents.yamlfile import Document
from robolink.exceptions import DocumentError, RobolinkError, nearest
from robolink.extensions.optional import part
from robolink.sim.checks.appearance import picture_problems, with_paths
from robolink.sim.checks.worlds import mass_problems, misfits, problems
from robolink.sim.description import WorldDescription
from robolink.sim.sensors import SENSORS, Sensor

if TYPE_CHECKING:
    from robolink.sim.maps.gridmap import GridMap

Load = Callable[[str | os.PathLike[str], str | None], WorldDescription]
FORMATS = {".wbt": "robolink.sim.webots:load"}
"""Readers of other simulators' world files by suffix: functions of the path and of a text read in its place."""


def load_world(path: str | os.PathLike[str], *, text: str | None = None) -> WorldDescription:
    """Read a world file, robolink's or Webots' (`.wbt`); a map of ROS becomes walls.

    Args:
        path: The file; its folder is where a map's path begins.
        text: Read instead of the file's content; None reads the file.

    Raises:
        DocumentError: with `file:line:column`, at the first mistake: YAML, an unknown key, a value of the wrong type
            or out of range, a degenerate shape, shapes that overlap, a robot that starts inside something, a map
            that cannot be read.
    """
    if (load := _other_format(path)) is not None:
        return load(path, text)
    document = yamlfile.read(path, WorldDescription, text=text, hook=sensor_class)
    grid = _map_of(document)
    description = _with_map(document, grid)
    for error in _mistakes(document, description, grid):
        raise error
    return with_paths(description, Path(path).parent)


class Checked(NamedTuple):
    """Result of a check: the description, or None if there is any mistake, and the mistakes."""

    description: WorldDescription | None
    errors: list[RobolinkError]


def check_world(path: str | os.PathLike[str], *, text: str | None = None) -> Checked:
    """Read a world file as `load_world`, but return all mistakes that can be seen at once.

    Args:
        path: The file.
        text: Read instead of the file's content; None reads the file.
    """
    if (load := _other_format(path)) is not None:
        try:
            return Checked(load(path, text), [])
        except RobolinkError as error:
            return Checked(None, [error])
    errors: list[RobolinkError] = [*yamlfile.mistakes(path, WorldDescription, text=text, hook=sensor_class)]
    if errors:
        return Checked(None, errors)
    document = yamlfile.read(path, WorldDescription, text=text, hook=sensor_class)
    description, grid = document.value, None
    try:
        grid = _map_of(document)
        description = _with_map(document, grid)
    except DocumentError as error:
        errors.append(error)
    # finding what overlaps takes time
    errors += first_mistakes(_mistakes(document, description, grid), MOST_REPORTED + 2)
    return Checked(None if errors else with_paths(description, Path(path).parent), errors)


def _other_format(path: str | os.PathLike[str]) -> Load | None:
    """Return the function that reads a file of another simulator; None for our own format."""
    suffix = Path(path).suffix.lower()
    return part(FORMATS[suffix], f"{path}: the reader of {suffix} files") if suffix in FORMATS else None


def sensor_class(kind: type, data: Any) -> type[Sensor]:
    """Return the class of a sensor by the one key that names its kind. Raises ValueError if none does, or several."""
    if not isinstance(data, dict):
        raise ValueError("expected a mapping such as {lidar: scan}")
    own = SENSORS.table()
    kinds = [key for key in data if key in own] or [key for key in data if key in SENSORS.added()]
    if len(kinds) > 1:
        raise ValueError(f"one sensor cannot be both {' and '.join(kinds)}: make each of them an item of its own")
    if not kinds:
        known = SENSORS.names()
        near = next(filter(None, (nearest(key, known) for key in data)), "")
        raise ValueError(f"this sensor has no kind{near}: one of its keys must be {', '.join(known)}")
    found = SENSORS.get(kinds[0])
    assert found is not None
    return found.description


def _mistakes(
    document: Document[WorldDescription], description: WorldDescription, grid: GridMap | None
) -> Iterator[DocumentError]:
    """Yield the mistakes of a world file whose every value is of the right type and in its range."""
    data: Any = document.data
    masses = mass_problems(description.robots, description.obstacles)
    pictures = picture_problems(description, Path(document.name).parent)
    for each in itertools.chain(misfits(data), problems(description, grid), masses, pictures):
        yield document.error(each.path, each.message, key=each.key)


def _map_of(document: Document[WorldDescription]) -> GridMap | None:
    """Read the map that a world file names, relative to its folder."""
    if document.value.map is None:
        return None
    from robolink.sim.maps.gridmap import load_map

    path = Path(document.name).parent / document.value.map.yaml
    try:
        return load_map(path)
    except DocumentError as error:
        if error.line:  # the map's own mistake, with its place in the map's file
            raise
        raise document.error("$.map.yaml", str(error)) from None


def _with_map(document: Document[WorldDescription], grid: GridMap | None) -> WorldDescription:
    if grid is None:
        return document.value
    from robolink.sim.maps.gridmap import map_walls

    try:
        look = document.value.map
        walls = map_walls(grid, look.height, look.colour) if look else map_walls(grid)
    except ValueError as error:
        raise document.error("$.map", str(error)) from None
    return msgspec.structs.replace(document.value, walls=(*document.value.walls, walls))
