"""Client of managed nodes' services, for the commands of `robolink lifecycle`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from robolink.cli.shared.graph import absolute, is_hidden, no_such_node
from robolink.cli.shared.session import call_all
from robolink.exceptions import RobolinkError
from robolink.interfaces.lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from robolink.system.terminal import shown
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.interfaces.lifecycle_msgs.msg import State, TransitionDescription

ANSWER_WITHIN = 5.0
"""Timeout of a node's answer about its state, in seconds."""

CHANGE_WITHIN = 60.0
"""Timeout of a transition, in seconds: its callback may open a device, or load a map."""

STATE = "/get_state"
"""Suffix of the service by which a managed node is recognized."""


class LifecycleCommandError(RobolinkError, RuntimeError):
    """A node is not there, is not managed, does not answer, or refuses a transition."""


def managed(context: Context, *, hidden: bool) -> list[str]:
    """Return the full names of the managed nodes, sorted; those that begin with _ only if `hidden`."""
    served = context.graph.endpoints(EndpointKind.SERVICE)
    names = {
        each.name.removesuffix(STATE)
        for each in served
        if each.type_name == GetState.__ros_type__ and each.name.endswith(STATE)
    }
    nodes = {each.full_node_name for each in context.graph.nodes()}
    return sorted(each for each in names & nodes if hidden or not is_hidden(each))


def known(context: Context, node: str) -> str:
    """Return the full name of a managed node. Raises LifecycleCommandError if there is none of this name."""
    name, names = absolute(node), managed(context, hidden=True)
    if name in names:
        return name
    if name in {each.full_node_name for each in context.graph.nodes()}:
        raise LifecycleCommandError(f"{name} is not managed: it does not serve {name}{STATE}")
    raise LifecycleCommandError(no_such_node(context, name, name + STATE, names))


def states(context: Context, names: Iterable[str]) -> tuple[dict[str, State], list[RobolinkError]]:
    """Return the states of nodes, and the errors of those that did not answer."""
    answers = _ask(context, GetState, {f"{name}{STATE}": GetState.Request() for name in names})
    found = {
        name.removesuffix(STATE): answer.current_state
        for name, answer in answers.items()
        if not isinstance(answer, RobolinkError)
    }
    return found, [answer for answer in answers.values() if isinstance(answer, RobolinkError)]


def transitions(context: Context, node: str, *, every: bool = False) -> list[TransitionDescription]:
    """Return the transitions that a node can make now, or with `every` all that it has."""
    service = "get_transition_graph" if every else "get_available_transitions"
    request = GetAvailableTransitions.Request()
    return list(_ask_one(context, GetAvailableTransitions, f"{node}/{service}", request).available_transitions)


def make_transition(context: Context, node: str, requested: str) -> None:
    """Trigger a transition of a node, by its name or number. Raises LifecycleCommandError unless that succeeds."""
    there = [each.transition for each in transitions(context, node)]
    chosen = [each for each in there if each.label == requested] or [
        each for each in there if str(each.id) == requested
    ]
    if not chosen:
        listed = ", ".join(f"{each.label} [{each.id}]" for each in there) or "none"
        raise LifecycleCommandError(f"Unknown transition '{shown(requested)}' requested, available ones are: {listed}")
    request = ChangeState.Request(transition=chosen[0])
    if not _ask_one(context, ChangeState, f"{node}/change_state", request, CHANGE_WITHIN).success:
        now = states(context, [node])[0].get(node)
        after = f"; it is {now.label} [{now.id}] now" if now is not None else ""
        raise LifecycleCommandError(f"Transitioning failed: {node} did not {chosen[0].label}{after}")


def as_data(each: TransitionDescription) -> dict[str, Any]:
    """Return a transition as plain data."""
    return {
        "id": each.transition.id,
        "label": each.transition.label,
        "start": each.start_state.label,
        "goal": each.goal_state.label,
    }


def _ask_one(context: Context, srv_type: type[Any], service: str, request: Any, within: float = ANSWER_WITHIN) -> Any:
    answer = _ask(context, srv_type, {service: request}, within)[service]
    if isinstance(answer, RobolinkError):
        raise answer
    return answer


def _ask(
    context: Context, srv_type: type[Any], requests: dict[str, Any], within: float = ANSWER_WITHIN
) -> dict[str, Any]:
    """Call services, all at once, and return the response of each, or its error."""

    def no_answer(service: str) -> RobolinkError:
        return LifecycleCommandError(f"no answer within {within:g} s from {service}: does the node spin?")

    return call_all(context, srv_type, requests, within, no_answer)
