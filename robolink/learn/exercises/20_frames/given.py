import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from tf2_ros import StaticTransformBroadcaster


class Mount(Node):
    def __init__(self):
        super().__init__("mount")
        self.broadcaster = StaticTransformBroadcaster(self)
        transform = TransformStamped()
        transform.header.stamp = self.get_clock().now().to_msg()
        # {frames}
        transform.header.frame_id = "laser"
        transform.child_frame_id = "base_link"
        # {place}
        transform.transform.rotation.w = 1.0
        self.broadcaster.sendTransform(transform)


def main():
    rclpy.init()
    rclpy.spin(Mount())


if __name__ == "__main__":
    main()
