"""Leads the managed node through its life and listens to it."""

import rclpy
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.node import Node
from std_msgs.msg import String


class LifecycleClient(Node):
    def __init__(self):
        super().__init__('lc_client')
        self.change = self.create_client(ChangeState, 'lc_talker/change_state')
        self.get = self.create_client(GetState, 'lc_talker/get_state')
        self.change.wait_for_service()
        self.get.wait_for_service()
        self.heard = rclpy.Future()
        self.create_subscription(String, 'lifecycle_chatter', self.on_chatter, 10)

    def on_chatter(self, msg):
        if not self.heard.done():
            self.heard.set_result(msg.data)

    def go(self, transition):
        request = ChangeState.Request()
        request.transition.id = transition
        future = self.change.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        asked = self.get.call_async(GetState.Request())
        rclpy.spin_until_future_complete(self, asked)
        self.get_logger().info('%s: %s' % (future.result().success, asked.result().current_state.label))


def main():
    rclpy.init()
    node = LifecycleClient()
    node.go(Transition.TRANSITION_CONFIGURE)
    node.go(Transition.TRANSITION_ACTIVATE)
    rclpy.spin_until_future_complete(node, node.heard)
    node.get_logger().info('data_callback: %s' % node.heard.result())
    node.go(Transition.TRANSITION_DEACTIVATE)
    node.go(Transition.TRANSITION_CLEANUP)
    node.go(Transition.TRANSITION_UNCONFIGURED_SHUTDOWN)
    rclpy.shutdown()


if __name__ == '__main__':
    main()
