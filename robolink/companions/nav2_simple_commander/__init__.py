"""nav2_simple_commander: a plain script sends a robot around by the actions and services of Nav2."""

from __future__ import annotations

from robolink.geometry.transformations import quaternion_from_euler
from robolink.interfaces.geometry_msgs.msg import Quaternion


def euler_to_quaternion(roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> Quaternion:
    """Return the rotation about the fixed axes x, y and z, in this order.

    Args:
        roll: Angle about x in radians.
        pitch: Angle about y in radians.
        yaw: Angle about z in radians.
    """
    x, y, z, w = map(float, quaternion_from_euler(roll, pitch, yaw))
    return Quaternion(x=x, y=y, z=z, w=w)
