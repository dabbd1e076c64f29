"""Base class of service types: a request and a response message.

class SetBool(Service):
    class Request(Message):
        data: boolean

    class Response(Message):
        success: boolean
        message: string
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from robolink.exceptions import MessageError
from robolink.message.annotations import AtMost, Sequence
from robolink.message.base import Message, MessageMeta
from robolink.message.description import TypeDescription, combine


class _EventOfService:
    """Descriptor of `SetBool.Event`, made when it is first asked for: it needs a type of the packages above."""

    def __get__(self, _: object, owner: type[Service]) -> type[Message]:
        if "_event" not in owner.__dict__:
            owner._event = _event_type(owner)
        return owner._event


def _event_type(service: type[Service]) -> type[Message]:
    from robolink.interfaces.service_msgs.msg import ServiceEventInfo

    annotations = {
        "info": ServiceEventInfo,
        "request": Annotated[Sequence[service.Request], AtMost(1)],  # type: ignore[name-defined]
        "response": Annotated[Sequence[service.Response], AtMost(1)],  # type: ignore[name-defined]
    }
    body = {
        "__module__": service.__module__,
        "__qualname__": f"{service.__qualname__}.Event",
        "__doc__": f"Events of {service.__name__}, which service introspection publishes.",
        "__annotations__": annotations,
    }
    made: type[Message] = MessageMeta("Event", (Message,), body, type_name=f"{service.__ros_type__}_Event")
    name_part(service, made, "Event")
    return made


def name_part(whole: Any, cls: Any, part: str) -> None:
    """Name the class `cls` of a part of a service or an action as rosidl does: ``SetBool_Request``."""
    cls.__ros_type__ = f"{whole.__ros_type__}_{part}"
    cls.__name__ = f"{whole.__name__}_{part}"


class DeferredPart:
    """Descriptor in a service class whose messages are made at their first use.

    Nobody calls most services of a node, those for its parameters; making their messages took a tenth of its start.

    Args:
        make: Function that gives the class its messages, its docstring and its text, in the place of such descriptors.
        name: Name of the attribute.
    """

    def __init__(self, make: Callable[[type[Service]], object], name: str) -> None:
        self._make, self._name = make, name

    def __get__(self, _: object, owner: type[Service]) -> Any:
        self._make(owner)
        return getattr(owner, self._name)


class Service:
    """Base class of service types; a subclass has the message classes `Request` and `Response`."""

    __ros_type__: ClassVar[str]
    _event: ClassVar[type[Message]]

    if TYPE_CHECKING:

        class Request(Message):
            """Request of a client."""

        class Response(Message):
            """Response of a server."""

        class Event(Message):
            """Event of service introspection."""

    else:
        Event = _EventOfService()

    def __init_subclass__(cls, deferred: str = "") -> None:
        if deferred:  # see DeferredPart
            cls.__ros_type__ = deferred
            return
        for part in ("Request", "Response"):
            found: Any = cls.__dict__.get(part)
            if not hasattr(found, "__ros_fields__"):
                raise MessageError(f"service {cls.__name__} needs a message class {part}")
        request_name = cls.Request.__ros_type__
        if not request_name.endswith("_Request"):
            raise MessageError(f"service {cls.__name__}: Request must be a class inside it, got {request_name}")
        cls.__ros_type__ = request_name.removesuffix("_Request").replace("/msg/", "/srv/")
        for part in ("Request", "Response"):
            name_part(cls, cls.__dict__[part], part)

    def __new__(cls) -> Any:  # NoReturn would make a type checker take the class for a function
        """Refuse to make one: a service is its two messages, and rclpy's class cannot be instantiated either."""
        raise NotImplementedError(f"a service cannot be instantiated: make a {cls.__name__}.Request()")

    @classmethod
    def describe(cls) -> TypeDescription:
        """Return the description of the service as rosidl has it: request, response and event message."""
        parts = {"request_message": cls.Request, "response_message": cls.Response, "event_message": cls.Event}
        return combine(cls.__ros_type__, parts)


def service_type(cls: Any) -> type[Service]:
    """Return `cls` if it is a service class. Raises MessageError otherwise."""
    if isinstance(cls, type) and issubclass(cls, Service):
        return cls
    raise MessageError(f"{cls!r} is not a service class")
