"""Paths as messages."""

from __future__ import annotations

import math

import numpy as np

from robolink.interfaces.geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from robolink.interfaces.nav_msgs.msg import Path
from robolink.interfaces.std_msgs.msg import Header
from robolink.navigation.grid import Floats


def path_message(poses: Floats, header: Header) -> Path:
    """Return rows of x, y and theta as a message; all of its poses have the same header."""
    return Path(
        header=header,
        poses=[
            PoseStamped(
                header=header,
                pose=Pose(
                    position=Point(x=x, y=y), orientation=Quaternion(z=math.sin(theta / 2), w=math.cos(theta / 2))
                ),
            )
            for x, y, theta in poses.tolist()
        ],
    )


def joined(parts: list[Floats]) -> Floats:
    """Return paths of which each begins where the one before ends as one, without the poses that come twice."""
    return np.concatenate([parts[0], *(each[1:] for each in parts[1:])])
