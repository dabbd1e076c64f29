"""The standard message and service types, one package for each of ROS 2's, and the way to find a type by name.

>>> from robolink.interfaces import find
>>> find("Twist")  # geometry_msgs.msg is imported now, and only it
<class 'robolink.interfaces.geometry_msgs.msg.Twist'>
"""

from __future__ import annotations

import importlib
from typing import Any

from robolink.exceptions import MessageError, NotFoundError
from robolink.interfaces._standard import STANDARD

__all__ = ["find", "names", "register"]

KINDS = {"msg": "message", "srv": "service", "action": "action"}
"""What a type name's middle part stands for."""
FIRST = ("std_msgs", "std_srvs")
"""The packages whose types a bare name stands for, when others have it too."""

_registered: dict[str, type[Any]] = {}


def find(name: str, kind: str = "msg") -> type[Any]:
    """Give the class of a type named ``Twist``, ``geometry_msgs/Twist`` or ``geometry_msgs/msg/Twist``.

    `kind` is ``msg``, ``srv`` or ``action``; dots may stand for the slashes. Raises NotFoundError, with the nearest
    name, when there is no such type, and MessageError when the text is no type name, is the name of another kind, or
    stands for several types.
    """
    package, short = _split(name, kind)
    if not package:
        package = _package_of(short, kind)
    elif package not in _packages():
        raise NotFoundError("interface package", package, _packages())
    elif short not in _types(kind).get(package, []):
        raise NotFoundError(f"{KINDS[kind]} type", short, _types(kind).get(package, []), where=package)
    registered = _registered.get(f"{package}/{kind}/{short}")
    return registered or _standard(package, kind, short)


def names(kind: str = "msg") -> list[str]:
    """Give the full names of all known types of a kind, sorted."""
    return sorted(f"{package}/{kind}/{short}" for package, types in _types(kind).items() for short in types)


def register(interface: type[Any]) -> None:
    """Make a message, service or action class known by its type name, in place of a standard one of that name."""
    _registered[interface.__ros_type__] = interface


def _split(name: str, kind: str) -> tuple[str, str]:
    """Split a type name into its package, empty for a bare name, and the name within it."""
    parts = name.replace(".", "/").split("/")
    said = parts[1] if len(parts) == 3 else kind
    if len(parts) > 3 or said not in KINDS or not all(part.isascii() and part.isidentifier() for part in parts):
        shown = name if len(name) <= 80 else name[:77] + "..."
        example = (
            "Trigger, std_srvs/Trigger or std_srvs/srv/Trigger"
            if kind == "srv"
            else ("Twist, geometry_msgs/Twist or geometry_msgs/msg/Twist")
        )
        raise MessageError(f"'{shown}' is no type name; it should look like {example}")
    if said != kind:
        raise MessageError(f"'{name}' is the name of a {KINDS[said]} type; a {KINDS[kind]} type is asked for")
    return ("" if len(parts) == 1 else parts[0]), parts[-1]


def _package_of(short: str, kind: str) -> str:
    types = _types(kind)
    packages = [package for package in types if short in types[package]]
    if not packages:
        raise NotFoundError(f"{KINDS[kind]} type", short, [each for known in types.values() for each in known])
    preferred = [package for package in packages if package in FIRST] or packages
    if len(preferred) > 1:
        candidates = " or ".join(f"{package}/{kind}/{short}" for package in preferred)
        raise MessageError(f"several {KINDS[kind]} types are named '{short}': say {candidates}")
    return preferred[0]


def _types(kind: str) -> dict[str, list[str]]:
    types = {package: text.split() for package, text in STANDARD[kind].items()}
    for full_name in _registered:
        package, of_kind, short = full_name.split("/")
        if of_kind == kind and short not in types.setdefault(package, []):
            types[package].append(short)
    return types


def _packages() -> list[str]:
    return sorted({package for kind in KINDS for package in _types(kind)})


def _standard(package: str, kind: str, short: str) -> type[Any]:
    found: type[Any] = getattr(importlib.import_module(f"robolink.interfaces.{package}.{kind}"), short)
    return found
