"""Surfaces of upright signs: fiducial markers and pictures on plates, on walls or on poles."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin

import numpy as np

from robolink.sim.description import Sign
from robolink.sim.scene.solids import Cylinder, Face, Picture, Surfaces
from robolink.sim.scene.tags import plate_size, tag_of, tag_picture

BACK = (120, 120, 125)
"""Colour of a plate's back, and of a pole."""

POLE_RADIUS = 0.01
"""Radius of a pole in metres."""

HANGS = 0.05
"""Greatest distance of a sign from the wall that it hangs on, in metres."""


def sign_surfaces(sign: Sign, read: Callable[[str], Picture], fixed: Surfaces | None = None) -> Surfaces:
    """Return the surfaces of a sign: its face, and unless it hangs on a wall its back and its pole.

    Args:
        sign: The sign, whose tag is one.
        read: Reader of a picture file.
        fixed: Walls and fixed obstacles that it may hang on; None for a sign on a robot or on an obstacle, which has no
            pole.
    """
    texture, width, height = _plate(sign, read)
    x, y, _ = sign.pose.place
    right, top = (-sin(sign.pose.theta), cos(sign.pose.theta)), sign.z + height / 2
    corner = (x - right[0] * width / 2, y - right[1] * width / 2, top)
    sides = (right[0] * width, right[1] * width, 0.0), (0.0, 0.0, -height)
    face = Face(corner, *sides, BACK, texture)
    if fixed is not None and hangs(sign, fixed):
        return Surfaces((face,))
    plate = (face, face._replace(texture=None))
    if fixed is None or sign.z <= height / 2:
        return Surfaces(plate)
    return Surfaces(plate, (Cylinder(x, y, POLE_RADIUS, 0.0, sign.z - height / 2, BACK),))


def _plate(sign: Sign, read: Callable[[str], Picture]) -> tuple[Picture, float, float]:
    """Return the picture on a sign, and its width and height in metres."""
    if sign.tag is not None:
        tag = tag_of(sign.tag)
        side = plate_size(tag, sign.size)
        return tag_picture(tag), side, side
    picture = read(sign.image or "")
    rows, columns = picture.shape[:2]
    return picture, sign.size, sign.size * rows / columns


def hangs(sign: Sign, fixed: Surfaces) -> bool:
    """True if a sign is on something that stands: a wall, or the side of an obstacle, that reaches up to its middle."""
    x, y, z = sign.pose.x, sign.pose.y, sign.z
    for post in fixed.cylinders:
        dx, dy = x - post.x, y - post.y
        if post.z1 >= z and dx * dx + dy * dy <= (post.radius + HANGS) ** 2:
            return True
    upright = [(*each.corner[:2], *each.a[:2]) for each in fixed.faces if each.b[2] >= z and not each.a[2]]
    ends = np.array(upright, dtype=np.float64).reshape(-1, 4).T
    to_x, to_y, way_x, way_y = x - ends[0], y - ends[1], ends[2], ends[3]
    share = np.clip((to_x * way_x + to_y * way_y) / (way_x * way_x + way_y * way_y), 0.0, 1.0)
    off_x, off_y = to_x - share * way_x, to_y - share * way_y
    return bool(np.any(off_x * off_x + off_y * off_y <= HANGS * HANGS))
