"""tf2: tells where the turtle of its parameter is."""

import numpy as np
import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from tf2_ros import TransformBroadcaster
from turtlesim.msg import Pose


class Spotter(Node):
    def __init__(self):
        super().__init__('spotter')
        whom = self.declare_parameter('whom', 'nobody').get_parameter_value().string_value
        self.sky = TransformBroadcaster(self)
        self.frame = TransformStamped(child_frame_id=whom)
        self.frame.header.frame_id = 'pond'
        self.create_subscription(Pose, f'/{whom}/pose', self.spot, 1)

    def spot(self, pose):
        self.frame.header.stamp = self.get_clock().now().to_msg()
        place, turn = self.frame.transform.translation, self.frame.transform.rotation
        place.x, place.y = pose.x, pose.y
        turn.z, turn.w = np.sin(pose.theta / 2), np.cos(pose.theta / 2)  # numbers of numpy's own
        self.sky.sendTransform(self.frame)


def main():
    rclpy.init()
    try:
        rclpy.spin(Spotter())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
