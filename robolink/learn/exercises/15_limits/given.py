import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.declare_parameter("speed", 0.3)
        self.add_on_set_parameters_callback(self.on_set)

    def on_set(self, parameters):
        # {refuse}
        return SetParametersResult(successful=True)


def main():
    rclpy.init()
    rclpy.spin(Driver())


if __name__ == "__main__":
    main()
