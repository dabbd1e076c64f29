"""Topics: a cup that hears the kettle, in the way of Humble: no context manager."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Cup(Node):
    """Remembers what it heard last."""

    last = None

    def __init__(self, name='cup'):
        Node.__init__(self, name)
        self.ear = self.create_subscription(String, 'water', self.hear, qos_profile=10)

    def hear(self, report):
        self.last = report.data
        self.get_logger().info(f'the kettle says {self.last}')


def main():
    rclpy.init()
    cup = Cup()
    try:
        rclpy.spin(cup)
    except KeyboardInterrupt:
        pass
    finally:
        cup.destroy_node()
        rclpy.try_shutdown()


main()
