"""Lead lifecycle_talker through its states, one each ten seconds.

robolink run lifecycle lifecycle_service_client
"""

from __future__ import annotations

import contextlib
from typing import Any

import robolink
from robolink.client import Client
from robolink.duration import Duration
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState, GetState
from robolink.node import Node

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


def main(args: list[str] | None = None) -> None:
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


if __name__ == "__main__":
    main()
