"""Checks of what only cameras see: colours, paint on the floor, signs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from robolink.sim.checks.problem import Problem, under
from robolink.sim.checks.shapes import repeated_points, shape_problems
from robolink.sim.colours import colour_of
from robolink.sim.description import Paint, Sign, WorldDescription
from robolink.sim.scene.floor_size import too_much
from robolink.sim.scene.tags import plate_size, tag_of

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
