"""Cancels a goal when the first feedback has come."""

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.node import Node


class Cancels(Node):
    def __init__(self):
        super().__init__('fibonacci_cancel')
        self.client = ActionClient(self, Fibonacci, 'fibonacci')
        self.feedback = rclpy.task.Future()

    def on_feedback(self, msg):
        if not self.feedback.done():
            self.feedback.set_result(msg.feedback)


def main(args=None):
    rclpy.init(args=args)
    node = Cancels()
    node.client.wait_for_server()
    sent = node.client.send_goal_async(Fibonacci.Goal(order=900), feedback_callback=node.on_feedback)
    rclpy.spin_until_future_complete(node, sent)
    goal_handle = sent.result()
    rclpy.spin_until_future_complete(node, node.feedback)
    cancelled = goal_handle.cancel_goal_async()
    rclpy.spin_until_future_complete(node, cancelled)
    if len(cancelled.result().goals_canceling) > 0:
        node.get_logger().info('Goal successfully canceled')
    else:
        node.get_logger().info('Goal failed to cancel')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
