"""Import of the class of a namespaced type."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from robolink.exceptions import NotFoundError
from robolink.interfaces import ACTION_PARTS, KINDS, find, find_announced, names


class TypeNotFoundError(NotFoundError, AttributeError):  # type: ignore[misc]
    """A package has no type of this name."""


class PackageOfTypeNotFoundError(NotFoundError, ModuleNotFoundError):  # type: ignore[misc]
    """There is no package of this name with types."""


class Namespaced(Protocol):
    """Protocol of rosidl_parser's NamespacedType, and of that in `message.slot_types`."""

    @property
    def namespaces(self) -> Sequence[str]: ...  # noqa: D102 - package and kind

    @property
    def name(self) -> str: ...  # noqa: D102


def import_message_from_namespaced_type(message_type: Namespaced) -> Any:
    """Return the class of `message_type`; also of the parts of an action, ``Fibonacci_FeedbackMessage``.

    Raises TypeNotFoundError (an AttributeError), PackageOfTypeNotFoundError (a ModuleNotFoundError), both
    NotFoundError, or MessageError (a ValueError) if the definition is wrong.
    """
    full = "/".join((*message_type.namespaces, message_type.name))
    kind = message_type.namespaces[1] if len(message_type.namespaces) > 1 else "msg"
    if kind not in KINDS:
        raise TypeNotFoundError("kind of type", kind, KINDS, full)
    try:
        if kind == "action" and message_type.name.rpartition("_")[2] in ACTION_PARTS:
            return find_announced(full)
        return find(full, kind)
    except NotFoundError as error:
        package = message_type.namespaces[0]
        known = [name.split("/") for each in KINDS for name in names(each)]
        if all(parts[0] != package for parts in known):
            raise PackageOfTypeNotFoundError("interface package", package, {parts[0] for parts in known}) from None
        of_kind = [parts[2] for parts in known if parts[:2] == [package, kind]]
        raise TypeNotFoundError(f"{error.kind}", message_type.name, of_kind, package) from None
