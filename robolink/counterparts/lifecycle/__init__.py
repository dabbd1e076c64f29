"""Counterparts of the package lifecycle: the demo of managed nodes."""

from __future__ import annotations

import contextlib
from typing import Any

import robolink
from robolink.client import Client
from robolink.counterparts.program import spin_program
from robolink.duration import Duration
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.lifecycle_msgs.msg import Transition, TransitionEvent
from robolink.interfaces.lifecycle_msgs.srv import ChangeState, GetState
from robolink.interfaces.std_msgs.msg import String
from robolink.lifecycle import LifecycleNode, LifecyclePublisher, LifecycleState, TransitionCallbackReturn
from robolink.node import Node
from robolink.timer import Timer

SUCCESS = TransitionCallbackReturn.SUCCESS


class LifecycleTalker(LifecycleNode):
    """A managed node that publishes a count. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("lc_talker", **options)
        self.count = 0
        self.chatter: LifecyclePublisher[String] | None = None
        self.timer: Timer | None = None

    def on_timer(self) -> None:
        """Publish the next count, which goes nowhere while the node is inactive."""
        self.count += 1
        message = String(data=f"Lifecycle HelloWorld #{self.count}")
        if self.chatter is None:
            return
        if self.chatter.is_activated:
            self.get_logger().info(f"Lifecycle publisher is active. Publishing: [{message.data}]")
            self.chatter.publish(message)
        else:
            self.get_logger().info("Lifecycle publisher is currently inactive. Messages are not published.")

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the publisher and the timer."""
        self.chatter = self.create_lifecycle_publisher(String, "lifecycle_chatter", 10)
        self.timer = self.create_timer(1.0, self.on_timer)
        self.get_logger().info("on_configure() is called.")
        return SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Publish from now on."""
        self.get_logger().info("on_activate() is called.")
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Publish no longer."""
        self.get_logger().info("on_deactivate() is called.")
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Destroy the publisher and the timer."""
        self._release()
        self.get_logger().info("on cleanup is called.")
        return SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Destroy the publisher and the timer."""
        self._release()
        self.get_logger().info(f"on shutdown is called from state {state.label}.")
        return SUCCESS

    def _release(self) -> None:
        if self.timer is not None:
            self.destroy_timer(self.timer)
        if self.chatter is not None:
            self.destroy_lifecycle_publisher(self.chatter)
        self.timer = self.chatter = None


def run_talker(args: list[str] | None = None) -> None:
    """Publish while active, until Ctrl-C."""
    spin_program(lambda words: LifecycleTalker(), args)


class LifecycleListener(Node):
    """A node that logs messages and transitions. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("lc_listener", **options)
        self.create_subscription(String, "lifecycle_chatter", self.on_message, 10)
        self.create_subscription(TransitionEvent, "/lc_talker/transition_event", self.on_transition, 10)

    def on_message(self, message: String) -> None:
        """Log a message."""
        self.get_logger().info(f"data_callback: {message.data}")

    def on_transition(self, event: TransitionEvent) -> None:
        """Log a transition."""
        states = f"from state {event.start_state.label} to {event.goal_state.label}"
        self.get_logger().info(f"notify callback: Transition {states}")


TALKER = "lc_talker"
PATIENCE, PAUSE = 3.0, 10.0
"""Timeout of a call, and time between two transitions, in seconds."""
STEPS = (
    Transition.TRANSITION_CONFIGURE,
    Transition.TRANSITION_ACTIVATE,
    Transition.TRANSITION_DEACTIVATE,
    Transition.TRANSITION_ACTIVATE,
    Transition.TRANSITION_DEACTIVATE,
    Transition.TRANSITION_CLEANUP,
    Transition.TRANSITION_UNCONFIGURED_SHUTDOWN,
)


def run_service_client(args: list[str] | None = None) -> None:
    """Make all transitions; the first failure ends it."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = Node("lc_client")
        change = node.create_client(ChangeState, f"/{TALKER}/change_state")
        state = node.create_client(GetState, f"/{TALKER}/get_state")
        for number, step in enumerate(STEPS):
            if number:
                node.get_clock().sleep_for(Duration(seconds=PAUSE))
            if not (_change(node, change, step) and _state(node, state)):
                return


def _change(node: Node, client: Client, step: int) -> bool:
    answer = _call(node, client, ChangeState.Request(transition=Transition(id=step)))
    if answer is None:
        return False
    if answer.success:
        node.get_logger().info(f"Transition {step} successfully triggered.")
    else:
        node.get_logger().warning(f"Failed to trigger transition {step}")
    return bool(answer.success)


def _state(node: Node, client: Client) -> bool:
    answer = _call(node, client, GetState.Request())
    if answer is not None:
        node.get_logger().info(f"Node {TALKER} has current state {answer.current_state.label}.")
    return answer is not None


def _call(node: Node, client: Client, request: Any) -> Any:
    """Return the response; None, and a line in the log, if there is none in time."""
    if not client.wait_for_service(PATIENCE):
        node.get_logger().error(f"Service {client.service_name} is not available.")
        return None
    future = client.call_async(request)
    robolink.spin_until_future_complete(node, future, timeout_sec=PATIENCE)
    if not future.done():
        node.get_logger().error(f"Server time out while getting current state for node {TALKER}")
        return None
    return future.result()
