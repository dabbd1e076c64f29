import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.declare_parameter("speed", 0.3)
        self.add_on_set_parameters_callback(self.on_set)

    def on_set(self, parameters):
        for each in parameters:
            if each.name == "speed" and not 0.0 <= each.value <= 1.0:
                return SetParametersResult(successful=False, reason="speed is 0.0 to 1.0 m/s")
        return SetParametersResult(successful=True)


def main():
    rclpy.init()
    rclpy.spin(Driver())


if __name__ == "__main__":
    main()
