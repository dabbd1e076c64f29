import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class Asker(Node):
    def __init__(self):
        super().__init__("asker")
        self.client = self.create_client(AddTwoInts, "add_two_ints")
        self.client.wait_for_service()
        self.ask()

    def ask(self):
        request = AddTwoInts.Request()
        request.a = 2
        request.b = 3
        future = self.client.call_async(request)
        future.add_done_callback(self.on_answer)

    def on_answer(self, future):
        self.get_logger().info(f"sum is {future.result().sum}")


def main():
    rclpy.init()
    rclpy.spin(Asker())


if __name__ == "__main__":
    main()
