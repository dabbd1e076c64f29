import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_srvs.srv import SetBool


class Motor(Node):
    def __init__(self):
        super().__init__("motor")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_service(SetBool, "power", self.on_power)
        self.timer = self.create_timer(0.1, self.drive)
        self.is_on = False

    def on_power(self, request, response):
        # {answer}
        self.get_logger().info(f"asked for {request.data}")

    def drive(self):
        twist = Twist()
        twist.linear.x = 0.2 if self.is_on else 0.0
        self.publisher.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Motor())


if __name__ == "__main__":
    main()
