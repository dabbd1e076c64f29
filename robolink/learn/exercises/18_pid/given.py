import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class Controller(Node):
    kp = 2.0
    ki = 0.0
    dt = 0.05

    def __init__(self):
        super().__init__("controller")
        self.publisher = self.create_publisher(Float64, "effort", 10)
        self.create_subscription(Float64, "speed", self.on_speed, 10)
        self.total = 0.0

    def on_speed(self, speed):
        error = 1.0 - speed.data
        # {integral}
        effort = self.kp * error
        self.publisher.publish(Float64(data=effort))


def main():
    rclpy.init()
    rclpy.spin(Controller())


if __name__ == "__main__":
    main()
