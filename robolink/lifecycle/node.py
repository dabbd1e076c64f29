"""Managed (lifecycle) node: a state machine, the callbacks of its transitions, and the services that drive it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, cast

from robolink.exceptions import ExternalShutdownException, InvalidHandle
from robolink.interfaces.lifecycle_msgs.msg import State, Transition, TransitionDescription, TransitionEvent
from robolink.interfaces.lifecycle_msgs.srv import (
    ChangeState,
    GetAvailableStates,
    GetAvailableTransitions,
    GetState,
)
from robolink.lifecycle.managed_entity import ManagedEntity
from robolink.lifecycle.publisher import LifecyclePublisher
from robolink.lifecycle.state_machine import LifecycleState as LifecycleState
from robolink.lifecycle.state_machine import LifecycleStateMachine, Step, TransitionError
from robolink.lifecycle.state_machine import TransitionCallbackReturn as TransitionCallbackReturn
from robolink.node import Node
from robolink.text.tracebacks import formatted

if TYPE_CHECKING:
    from robolink.callback_groups import CallbackGroup
    from robolink.publisher import MsgT
    from robolink.qos import QoSProfile

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
        expected = request.transition
        try:
            number = self._machine.get_transition_by_label(expected.label) if expected.label else expected.id
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


CALLBACKS = {
    State.TRANSITION_STATE_CONFIGURING: "on_configure",
    State.TRANSITION_STATE_CLEANINGUP: "on_cleanup",
    State.TRANSITION_STATE_SHUTTINGDOWN: "on_shutdown",
    State.TRANSITION_STATE_ACTIVATING: "on_activate",
    State.TRANSITION_STATE_DEACTIVATING: "on_deactivate",
    State.TRANSITION_STATE_ERRORPROCESSING: "on_error",
}
"""Callback by transition state."""

SHUTDOWNS = {
    State.PRIMARY_STATE_UNCONFIGURED: Transition.TRANSITION_UNCONFIGURED_SHUTDOWN,
    State.PRIMARY_STATE_INACTIVE: Transition.TRANSITION_INACTIVE_SHUTDOWN,
    State.PRIMARY_STATE_ACTIVE: Transition.TRANSITION_ACTIVE_SHUTDOWN,
}
"""Shutdown transition by primary state."""


class LifecycleNodeMixin(ManagedEntity):
    """Mixin that makes a Node a managed one, for classes that need another order of bases than LifecycleNode."""

    def __init__(
        self, *, enable_communication_interface: bool = True, callback_group: CallbackGroup | None = None
    ) -> None:
        """Create the state machine and its services.

        Args:
            enable_communication_interface: True offers the services and the topic by which others observe and drive it.
            callback_group: Group of the services; the node's default group by default.

        Raises:
            RuntimeError: if Node is not among the class's bases.
            TypeError: if `enable_communication_interface` is not a bool.
        """
        if not isinstance(self, Node):
            raise RuntimeError("a LifecycleNodeMixin needs Node beside it among the class's bases")
        if not isinstance(enable_communication_interface, bool):
            raise TypeError(f"enable_communication_interface: expected a bool, got {enable_communication_interface!r}")
        self._managed_entities: dict[ManagedEntity, None] = {}
        self._state_machine = LifecycleStateMachine()
        if enable_communication_interface:
            group = callback_group or self.default_callback_group
            Communication(self, self._state_machine, self._succeeds_, group)

    # Transitions on request

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Configure the node; return the result of `on_configure`, or ERROR unless it is unconfigured."""
        return self._change_state_(Transition.TRANSITION_CONFIGURE)

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Undo `trigger_configure`; return the result of `on_cleanup`, or ERROR unless it is inactive."""
        return self._change_state_(Transition.TRANSITION_CLEANUP)

    def trigger_activate(self) -> TransitionCallbackReturn:
        """Activate the node; return the result of `on_activate`, or ERROR unless it is inactive."""
        return self._change_state_(Transition.TRANSITION_ACTIVATE)

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Deactivate the node; return the result of `on_deactivate`, or ERROR unless it is active."""
        return self._change_state_(Transition.TRANSITION_DEACTIVATE)

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """End the node for good; return the result of `on_shutdown`. Raises TransitionError if it has ended."""
        state_id, label = self._state_machine.current_state
        if state_id not in SHUTDOWNS:
            raise TransitionError(f"no shutdown from {label}")
        return self._change_state_(SHUTDOWNS[state_id])

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Register `entity` for the transitions to come. Raises TypeError if it is not a ManagedEntity."""
        if not isinstance(entity, ManagedEntity):
            raise TypeError(f"expected a ManagedEntity, got {entity!r}")
        self._managed_entities[entity] = None

    def create_lifecycle_publisher(
        self,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        publisher_class: None = None,
        **kwargs: Any,
    ) -> LifecyclePublisher[MsgT]:
        """Create a publisher that sends only while the node is active, from its next activation on.

        Args:
            msg_type: Class of the messages.
            topic: Name of the topic.
            qos_profile: QoS profile, or its depth.
            publisher_class: Must be None: it is LifecyclePublisher.
            kwargs: The other keywords of `Node.create_publisher`.

        Raises:
            TypeError: if `publisher_class` is given.
        """
        if publisher_class is not None:
            raise TypeError("create_lifecycle_publisher() takes no publisher_class: it is LifecyclePublisher")
        made = Node.create_publisher(
            self._node_, msg_type, topic, qos_profile, publisher_class=LifecyclePublisher, **kwargs
        )
        publisher = cast("LifecyclePublisher[MsgT]", made)
        self.add_managed_entity(publisher)
        return publisher

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher[Any]) -> bool:
        """Destroy `publisher`; False if it is none of this node's."""
        self._managed_entities.pop(publisher, None)
        return self._node_.destroy_publisher(publisher)

    # A subclass overrides these: each calls the managed entities, in the order in which they were made, until one of
    # them does not succeed, and returns that result.

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Prepare for activation; `state` is the one before."""
        return self._tell_entities_("on_configure", state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Undo `on_configure`; `state` is the one before."""
        return self._tell_entities_("on_cleanup", state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Release everything before the node's end; `state` is the one before."""
        return self._tell_entities_("on_shutdown", state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start to work: from now on its publishers send; `state` is the one before."""
        return self._tell_entities_("on_activate", state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop working, but stay configured: its publishers send no longer; `state` is the one before."""
        return self._tell_entities_("on_deactivate", state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Clean up after a callback's error; `state` is the one before. On SUCCESS it is unconfigured, else it ends."""
        return self._tell_entities_("on_error", state)

    # Course of a transition

    @property
    def _node_(self) -> Node:
        return cast(Node, self)

    def _succeeds_(self, transition_id: int) -> bool:
        return self._change_state_(transition_id) is TransitionCallbackReturn.SUCCESS

    def _change_state_(self, transition_id: int) -> TransitionCallbackReturn:
        """Make a transition that the current state has; ERROR, and a line in the log, when it has it not."""
        machine = self._state_machine
        state_id, label = machine.current_state
        before = LifecycleState(label, state_id)
        try:
            if state_id in CALLBACKS:  # its callback says how it goes on, nobody else
                raise TransitionError(f"no transition '{transition_id}' while {CALLBACKS[state_id]} runs")
            machine.trigger_transition_by_id(transition_id)
        except TransitionError as error:
            self._node_.get_logger().error(str(error))
            return TransitionCallbackReturn.ERROR
        result = self._run_callback_(before)
        machine.trigger_transition_by_label(result.to_label())
        if result is TransitionCallbackReturn.ERROR:
            machine.trigger_transition_by_label(self._run_callback_(before).to_label())
        return result

    def _run_callback_(self, before: LifecycleState) -> TransitionCallbackReturn:
        """Run the callback of the current state; one that raises, or returns anything but a result, is an ERROR."""
        name = CALLBACKS[self._state_machine.current_state[0]]
        try:
            return _checked(getattr(self, name)(before), name, self)
        except (ExternalShutdownException, KeyboardInterrupt):
            raise
        except Exception as error:  # noqa: BLE001 - what a callback raises is what on_error is for
            self._node_.get_logger().error(f"{name} failed:\n{formatted(error)}")
            return TransitionCallbackReturn.ERROR

    def _tell_entities_(self, name: str, state: LifecycleState) -> TransitionCallbackReturn:
        for entity in list(self._managed_entities):
            result = _checked(getattr(entity, name)(state), name, entity)
            if result is not TransitionCallbackReturn.SUCCESS:
                return result
        return TransitionCallbackReturn.SUCCESS


def _checked(result: Any, name: str, of: object) -> TransitionCallbackReturn:
    if isinstance(result, TransitionCallbackReturn):
        return result
    raise TypeError(f"{type(of).__name__}.{name} must return a TransitionCallbackReturn, got {result!r:.80}")


class LifecycleNode(LifecycleNodeMixin, Node):
    """A managed node: it is configured, activated, deactivated and ended on request, of its program or of others."""

    def __init__(self, node_name: str, *, enable_communication_interface: bool = True, **kwargs: Any) -> None:
        """Create a managed node.

        Args:
            node_name: Name of the node.
            enable_communication_interface: True offers the services and the topic by which others observe and drive it.
            kwargs: The other keywords of `Node`.

        Raises:
            TypeError: if `enable_communication_interface` is not a bool.
        """
        Node.__init__(self, node_name, **kwargs)
        try:
            LifecycleNodeMixin.__init__(self, enable_communication_interface=enable_communication_interface)
        except BaseException:
            self.destroy_node()
            raise
