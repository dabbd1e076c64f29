"""Actions: a farmer who wants five months of rabbits, after a wish that is too large."""

import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Farmer(Node):
    def __init__(self, months):
        super().__init__('farmer')
        self.hutch = ActionClient(self, Fibonacci, 'breed')
        self.months = months

    def say(self, *words):
        self.get_logger().info(' '.join(map(str, words)))

    def wish(self):
        self.hutch.wait_for_server()
        months = self.months.pop(0)
        answer = self.hutch.send_goal_async(Fibonacci.Goal(order=months), feedback_callback=self.count)
        answer.add_done_callback(self.answered)

    def answered(self, answer):
        goal = answer.result()
        self.say('accepted:', goal.accepted)
        if goal.accepted:
            goal.get_result_async().add_done_callback(self.finished)
        else:
            self.wish()

    def count(self, message):
        self.say('so far', message.feedback.sequence.tolist())

    def finished(self, outcome):
        ended = outcome.result()
        assert ended.status == GoalStatus.STATUS_SUCCEEDED
        self.say('in the end', list(ended.result.sequence))
        rclpy.shutdown()


def main():
    rclpy.init()
    farmer = Farmer(months=[5000, 5])
    farmer.wish()
    try:
        rclpy.spin(farmer)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


main()
