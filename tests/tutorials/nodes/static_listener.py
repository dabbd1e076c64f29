"""Waits for a frame with a timeout, and transforms a point into it."""

import rclpy
import tf2_ros
from geometry_msgs.msg import PointStamped
from rclpy.duration import Duration
from rclpy.node import Node
import tf2_geometry_msgs


def main():
    rclpy.init()
    node = Node('static_listener')
    tf_buffer = tf2_ros.Buffer()
    tf_listener = tf2_ros.TransformListener(tf_buffer, node, spin_thread=True)
    if not tf_buffer.can_transform('world', 'mystaticturtle', rclpy.time.Time(), timeout=Duration(seconds=30.0)):
        raise SystemExit('there is no mystaticturtle')
    t = tf_buffer.lookup_transform('world', 'mystaticturtle', rclpy.time.Time())
    node.get_logger().info('At z=%.1f' % t.transform.translation.z)
    point = PointStamped()
    point.header.frame_id = 'mystaticturtle'
    point.point.x = 2.0
    moved = tf2_geometry_msgs.do_transform_point(point, t)
    node.get_logger().info('The point is at y=%.1f, z=%.1f' % (moved.point.y, moved.point.z))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
