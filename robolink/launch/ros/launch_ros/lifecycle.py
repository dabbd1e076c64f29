"""Actions about nodes with a lifecycle (`launch_ros.actions`)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from robolink.launch.ros.launch.actions import EmitEvent, OpaqueFunction, RegisterEventHandler
from robolink.launch.ros.launch.bases import (
    Action,
    LaunchArgumentError,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    SomeSubstitutionsType,
)
from robolink.launch.ros.launch.utilities import performed
from robolink.launch.ros.launch_ros.events import (
    ChangeState,
    OnStateTransition,
    StateTransition,
    full_name,
    matches_node_name,
)
from robolink.launch.ros.launch_ros.node import Node
from robolink.system.terminal import shown


class LifecycleNode(Node):
    """Start a node with a lifecycle.

    Args:
        name: Name of the node; it must be given.
        namespace: Namespace of the node; it must be given.
        autostart: True configures and activates it once it is there.
        **kwargs: Those of Node.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        autostart: bool | SomeSubstitutionsType = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        for needed, value in (("name", self.requested_name), ("namespace", self.requested_namespace)):
            if value is None:
                raise LaunchArgumentError(f"LifecycleNode needs {needed}=...")
        self.autostart = autostart


class TransitionError(LaunchError, ValueError):
    """A transition is requested that there is not, or none at all."""


class LifecycleTransition(Action):
    """Ask nodes with a lifecycle for transitions.

    Args:
        lifecycle_node_names: Full names of the nodes.
        transition_ids: The transitions, in their order (`lifecycle_msgs.msg.Transition`).
        **kwargs: `condition`.
    """

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[SomeSubstitutionsType],
        transition_ids: Iterable[int | SomeSubstitutionsType],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.lifecycle_node_names, self.transition_ids = list(lifecycle_node_names), list(transition_ids)
        if not self.lifecycle_node_names or not self.transition_ids:
            raise TransitionError("LifecycleTransition needs names of nodes, and transitions")

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the actions that ask each node for the first transition, and for each further one once it is there."""
        ids = [transition_of(each, context) for each in self.transition_ids]
        names = [full_name(performed(context, each)) for each in self.lifecycle_node_names]
        return transitions(names, ids, context)


def transitions(names: Iterable[str], ids: Sequence[int], context: LaunchContext) -> list[LaunchDescriptionEntity]:
    """Return the actions that bring nodes through transitions, one after the other.

    A node that comes to the state `errorprocessing` is asked for no further one.

    Args:
        names: Full names of the nodes.
        ids: Numbers of the transitions.
        context: The context, which hears of such errors from here on.
    """
    registered: list[LaunchDescriptionEntity] = []
    first: list[LaunchDescriptionEntity] = []
    for name in names:
        ask, *further = [EmitEvent(event=_request_of(name, each)) for each in ids]
        *handlers, of_error = _handlers(name, ids, further)
        context.register_event_handler(of_error)
        registered += map(RegisterEventHandler, handlers)
        first.append(ask)
    return [*registered, *first]


def _handlers(name: str, ids: Sequence[int], further: Sequence[EmitEvent]) -> list[OnStateTransition]:
    """Return the handlers that ask a node for each further transition; the last ones remove all of them."""
    handlers: list[OnStateTransition] = []

    def remove(context: LaunchContext) -> None:
        for each in [each for each in handlers if each in context.handlers]:
            context.unregister_event_handler(each)

    end = OpaqueFunction(function=remove)
    for number, action in zip(ids, [*further, end], strict=True):
        reaches = _reaches(name, *_WAYS[number])
        handlers.append(OnStateTransition(matcher=reaches, entities=[action], handle_once=True))
    handlers.append(OnStateTransition(matcher=_reaches(name, "", "errorprocessing"), entities=[end], handle_once=True))
    return handlers


def _request_of(name: str, transition_id: int) -> ChangeState:
    event = ChangeState(lifecycle_node_matcher=matches_node_name(name), transition_id=transition_id)
    event.node_name = name
    return event


def transition_of(given: Any, context: LaunchContext) -> int:
    """Return the number of a transition, which may be `given` as one, as its text or its label.

    Substitutions are performed with the values of `context`. Raises TransitionError for one that there is not.
    """
    text = str(given) if isinstance(given, int) else performed(context, given).strip()
    number = _BY_LABEL.get(text, text)
    if str(number) not in map(str, _WAYS):
        raise TransitionError(f"a transition is one of {', '.join(_BY_LABEL)}, or its number, got '{shown(text)}'")
    return int(number)


def _reaches(name: str, start: str, goal: str) -> Callable[[Any], bool]:
    """Return a function that is true for the event that a node came from the state `start`, '' for any, to `goal`."""
    is_node = matches_node_name(name)

    def matches(event: Any) -> bool:
        is_meant = isinstance(event, StateTransition) and is_node(event.action)
        return is_meant and event.goal_state == goal and event.start_state in (start or event.start_state,)

    return matches


_BY_LABEL = {"configure": 1, "cleanup": 2, "activate": 3, "deactivate": 4, "shutdown": 5}
_WAYS = {
    1: ("configuring", "inactive"),
    2: ("cleaningup", "unconfigured"),
    3: ("activating", "active"),
    4: ("deactivating", "inactive"),
    5: ("shuttingdown", "finalized"),
    6: ("shuttingdown", "finalized"),
    7: ("shuttingdown", "finalized"),
}
"""States through which and to which each transition leads, by its number."""
