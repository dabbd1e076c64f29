"""What a world file may say, as Structs: the keys, their units, limits and defaults.

Metres, radians (degrees where a field of view is meant), seconds, kilograms. Poses are ``[x, y, theta]``.
"""

from __future__ import annotations

import math
from typing import Annotated, TypeAlias

from msgspec import Meta, Struct

Coordinate: TypeAlias = Annotated[float, Meta(ge=-100_000.0, le=100_000.0)]
Angle: TypeAlias = Annotated[float, Meta(ge=-6.2832, le=6.2832)]  # one turn: who writes 90 meant degrees
Length: TypeAlias = Annotated[float, Meta(ge=0.001, le=100_000.0)]
Mass: TypeAlias = Annotated[float, Meta(ge=0.001, le=100_000.0)]
Rate: TypeAlias = Annotated[float, Meta(ge=0.001, le=10_000.0)]
Limit: TypeAlias = Annotated[float, Meta(ge=0.001, le=1000.0)]
Share: TypeAlias = Annotated[float, Meta(ge=0.0, le=1.0)]
Point: TypeAlias = tuple[Coordinate, Coordinate]


class Pose(Struct, frozen=True, array_like=True, forbid_unknown_fields=True):
    """A place and a heading in the plane: metres, and radians counter-clockwise from the x axis."""

    x: Coordinate
    y: Coordinate
    theta: Angle = 0.0


class Settings(Struct, frozen=True, forbid_unknown_fields=True):
    """The world as a whole: step `dt`, real-time factor `rtf` (0 is as fast as it goes), the `size` that holds all."""

    name: str = ""
    size: tuple[Length, Length] | None = None
    dt: Annotated[float, Meta(ge=0.0001, le=0.1)] = 0.01
    rtf: Annotated[float, Meta(ge=0.0, le=1000.0)] = 1.0
    seed: Annotated[int, Meta(ge=0, le=2**63 - 1)] = 0


class Wall(Struct, frozen=True, forbid_unknown_fields=True):
    """A line of walls from point to point, without thickness; `closed` joins the last to the first."""

    polyline: Annotated[tuple[Point, ...], Meta(min_length=2)]
    closed: bool = False

    def segments(self) -> list[tuple[Point, Point]]:
        """Give the wall as pairs of end points."""
        ends = [*self.polyline[1:], self.polyline[0]] if self.closed else self.polyline[1:]
        return list(zip(self.polyline, ends, strict=False))


class Shape(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """An outline about its own centre: a box (length along x, width along y) or a circle (radius)."""

    box: tuple[Length, Length] | None = None
    circle: Length | None = None

    def corners(self) -> list[Point]:
        """Give a box's corners, counter-clockwise; a circle has none."""
        x, y = (side / 2 for side in self.box or (0.0, 0.0))
        return [(x, y), (-x, y), (-x, -y), (x, -y)] if self.box else []

    def inner_radius(self) -> float:
        """Give the radius of the largest circle about the centre that fits in, in metres."""
        return self.circle or min(self.box or (0.0, 0.0)) / 2

    def outer_radius(self) -> float:
        """Give the distance of the farthest point from the centre, in metres."""
        return self.circle or math.hypot(*(self.box or (0.0, 0.0))) / 2

    def inertia(self, mass: float) -> float:
        """Give the moment of inertia about the centre of a solid of this shape, in kg m²."""
        if self.circle is not None:
            return mass * self.circle**2 / 2
        length, width = self.box or (0.0, 0.0)
        return mass * (length**2 + width**2) / 12


class Obstacle(Shape, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A thing in the way: fixed, or with a mass one that can be pushed."""

    pose: Pose
    mass: Mass | None = None


class Drive(Struct, frozen=True, forbid_unknown_fields=True):
    """A differential drive: limits in m/s, rad/s, m/s², rad/s²; it stops `timeout` seconds after its last command."""

    type: str = "diff"
    v_max: Limit = 0.5
    w_max: Limit = 2.0
    a_max: Limit = 1.5
    alpha_max: Limit = 10.0
    timeout: Limit = 0.5


class Odom(Struct, frozen=True, forbid_unknown_fields=True):
    """Odometry, published `rate` times a second."""

    rate: Rate = 50.0


class Lidar(Struct, frozen=True, forbid_unknown_fields=True):
    """A planar laser scanner that publishes on the topic `lidar`.

    `fov` and `start` (the first beam; by default half of `fov` to the right) are in degrees, `range` is
    [nearest, farthest] in metres, `noise` a standard deviation in metres, `dropout` the share of beams that get
    no return, `offset` its pose on the robot. A full circle has a beam each 360/beams degrees, so that none is
    doubled; a smaller field of view has a beam at both ends.
    """

    lidar: str
    rate: Rate = 10.0
    beams: Annotated[int, Meta(ge=2, le=100_000)] = 360
    fov: Annotated[float, Meta(ge=0.01, le=360.0)] = 360.0
    start: Annotated[float, Meta(ge=-360.0, le=360.0)] | None = None
    range: tuple[Annotated[float, Meta(ge=0.0, le=10_000.0)], Length] = (0.12, 12.0)
    noise: Annotated[float, Meta(ge=0.0, le=100.0)] = 0.0
    dropout: Share = 0.0
    offset: Pose = Pose(0.0, 0.0, 0.0)


class RobotDescription(Struct, frozen=True, forbid_unknown_fields=True):
    """A robot: where it starts, its outline, what drives it and what it senses."""

    name: str
    pose: Pose
    shape: Shape = Shape(circle=0.17)
    mass: Mass = 3.0
    drive: Drive = Drive()
    odom: Odom = Odom()
    sensors: tuple[Lidar, ...] = ()


class WorldDescription(Struct, frozen=True, forbid_unknown_fields=True):
    """A whole world file."""

    world: Settings = Settings()
    walls: tuple[Wall, ...] = ()
    obstacles: tuple[Obstacle, ...] = ()
    robots: tuple[RobotDescription, ...] = ()
