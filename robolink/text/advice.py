"""Advice on usual mistakes in a program: what Python's text of an exception means in a node."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from types import FrameType, FunctionType, MethodType, ModuleType, TracebackType
from typing import Any

from robolink.exceptions import RobolinkError, imported_as
from robolink.system.patterns import late
from robolink.text.callbacks import miscalled

_MODULES = {"Node": ("robolink", "rclpy.node"), "rclpy": ("", ""), "robolink": ("", "")}
"""Modules of names that are not types: in a program with robolink's names, and in one with rclpy's; '' imports it."""


def advice(error: BaseException) -> str:
    """Return what to do about an exception, without a capital letter and a full stop; '' for an unusual mistake.

    Args:
        error: The exception, with its traceback.
    """
    if isinstance(error, RobolinkError) or error.__traceback__ is None:
        return ""
    frame = _last_frame(error.__traceback__)
    for kind, advise in _ADVISERS:
        if isinstance(error, kind) and (found := advise(error, frame)):
            return found
    return ""


def home_of(name: str, program: str = "") -> str:
    """Return the statement that imports a name that many programs need; '' for a name of something else.

    Args:
        name: A message, service or action, Node, or a module of Python.
        program: Name of a module that the program has imported: rclpy's names are for programs that have those.
    """
    ros_names = program.partition(".")[0] != "robolink"
    if name in _MODULES:
        module = _MODULES[name][ros_names]
        return f"from {module} import {name}" if module else f"import {name}"
    types = sys.modules.get("robolink.interfaces")  # above this floor; a program without it uses no types
    homes: list[str] = types.homes_of(name) if types is not None else []
    if homes:
        return f"from {'' if ros_names else 'robolink.interfaces.'}{homes[0]} import {name}"
    return f"import {name}" if name in sys.stdlib_module_names else ""


def _last_frame(trace: TracebackType) -> FrameType:
    while trace.tb_next is not None:
        trace = trace.tb_next
    return trace.tb_frame


# --- Names ------------------------------------------------------------------------------------------------------------

_UNBOUND = late(r"local variable '(\w+)'")


def _unknown_name(error: Any, frame: FrameType) -> str:
    unbound = _UNBOUND.search(str(error))
    name = unbound[1] if unbound else error.name
    if not isinstance(name, str):
        return ""
    if name == "self":
        return _no_self(frame)
    if hasattr(frame.f_locals.get("self"), name):
        return f"did you mean self.{name}?"
    within = next((each for each, value in frame.f_globals.items() if _has(value, name)), "")
    if within:
        return f"did you mean {within}.{name}?"
    statement = "" if unbound else home_of(name, _style(frame))
    return f"is `{statement}` missing on top?" if statement else ""


def _has(value: Any, name: str) -> bool:
    """True for a module of Python's own that has this name, as math has pi."""
    known = isinstance(value, ModuleType) and value.__name__ in sys.stdlib_module_names
    return known and name in vars(value)


_OPTIMIZED = 1
"""Flag of the code of a function, `inspect.CO_OPTIMIZED`: `inspect` takes a node's start 5 ms."""


def _no_self(frame: FrameType) -> str:
    if frame.f_code.co_flags & _OPTIMIZED:
        return f"is self the first parameter of {frame.f_code.co_name}()?"
    return "this line is in no function: it needs more spaces in front of it"


def _style(frame: FrameType) -> str:
    """Return `robolink` for a program that imports robolink's names, and `rclpy` for one with those of ROS 2."""
    import linecache  # late, as in all modules that describe errors: most programs make none

    text = "".join(linecache.getlines(frame.f_code.co_filename, frame.f_globals))
    imported = re.findall(r"^\s*(?:from|import)\s+(robolink|rclpy)\b", text, re.MULTILINE)
    return imported[0] if imported else imported_as()


_NOT_IN_MODULE = late(r"cannot import name '(\w+)' from '([\w.]+)'")


def _not_in_module(error: Any, frame: FrameType) -> str:
    found = _NOT_IN_MODULE.match(str(error))
    statement = home_of(found[1], found[2]) if found else ""
    return f"write `{statement}`" if statement and found and f"from {found[2]} import" not in statement else ""


# --- Attributes -------------------------------------------------------------------------------------------------------

_ATTRIBUTE = late(r"'(\w+)' object has no attribute '(\w+)'")


def _unknown_attribute(error: Any, frame: FrameType) -> str:
    found = _ATTRIBUTE.match(str(error))
    if found is None:
        return ""
    owner, name = error.obj, found[2]
    if found[1] in ("function", "method") and isinstance(owner, (FunctionType, MethodType)):
        return f"{owner.__name__} is a function: call it, {owner.__name__}()"
    if found[1] in ("member_descriptor", "property"):
        return "this is the class, not a message: make one with (), as in Twist()"
    return _left_outside(owner, name)


def _left_outside(owner: Any, name: str) -> str:
    """Return advice if the method that is missing stands as a function beside its class."""
    module = sys.modules.get(type(owner).__module__)
    scopes = [vars(module)] if module is not None else []
    init = getattr(type(owner).__init__, "__globals__", None)  # a module that a check has made is in no list
    for scope in [*scopes, *([init] if init is not None else [])]:
        function = scope.get(name)
        if isinstance(function, FunctionType) and "self" in function.__code__.co_varnames[:1]:
            line = function.__code__.co_firstlineno
            return f"{name} of line {line} stands outside of the class: indent it like the methods above"
    return ""


# --- Calls and values -------------------------------------------------------------------------------------------------

_TEXTS: tuple[tuple[str, str], ...] = (
    (r"descriptor '__init__' requires a 'super' object", "write super().__init__(...), with () after super"),
    (r"(\w+\.)?__init__\(\) missing 1 .* 'node_name'", "a node needs a name: super().__init__('my_node')"),
    (r".* instances of .*'Parameter'", "its value is what .value has"),
    (r"unsupported operand .*'Parameter'", "its value is what .value has"),
    (r"'Publisher' object is not callable", "its method publish(message) sends a message"),
    (r".*\bcreate_\w+\(\) missing 1 .* 'qos_profile'", "the last argument is how many messages may wait, such as 10"),
)
"""Patterns of a TypeError's text, and what to do."""


def _wrong_type(error: TypeError, frame: FrameType) -> str:
    text = str(error)
    by_text = (advised for pattern, advised in _TEXTS if re.match(pattern, text))
    return next(by_text, "") or miscalled(error) or _method_without_self(text, frame) or _module_as_base(text, frame)


_TOO_MANY = late(r"(?:[\w.]+\.<locals>\.)?(\w+)\.(\w+)\(\) takes (\d+) positional arguments? but (\d+) w")


def _method_without_self(text: str, frame: FrameType) -> str:
    found = _TOO_MANY.match(text)
    method = getattr(frame.f_globals.get(found[1]), found[2], None) if found else None
    if found is None or not isinstance(method, FunctionType) or int(found[4]) != int(found[3]) + 1:
        return ""
    first = method.__code__.co_varnames[:1] if method.__code__.co_argcount else ()
    line = method.__code__.co_firstlineno
    return "" if first == ("self",) else f"the first parameter of {found[2]} (line {line}) has to be self"


def _module_as_base(text: str, frame: FrameType) -> str:
    """Return advice for `class Careful(node)`: Python's text speaks of what a module takes."""
    if not text.startswith("module() takes"):
        return ""
    for name, value in frame.f_globals.items():
        statement = home_of(name.capitalize(), _style(frame)) if isinstance(value, ModuleType) else ""
        if statement:
            return f"{name} is a module, and {name.capitalize()} the class: `{statement}`"
    return "a module is not a class"


_ADVISERS: tuple[tuple[type[BaseException], Callable[[Any, FrameType], str]], ...] = (
    (NameError, _unknown_name),
    (ImportError, _not_in_module),
    (AttributeError, _unknown_attribute),
    (TypeError, _wrong_type),
)
