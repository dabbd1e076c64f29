"""Checks of a robot's place: anywhere on the plane, outside of everything else."""

from __future__ import annotations

from collections.abc import Iterable

import pymunk

from robolink.exceptions import RobolinkError
from robolink.sim.description import MapWalls, Wall
from robolink.sim.quantities import FARTHEST, Pose
from robolink.system.terminal import shown

_TOUCHING = 1e-9
"""Depth up to which shapes only touch, in metres."""


class WorldError(RobolinkError, ValueError):
    """A change that a world refuses: a robot inside of something, a name that is taken."""


def check_pose(name: str, pose: Pose) -> None:
    """Raise `WorldError` if a pose is not finite or too far away."""
    if not (abs(pose.x) <= FARTHEST and abs(pose.y) <= FARTHEST and abs(pose.theta) <= FARTHEST):
        at = f"[{pose.x:g}, {pose.y:g}, {pose.theta:g}]"
        limit = f"expected finite numbers, at most {FARTHEST:g} m from the origin"
        raise WorldError(f"robot '{shown(name)}' can't stand at {at}: {limit}")


def check_place(
    space: pymunk.Space, shapes: Iterable[pymunk.Shape], name: str, pose: Pose, walls: Iterable[Wall] = ()
) -> None:
    """Raise `WorldError` if the shapes of a robot at a pose overlap something by more than a touch.

    Those among `walls` that are a map's have an inside too.
    """
    what = "" if (other := overlap(space, shapes)) is None else _called(other)
    if not what and any(isinstance(each, MapWalls) and each.enclose(pose.x, pose.y) for each in walls):
        what = "the map's walls"
    if what:
        at = f"[{pose.x:g}, {pose.y:g}, {pose.theta:g}]"
        raise WorldError(f"robot '{shown(name)}' can't stand at {at}: inside of {what}")


def overlap(space: pymunk.Space, shapes: Iterable[pymunk.Shape]) -> pymunk.Shape | None:
    """Return the first shape that the shapes of one body overlap by more than a touch, or None."""
    return next(filter(None, (overlapped(shape, space.shape_query(shape)) for shape in shapes)), None)


def overlapped(shape: pymunk.Shape, found: Iterable[pymunk.ShapeQueryInfo]) -> pymunk.Shape | None:
    """Return the first of the shapes `found` by a query that a shape overlaps by more than a touch, or None.

    Of shapes with one centre Chipmunk knows no normal.
    """
    for info in found:
        if info.shape is None or info.shape.body is shape.body:
            continue
        contact = info.contact_point_set
        # A contact's own distance has the wrong sign where a polygon asks about a circle or a segment.
        depths = [(point.point_a - point.point_b).dot(contact.normal) for point in contact.points]
        if contact.normal.length < 0.5 or any(depth > _TOUCHING for depth in depths):
            return info.shape
    return None


def _called(shape: pymunk.Shape) -> str:
    if isinstance(shape, pymunk.Segment):
        return "a wall"
    if shape.body is None or shape.body.body_type != pymunk.Body.DYNAMIC:
        return "an obstacle"
    return "another robot or an obstacle"
