"""Several nodes in one process, one of them with an executor of its own."""

import threading

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Trigger


class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.i = 0
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.tmr = self.create_timer(0.05, self.timer_callback)

    def timer_callback(self):
        self.i += 1
        self.pub.publish(String(data=f'Hello World: {self.i}'))


class Listener(Node):
    def __init__(self):
        super().__init__('listener')
        self.sub = self.create_subscription(String, 'chatter', self.chatter_callback, 10)

    def chatter_callback(self, msg):
        self.get_logger().info('I heard: [%s]' % msg.data)


class Asks(Node):
    """A service that is called within a callback: a group for each of them."""

    def __init__(self):
        super().__init__('asks')
        self.srv = self.create_service(
            Trigger, 'trigger', self.on_trigger, callback_group=MutuallyExclusiveCallbackGroup()
        )
        self.cli = self.create_client(Trigger, 'trigger', callback_group=MutuallyExclusiveCallbackGroup())
        self.tmr = self.create_timer(0.1, self.on_timer, callback_group=MutuallyExclusiveCallbackGroup())

    def on_trigger(self, request, response):
        response.success = True
        response.message = 'triggered'
        return response

    def on_timer(self):
        self.tmr.cancel()
        response = self.cli.call(Trigger.Request())
        self.get_logger().info('Answered: %s' % response.message)


def main(args=None):
    rclpy.init(args=args)
    own = SingleThreadedExecutor()
    own.add_node(Listener())
    thread = threading.Thread(target=own.spin, daemon=True)
    thread.start()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(Talker())
    executor.add_node(Asks())
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    finally:
        executor.shutdown()
        own.shutdown()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
