"""Client of the nodes with a lifecycle of a launch: asks for transitions, and hears of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.interfaces.lifecycle_msgs.msg import TransitionEvent
from robolink.interfaces.lifecycle_msgs.srv import ChangeState

if TYPE_CHECKING:
    from robolink.client import Client
    from robolink.node import Node
    from robolink.timer import Timer

LOOK_AGAIN = 0.05
"""Interval between two looks for a service, in s."""
PATIENCE = 10.0
"""Time after which a service that is still missing is reported, in s."""


class Lifecycles:
    """Client of nodes with a lifecycle.

    Args:
        with_node: Calls a function with the launcher's own node, where that is spun.
        on_transition: Called there with the full name of a node and the event of each of its transitions.
        say: Called there with a line for people.
    """

    def __init__(
        self,
        with_node: Callable[[Callable[[Node], object]], None],
        on_transition: Callable[[str, TransitionEvent], object],
        say: Callable[[str], object],
    ) -> None:
        self._with_node, self._on_transition, self._say = with_node, on_transition, say
        self._watched: set[str] = set()
        self._clients: dict[str, Client] = {}

    def watch(self, name: str) -> None:
        """Hear of the transitions of the node with the full name `name`."""
        if name in self._watched:
            return
        self._watched.add(name)

        def subscribe(node: Node) -> None:
            topic = f"{name}/transition_event"
            node.create_subscription(TransitionEvent, topic, lambda event: self._on_transition(name, event), 10)

        self._with_node(subscribe)

    def change(self, name: str, transition_id: int) -> None:
        """Ask the node with the full name `name` for a transition, once it serves that."""
        self.watch(name)
        self._with_node(lambda node: _Change(node, self._client(node, name), name, transition_id, self._say))

    def _client(self, node: Node, name: str) -> Client:
        if name not in self._clients:
            self._clients[name] = node.create_client(ChangeState, f"{name}/change_state")
        return self._clients[name]


class _Change:
    """One request for a transition, which waits until its service is there."""

    def __init__(self, node: Node, client: Client, name: str, transition_id: int, say: Callable[[str], object]) -> None:
        self._node, self._client, self._name, self._say = node, client, name, say
        self._request = ChangeState.Request()
        self._request.transition.id = transition_id
        self._left = round(PATIENCE / LOOK_AGAIN)
        self._timer: Timer = node.create_timer(LOOK_AGAIN, self._look)

    def _look(self) -> None:
        if self._client.service_is_ready():
            self._node.destroy_timer(self._timer)
            self._client.call_async(self._request).add_done_callback(self._answered)
            return
        self._left -= 1
        if self._left == 0:
            self._say(f"{self._name} has no lifecycle yet: it is to make transition {self._request.transition.id}")

    def _answered(self, future: Any) -> None:
        if future.exception() is not None or not future.result().success:
            self._say(f"{self._name} did not make transition {self._request.transition.id}")
