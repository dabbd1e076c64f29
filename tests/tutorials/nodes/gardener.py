"""Managed nodes: a gardener who leads the fountain through a day and listens to it."""

import rclpy
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.node import Node
from std_msgs.msg import String

MORNING = (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE)
EVENING = (
    Transition.TRANSITION_DEACTIVATE,
    Transition.TRANSITION_CLEANUP,
    Transition.TRANSITION_UNCONFIGURED_SHUTDOWN,
)


class Gardener(Node):
    def __init__(self):
        super().__init__('gardener')
        self.splash = rclpy.Future()
        self.create_subscription(String, 'splashes', lambda said: self.splash.set_result(said.data), 10)
        self.change, self.state = (
            self.create_client(kind, f'fountain/{name}')
            for kind, name in ((ChangeState, 'change_state'), (GetState, 'get_state'))
        )

    def ask(self, client, request):
        client.wait_for_service()
        answer = client.call_async(request)
        rclpy.spin_until_future_complete(self, answer)
        return answer.result()

    def lead(self, transitions):
        for each in transitions:
            changed = self.ask(self.change, ChangeState.Request(transition=Transition(id=each)))
            now = self.ask(self.state, GetState.Request()).current_state
            self.get_logger().info(f'the fountain is {now.label}: {changed.success}')


rclpy.init()
gardener = Gardener()
gardener.lead(MORNING)
rclpy.spin_until_future_complete(gardener, gardener.splash)
gardener.get_logger().info('heard ' + gardener.splash.result())
gardener.lead(EVENING)
rclpy.shutdown()
