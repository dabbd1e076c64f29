"""Actions: a hutch in which rabbits multiply, month by month, as Fibonacci counted them."""

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

TOO_LONG = 1000
ROOM = 50


class Hutch(Node):
    def __init__(self):
        super().__init__('hutch')
        self.month = self.create_rate(50)
        self.door = ActionServer(
            self,
            Fibonacci,
            'breed',
            self.breed,
            goal_callback=self.weigh_up,
            cancel_callback=self.give_in,
            callback_group=ReentrantCallbackGroup(),
        )

    def weigh_up(self, wish):
        self.get_logger().info(f'{wish.order} months are wished for')
        if wish.order < TOO_LONG:
            return GoalResponse.ACCEPT
        return GoalResponse.REJECT

    def give_in(self, goal):
        self.get_logger().info('somebody has enough')
        return CancelResponse.ACCEPT

    def breed(self, goal):
        pairs, outcome = [0, 1], Fibonacci.Result()
        while len(pairs) <= goal.request.order:
            self.month.sleep()
            if goal.is_cancel_requested:
                self.get_logger().info('no more rabbits')
                goal.canceled()
                return outcome
            pairs.append(min(sum(pairs[-2:]), ROOM))
            goal.publish_feedback(Fibonacci.Feedback(sequence=pairs))
        outcome.sequence = pairs
        goal.succeed()
        return outcome


def main():
    try:
        with rclpy.init():
            rclpy.spin(Hutch(), executor=MultiThreadedExecutor(num_threads=4))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
