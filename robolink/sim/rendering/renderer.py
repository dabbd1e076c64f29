"""Renderer of a camera: what it sees of a setting, the surfaces of a world with those that move at their places.

setting = Setting(Backdrop(scenery), [(0, robot_surfaces(robot))])
renderer = Renderer(Pinhole(320, 240, fov=70.0))
canvas = renderer.render(setting, view_from((1.0, 2.0, 0.2), yaw=0.0, pitch=0.1), places)
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from robolink.sim.rendering.arrays import Array, packed
from robolink.sim.rendering.canvas import Canvas
from robolink.sim.rendering.columns import draw_cylinders
from robolink.sim.rendering.drawing import draw_patches
from robolink.sim.rendering.ground import Ground
from robolink.sim.rendering.patches import (
    FIXED,
    Cylinders,
    Patches,
    Places,
    Textures,
    cylinders_of,
    joined,
    joined_cylinders,
    patches_of,
)
from robolink.sim.rendering.pinhole import Pinhole, View
from robolink.sim.rendering.projection import Seen, seen_patches, spans
from robolink.sim.rendering.signs import Box, draw_sign
from robolink.sim.scene.surfaces import Scenery, Surfaces


class Backdrop:
    """Things that never move, ready to be drawn: the floor, the sky, and the surfaces `fixed`; and all textures."""

    def __init__(self, scenery: Scenery) -> None:
        self.ground, self.sky = Ground(scenery.floor), int(packed(np.array(scenery.sky, dtype=np.uint8)))
        self.textures = Textures()
        fixed = [(FIXED, scenery.fixed)]
        self.patches, self.cylinders = patches_of(fixed, self.textures), cylinders_of(fixed)


class Setting:
    """Surfaces that are ready to be drawn.

    Args:
        backdrop: What never moves.
        things: Surfaces of what moves in their own frames, each with the row of its place.
    """

    def __init__(self, backdrop: Backdrop, things: Sequence[tuple[int, Surfaces]]) -> None:
        self.backdrop = backdrop
        self._moving = patches_of(things, backdrop.textures), cylinders_of(things)

    def at(self, rows: Array) -> tuple[Patches, Cylinders]:
        """Return all surfaces in the world, owners at these places (rows x, y, heading)."""
        patches, cylinders = self.backdrop.patches, self.backdrop.cylinders
        own_patches, own_cylinders = self._moving
        places = Places(rows)
        if len(own_patches.outline):
            patches = joined(patches, places.patches(own_patches))
        if len(own_cylinders.x):
            moved = places.cylinders(own_cylinders)
            cylinders = joined_cylinders(cylinders, moved)
        return patches, cylinders


class Renderer:
    """Renders the images of one camera, each on the same canvas."""

    def __init__(self, pinhole: Pinhole) -> None:
        self.pinhole, self.canvas = pinhole, Canvas(pinhole)

    def render(self, setting: Setting, view: View, rows: Array) -> Canvas:
        """Render what is seen; the canvas is valid until the next image.

        Args:
            setting: The surfaces.
            view: The camera's view.
            rows: Places of what moves: x, y, heading.
        """
        canvas, pinhole = self.canvas, self.pinhole
        canvas.clear(setting.backdrop.sky)
        setting.backdrop.ground.draw(canvas, view, pinhole)
        patches, cylinders = setting.at(rows)
        if len(patches.outline):
            seen = seen_patches(patches, view, pinhole)
            textured = patches.textured.take(seen.which) >= 0
            draw_patches(canvas, patches, seen.taken(np.flatnonzero(~textured)), pinhole)
        if len(cylinders.x):
            draw_cylinders(canvas, cylinders, view, pinhole)
        if len(patches.outline) and textured.any():
            self._draw_signs(setting, patches, seen.taken(np.flatnonzero(textured)))
        return canvas

    def _draw_signs(self, setting: Setting, patches: Patches, seen: Seen) -> None:
        """Draw patches with textures, far ones first, since they mix with what is behind them at their edges."""
        found = spans(seen, patches, self.pinhole)
        for each in range(len(seen.which) - 1, -1, -1):
            here = slice(int(found.starts[each]), int(found.starts[each + 1]))
            low, high = found.low[here], found.high[here]
            if not len(low) or not (high >= low).any():
                continue
            left, right = max(0, int(low.min()) - 1), min(self.pinhole.width, int(high.max()) + 2)
            top = max(0, int(seen.first[each]) - 1)
            bottom = min(self.pinhole.height, int(seen.first[each] + seen.rows[each]) + 1)
            box = Box(left, right, top, bottom)
            if self.canvas.inverse[top:bottom, left:right].min() < seen.nearest[each] * 1.001:
                which = int(seen.which[each])
                levels = setting.backdrop.textures.levels(int(patches.textured[which]))
                outline = int(patches.outline[which])
                draw_sign(self.canvas, seen.gradients[:, :, each], levels, box, self.pinhole, outline=outline)
