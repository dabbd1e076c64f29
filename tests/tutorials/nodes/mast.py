"""tf2: a mast that stands where the arguments say: NAME X Y Z ROLL PITCH YAW."""

import sys

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster
from tf_transformations import quaternion_from_euler

if len(sys.argv) != 8:
    rclpy.logging.get_logger('mast').error(f'seven arguments are needed, there are {len(sys.argv) - 1}')
    sys.exit(1)


def pose_of(name, *numbers):
    standing = TransformStamped(child_frame_id=name)
    standing.header.frame_id = 'ground'
    for axis, metres in zip('xyz', numbers):
        setattr(standing.transform.translation, axis, metres)
    for part, value in zip('xyzw', quaternion_from_euler(*numbers[3:])):
        setattr(standing.transform.rotation, part, value)
    return standing


rclpy.init()
mast = Node('mast')
stamped = pose_of(sys.argv[1], *map(float, sys.argv[2:]))
stamped.header.stamp = mast.get_clock().now().to_msg()
StaticTransformBroadcaster(mast).sendTransform(stamped)
try:
    rclpy.spin(mast)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
