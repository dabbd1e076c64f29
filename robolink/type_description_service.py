"""The service ``~/get_type_description`` of a node: what the types that it uses are made of."""

from __future__ import annotations

import re
import weakref
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import MutuallyExclusiveCallbackGroup
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor, ParameterType
from robolink.message import Service, type_hash, type_name
from robolink.message.description import described, to_message
from robolink.parameter import Parameter
from robolink.system.patterns import late
from robolink.system.terminal import shown
from robolink.wire import NO_HASH

if TYPE_CHECKING:
    from robolink.interfaces.type_description_interfaces.srv import GetTypeDescription
    from robolink.node_parts.ports import TypedNode
    from robolink.service import Service as Server

START_TYPE_DESCRIPTION_SERVICE_PARAM = "start_type_description_service"
SERVICE_NAME = "get_type_description"
HASH = late(r"RIHS01_[0-9a-f]{64}", re.ASCII)


class TypeDescriptionService:
    """Server of `~/get_type_description`, unless the parameter `start_type_description_service` of `node` is false.

    It declares that parameter, and answers for the types of the node's publishers, subscriptions, services, clients
    and actions, for the messages that a service is made of, and for an action whose services they are. A request
    states the type's hash, which alone counts then, or only its name. A group of its own makes the answer come
    while other callbacks run, where the executor has several threads.
    """

    def __init__(self, node: TypedNode) -> None:
        self._node = weakref.ref(node)  # the transport holds the service: it must not keep the node alive
        self.enabled = _enabled(node) and not node.context.speaks_humble
        self._service: Server | None = None
        if self.enabled:
            from robolink.interfaces.type_description_interfaces.srv import GetTypeDescription

            group = MutuallyExclusiveCallbackGroup()
            name = f"{node.get_name()}/{SERVICE_NAME}"
            self._service = node.create_service(GetTypeDescription, name, self._answer, **node._in_group_(group))

    def destroy(self) -> None:
        """Serve no more. Safe to call twice."""
        node, service, self._service = self._node(), self._service, None
        if node is not None and service is not None:
            node.destroy_service(service)

    def _answer(
        self, request: GetTypeDescription.Request, response: GetTypeDescription.Response
    ) -> GetTypeDescription.Response:
        requested = "" if request.type_hash == NO_HASH else request.type_hash
        if requested and not HASH.fullmatch(requested):
            return _refused(response, f"expected a type hash such as RIHS01_ and 64 hex digits, got {shown(requested)}")
        for each in self._types():
            if (type_hash(each) == requested) if requested else (type_name(each) == request.type_name):
                return _described(response, each, request.include_type_sources)
        return _refused(response, f"this node does not use {shown(requested or request.type_name)}")

    def _types(self) -> Iterator[type[Any]]:
        node = self._node()
        if node is None:
            return
        yield from (each.msg_type for each in node.publishers)
        yield from (each.msg_type for each in node.subscriptions)
        of_actions = [each for waitable in node.waitables for each in waitable.interfaces()]
        yield from of_actions
        services = [each.srv_type for each in node.services] + [each.srv_type for each in node.clients]
        for service in services + [each for each in of_actions if issubclass(each, Service)]:
            yield service
            yield from (service.Request, service.Response, service.Event)
            action = getattr(service, "__ros_action__", None)
            if action is not None:
                yield from (action, action.Goal, action.Result, action.Feedback)


def _enabled(node: TypedNode) -> bool:
    name = START_TYPE_DESCRIPTION_SERVICE_PARAM
    if not node.has_parameter(name):
        descriptor = ParameterDescriptor(
            name=name,
            type=ParameterType.PARAMETER_BOOL,
            description=f"Whether ~/{SERVICE_NAME} tells others what this node's types are made of.",
            read_only=True,
        )
        node.declare_parameter(name, True, descriptor)
    parameter = node.get_parameter(name)
    if parameter.type_ is not Parameter.Type.BOOL:  # somebody declared it before, with a type of their own
        node.get_logger().error(
            f"parameter {name}: expected a bool, got {parameter.value!r}; there is no ~/{SERVICE_NAME}"
        )
        return False
    return bool(parameter.value)


def _refused(response: GetTypeDescription.Response, reason: str) -> GetTypeDescription.Response:
    response.successful, response.failure_reason = False, reason
    return response


def _described(
    response: GetTypeDescription.Response, requested: type[Any], with_sources: bool
) -> GetTypeDescription.Response:
    from robolink.interfaces.type_description_interfaces.msg import TypeSource

    response.successful, response.failure_reason = True, ""
    response.type_description = to_message(described(requested))
    if with_sources:
        response.type_sources = [TypeSource(**_source(each)) for each in _reached(requested)]
    return response


def _reached(requested: type[Any]) -> list[type[Any]]:
    """Return a type and then, by name, those that it is made of."""
    found: dict[str, type[Any]] = {}
    waiting = [requested]
    while waiting:
        each = waiting.pop()
        if type_name(each) not in found:
            found[type_name(each)] = each
            waiting.extend(_made_of(each))
    del found[type_name(requested)]
    return [requested, *(found[name] for name in sorted(found))]


def _made_of(cls: type[Any]) -> list[type[Any]]:
    if hasattr(cls, "__ros_fields__"):
        return [kind.message for kind in cls.__ros_fields__.values() if kind.message is not None]
    if issubclass(cls, Service):
        return [cls.Request, cls.Response, cls.Event]
    impl = cls.Impl
    return [cls.Goal, cls.Result, cls.Feedback, impl.SendGoalService, impl.GetResultService, impl.FeedbackMessage]


def _source(cls: type[Any]) -> dict[str, str]:
    """Return the fields of a TypeSource. What no file says by itself, such as a request, is `implicit`, as in ROS 2."""
    _, kind, short = type_name(cls).split("/")
    if kind != "msg" and "_" in short:
        return {"type_name": type_name(cls), "encoding": "implicit", "raw_file_contents": ""}
    from robolink.message.text import text_of  # late: most nodes are never asked

    return {"type_name": type_name(cls), "encoding": kind, "raw_file_contents": text_of(cls)}
