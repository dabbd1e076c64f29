import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer
from rclpy.node import Node


class FibonacciServer(Node):
    def __init__(self):
        super().__init__("fibonacci_server")
        self.server = ActionServer(self, Fibonacci, "fibonacci", self.execute)

    def execute(self, goal_handle):
        feedback = Fibonacci.Feedback()
        numbers = [0, 1]
        while len(numbers) < goal_handle.request.order + 1:
            numbers.append(numbers[-1] + numbers[-2])
            feedback.sequence = numbers
            goal_handle.publish_feedback(feedback)
        goal_handle.succeed()
        result = Fibonacci.Result()
        result.sequence = numbers
        return result


def main():
    rclpy.init()
    rclpy.spin(FibonacciServer())


if __name__ == "__main__":
    main()
