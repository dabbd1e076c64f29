"""Checks of message, service and action classes, and rclpy's names for such classes in annotations."""

from __future__ import annotations

from types import GenericAlias
from typing import Any, TypeVar

from robolink.exceptions import MessageError, NoTypeSupportImportedException
from robolink.message import Message, Service, message_type, service_type

Msg, Srv = Message, Service
MsgT = TypeVar("MsgT", bound=Message)
SrvT = TypeVar("SrvT", bound=type[Service])
SrvRequestT = TypeVar("SrvRequestT", bound=Message)
SrvResponseT = TypeVar("SrvResponseT", bound=Message)
SrvEventT = TypeVar("SrvEventT", bound=Message)


def in_brackets(count: int) -> Any:
    """Return a ``__class_getitem__`` for a class whose annotations have `count` types in brackets in rclpy."""

    def alias(cls: type[Any], types: Any) -> GenericAlias:
        found = types if isinstance(types, tuple) else (types,)
        if len(found) != count:
            raise TypeError(f"{cls.__name__}[...] has {count} types, got {len(found)}")
        return GenericAlias(cls, found)

    return classmethod(alias)


class NoTypeError(MessageError, AttributeError):
    """Something that is not the class of a message, service or action was given for one."""


class WrongTypeError(MessageError, RuntimeError):
    """A class is a type of another kind than the one that is asked for."""


def check_for_type_support(msg_or_srv_type: type[Any]) -> None:
    """Check that `msg_or_srv_type` is a message, service or action class.

    Robolink's own classes have no compiled part: their codec comes from their annotations.

    Raises:
        NoTypeError: (an AttributeError and ValueError) if it is not one.
        NoTypeSupportImportedException: (a TypeError) if rosidl has made the class, and its compiled part cannot be
            loaded.
    """
    if isinstance(msg_or_srv_type, type) and hasattr(msg_or_srv_type, "__ros_type__"):
        return
    if not hasattr(msg_or_srv_type, "_TYPE_SUPPORT"):
        raise NoTypeError(f"{msg_or_srv_type!r} is not the class of a message, service or action")
    if msg_or_srv_type._TYPE_SUPPORT is None:
        msg_or_srv_type.__import_type_support__()
    if msg_or_srv_type._TYPE_SUPPORT is None:
        raise NoTypeSupportImportedException(f"the compiled part of {msg_or_srv_type!r} cannot be loaded")


def check_is_valid_msg_type(msg_type: type[Any]) -> None:
    """Check that `msg_type` is a message class. Raises WrongTypeError (a RuntimeError), or as the check above."""
    check_for_type_support(msg_type)
    try:
        message_type(msg_type)
    except MessageError:
        raise WrongTypeError(f"{msg_type!r} is not a message class, but one of a service or action") from None


def check_is_valid_srv_type(srv_type: type[Any]) -> None:
    """Check that `srv_type` is a service class. Raises WrongTypeError (a RuntimeError), or as the first check."""
    check_for_type_support(srv_type)
    try:
        service_type(srv_type)
    except MessageError:
        raise WrongTypeError(f"{srv_type!r} is not a service class, but one of a message or action") from None
