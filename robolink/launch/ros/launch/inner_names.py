"""Names by which programs read what ROS 2's launch keeps private, as in `node._Node__parameters`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

C = TypeVar("C", bound=type)


class _Inner:
    """Attribute that is another attribute of the same object."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, instance: Any, owner: type) -> Any:
        return self if instance is None else getattr(instance, self._name)

    def __set__(self, instance: Any, value: Any) -> None:
        setattr(instance, self._name, value)


def inner_names(*same: str, **others: str) -> Callable[[C], C]:
    """Let a class of robolink be read, and changed, by the names that ROS 2's class of the same name has inside.

    ROS 2 has no other way to the package or parameters of a Node, the respawning of a process, or the function of an
    OpaqueFunction. So tests of launch files, viewers and checkers write `node._Node__parameters`: two underscores
    in front, as Python spells the private names of a class.

    Args:
        same: Names of attributes that have the same name in ROS 2's class.
        others: By the name in ROS 2's class, the name of the attribute here.
    """

    def named(cls: C) -> C:
        for inner, name in {**{each: each for each in same}, **others}.items():
            setattr(cls, f"_{cls.__name__}__{inner}", _Inner(name))
        return cls

    return named
