"""Drawing of upright cylinders, with exact silhouettes.

With the axis at (dx, dy) from the camera, r its radius and D its distance, a ray of depth 1 goes (ex, ey) over the
floor. Let e = dx ex + dy ey and c = dx ey - dy ex, both affine in the pixel. The ray enters the cylinder at the inverse
depth p + sqrt((p r / D)² - c² / (D² - r²) / D²), with p = e / (D² - r²). The difference of squares is a product, which
does not lose digits at the silhouette.
"""

from __future__ import annotations

import numpy as np

from robolink.sim.rendering.arrays import Array, Floats, Indices, Packed, packed
from robolink.sim.rendering.canvas import Canvas
from robolink.sim.rendering.patches import Cylinders
from robolink.sim.rendering.pinhole import Pinhole, View

_TONES = 16
_DARKEST, _BRIGHTEST = 0.65, 0.95
"""Brightness of a cylinder at its silhouette and in its middle."""

_IN_FRONT = 1e-6
_LEAST = np.float32(1e-12)


def draw_cylinders(canvas: Canvas, cylinders: Cylinders, view: View, pinhole: Pinhole) -> None:
    """Draw the sides of cylinders, near ones first; one that the camera is in is not seen."""
    x, y = cylinders.x - view.position[0], cylinders.y - view.position[1]
    square, radius = x * x + y * y, cylinders.radius
    boxes, nearest = _boxes(cylinders, view, pinhole)
    left, right, top, bottom = boxes
    drawn = np.flatnonzero(
        (square > radius * radius * (1.0 + 1e-9)) & (left < right) & (top < bottom) & (nearest > 0.0)
    )
    for each in drawn[np.argsort(-nearest.take(drawn), kind="stable")].tolist():
        box = tuple(int(side[each]) for side in boxes)
        if canvas.inverse[box[2] : box[3], box[0] : box[1]].min() < nearest[each]:
            _draw(canvas, cylinders, each, (float(x[each]), float(y[each])), box, view, pinhole)


def _boxes(cylinders: Cylinders, view: View, pinhole: Pinhole) -> tuple[tuple[Indices, ...], Array]:
    """Return boxes of pixels that cylinders may cover: left, right, top, bottom; and their largest inverse depths."""
    x, y, r = cylinders.x, cylinders.y, cylinders.radius
    x, y = np.concatenate((x - r, x - r, x + r, x + r)), np.concatenate((y - r, y + r, y - r, y + r))
    low, high = np.tile(cylinders.low, 4), np.tile(cylinders.high, 4)
    corners = np.stack((np.concatenate((x, x)), np.concatenate((y, y)), np.concatenate((low, high))))
    seen = view.seen_points(corners).reshape(3, 8, -1)
    depth = seen[2]
    behind, unseen = depth.min(axis=0) <= _IN_FRONT, depth.max(axis=0) <= _IN_FRONT
    scale = pinhole.focal / np.maximum(depth, _IN_FRONT)
    sides: list[Indices] = []
    for axis, size in ((0, pinhole.width), (1, pinhole.height)):
        place = seen[axis] * scale + pinhole.centre[axis]
        first = np.where(behind, 0.0, np.clip(np.floor(place.min(axis=0)), 0, size)).astype(np.intp)
        last = np.where(behind, size, np.clip(np.ceil(place.max(axis=0)) + 1.0, 0, size)).astype(np.intp)
        sides += [first, last]
    nearest = np.where(behind, np.inf, 1.0 / np.maximum(depth.min(axis=0), _IN_FRONT))
    return tuple(sides), np.where(unseen, 0.0, nearest)


def _draw(
    canvas: Canvas,
    cylinders: Cylinders,
    which: int,
    centre: tuple[float, float],
    box: tuple[int, ...],
    view: View,
    pinhole: Pinhole,
) -> None:
    rays, (dx, dy), radius = view.axes.T.tolist(), centre, float(cylinders.radius[which])
    distance = float(np.sqrt(dx * dx + dy * dy))
    power = (distance - radius) * (distance + radius)
    ahead = [(dx * a + dy * b) / power for a, b in zip(rays[0], rays[1], strict=True)]
    aside = [(dx * b - dy * a) / distance / power**0.5 for a, b in zip(rays[0], rays[1], strict=True)]
    p, c, rise = (_affine(each, box, pinhole) for each in (ahead, aside, rays[2]))
    half = p * np.float32(radius / distance)
    product = (half - c) * (half + c)
    root = np.sqrt(np.maximum(product, np.float32(0.0)))
    own = p + root
    inverse = canvas.inverse[box[2] : box[3], box[0] : box[1]]
    mask = (product >= 0) & (own > inverse)
    height = view.position[2]
    mask &= rise >= own * np.float32(float(cylinders.low[which]) - height)
    mask &= rise <= own * np.float32(float(cylinders.high[which]) - height)
    share = root / np.maximum(half, _LEAST)
    tone = np.minimum(share * np.float32(_TONES), np.float32(_TONES - 1)).astype(np.int16)
    np.copyto(inverse, own, where=mask)
    tones = _tones(cylinders.colours[which].tolist())
    np.copyto(canvas.colours[box[2] : box[3], box[0] : box[1]], tones.take(tone), where=mask)


def _affine(along: list[float], box: tuple[int, ...], pinhole: Pinhole) -> Floats:
    """Return over a box of pixels how far rays of depth 1 go in a direction, given along the camera's axes."""
    right, down, ahead = along
    columns = (pinhole.columns[box[0] : box[1]] * (right / pinhole.focal)).astype(np.float32)
    rows = (pinhole.rows[box[2] : box[3]] * (down / pinhole.focal) + ahead).astype(np.float32)
    return columns + rows[:, None]


def _tones(colour: list[int]) -> Packed:
    """Return the packed colours of a cylinder from its silhouette to its middle."""
    share = _DARKEST + (_BRIGHTEST - _DARKEST) * np.arange(_TONES)[:, None] / (_TONES - 1)
    return packed((share * np.array(colour) + 0.5).astype(np.uint8))
