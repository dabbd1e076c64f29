"""Which class a command uses for a topic or service: the type named, or the one that the graph shows."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.interfaces import find, is_named
from robolink.message import type_hash
from robolink.type_lookup import type_of
from robolink.wire import NO_HASH, EndpointKind, EndpointToken

if TYPE_CHECKING:
    from robolink.context import Context


class SeveralTypesError(RobolinkError, ValueError):
    """A topic or service has several types, and none was named."""


def message_type(context: Context, topic: str, given: str = "") -> type[Any]:
    """Give the message class of a topic, named in full: the type `given`, else the one that it has now.

    A type that is not installed, or is another one here than on the topic, is asked of the nodes that use it.
    Raises NotFoundError when there is no such type or topic, SeveralTypesError, and what `type_of` raises.
    """
    ends = context.graph.endpoints(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
    return _chosen(context, ends, "msg", topic, given)


def service_type(context: Context, service: str, given: str = "") -> type[Any]:
    """Give the service class of a service, as `message_type` does for a topic."""
    return _chosen(context, context.graph.endpoints(EndpointKind.SERVICE), "srv", service, given)


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
    """Give a named type; where the topic has a version of it that is not installed, that one."""
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
    """Give the endpoint to ask after: a publisher rather than a subscription."""
    return min(ends, key=lambda each: each.kind is EndpointKind.SUBSCRIPTION)
