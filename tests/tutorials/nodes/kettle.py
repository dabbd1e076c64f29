"""Topics: a kettle that says how warm its water is."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Kettle(Node):
    def __init__(self):
        super().__init__('kettle')
        self.degrees = 20
        self.steam = self.create_publisher(String, 'water', 10)
        self.create_timer(0.1, self.heat)

    def heat(self):
        report = String(data=f'{self.degrees} degrees')
        self.steam.publish(report)
        self.get_logger().info('told: ' + report.data)
        self.degrees = min(self.degrees + 1, 100)


def main(args=None):
    try:
        with rclpy.init(args=args):
            rclpy.spin(Kettle())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
