"""The standard message, service and action types, one package for each of ROS 2's, and the way to find a type by name.

>>> from robolink.interfaces import find
>>> find("Twist")  # geometry_msgs.msg is imported now, and only it
<class 'robolink.interfaces.geometry_msgs.msg.Twist'>

Types of installed packages that add some (`standard.INTERFACES`) are found in the same way, and those of a source, once
it is added (`add_source`): the workspace's `.msg`, `.srv` and `.action` files are one
(`robolink.workspace.use_interfaces`).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, Protocol

from robolink.exceptions import MessageError, NotFoundError
from robolink.interfaces.standard import added_type, added_types, standard_type, types_of
from robolink.interfaces.standard import packages as standard_packages

__all__ = ["Source", "add_source", "find", "find_announced", "is_named", "names", "register", "remove_source"]

KINDS = {"msg": "message", "srv": "service", "action": "action"}
"""Middle part of a type name, and the word for it."""
_KIND_TYPES = {"msg": "a message type", "srv": "a service type", "action": "an action type"}
FIRST = (
    ("std_msgs", "std_srvs"),
    ("geometry_msgs", "sensor_msgs", "nav_msgs"),
    ("lifecycle_msgs", "nav2_msgs", "rosbag2_interfaces"),
)
"""Packages whose types a bare name stands for, when others have it too; those named first go first."""
ACTION_PARTS = {
    "SendGoal": "SendGoalService",
    "GetResult": "GetResultService",
    "FeedbackMessage": "FeedbackMessage",
}
"""Suffix of the types of an action's services and topic, and their names in its `Impl`."""


class Source(Protocol):
    """Source of types that are not robolink's own."""

    def names(self, kind: str) -> Mapping[str, Collection[str]]:
        """Return the types of a kind that there are now: package to the names within it. Nothing is read or built."""

    def get(self, package: str, kind: str, short: str) -> type[Any] | None:
        """Return the class of a type, None if there is none. Raises MessageError if its definition is wrong."""


_registered: dict[str, type[Any]] = {}
_sources: tuple[Source, ...] = ()


def find(name: str, kind: str = "msg") -> type[Any]:
    """Return the class of a type named ``Twist``, ``geometry_msgs/Twist`` or ``geometry_msgs/msg/Twist``.

    `kind` is ``msg``, ``srv`` or ``action``; dots may stand for the slashes. Raises NotFoundError, with the nearest
    name, when there is no such type, and MessageError when the text is not a type name, is the name of another kind,
    stands for several types, or its definition is wrong.
    """
    package, short = _split(name, kind)
    found = _get(package or _package_of(short, kind), kind, short)
    if found is not None:
        return found
    types = _types(kind)
    if package not in types and package not in _packages():
        raise NotFoundError("interface package", package, _packages())
    raise NotFoundError(f"{KINDS[kind]} type", short, types.get(package, ()), where=package)


def find_announced(name: str) -> type[Any]:
    """Return the class of a type that an endpoint names: a message, a service, or a part of an action.

    >>> find_announced("std_srvs/srv/Trigger")
    <class 'robolink.interfaces.std_srvs.srv.Trigger'>

    The name is full. Raises what `find` raises.
    """
    package, _, rest = name.partition("/")
    kind, _, short = rest.partition("/")
    action, _, part = short.rpartition("_")
    if kind == "action" and part in ACTION_PARTS:
        found: type[Any] = getattr(find(f"{package}/action/{action}", "action").Impl, ACTION_PARTS[part])
        return found
    return find(name, kind if kind in KINDS else "msg")


def is_named(type_name: str, given: str) -> bool:
    """True if ``std_srvs/srv/Trigger`` is what ``Trigger``, ``std_srvs/Trigger`` or the whole name means."""
    package, *_, short = type_name.split("/")
    return given.replace(".", "/") in (short, f"{package}/{short}", type_name)


def names(kind: str = "msg") -> list[str]:
    """Return the full names of all known types of a kind, sorted."""
    return sorted(f"{package}/{kind}/{short}" for package, types in _types(kind).items() for short in types)


def homes_of(short: str) -> list[str]:
    """Return the modules that have a type of this name, as ``geometry_msgs.msg``; those that it usually means first."""
    found = [f"{package}.{kind}" for kind in KINDS for package, types in _types(kind).items() if short in types]
    usual = [package for group in FIRST for package in group]
    return sorted(found, key=lambda each: each.partition(".")[0] not in usual)


def register(interface: type[Any]) -> None:
    """Register a message, service or action class by its type name, in place of any other of that name."""
    _registered[interface.__ros_type__] = interface


def add_source(source: Source) -> None:
    """Add a source of types, searched before robolink's own and after the sources added earlier; adding twice is once.

    A source may add to a standard package and replace a type of it. Where its type has the very hash of the standard
    one, the standard class is used: a copy of a standard file changes nothing.
    """
    global _sources
    if source not in _sources:
        _sources = (*_sources, source)


def remove_source(source: Source) -> None:
    """Remove a source of types."""
    global _sources
    _sources = tuple(each for each in _sources if each is not source)


def _split(name: str, kind: str) -> tuple[str, str]:
    """Split a type name into its package, empty for a bare name, and the name within it."""
    parts = name.replace(".", "/").split("/")
    said = parts[1] if len(parts) == 3 else kind
    if len(parts) > 3 or said not in KINDS or not all(part.isascii() and part.isidentifier() for part in parts):
        shown = name if len(name) <= 80 else name[:77] + "..."
        raise MessageError(f"'{shown}' is not a type name; it should look like {_EXAMPLES[kind]}")
    if said != kind:
        raise MessageError(f"'{name}' is the name of {_KIND_TYPES[said]}; {_KIND_TYPES[kind]} is asked for")
    return ("" if len(parts) == 1 else parts[0]), parts[-1]


_EXAMPLES = {
    "msg": "Twist, geometry_msgs/Twist or geometry_msgs/msg/Twist",
    "srv": "Trigger, std_srvs/Trigger or std_srvs/srv/Trigger",
    "action": "NavigateToPose, nav2_msgs/NavigateToPose or nav2_msgs/action/NavigateToPose",
}


def _package_of(short: str, kind: str) -> str:
    types = _types(kind, added=False)
    packages = [package for package in types if short in types[package]]
    preferred = next(filter(None, ([each for each in packages if each in group] for group in FIRST)), [])
    if not preferred:
        types = _types(kind)  # late: of the usual names no entry points are read
        preferred = [package for package in types if short in types[package]]
    if not preferred:
        raise NotFoundError(f"{KINDS[kind]} type", short, [each for known in types.values() for each in known])
    if len(preferred) > 1:
        candidates = " or ".join(f"{package}/{kind}/{short}" for package in preferred)
        raise MessageError(f"several {KINDS[kind]} types are named '{short}': say {candidates}")
    return preferred[0]


def _types(kind: str, *, added: bool = True) -> dict[str, list[str]]:
    """Return the names of all types of a kind, by package; with `added` those too that other packages add."""
    standard = {package: types_of(package, kind) for package in standard_packages()}
    found = {package: list(names) for package, names in standard.items() if names}
    others = [*(source.names(kind) for source in _sources), *([added_types(kind)] if added else ())]
    known = [(package, short) for each in others for package, shorts in each.items() for short in shorts]
    for full_name in _registered:
        package, of_kind, short = full_name.split("/")
        if of_kind == kind:
            known.append((package, short))
    for package, short in known:
        if short not in found.setdefault(package, []):
            found[package].append(short)
    return found


def _packages() -> list[str]:
    return sorted({package for kind in KINDS for package in _types(kind)})


def _get(package: str, kind: str, short: str) -> type[Any] | None:
    registered = _registered.get(f"{package}/{kind}/{short}")
    if registered is not None:
        return registered
    standard = standard_type(package, kind, short)
    for source in _sources:
        found = source.get(package, kind, short)
        if found is not None:
            return standard if standard is not None and _same(found, standard) else found
    return added_type(package, kind, short) if standard is None else standard


def _same(one: type[Any], other: type[Any]) -> bool:
    from robolink.message import type_hash

    return type_hash(one) == type_hash(other)
