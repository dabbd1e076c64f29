"""Views of a tag by simulated cameras, and what OpenCV makes of them beside the truth."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from robolink.sim import load_world
from robolink.sim.rendering.canvas import write_colours
from robolink.sim.rendering.pinhole import Pinhole, View, view_from
from robolink.sim.rendering.renderer import Backdrop, Renderer, Setting
from robolink.sim.scene.scenery import scenery

Array = npt.NDArray[np.float64]

SIZE, WALL, HEIGHT = 0.192, 3.0, 0.5
"""Side of the black square, x of the wall that it hangs on and height of its middle, in metres."""

ROOM = f"""
walls: [{{polyline: [[{WALL}, -4], [{WALL}, 4]], height: 1.2}}]
signs: [{{tag: 36h11/3, pose: [{WALL}, 0, 3.14159265], z: {HEIGHT}, size: {SIZE}}}]
"""
CORNERS = [(WALL, side * SIZE / 2, HEIGHT + up * SIZE / 2) for side, up in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
"""Corners of the tag in the world: the upper left one of the picture, and on clockwise."""


class Errors(NamedTuple):
    """Errors of what was found: of each corner in pixels, (n, 4, 2), and of the tag's place in metres; and misses."""

    corners: Array
    places: Array
    missed: int


def tag_errors(size: tuple[int, int], distance: float, poses: int, fov: float = 70.0, seed: int = 1) -> Errors:
    """Look at the tag from random poses at a distance in metres, and have OpenCV find it.

    Corners are refined by `CORNER_REFINE_SUBPIX`, the place is found by `SOLVEPNP_IPPE_SQUARE`.
    """
    random, missed = np.random.default_rng(seed), 0
    setting = Setting(Backdrop(scenery(load_world("room.yaml", text=ROOM))), ())
    renderer, detector = Renderer(Pinhole(*size, fov)), _detector()
    corners, places = [], []
    for _ in range(poses):
        view = _view(random, distance)
        image = np.empty((size[1], size[0], 1), dtype=np.uint8)
        write_colours(renderer.render(setting, view, np.zeros((0, 3))).colours, "mono8", image)
        found, _, _ = detector.detectMarkers(image[..., 0])
        if len(found) != 1:
            missed += 1
            continue
        seen, place = _found(np.asarray(found[0][0], dtype=np.float64), renderer.pinhole)
        points = view.seen_points(np.array(CORNERS).T).T
        exact = points[:, :2] / points[:, 2:] * renderer.pinhole.focal + renderer.pinhole.centre
        corners.append(seen - exact)
        places.append(float(np.linalg.norm(place - points.mean(axis=0))))
    return Errors(np.array(corners), np.array(places), missed)


def _detector() -> Any:
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    return cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11), parameters)


def _view(random: np.random.Generator, distance: float) -> View:
    """Return a view of the tag from aside, with the tag anywhere about the image's middle."""
    aside, above, off, pitch = (random.uniform(-each, each) for each in (0.9, 0.3, 0.25, 0.1))
    x, y = WALL - distance * math.cos(aside), distance * math.sin(aside)
    return view_from((x, y, HEIGHT + above * distance), math.atan2(-y, WALL - x) + off, math.atan(above) + pitch)


def _found(corners: Array, pinhole: Pinhole) -> tuple[Array, Array]:
    """Return a tag's corners, and its place in the camera's frame."""
    (u, v), focal, half = pinhole.centre, pinhole.focal, SIZE / 2
    square = np.array([(-half, half, 0.0), (half, half, 0.0), (half, -half, 0.0), (-half, -half, 0.0)])
    matrix = np.array([(focal, 0.0, u), (0.0, focal, v), (0.0, 0.0, 1.0)])
    _, _, place = cv2.solvePnP(square, corners, matrix, None, flags=cv2.SOLVEPNP_IPPE_SQUARE)
    return corners, np.asarray(place, dtype=np.float64)[:, 0]
