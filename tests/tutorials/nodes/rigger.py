"""tf2: waits for the mast with a timeout, and asks where the end of its boom is."""

import rclpy
import tf2_geometry_msgs
import tf2_ros
from geometry_msgs.msg import PointStamped
from rclpy.duration import Duration
from rclpy.time import Time

rclpy.init()
rigger = rclpy.create_node('rigger')
frames = tf2_ros.Buffer()
listener = tf2_ros.TransformListener(frames, rigger, spin_thread=True)
if not frames.can_transform('ground', 'mast', Time(), timeout=Duration(seconds=30.0)):
    raise SystemExit('no mast was set up')

boom = PointStamped()
boom.header.frame_id = 'mast'
boom.point.x = 2.0
mast = frames.lookup_transform('ground', 'mast', Time())
end = tf2_geometry_msgs.do_transform_point(boom, mast).point
rigger.get_logger().info(f'the boom ends at y={end.y:.1f}, z={end.z:.1f}')
rigger.destroy_node()
rclpy.shutdown()
