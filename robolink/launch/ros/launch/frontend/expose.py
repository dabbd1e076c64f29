"""Names that XML and YAML launch files have for actions and substitutions, robolink's own and those of programs."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

from robolink.exceptions import nearest
from robolink.launch.ros.launch.bases import Action, LaunchError, Substitution
from robolink.launch.ros.launch.frontend.entity import Entity, placing
from robolink.launch.ros.launch.registry import registered
from robolink.system.terminal import shown

__all__ = [
    "action_parse_methods",
    "expose_action",
    "expose_substitution",
    "instantiate_action",
    "instantiate_substitution",
    "substitution_parse_methods",
]

T = TypeVar("T")
Method = Callable[..., tuple[Callable[..., Any], dict[str, Any]]]
"""Function that returns a class, and the arguments for an object of it."""


class WrongNumberError(LaunchError):
    """A substitution does not take that many arguments."""


action_parse_methods: dict[str, Method] = {}
"""Functions of an element and the parser, by the element's name; complete once a first one is looked up."""
substitution_parse_methods: dict[str, Method] = {}
"""Functions of the list of arguments, by the substitution's name; complete once a first one is looked up."""
OF_ROS_1 = {"arg": "var", "find": "find-pkg-share", "optenv": "env"}
"""Substitutions of ROS 1, with those of ROS 2."""


def add_own() -> None:
    """Add robolink's own actions and substitutions, once: their modules are imported late."""
    if "node" in action_parse_methods:
        return
    action_parse_methods.update({name: _checked(method) for name, method in registered("actions")().items()})
    substitution_parse_methods.update(registered("substitutions")())


def expose_action(name: str) -> Callable[[T], T]:
    """Return a decorator that lets launch files in XML and YAML have an action.

    It is for a class with a class method `parse(entity, parser)`, or for a function of these two: they return the class
    and the arguments for an object of it.

    Args:
        name: Name of the element.
    """
    return _exposed(name, action_parse_methods, "action", _checked)


def expose_substitution(name: str) -> Callable[[T], T]:
    """Return a decorator that lets launch files in XML and YAML have a substitution.

    It is for a class with a class method `parse(data)`, or for a function: `data` is the list of arguments, each a list
    of substitutions. They return the class and the arguments for an object of it.

    Args:
        name: Name of the substitution: `$(name ...)`.
    """
    return _exposed(name, substitution_parse_methods, "substitution", lambda method: method)


def _exposed(name: str, methods: dict[str, Method], kind: str, made: Callable[[Method], Method]) -> Callable[[T], T]:
    def expose(exposed: T) -> T:
        add_own()
        method: Any = exposed
        if inspect.isclass(exposed):
            method = getattr(exposed, "parse", None)
            if not inspect.ismethod(method):
                raise LaunchError(f"{exposed.__name__}, which is exposed as '{name}', has no class method parse()")
        if not (inspect.isfunction(method) or inspect.ismethod(method)):
            raise LaunchError(f"a class with parse(), or a function, is exposed as '{name}', not {exposed!r:.60}")
        known = methods.get(name)
        if known is not None and getattr(known, "__wrapped__", known) != method:
            raise LaunchError(f"there is {kind} '{name}' already: {kind}s of XML and YAML have a name each")
        methods[name] = made(method)
        return exposed

    return expose


def _checked(method: Method) -> Method:
    """Return a function that refuses what an action's own one has not read."""

    @functools.wraps(method)
    def parse(entity: Entity, parser: Any) -> tuple[Callable[..., Any], dict[str, Any]]:
        found = method(entity, parser)
        entity.assert_entity_completely_parsed()
        return found

    return parse


def instantiate_action(entity: Entity, parser: Any) -> Action:
    """Return the action that an element stands for.

    Args:
        entity: The element.
        parser: Parser of the elements in it.

    Raises:
        DocumentError: for a mistake, at the place of the element.
    """
    add_own()
    name = entity.type_name
    if name not in action_parse_methods:
        name = name.replace("-", "_")
    if name not in action_parse_methods:
        parser.load_launch_extensions()
    if name not in action_parse_methods:
        name = entity.type_name
    if name not in action_parse_methods:
        raise entity.error(f"there is no such element{nearest(name, action_parse_methods)}")
    with placing(entity):
        cls, arguments = action_parse_methods[name](entity, parser)
        action: Action = cls(**arguments)
    action.place = entity.place
    return action


def instantiate_substitution(type_name: str, args: Iterable[Any] | None = None) -> Substitution:
    """Return a substitution by its name.

    Args:
        type_name: Name of the substitution.
        args: Its arguments, each a list of substitutions.

    Raises:
        LaunchError: for an unknown name, and for arguments that it does not take.
    """
    add_own()
    if type_name not in substitution_parse_methods:
        registered("parser").load_launch_extensions()
    if type_name not in substitution_parse_methods:
        if type_name in OF_ROS_1:
            raise LaunchError(f"$({type_name} ...) is ROS 1: $({OF_ROS_1[type_name]} ...) is what ROS 2 has")
        hint = nearest(type_name, substitution_parse_methods)
        raise LaunchError(f"no substitution is called '{shown(type_name)}'{hint}")
    cls, arguments = substitution_parse_methods[type_name](list(args or ()))
    made: Substitution = cls(**arguments)
    return made
