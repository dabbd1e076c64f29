"""Checks of the picture files that a world names: on its floor and on its signs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from msgspec.structs import replace

from robolink.documents.yamlfile import siblings
from robolink.exceptions import nearest
from robolink.sim.checks.problem import Problem
from robolink.sim.description import RobotDescription, Sign, WorldDescription
from robolink.sim.scene.floor_size import too_much
from robolink.system.terminal import shown

MOST_PIXELS = 64_000_000
"""Most pixels of all pictures of a world together."""


def picture_problems(description: WorldDescription, folder: Path) -> Iterator[Problem]:
    """Yield the problems of all pictures: files that cannot be read or are huge, and what reaches below the floor.

    Args:
        description: The world, with the pictures' names as its file has them.
        folder: The folder where these names begin.
    """
    files = _Files(folder)
    yield from _sign_problems(_signs(description), files)
    floor = description.world.floor
    if floor.image is not None:
        width, height, reason = files.look(floor.image)
        if reason := reason or too_much(floor, description.paint, (width, height)):
            yield Problem("$.world.floor.image", reason)


def robot_picture_problems(robot: RobotDescription, folder: Path) -> Iterator[Problem]:
    """Yield the problems of the pictures of one robot's signs, as `picture_problems` does; paths begin with .signs."""
    signs = ((f".signs[{index}]", each) for index, each in enumerate(robot.signs))
    yield from _sign_problems(signs, _Files(folder))


def _sign_problems(signs: Iterable[tuple[str, Sign]], files: _Files) -> Iterator[Problem]:
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
