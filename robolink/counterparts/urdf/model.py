"""Robot model: links, joints, and the transform of a joint's child in its parent at a position of the joint."""

from __future__ import annotations

import math
from typing import NamedTuple

from robolink.tf2.rigid import Rigid, compose

MOVING = ("revolute", "continuous", "prismatic")
"""Kinds of joints that one number moves."""
KINDS = (*MOVING, "fixed", "floating", "planar")
"""Kinds of joints."""

Vector = tuple[float, float, float]


class Mimic(NamedTuple):
    """Rule of a joint that follows another: `multiplier` times that one's position, plus `offset`."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


class Joint(NamedTuple):
    """A joint: `child` stands in `parent` at `origin`, and moves about or along the unit vector `axis`.

    `lower` and `upper` are limits in rad or m, `soft` those of a safety controller; None where the model has none.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: Rigid
    axis: Vector = (1.0, 0.0, 0.0)
    lower: float | None = None
    upper: float | None = None
    soft: tuple[float | None, float | None] = (None, None)
    mimic: Mimic | None = None

    @property
    def moves(self) -> bool:
        """True if one number says where the child is."""
        return self.kind in MOVING


class Robot(NamedTuple):
    """A robot: a tree of links below `root`; `joints` by name, in the order of the text."""

    name: str
    root: str
    links: tuple[str, ...]
    joints: dict[str, Joint]
    notes: tuple[str, ...] = ()
    """Lines about oddities that ROS takes all the same, each with file and line."""


def placed(joint: Joint, position: float = 0.0) -> Rigid:
    """Return the transform of a joint's child in its parent.

    Args:
        joint: The joint.
        position: Position in rad, in m for a prismatic joint; a joint that does not move ignores it.
    """
    x, y, z = joint.axis
    if joint.kind == "prismatic":
        return compose(joint.origin, (position * x, position * y, position * z, 0.0, 0.0, 0.0, 1.0))
    if joint.moves:
        sine = math.sin(position / 2)
        return compose(joint.origin, (0.0, 0.0, 0.0, x * sine, y * sine, z * sine, math.cos(position / 2)))
    return joint.origin
