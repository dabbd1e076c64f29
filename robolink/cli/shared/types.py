"""Look-up of the message class of a topic, service or action: by the type that is named, or from the graph."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from robolink.exceptions import MessageError, NotFoundError, RobolinkError
from robolink.interfaces import find, is_named
from robolink.message import type_hash
from robolink.type_lookup import type_of
from robolink.wire import NO_HASH, EndpointKind, EndpointToken

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.message import Action


class SeveralTypesError(RobolinkError, ValueError):
    """A topic, service or action has several types, and none was named."""


def message_type(context: Context, topic: str, given: str = "") -> type[Any]:
    """Return the message class of a topic, named in full: the type `given`, else the one that it has now.

    A type that is not installed, or is another one here than on the topic, is asked of the nodes that use it.
    Raises NotFoundError if there is no such type or topic, SeveralTypesError, and what `type_of` raises.
    """
    ends = context.graph.endpoints(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
    return _chosen(context, ends, "msg", topic, given)


def service_type(context: Context, service: str, given: str = "") -> type[Any]:
    """Return the service class of a service, as `message_type` does for a topic."""
    return _chosen(context, context.graph.endpoints(EndpointKind.SERVICE), "srv", service, given)


def action_type(context: Context, action: str, given: str = "") -> type[Action]:
    """Return the action class of an action that is served, as `message_type` does for a topic."""
    from robolink.action.graph import GOAL_TYPE, SEND_GOAL, part_name

    ends = context.graph.endpoints(EndpointKind.SERVICE, name=part_name(action, SEND_GOAL))
    served = {each.type_name.removesuffix(GOAL_TYPE) for each in ends}
    types = sorted(each for each in served if not given or is_named(each, given))
    if len(types) > 1:
        raise SeveralTypesError(f"{action} has several types: say which, {' or '.join(types)}")
    found: type[Action] = _action_of(context, action, types[0]) if types else find(given, "action")
    return found


def _action_of(context: Context, action: str, type_: str) -> type[Action]:
    """Return an action's class, which the graph knows by its parts only: the installed one if it has these parts."""
    from robolink.action.graph import FEEDBACK, GET_RESULT, SEND_GOAL
    from robolink.message.class_factory import action_class

    goal = type_of(context, _part(context, action, SEND_GOAL, EndpointKind.SERVICE))
    result = type_of(context, _part(context, action, GET_RESULT, EndpointKind.SERVICE))
    feedback = type_of(context, _part(context, action, FEEDBACK, EndpointKind.PUBLISHER))
    with contextlib.suppress(NotFoundError):
        installed: type[Action] = find(type_, "action")
        if _parts_of(installed) == (goal, result, feedback):
            return installed
    fields = {"Goal": (goal.Request, "goal"), "Result": (result.Response, "result"), "Feedback": (feedback, "feedback")}
    try:
        parts = {part: cls.__ros_fields__[name].message for part, (cls, name) in fields.items()}
    except KeyError as error:
        raise MessageError(f"{action} is not an action: a part of it has no field {error}") from None
    made = action_class(type_, parts, doc=None, text=None)
    if [*map(type_hash, _parts_of(made))] != [*map(type_hash, (goal, result, feedback))]:
        raise MessageError(f"{action} is no {type_}: its parts do not belong together")
    return made


def _parts_of(action: type[Action]) -> tuple[type[Any], ...]:
    return action.Impl.SendGoalService, action.Impl.GetResultService, action.Impl.FeedbackMessage


def _part(context: Context, action: str, part: str, kind: EndpointKind) -> EndpointToken:
    from robolink.action.graph import part_name

    name = part_name(action, part)
    found = context.graph.endpoints(kind, name=name)
    if not found:
        raise NotFoundError("part of an action", name, where=f"domain {context.get_domain_id()}")
    return found[0]


def _chosen(context: Context, ends: list[EndpointToken], kind: str, name: str, given: str) -> type[Any]:
    here = [each for each in ends if each.name == name]
    if given:
        return _given(context, here, kind, given)
    types = sorted({each.type_name for each in here})
    if not types:
        noun = "topic" if kind == "msg" else "service"
        raise NotFoundError(noun, name, {each.name for each in ends}, f"domain {context.get_domain_id()}")
    if len(types) > 1:
        raise SeveralTypesError(f"{name} has several types: say which, {' or '.join(types)}")
    return type_of(context, _first(here))


def _given(context: Context, here: list[EndpointToken], kind: str, given: str) -> type[Any]:
    """Return the class of a named type; if the topic has a version of it that is not installed, that one."""
    try:
        installed = find(given, kind)
    except NotFoundError:
        same = [each for each in here if is_named(each.type_name, given)]
        if not same:
            raise
        return type_of(context, _first(same))
    same = [each for each in here if each.type_name == installed.__ros_type__]
    if not same or {each.type_hash for each in same} & {NO_HASH, type_hash(installed)}:
        return installed
    return type_of(context, _first(same))


def _first(ends: Iterable[EndpointToken]) -> EndpointToken:
    """Return the endpoint whose type is looked up: a publisher rather than a subscription."""
    return min(ends, key=lambda each: each.kind is EndpointKind.SUBSCRIPTION)
