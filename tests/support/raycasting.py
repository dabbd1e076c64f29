"""Reference of the renderer: each ray is met with each surface, in double precision."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from robolink.sim.scene.solids import Cylinder, Face, Surfaces

Array = npt.NDArray[np.float64]


def rays(width: int, height: int, fov: float, yaw: float, pitch: float) -> Array:
    """Directions of all pixels in the world, (rows, columns, 3): one metre of depth long."""
    focal = width / 2 / math.tan(math.radians(fov) / 2)
    u, v = np.meshgrid(np.arange(width) - (width - 1) / 2, np.arange(height) - (height - 1) / 2)
    ahead = np.array((math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), -math.sin(pitch)))
    right = np.array((math.sin(yaw), -math.cos(yaw), 0.0))
    down = np.cross(ahead, right)
    found: Array = ahead + (u / focal)[..., None] * right + (v / focal)[..., None] * down
    return found


def depths(
    surfaces: Surfaces, eye: tuple[float, float, float], directions: Array
) -> tuple[Array, npt.NDArray[np.intp]]:
    """Depth of the nearest surface of each ray, inf for none, and which it is: -1 the floor, faces, then cylinders."""
    with np.errstate(divide="ignore", invalid="ignore"):
        nearest = np.where(directions[..., 2] < 0.0, -eye[2] / directions[..., 2], np.inf)
        which = np.where(np.isfinite(nearest), -1, -2)
        found = [of_face(each, eye, directions) for each in surfaces.faces]
        found += [of_cylinder(each, eye, directions) for each in surfaces.cylinders]
    for number, each in enumerate(found):
        which = np.where(each < nearest, number, which)
        nearest = np.minimum(each, nearest)
    return nearest, which


def of_face(face: Face, eye: tuple[float, float, float], directions: Array) -> Array:
    """Depth at which rays meet a face, inf if they miss it."""
    corner, a, b = np.array(face.corner) - eye, np.array(face.a), np.array(face.b)
    normal = np.cross(a, b)
    depth = (corner @ normal) / (directions @ normal)
    if face.texture is not None and corner @ normal <= 0.0:
        return np.full_like(depth, np.inf)  # from behind
    place = directions * depth[..., None] - corner
    inverse = np.linalg.inv(np.stack((a, b, normal), axis=1))
    s, t = place @ inverse[0], place @ inverse[1]
    inside = (s >= 0.0) & (t >= 0.0) & (s <= 1.0) & (t <= 1.0)
    if face.outline == "ellipse":
        inside = (s - 0.5) ** 2 + (t - 0.5) ** 2 <= 0.25
    elif face.outline == "triangle":
        inside = (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0)
    return np.where(inside & (depth > 0.0), depth, np.inf)


def of_cylinder(cylinder: Cylinder, eye: tuple[float, float, float], directions: Array) -> Array:
    """Depth at which rays meet the outside of a cylinder, inf if they miss it."""
    dx, dy = cylinder.x - eye[0], cylinder.y - eye[1]
    if math.hypot(dx, dy) <= cylinder.radius:
        return np.full(directions.shape[:2], np.inf)  # within it
    along, across = directions[..., 0], directions[..., 1]
    square, half = along**2 + across**2, along * dx + across * dy
    root = half**2 - square * (dx**2 + dy**2 - cylinder.radius**2)
    depth = (half - np.sqrt(np.maximum(root, 0.0))) / square
    height = eye[2] + depth * directions[..., 2]
    met = (root >= 0.0) & (depth > 0.0) & (height >= cylinder.z0) & (height <= cylinder.z1)
    return np.where(met, depth, np.inf)
