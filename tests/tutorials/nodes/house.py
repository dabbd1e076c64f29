"""Executors: three nodes in one house, one of them with a thread of its own, one that calls itself."""

import threading

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Int32
from std_srvs.srv import Trigger


class Clock(Node):
    """Strikes."""

    strokes = 0

    def strike(self):
        self.strokes += 1
        self.bell.publish(Int32(data=self.strokes))


class Butler(Node):
    """Answers the bell that he rings himself: a callback group each for both ends, and for the one who waits."""

    def __init__(self):
        super().__init__('butler')
        hand, ear, mouth = (MutuallyExclusiveCallbackGroup() for _ in range(3))
        self.create_service(Trigger, 'bell', self.answer, callback_group=ear)
        self.rope = self.create_client(Trigger, 'bell', callback_group=mouth)
        self.once = self.create_timer(0.1, self.ring, callback_group=hand)

    def answer(self, _, words):
        words.success, words.message = True, 'dinner is served'
        return words

    def ring(self):
        self.once.cancel()
        self.get_logger().info(self.rope.call(Trigger.Request()).message)


rclpy.init()
clock, attic = Clock('clock'), Node('attic')
clock.bell = clock.create_publisher(Int32, 'strokes', 10)
clock.create_timer(0.05, clock.strike)
attic.create_subscription(Int32, 'strokes', lambda stroke: attic.get_logger().info(f'stroke {stroke.data}'), 10)

upstairs, downstairs = SingleThreadedExecutor(), MultiThreadedExecutor(num_threads=4)
upstairs.add_node(attic)
for servant in (clock, Butler()):
    downstairs.add_node(servant)
threading.Thread(target=upstairs.spin, daemon=True).start()
try:
    downstairs.spin()
except KeyboardInterrupt:
    pass
finally:
    for each in (upstairs, downstairs):
        each.shutdown()
    rclpy.try_shutdown()
