"""Actions about nodes with a lifecycle (`launch_ros.actions`)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from robolink.launch.ros.launch.actions import EmitEvent, RegisterEventHandler
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
            raise LaunchArgumentError("LifecycleTransition needs names of nodes, and transitions")

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the actions that ask each node for the first transition, and for each further one once it is there."""
        ids = [transition_of(each, context) for each in self.transition_ids]
        names = [full_name(performed(context, each)) for each in self.lifecycle_node_names]
        return [each for name in names for each in transitions(name, ids)]


def transitions(name: str, ids: Sequence[int]) -> list[LaunchDescriptionEntity]:
    """Return the actions that bring the node `name` through the transitions `ids`, one after the other."""
    asks = [EmitEvent(event=_request_of(name, each)) for each in ids]
    handlers: list[LaunchDescriptionEntity] = [
        RegisterEventHandler(OnStateTransition(matcher=_reaches(name, before), entities=[ask], handle_once=True))
        for before, ask in zip(ids, asks[1:], strict=False)
    ]
    return [*handlers, asks[0]]


def _request_of(name: str, transition_id: int) -> ChangeState:
    event = ChangeState(lifecycle_node_matcher=matches_node_name(name), transition_id=transition_id)
    event.node_name = name
    return event


def transition_of(given: Any, context: LaunchContext) -> int:
    """Return the number of a transition, which may be `given` as one, as its text or its label.

    Substitutions are performed with the values of `context`. Raises LaunchError for one that there is not.
    """
    text = str(given) if isinstance(given, int) else performed(context, given).strip()
    number = _BY_LABEL.get(text, text)
    if str(number) not in map(str, _GOALS):
        raise LaunchError(f"a transition is one of {', '.join(_BY_LABEL)}, or its number, got '{shown(text)}'")
    return int(number)


def _reaches(name: str, transition_id: int) -> Callable[[Any], bool]:
    """Return a function that is true for the event that a node has reached the goal of a transition."""
    goal, is_node = _GOALS[transition_id], matches_node_name(name)
    return lambda event: isinstance(event, StateTransition) and is_node(event.action) and event.goal_state == goal


_BY_LABEL = {"configure": 1, "cleanup": 2, "activate": 3, "deactivate": 4, "shutdown": 5}
_GOALS = {1: "inactive", 2: "unconfigured", 3: "active", 4: "inactive", 5: "finalized", 6: "finalized", 7: "finalized"}
"""State that each transition leads to, by its number."""
