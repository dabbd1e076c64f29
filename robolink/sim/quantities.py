"""Types of the numbers in a world file, each with its unit and range; and `Pose`."""

from __future__ import annotations

from typing import Annotated, TypeAlias

from msgspec import Meta, Struct

from robolink.geometry import plane

FARTHEST = 100_000.0
"""Largest distance from the origin along an axis, in metres."""

Coordinate: TypeAlias = Annotated[float, Meta(ge=-FARTHEST, le=FARTHEST)]
Angle: TypeAlias = Annotated[float, Meta(ge=-6.2832, le=6.2832)]  # one turn: who writes 90 meant degrees
Length: TypeAlias = Annotated[float, Meta(ge=0.001, le=100_000.0)]
Height: TypeAlias = Annotated[float, Meta(ge=0.001, le=1000.0)]
Mass: TypeAlias = Annotated[float, Meta(ge=0.001, le=100_000.0)]
Rate: TypeAlias = Annotated[float, Meta(ge=0.001, le=10_000.0)]
Limit: TypeAlias = Annotated[float, Meta(ge=0.001, le=1000.0)]
Share: TypeAlias = Annotated[float, Meta(ge=0.0, le=1.0)]
Factor: TypeAlias = Annotated[float, Meta(ge=0.5, le=2.0)]  # near 1: who writes 0.03 meant 1.03
Point: TypeAlias = tuple[Coordinate, Coordinate]


class Pose(Struct, frozen=True, array_like=True, forbid_unknown_fields=True):
    """Pose in the plane: `x` and `y` in metres, heading `theta` in radians counter-clockwise from the x axis."""

    x: Coordinate
    y: Coordinate
    theta: Angle = 0.0

    @property
    def place(self) -> plane.Pose:
        """The same pose as a `robolink.geometry.plane.Pose`."""
        return plane.Pose(self.x, self.y, self.theta)
