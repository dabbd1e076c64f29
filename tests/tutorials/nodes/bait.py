"""tf2: a fixed frame of its own, half a metre before the first turtle."""

import rclpy
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Header
from tf2_ros import TransformBroadcaster


class Bait(Node):
    offset = Transform(translation=Vector3(x=0.5), rotation=Quaternion(w=1.0))

    def __init__(self):
        super().__init__('bait')
        self.frames = TransformBroadcaster(self)
        self.create_timer(0.1, self.dangle)

    def dangle(self):
        head = Header(stamp=self.get_clock().now().to_msg(), frame_id='turtle1')
        self.frames.sendTransform([TransformStamped(header=head, child_frame_id='bait', transform=self.offset)])


def main():
    rclpy.init()
    try:
        rclpy.spin(Bait())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
