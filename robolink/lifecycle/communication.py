"""Services and events of a managed node, by which others observe and drive it: five services, ~/transition_event."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from robolink.exceptions import InvalidHandle
from robolink.interfaces.lifecycle_msgs.msg import State, Transition, TransitionDescription, TransitionEvent
from robolink.interfaces.lifecycle_msgs.srv import (
    ChangeState,
    GetAvailableStates,
    GetAvailableTransitions,
    GetState,
)
from robolink.lifecycle.state_machine import LifecycleStateMachine, Step, TransitionError
from robolink.node import Node

if TYPE_CHECKING:
    from robolink.callback_groups import CallbackGroup

EVENTS_DEPTH = 10
"""Depth of the events' publisher in messages, as in rcl_lifecycle."""


class Communication:
    """The services and the topic of one managed node. `change` makes a transition; True if it succeeded."""

    def __init__(
        self, node: Node, machine: LifecycleStateMachine, change: Callable[[int], bool], group: CallbackGroup
    ) -> None:
        self._node, self._machine, self._change = node, machine, change
        # Node's own methods: a subclass's may make managed publishers, which are none of these.
        self._events = Node.create_publisher(node, TransitionEvent, "~/transition_event", EVENTS_DEPTH)
        machine.on_step = self.publish
        for srv_type, name in (
            (ChangeState, "change_state"),
            (GetState, "get_state"),
            (GetAvailableStates, "get_available_states"),
            (GetAvailableTransitions, "get_available_transitions"),
            (GetAvailableTransitions, "get_transition_graph"),
        ):
            answer = getattr(self, f"_{name}")
            service = Node.create_service(node, srv_type, f"~/{name}", answer, callback_group=group)
            setattr(machine, f"service_{name}", service)

    def publish(self, step: Step) -> None:
        """Publish an event of a transition."""
        made = _described(step)
        event = TransitionEvent(
            timestamp=self._node.get_clock().now().nanoseconds,
            transition=made.transition,
            start_state=made.start_state,
            goal_state=made.goal_state,
        )
        with contextlib.suppress(InvalidHandle):  # its program may end a node in good order that has been destroyed
            self._events.publish(event)

    def _change_state(self, request: Any, response: Any) -> Any:
        wanted = request.transition
        try:
            number = self._machine.get_transition_by_label(wanted.label) if wanted.label else wanted.id
        except TransitionError as error:
            self._node.get_logger().warning(str(error))
            return response
        response.success = self._change(number)
        return response

    def _get_state(self, _: Any, response: Any) -> Any:
        response.current_state.id, response.current_state.label = self._machine.current_state
        return response

    def _get_available_states(self, _: Any, response: Any) -> Any:
        response.available_states = [State(id=id_, label=label) for id_, label in self._machine.available_states]
        return response

    def _get_available_transitions(self, _: Any, response: Any) -> Any:
        return _listed(self._machine.available_transitions, response)

    def _get_transition_graph(self, _: Any, response: Any) -> Any:
        return _listed(self._machine.transition_graph, response)


def _listed(steps: Iterable[Step], response: Any) -> Any:
    response.available_transitions = [_described(step) for step in steps]
    return response


def _described(step: Step) -> TransitionDescription:
    return TransitionDescription(
        transition=Transition(id=step.id, label=step.label),
        start_state=State(id=step.start_id, label=step.start_label),
        goal_state=State(id=step.goal_id, label=step.goal_label),
    )
