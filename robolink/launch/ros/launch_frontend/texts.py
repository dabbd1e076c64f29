"""Table of the substitutions that texts of XML and YAML launch files have: `$(var name)`, `$(env NAME default)`."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any

from robolink.launch.ros.launch import substitutions as own
from robolink.launch.ros.launch.bases import Substitution
from robolink.launch.ros.launch.frontend.expose import Method, WrongNumberError
from robolink.launch.ros.launch_ros import substitutions as ros

Arguments = Sequence["list[Substitution]"]
MANY = 1000
"""Upper bound of the arguments of those substitutions that take any number."""


def _named(cls: Callable[..., Any], *names: str, least: int | None = None) -> tuple[int, int, Method]:
    """Return the row of a substitution whose arguments have these names, in their order.

    Args:
        cls: Its class.
        *names: Names of its arguments.
        least: Fewest arguments; None needs all.
    """
    return len(names) if least is None else least, len(names), lambda data: (cls, dict(zip(names, data, strict=False)))


def _any_number(cls: Callable[..., Any]) -> tuple[int, int, Method]:
    return 0, MANY, lambda data: (functools.partial(cls, *data), {})


def _joined(data: Arguments) -> tuple[Callable[..., Any], dict[str, Any]]:
    return own.StringJoinSubstitution, {"substitutions": data}


def _joined_by(data: Arguments) -> tuple[Callable[..., Any], dict[str, Any]]:
    return own.StringJoinSubstitution, {"delimiter": data[0], "substitutions": data[1:]}


def _path(data: Arguments) -> tuple[Callable[..., Any], dict[str, Any]]:
    return own.PathJoinSubstitution, {"substitutions": data}


def _expression(data: Arguments) -> tuple[Callable[..., Any], dict[str, Any]]:
    """Return the arguments of an expression; the names of modules are one text, with commas."""
    found: dict[str, Any] = {"expression": data[0]}
    if len(data) > 1:
        names = "".join(getattr(each, "text", "") for each in data[1]).split(",")
        found["python_modules"] = [each.strip() for each in names if each.strip()]
    return own.PythonExpression, found


ROWS: dict[str, tuple[int, int, Method]] = {
    "all": _any_number(own.AllSubstitution),
    "and": _named(own.AndSubstitution, "left", "right"),
    "anon": _named(own.AnonName, "name"),
    "any": _any_number(own.AnySubstitution),
    "command": _named(own.Command, "command", "on_stderr", least=1),
    "dirname": _named(own.ThisLaunchFileDir),
    "env": _named(own.EnvironmentVariable, "name", "default_value", least=1),
    "equals": _named(own.EqualsSubstitution, "left", "right"),
    "eval": (1, 2, _expression),
    "exec-in-pkg": _named(ros.ExecutableInPackage, "executable", "package"),
    "file-content": _named(own.FileContent, "path"),
    "filename": _named(own.ThisLaunchFile),
    "find-exec": _named(own.FindExecutable, "name"),
    "find-pkg-prefix": _named(ros.FindPackagePrefix, "package"),
    "find-pkg-share": _named(ros.FindPackageShare, "package"),
    "for-var": _named(own.ForEachVar, "name", "default_value", least=1),
    "if": _named(own.IfElseSubstitution, "condition", "if_value", "else_value", least=2),
    "index": _named(own.ForLoopIndex, "name"),
    "join": (0, MANY, _joined),
    "launch_log_dir": _named(own.LaunchLogDir),
    "log_dir": _named(own.LaunchLogDir),
    "not": _named(own.NotSubstitution, "value"),
    "not-equals": _named(own.NotEqualsSubstitution, "left", "right"),
    "or": _named(own.OrSubstitution, "left", "right"),
    "param": _named(ros.Parameter, "name", "default", least=1),
    "path-join": (1, MANY, _path),
    "string-join": (2, MANY, _joined_by),
    "var": _named(own.LaunchConfiguration, "variable_name", "default", least=1),
}
"""Fewest and most arguments, and the function of them, by name."""


def methods() -> dict[str, Method]:
    """Return the functions of the table, which refuse a wrong number of arguments, by name."""
    return {name: functools.partial(_counted, name) for name in ROWS}


def _counted(name: str, data: Arguments) -> tuple[Callable[..., Any], dict[str, Any]]:
    least, most, method = ROWS[name]
    if not least <= len(data) <= most:
        number = str(least) if least == most else f"{least} to {most}" if most < MANY else f"{least} or more"
        raise WrongNumberError(f"$({name} ...) takes {number} arguments, got {len(data)}")
    return method(data)
