"""Markers of signs: their pictures as coloured rectangles, upright in the frame of each sign."""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from math import hypot
from pathlib import Path

from robolink.geometry.plane import Pose, placed_on
from robolink.interfaces.geometry_msgs.msg import Point
from robolink.interfaces.geometry_msgs.msg import Pose as PoseMessage
from robolink.interfaces.visualization_msgs.msg import Marker
from robolink.sim.description import Shape, Sign, WorldDescription
from robolink.sim.looks import moves
from robolink.sim.scene.mosaic import Mosaic, mosaic
from robolink.sim.scene.pictures import cached_picture
from robolink.sim.scene.scenery import standing_surfaces
from robolink.sim.scene.signs import BACK, sign_surfaces
from robolink.sim.scene.solids import Picture, Surfaces
from robolink.world_node import markers
from robolink.world_node.messages import facing

MOST, LEAST, MOST_TOGETHER = 160, 16, 8_000
"""Most rectangles of a sign's picture, fewer where there are many signs, and most of all signs of a world."""

_EVERY_CELL = 1_000
"""More rectangles than a tag can have: one that is drawn coarser would be another tag."""


class Signs:
    """Markers of the signs of a world, each made once.

    Args:
        description: The world.
    """

    def __init__(self, description: WorldDescription) -> None:
        self._description = description
        signs = [description.signs, *(each.signs for each in description.obstacles)]
        signs += [each.signs for each in description.robots]
        self._most = min(MOST, max(LEAST, MOST_TOGETHER // max(1, sum(map(len, signs)))))
        self._made: dict[Sign, Marker] = {}
        self._mosaics: dict[tuple[str | None, str | None], Mosaic] = {}
        """Pictures by tag and file: many signs may have the same one, and a large one takes half a second."""

    def standing(self) -> Iterator[Marker]:
        """Yield the markers of signs of the world and of fixed obstacles, with their poles."""
        on_obstacles = [
            (sign, each.start.place) for each in self._description.obstacles if not moves(each) for sign in each.signs
        ]
        placed = [*((sign, Pose()) for sign in self._description.signs), *on_obstacles]
        for index, (sign, origin) in enumerate(placed):
            yield self.at(origin, sign, index)
        yield from self._poles()

    def _poles(self) -> Iterator[Marker]:
        """Yield the markers of the poles of signs that hang on nothing."""
        standing = standing_surfaces(self._description) if self._description.signs else Surfaces()
        for index, sign in enumerate(self._description.signs):
            for each in _surfaces(sign, standing).cylinders:
                yield markers.solid("poles", index, Shape(circle=each.radius), each.z1, Pose(each.x, each.y), BACK)

    def at(self, origin: Pose, sign: Sign, index: int, frame: str | None = None) -> Marker:
        """Return the marker of a sign.

        Args:
            origin: Pose in the marker's frame of what the sign is on.
            sign: The sign.
            index: Its id.
            frame: Frame of a robot that it is on; None: it is in the map.
        """
        there = placed_on(origin, sign.pose.place)
        marker = copy(self._marker(sign))
        marker.id = index
        marker.pose = PoseMessage(position=Point(x=there.x, y=there.y, z=sign.z), orientation=facing(there.theta))
        if frame is not None:
            markers.fix_to(marker, frame)
        return marker

    def _marker(self, sign: Sign) -> Marker:
        if sign not in self._made:
            self._made[sign] = markers.sign_picture(*self._picture(sign))
            self._made[sign].text = sign.tag or Path(sign.image or "").stem
        return self._made[sign]

    def _picture(self, sign: Sign) -> tuple[Mosaic, tuple[float, float]]:
        """Return the picture on a sign, with its width and height in metres."""
        face = _surfaces(sign).faces[0]
        assert face.texture is not None
        key = sign.tag, sign.image
        if key not in self._mosaics:
            self._mosaics[key] = mosaic(face.texture, self._most if sign.tag is None else _EVERY_CELL)
        return self._mosaics[key], (hypot(*face.a), hypot(*face.b))


def _surfaces(sign: Sign, fixed: Surfaces | None = None) -> Surfaces:
    """Return the surfaces of a sign; it is a plain plate if its file has gone since the world was read."""
    try:
        return sign_surfaces(sign, cached_picture, fixed)
    except (OSError, ValueError):
        return sign_surfaces(sign, _plain, fixed)


def _plain(_: str) -> Picture:
    import numpy as np

    return np.full((1, 1, 3), BACK, np.uint8)
