"""Generator of a picture: what the cameras of simulated robots see, side by side, without noise.

Usage: python tools/camera_picture.py docs/pictures/simulated_camera.png
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import numpy.typing as npt
from msgspec import structs

from robolink.image.codecs import png_of
from robolink.sim import Pose, World, load_world
from robolink.sim.rendering.renderer import Shot
from robolink.sim.sensors import Camera
from robolink.workspace import find_world

SEEN = {
    "signs": Pose(1.0, 0.75, 0.0),
    "track": Pose(4.55, 1.0, 0.3),
    "blobs": Pose(0.6, 2.9, 0.0),
}
"""Worlds, and where the robot stands in each."""

WIDTH, HEIGHT, GAP = 320, 240, 6
"""Size of each image, and white columns between them, in pixels."""


def seen(name: str, pose: Pose) -> npt.NDArray[np.uint8]:
    """Return the image of the first camera in a world, with its robot at a pose, brought to one size."""
    description = load_world(find_world(name))
    (robot,) = description.robots
    cameras = tuple(structs.replace(each, noise=0.0) for each in robot.sensors if isinstance(each, Camera))
    world = World(structs.replace(description, robots=(structs.replace(robot, sensors=cameras),)))
    next(iter(world.robots.values())).teleport(pose)
    while True:
        world.step()
        for _, _, shot in world.readings():
            if isinstance(shot, Shot):
                image = shot.image("rgb8")
                rows, columns = (
                    np.arange(new) * old // new for new, old in zip((HEIGHT, WIDTH), image.shape, strict=False)
                )
                return np.asarray(image[rows[:, None], columns], np.uint8)


def main() -> None:
    """Write the picture."""
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("path", type=Path, help="file to write, a PNG")
    gap = np.full((HEIGHT, GAP, 3), 255, np.uint8)
    images = [part for name, pose in SEEN.items() for part in (gap, seen(name, pose))]
    words.parse_args().path.write_bytes(png_of(np.concatenate(images[1:], axis=1)))


if __name__ == "__main__":
    main()
