"""Interface classes by the names of their types, and the kind of a class."""

from __future__ import annotations

from typing import Any

from robolink.companions.rosidl_runtime.import_message import import_message_from_namespaced_type
from robolink.exceptions import MessageError
from robolink.message.slot_types import NamespacedType


def get_interface(identifier: str) -> Any:
    """Return the message, service or action class of the full name `identifier`, such as ``std_msgs/msg/String``.

    Raises NotFoundError (also an AttributeError or a ModuleNotFoundError), and MessageError (a ValueError).
    """
    return import_message_from_namespaced_type(get_namespaced_type(identifier))


def get_message(identifier: str) -> Any:
    """Return the message class of the name `identifier`: ``std_msgs/msg/String`` or ``std_msgs/String``.

    Raises NotFoundError (also an AttributeError or a ModuleNotFoundError), and MessageError (a ValueError) for what is
    no message.
    """
    return _checked(get_message_namespaced_type(identifier), identifier, "a message", is_message)


def get_service(identifier: str) -> Any:
    """Return the service class of the name `identifier`; else as `get_message`."""
    return _checked(get_service_namespaced_type(identifier), identifier, "a service", is_service)


def get_action(identifier: str) -> Any:
    """Return the action class of the name `identifier`; else as `get_message`."""
    return _checked(get_action_namespaced_type(identifier), identifier, "an action", is_action)


def get_namespaced_type(identifier: str) -> NamespacedType:
    """Split `identifier`, the full name of a type. Raises MessageError (a ValueError)."""
    return _parted(identifier)


def get_message_namespaced_type(identifier: str) -> NamespacedType:
    """Split `identifier`, the name of a message; ``msg`` may be missing. Raises MessageError (a ValueError)."""
    return _parted(identifier, "msg")


def get_service_namespaced_type(identifier: str) -> NamespacedType:
    """Split `identifier`, the name of a service; ``srv`` may be missing. Raises MessageError (a ValueError)."""
    return _parted(identifier, "srv")


def get_action_namespaced_type(identifier: str) -> NamespacedType:
    """Split `identifier`, the name of an action; ``action`` may be missing. Raises MessageError (a ValueError)."""
    return _parted(identifier, "action")


def is_message(interface: Any) -> bool:
    """True if `interface` is a message class."""
    return hasattr(interface, "__ros_fields__")


def is_service(interface: Any) -> bool:
    """True if `interface` is a service class."""
    return hasattr(interface, "Request") and hasattr(interface, "Response")


def is_action(interface: Any) -> bool:
    """True if `interface` is an action class."""
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
