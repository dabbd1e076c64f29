"""Managed nodes: a fountain that splashes while it is active."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import Node, State, TransitionCallbackReturn
from std_msgs.msg import String


class Fountain(Node):
    jets = pump = None

    def on_configure(self, state: State):
        self.get_logger().info(f'filled; it was {state.label}')
        self.jets = self.create_lifecycle_publisher(String, 'splashes', 10)
        self.pump = self.create_timer(0.1, self.splash)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        self.get_logger().info('opened')
        return super().on_activate(state)

    def splash(self):
        if not self.jets.is_activated:
            self.get_logger().info('the jets are shut', throttle_duration_sec=1.0)
        self.jets.publish(String(data='splash!'))

    def on_deactivate(self, state):
        self.get_logger().info('shut')
        return super().on_deactivate(state)

    def on_cleanup(self, _):
        return self.empty('cleaned')

    def on_shutdown(self, _):
        return self.empty('taken down')

    def empty(self, how):
        if self.pump:
            self.destroy_timer(self.pump)
            self.destroy_publisher(self.jets)
        self.jets = self.pump = None
        self.get_logger().info(how)
        return TransitionCallbackReturn.SUCCESS


def main():
    rclpy.init()
    fountain = Fountain('fountain')
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(fountain)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        fountain.destroy_node()


if __name__ == '__main__':
    main()
