"""Markers of visualization_msgs from a world's shapes, lines and pictures."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain, pairwise
from typing import Any

from robolink.geometry.plane import Pose
from robolink.interfaces.geometry_msgs.msg import Point, Vector3
from robolink.interfaces.geometry_msgs.msg import Pose as PoseMessage
from robolink.interfaces.std_msgs.msg import ColorRGBA, Header
from robolink.interfaces.visualization_msgs.msg import Marker
from robolink.sim import quantities
from robolink.sim.colours import Colour
from robolink.sim.description import Shape
from robolink.sim.scene import triangles
from robolink.sim.scene.mosaic import Mosaic, Patch
from robolink.world_node.messages import facing
from robolink.world_node.robot_topics import MAP

LINE = 0.04
"""Width of walls, which have none themselves, in metres."""

SIGN_LIFT = 0.002
"""Distance of a sign's patches from its background, and half of that of the background from its wall, in metres."""

FLAT_LIFT = 0.0005
"""Height of the patches of a picture on the floor over its background, in metres."""

_ITSELF = Vector3(x=1.0, y=1.0, z=1.0)
"""Scale of what is made of points: as they are."""


def colour_message(colour: Colour) -> ColorRGBA:
    """Return a colour as a message, opaque."""
    red, green, blue = (round(each / 255, 4) for each in colour)
    return ColorRGBA(r=red, g=green, b=blue, a=1.0)


def flat(group: str, index: int, parts: Iterable[triangles.Triangle], z: float, colour: Colour) -> Marker:
    """Return the marker of triangles that lie on the floor, at a height `z` in metres."""
    points = [Point(x=x, y=y) for part in parts for x, y in part]
    pose = PoseMessage(position=Point(z=z))
    return _marker(
        group, index, Marker.TRIANGLE_LIST, scale=_ITSELF, color=colour_message(colour), points=points, pose=pose
    )


def lines(
    group: str, index: int, segments: Iterable[tuple[quantities.Point, quantities.Point]], z: float, colour: Colour
) -> Marker:
    """Return the marker of separate lines at a height `z` in metres."""
    points = [Point(x=x, y=y, z=z) for segment in segments for x, y in segment]
    scale = Vector3(x=LINE)
    return _marker(group, index, Marker.LINE_LIST, scale=scale, color=colour_message(colour), points=points)


def solid(group: str, index: int, shape: Shape, height: float, pose: Pose, colour: Colour) -> Marker:
    """Return the marker of a solid that stands on the floor: a cylinder, a box, or a polygon's top and sides."""
    there = PoseMessage(position=Point(x=pose.x, y=pose.y, z=height / 2), orientation=facing(pose.theta))
    marker = _marker(group, index, Marker.TRIANGLE_LIST, scale=_ITSELF, color=colour_message(colour), pose=there)
    if shape.circle is not None:
        marker.type, marker.scale = Marker.CYLINDER, Vector3(x=2 * shape.circle, y=2 * shape.circle, z=height)
    elif shape.box is not None:
        marker.type, marker.scale = Marker.CUBE, Vector3(x=shape.box[0], y=shape.box[1], z=height)
    else:
        marker.points = _prism(shape.corners(), height / 2)
    return marker


def upright(
    group: str, index: int, segments: Iterable[tuple[quantities.Point, quantities.Point]], height: float, colour: Colour
) -> Marker:
    """Return the marker of rectangles that stand on the floor, each on a line."""
    points = [point for start, end in segments for point in _rectangle(start, end, 0.0, height)]
    return _marker(group, index, Marker.TRIANGLE_LIST, scale=_ITSELF, color=colour_message(colour), points=points)


def floor_picture(shown: Mosaic, corner: tuple[float, float, float], size: tuple[float, float]) -> Marker:
    """Return the marker of a picture on the floor.

    Args:
        shown: The picture.
        corner: Place of its lower left corner in metres.
        size: Width and height in metres.
    """
    marker = _marker("floor", 1, Marker.TRIANGLE_LIST, scale=_ITSELF, color=colour_message(shown.background))
    marker.pose.position.x, marker.pose.position.y, marker.pose.position.z = corner
    width, height = size[0] / shown.columns, size[1] / shown.rows
    places, marker.colors = _cells(shown)
    marker.points = [Point(x=u * width, y=v * height, z=lift * FLAT_LIFT) for u, v, lift in places]
    return marker


def sign_picture(shown: Mosaic, size: tuple[float, float]) -> Marker:
    """Return the marker of a sign in its own frame: x out of its face, y to the right of who looks at it, z up.

    Args:
        shown: The picture.
        size: Width and height in metres.
    """
    marker = _marker("signs", 0, Marker.TRIANGLE_LIST, scale=_ITSELF, color=colour_message(shown.background))
    width, height = size[0] / shown.columns, size[1] / shown.rows
    places, marker.colors = _cells(shown)
    marker.points = [
        Point(x=SIGN_LIFT * (2 + lift), y=u * width - size[0] / 2, z=v * height - size[1] / 2) for u, v, lift in places
    ]
    return marker


def fix_to(marker: Marker, frame: str) -> None:
    """Let a marker move with the frame of a robot."""
    marker.header, marker.frame_locked = Header(frame_id=frame), True


def _cells(shown: Mosaic) -> tuple[list[tuple[int, int, int]], list[ColorRGBA]]:
    """Return the corners of a picture's triangles, and their colours.

    Corners are cells to the right, cells up from its lower edge, and 0 for the background, which reaches behind all
    the rest: nothing shines through between two patches. 1 is the rest.
    """
    places: list[tuple[int, int, int]] = []
    colours: list[ColorRGBA] = []
    whole = Patch(0, 0, shown.columns, shown.rows, shown.background)
    for lift, (left, top, right, bottom, colour) in chain([(0, whole)], ((1, each) for each in shown.patches)):
        low, high = shown.rows - bottom, shown.rows - top
        places += [(left, low, lift), (right, low, lift), (right, high, lift)]
        places += [(left, low, lift), (right, high, lift), (left, high, lift)]
        colours += [colour_message(colour)] * 6
    return places, colours


def _prism(corners: list[quantities.Point], half: float) -> list[Point]:
    points = [Point(x=x, y=y, z=half) for part in triangles.of_polygon(corners) for x, y in part]
    for start, end in pairwise([*corners, corners[0]]):
        points += _rectangle(start, end, -half, half)
    return points


def _rectangle(start: quantities.Point, end: quantities.Point, z0: float, z1: float) -> list[Point]:
    (x1, y1), (x2, y2) = start, end
    low, far, top, high = ((x1, y1, z0), (x2, y2, z0), (x2, y2, z1), (x1, y1, z1))
    return [Point(x=x, y=y, z=z) for x, y, z in (low, far, top, low, top, high)]


def _marker(group: str, index: int, kind: int, **fields: Any) -> Marker:
    return Marker(header=Header(frame_id=MAP), ns=group, id=index, type=kind, **fields)
