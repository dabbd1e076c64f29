"""Managed nodes: a state machine, the callbacks of its transitions, and the services by which others drive it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, cast

from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.lifecycle_msgs.msg import State, Transition
from robolink.lifecycle.communication import Communication
from robolink.lifecycle.managed_entity import ManagedEntity
from robolink.lifecycle.publisher import LifecyclePublisher
from robolink.lifecycle.state_machine import LifecycleStateMachine, TransitionError
from robolink.lifecycle.state_machine import TransitionCallbackReturn as TransitionCallbackReturn
from robolink.node import Node
from robolink.tracebacks import formatted

if TYPE_CHECKING:
    from robolink.callback_groups import CallbackGroup
    from robolink.publisher import MsgT
    from robolink.qos import QoSProfile

CALLBACKS = {
    State.TRANSITION_STATE_CONFIGURING: "on_configure",
    State.TRANSITION_STATE_CLEANINGUP: "on_cleanup",
    State.TRANSITION_STATE_SHUTTINGDOWN: "on_shutdown",
    State.TRANSITION_STATE_ACTIVATING: "on_activate",
    State.TRANSITION_STATE_DEACTIVATING: "on_deactivate",
    State.TRANSITION_STATE_ERRORPROCESSING: "on_error",
}
"""What runs in each state that is passed through."""

SHUTDOWNS = {
    State.PRIMARY_STATE_UNCONFIGURED: Transition.TRANSITION_UNCONFIGURED_SHUTDOWN,
    State.PRIMARY_STATE_INACTIVE: Transition.TRANSITION_INACTIVE_SHUTDOWN,
    State.PRIMARY_STATE_ACTIVE: Transition.TRANSITION_ACTIVE_SHUTDOWN,
}


class LifecycleState(NamedTuple):
    """A state, as callbacks of transitions are given it."""

    label: str
    state_id: int


class LifecycleNodeMixin(ManagedEntity):
    """What makes a node a managed one; used beside `Node` by whoever needs both in another order than LifecycleNode.

    Raises RuntimeError where there is no Node, TypeError when `enable_communication_interface` is no bool.
    """

    def __init__(
        self, *, enable_communication_interface: bool = True, callback_group: CallbackGroup | None = None
    ) -> None:
        if not isinstance(self, Node):
            raise RuntimeError("a LifecycleNodeMixin needs Node beside it among the class's bases")
        if not isinstance(enable_communication_interface, bool):
            raise TypeError(f"enable_communication_interface: expected a bool, got {enable_communication_interface!r}")
        self._managed_entities: dict[ManagedEntity, None] = {}
        self._state_machine = LifecycleStateMachine()
        if enable_communication_interface:
            group = callback_group or self.default_callback_group
            Communication(self, self._state_machine, self._succeeds_, group)

    # What a program does

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Configure it; how `on_configure` ended, ERROR too when the state is another than unconfigured."""
        return self._change_state_(Transition.TRANSITION_CONFIGURE)

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Undo `trigger_configure`; how `on_cleanup` ended, ERROR too when the state is another than inactive."""
        return self._change_state_(Transition.TRANSITION_CLEANUP)

    def trigger_activate(self) -> TransitionCallbackReturn:
        """Have it work; how `on_activate` ended, ERROR too when the state is another than inactive."""
        return self._change_state_(Transition.TRANSITION_ACTIVATE)

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Have it stop working; how `on_deactivate` ended, ERROR too when the state is another than active."""
        return self._change_state_(Transition.TRANSITION_DEACTIVATE)

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """End it for good; how `on_shutdown` ended. Raises TransitionError (a RuntimeError) when it has ended."""
        state_id, label = self._state_machine.current_state
        if state_id not in SHUTDOWNS:
            raise TransitionError(f"no shutdown from {label}")
        return self._change_state_(SHUTDOWNS[state_id])

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Tell `entity` of the transitions to come. Raises TypeError for what is no ManagedEntity."""
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
        """Make a publisher that sends only while the node is active, from its next activation on.

        The keywords are those of `create_publisher`, but for `publisher_class`: that raises TypeError.
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
        """Undeclare such a publisher; False when it is none of this node's."""
        self._managed_entities.pop(publisher, None)
        return self._node_.destroy_publisher(publisher)

    # What a subclass overrides: each tells the managed entities, in the order in which they were made, until one of
    # them does not succeed, and gives back how that went.

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Get ready to be activated; `state` is the one before."""
        return self._tell_entities_("on_configure", state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Undo what `on_configure` did."""
        return self._tell_entities_("on_cleanup", state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Give up everything: the node will do nothing more."""
        return self._tell_entities_("on_shutdown", state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to work: from now on its publishers send."""
        return self._tell_entities_("on_activate", state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop working, but stay ready: its publishers send no longer."""
        return self._tell_entities_("on_deactivate", state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Tidy up after a callback's error: SUCCESS makes the node unconfigured, anything else ends it."""
        return self._tell_entities_("on_error", state)

    # How a transition goes

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
        """Run the callback of the current state; one that raises, or says nothing of how it went, is an ERROR."""
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
    """A managed node: it is set up, starts, stops and ends when it is told to, by its program or by others."""

    def __init__(self, node_name: str, *, enable_communication_interface: bool = True, **kwargs: Any) -> None:
        """Make one; the other keywords are those of `Node`."""
        Node.__init__(self, node_name, **kwargs)
        try:
            LifecycleNodeMixin.__init__(self, enable_communication_interface=enable_communication_interface)
        except BaseException:
            self.destroy_node()
            raise
