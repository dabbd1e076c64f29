"""Checks of appearance: colours, signs, tags and pictures."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from msgspec.structs import replace

from robolink.documents.yamlfile import siblings
from robolink.exceptions import nearest
from robolink.sim.checks.shapes import Problem, repeated_points, shape_problems, under
from robolink.sim.colours import colour_of
from robolink.sim.description import Paint, RobotDescription, Sign, WorldDescription
from robolink.sim.scene.strokes import too_much
from robolink.sim.scene.tags import plate_size, tag_of
from robolink.system.terminal import shown

_ONLY_LINES = ("width", "closed", "radius", "dashes")


def appearance_misfits(data: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the keys of a world file's plain data, valid otherwise, that mean nothing where they stand."""
    world, paint = data.get("world") or {}, data.get("paint", ())
    floor = world.get("floor") or {}
    yield from under("$.world.floor", null_colour(floor))
    if "origin" in floor and floor.get("image") is None:
        yield Problem("$.world.floor.origin", "this is where an 'image' lies, and there is none", key=True)
    yield from under("$.map", null_colour(data.get("map") or {}))
    for part in ("walls", "obstacles", "paint"):
        for index, each in enumerate(data.get(part, ())):
            yield from under(f"$.{part}[{index}]", null_colour(each))
    for index, each in enumerate(paint):
        wrong = ("pose",) if each.get("line") is not None else _ONLY_LINES
        has = "an outline" if each.get("line") is not None else "a 'line'"
        for key in wrong:
            if key in each:
                yield Problem(f"$.paint[{index}].{key}", f"only {has} has '{key}'", key=True)


def null_colour(data: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield a problem for a colour without a value: YAML takes what follows a # for a comment."""
    if "colour" in data and data["colour"] is None:
        yield Problem(".colour", "this colour is empty: one that begins with # stands in quotes, '#ff0000'", key=True)


def colour_problems(colour: str | None) -> Iterator[Problem]:
    """Yield the problem of a colour that is none."""
    try:
        if colour is not None:
            colour_of(colour)
    except ValueError as error:
        yield Problem(".colour", str(error))


def sign_problems(signs: Sequence[Sign]) -> Iterator[Problem]:
    """Yield the problems of some signs, except those of their pictures."""
    for index, sign in enumerate(signs):
        yield from under(f".signs[{index}]", _sign_problems(sign))


def _sign_problems(sign: Sign) -> Iterator[Problem]:
    given = [kind for kind in ("tag", "image") if getattr(sign, kind) is not None]
    if len(given) != 1:
        yield Problem("", f"expected one of 'tag' and 'image', got {' and '.join(given) or 'none of them'}")
        return
    if sign.tag is None:
        return
    try:
        height = plate_size(tag_of(sign.tag), sign.size)
    except ValueError as error:
        yield Problem(".tag", str(error))
        return
    if height / 2 > sign.z + 1e-9:
        reason = f"with its margin it is {height:.4g} m high, and would reach below the floor"
        yield Problem(".z", f"{reason}: at least {math.ceil(height * 500) / 1000:g}")


def paint_problems(paint: Paint) -> Iterator[Problem]:
    """Yield the problems of one thing painted on the floor."""
    yield from colour_problems(paint.colour)
    if paint.line is None:
        given = [kind for kind in ("box", "circle", "polygon") if getattr(paint, kind) is not None]
        if not given:
            yield Problem("", "expected one of 'line', 'box', 'circle' and 'polygon', got none of them")
        else:
            yield from shape_problems(paint)
        return
    if any(getattr(paint, kind) is not None for kind in ("box", "circle", "polygon")):
        yield Problem(".line", "this is a line and an outline at once: make two of them", key=True)
    if paint.closed and len(paint.line) < 3:
        yield Problem(".line", f"a closed line needs 3 points or more, got {len(paint.line)}")
        return
    yield from under(".line", repeated_points(paint.line, "a line", "closed: true" if paint.closed else ""))


def floor_problems(description: WorldDescription) -> Iterator[Problem]:
    """Yield the problems of a world's floor, whose parts are right by themselves; not those of its picture."""
    floor = description.world.floor
    yield from colour_problems(floor.colour)
    if floor.image is not None and floor.resolution is None:
        yield Problem(".image", "missing key 'resolution' beside it: the side of the picture's pixels in metres")
    elif reason := too_much(floor, description.paint):
        yield Problem(".resolution" if floor.resolution is not None else "", reason)


MOST_PIXELS = 64_000_000
"""Most pixels of all pictures of a world together."""


def picture_problems(description: WorldDescription, folder: Path) -> Iterator[Problem]:
    """Yield the problems of all pictures: files that cannot be read or are huge, and what reaches below the floor.

    Args:
        description: The world, with the pictures' names as its file has them.
        folder: The folder where these names begin.
    """
    files = _Files(folder)
    yield from _plate_problems(_signs(description), files)
    floor = description.world.floor
    if floor.image is not None:
        width, height, reason = files.look(floor.image)
        if reason := reason or too_much(floor, description.paint, (width, height)):
            yield Problem("$.world.floor.image", reason)


def robot_picture_problems(robot: RobotDescription, folder: Path) -> Iterator[Problem]:
    """Yield the problems of the pictures of one robot's signs, as `picture_problems` does; paths begin with .signs."""
    signs = ((f".signs[{index}]", each) for index, each in enumerate(robot.signs))
    yield from _plate_problems(signs, _Files(folder))


def _plate_problems(signs: Iterable[tuple[str, Sign]], files: _Files) -> Iterator[Problem]:
    for path, sign in signs:
        if sign.image is None:
            continue
        width, height, reason = files.look(sign.image)
        if not reason and (high := sign.size * height / width) / 2 > sign.z + 1e-9:
            reason = f"it is {high:.4g} m high, and would reach below the floor: z at least {high / 2:.4g}"
        if reason:
            yield Problem(f"{path}.image", reason)


class _Files:
    """Picture files that were looked at, and how many pixels they have together."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._known, self._pixels = folder, dict[str, tuple[int, int, str]](), 0

    def look(self, name: str) -> tuple[int, int, str]:
        """Return a picture's width and height in pixels, and why it cannot be taken ('' if it can)."""
        if name not in self._known:
            self._known[name] = self._look(name)
        return self._known[name]

    def _look(self, name: str) -> tuple[int, int, str]:
        if self._pixels > MOST_PIXELS:
            return 1, 1, f"all pictures together have over {MOST_PIXELS // 10**6} million pixels: shrink some"
        from robolink.sim.scene.pictures import read_picture  # late: only worlds with pictures need numpy

        path = self._folder / name
        try:
            height, width = read_picture(str(path)).shape[:2]
        except FileNotFoundError:
            return 1, 1, f"no file '{shown(str(path))}'{nearest(path.name, siblings(path))}"
        except (OSError, ValueError) as error:
            reason = str(error.strerror if isinstance(error, OSError) else error)
            return 1, 1, f"'{shown(name)}' cannot be read: {reason}"
        self._pixels += width * height
        return width, height, ""


def _signs(description: WorldDescription) -> Iterator[tuple[str, Sign]]:
    """Yield all signs with their paths."""
    bearers: list[tuple[str, Sequence[Sign]]] = [("$", description.signs)]
    bearers += [(f"$.obstacles[{index}]", each.signs) for index, each in enumerate(description.obstacles)]
    bearers += [(f"$.robots[{index}]", each.signs) for index, each in enumerate(description.robots)]
    for path, signs in bearers:
        yield from ((f"{path}.signs[{index}]", each) for index, each in enumerate(signs))


def with_paths(description: WorldDescription, folder: Path) -> WorldDescription:
    """Return a world whose pictures are named by their whole paths.

    Args:
        description: The world.
        folder: The folder where the names of its pictures begin.
    """

    def found(signs: tuple[Sign, ...]) -> tuple[Sign, ...]:
        return tuple(each if each.image is None else replace(each, image=whole(each.image)) for each in signs)

    def whole(name: str) -> str:
        return str((folder / name).absolute())

    floor = description.world.floor
    if floor.image is not None:
        world = replace(description.world, floor=replace(floor, image=whole(floor.image)))
        description = replace(description, world=world)
    if not any(sign.image for _, sign in _signs(description)):
        return description
    return replace(
        description,
        signs=found(description.signs),
        obstacles=tuple(replace(each, signs=found(each.signs)) for each in description.obstacles),
        robots=tuple(replace(each, signs=found(each.signs)) for each in description.robots),
    )
