"""Classes by the names of their types, and what a class is."""

from __future__ import annotations

from typing import Any

from robolink.exceptions import MessageError
from robolink.message.slot_types import NamespacedType
from robolink.rosidl_runtime.import_message import import_message_from_namespaced_type


def get_interface(identifier: str) -> Any:
    """Give the message, service or action class of a full name: ``std_msgs/msg/String``."""
    return import_message_from_namespaced_type(get_namespaced_type(identifier))


def get_message(identifier: str) -> Any:
    """Give the message class of a name: ``std_msgs/msg/String`` or ``std_msgs/String``.

    Raises NotFoundError, also an AttributeError or a ModuleNotFoundError, and MessageError, a ValueError, for what is
    no message.
    """
    return _checked(get_message_namespaced_type(identifier), identifier, "a message", is_message)


def get_service(identifier: str) -> Any:
    """Give the service class of a name; else as `get_message`."""
    return _checked(get_service_namespaced_type(identifier), identifier, "a service", is_service)


def get_action(identifier: str) -> Any:
    """Give the action class of a name; else as `get_message`."""
    return _checked(get_action_namespaced_type(identifier), identifier, "an action", is_action)


def get_namespaced_type(identifier: str) -> NamespacedType:
    """Part the full name of a type."""
    return _parted(identifier)


def get_message_namespaced_type(identifier: str) -> NamespacedType:
    """Part the name of a message; ``msg`` may be left out of it."""
    return _parted(identifier, "msg")


def get_service_namespaced_type(identifier: str) -> NamespacedType:
    """Part the name of a service; ``srv`` may be left out of it."""
    return _parted(identifier, "srv")


def get_action_namespaced_type(identifier: str) -> NamespacedType:
    """Part the name of an action; ``action`` may be left out of it."""
    return _parted(identifier, "action")


def is_message(interface: Any) -> bool:
    """Whether a class is a message's."""
    return hasattr(interface, "__ros_fields__")


def is_service(interface: Any) -> bool:
    """Whether a class is a service's."""
    return hasattr(interface, "Request") and hasattr(interface, "Response")


def is_action(interface: Any) -> bool:
    """Whether a class is an action's."""
    return all(hasattr(interface, each) for each in ("Goal", "Result", "Feedback"))


def _parted(identifier: str, kind: str = "") -> NamespacedType:
    *namespaces, name = identifier.split("/")
    if len(namespaces) == 1 and kind:
        namespaces.append(kind)
    if len(namespaces) != 2 or not all((*namespaces, name)):
        raise MessageError(f"Expected the full name of a type, as std_msgs/msg/String, got '{identifier}'")
    return NamespacedType(tuple(namespaces), name)


def _checked(found: NamespacedType, identifier: str, what: str, is_right: Any) -> Any:
    interface = import_message_from_namespaced_type(found)
    if not is_right(interface):
        raise MessageError(f"Expected the full name of {what}, got '{identifier}'")
    return interface
