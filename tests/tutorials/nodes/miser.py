"""Actions: a miser who has enough rabbits as soon as he hears of the first."""

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient

rclpy.init()
miser = rclpy.create_node('miser')
hutch = ActionClient(miser, Fibonacci, 'breed')
first = rclpy.task.Future()


def heard(message):
    if not first.done():
        first.set_result(message.feedback)


hutch.wait_for_server()
asked = hutch.send_goal_async(Fibonacci.Goal(order=900), heard)
rclpy.spin_until_future_complete(miser, asked)
rclpy.spin_until_future_complete(miser, first)
stopped = asked.result().cancel_goal_async()
rclpy.spin_until_future_complete(miser, stopped)
miser.get_logger().info(f'{len(stopped.result().goals_canceling)} goal ends')
miser.destroy_node()
rclpy.shutdown()
