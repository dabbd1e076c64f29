"""Renderer of what a camera sees, and the shots that a camera takes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from robolink.sim.rendering.canvas import Canvas, ImageNoise, channels, write_colours, write_depths
from robolink.sim.rendering.drawing import Box, Ground, draw_cylinders, draw_patches, draw_sign
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
from robolink.sim.rendering.pinhole import Array, Bytes, Floats, Pinhole, View, packed
from robolink.sim.rendering.projection import Seen, seen_patches, spans
from robolink.sim.scene.solids import Scenery, Surfaces
from robolink.sim.sensors import Camera

# Renderer of a camera: what it sees of a setting, the surfaces of a world with those that move at their places.
#
# setting = Setting(Backdrop(scenery), [(0, robot_surfaces(robot))])
# renderer = Renderer(Pinhole(320, 240, fov=70.0))
# canvas = renderer.render(setting, view_from((1.0, 2.0, 0.2), yaw=0.0, pitch=0.1), places)


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


class Shooter:
    """The inside of a camera, in which its shots are rendered one by one.

    Args:
        camera: The camera as the world file describes it.
        key: Text from which its noise follows: seed, robot and camera.
    """

    def __init__(self, camera: Camera, key: str) -> None:
        self.camera = camera
        self._noise = ImageNoise(camera.noise, key) if camera.noise else None
        self._renderer: Renderer | None = None
        self._shown: Shot | None = None

    def canvas(self, shot: Shot) -> Canvas:
        """Return the canvas with a shot on it, until the next one."""
        if self._renderer is None:
            camera = self.camera
            self._renderer = Renderer(Pinhole(camera.width, camera.height, camera.fov))
        if self._shown is not shot:
            self._renderer.render(shot.setting, shot.view, shot.places)
            self._shown = shot
        return self._renderer.canvas

    def disturb(self, image: Bytes, number: int) -> None:
        """Add the noise of a shot by its number."""
        if self._noise is not None:
            self._noise.disturb(image, number)


class Shot:
    """The sight of a camera at one moment; it may be rendered later, or never.

    Args:
        shooter: The camera.
        setting: The surfaces around.
        view: Where the camera is, and where it looks.
        places: Places of what moves, for the setting.
        number: Number of the shot, from which its noise follows.
    """

    def __init__(self, shooter: Shooter, setting: Setting, view: View, places: Array, number: int) -> None:
        self.setting, self.view, self.places = setting, view, places
        self._shooter, self._number = shooter, number

    def image(self, encoding: str = "") -> Bytes:
        """Return the image, of shape (rows, columns, channels); of mono8 it is (rows, columns).

        Args:
            encoding: rgb8, bgr8, rgba8, bgra8 or mono8; '' is that of the camera.

        Raises:
            KeyError: for another encoding.
        """
        camera = self._shooter.camera
        encoding = encoding or camera.encoding
        image = np.empty((camera.height, camera.width, channels(encoding)), dtype=np.uint8)
        colours = self._shooter.canvas(self).colours
        if image.shape[2] < 4:
            write_colours(colours, encoding, image)
            self._shooter.disturb(image, self._number)
        else:
            image[..., :3], image[..., 3] = self.image(encoding.replace("a", "")), 255
        return image[..., 0] if encoding == "mono8" else image

    def depths(self) -> Floats:
        """Return the depth of each pixel in metres, (rows, columns): +inf for nothing, -inf for too near (REP 118)."""
        camera = self._shooter.camera
        depths = np.empty((camera.height, camera.width), dtype=np.float32)
        write_depths(self._shooter.canvas(self).inverse, *camera.range, depths)
        return depths
