"""A camera's shots: what it sees at one moment, which is rendered once somebody asks for its image or depths."""

from __future__ import annotations

import numpy as np

from robolink.sim.rendering.arrays import Array, Bytes, Floats
from robolink.sim.rendering.canvas import Canvas
from robolink.sim.rendering.noise import ImageNoise
from robolink.sim.rendering.pinhole import Pinhole, View
from robolink.sim.rendering.pixels import channels, write_colours, write_depths
from robolink.sim.rendering.renderer import Renderer, Setting
from robolink.sim.sensors import Camera


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
