"""Substitutions: texts that are known only when the launch runs (`launch.substitutions`)."""

from __future__ import annotations

import itertools
import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from robolink.exceptions import nearest
from robolink.launch.ros.launch.bases import (
    LaunchContext,
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
    described,
)
from robolink.launch.ros.launch.booleans import (
    AllSubstitution,
    AndSubstitution,
    AnySubstitution,
    EqualsSubstitution,
    IfElseSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
)
from robolink.launch.ros.launch.commands import Command, FileContent, FindExecutable, PythonExpression
from robolink.launch.ros.launch.utilities import (
    TextSubstitution,
    is_substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from robolink.system.terminal import shown

__all__ = [
    "AllSubstitution",
    "AndSubstitution",
    "AnonName",
    "AnySubstitution",
    "Command",
    "EnvironmentVariable",
    "EqualsSubstitution",
    "FileContent",
    "FindExecutable",
    "ForEachVar",
    "ForLoopIndex",
    "IfElseSubstitution",
    "LaunchConfiguration",
    "LaunchLogDir",
    "LocalSubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
    "PathJoinSubstitution",
    "PathSubstitution",
    "PythonExpression",
    "StringJoinSubstitution",
    "SubstitutionFailure",
    "TextSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]


_STEP = re.compile(r"\.?(\w+)|\[\s*(?:'([^']*)'|\"([^\"]*)\"|(\d+))\s*\]")
_numbers = itertools.count(1)


class LaunchConfiguration(Substitution):
    """Value of a launch argument, or of what SetLaunchConfiguration has set.

    Args:
        variable_name: Name of the configuration.
        default: Value where it is not set; without one that is an error.
    """

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self.variable_name = normalize_to_list_of_substitutions(variable_name)
        self.default = None if default is None else _plain(default)

    def perform(self, context: LaunchContext) -> str:
        """Return the value; raises SubstitutionFailure if it is not set."""
        name, known = perform_substitutions(context, self.variable_name), context.launch_configurations
        context.requested.add(name)
        if name in known:
            return str(known[name])
        if self.default is None:
            own = [each for each in known if each not in ("ros_remaps", "global_params")]
            hint = nearest(name, own) or (f": there is {', '.join(own[:8])}" if own else "")
            raise SubstitutionFailure(f"no launch argument is called '{shown(name)}'{hint}")
        return perform_substitutions(context, self.default)

    def describe(self) -> str:
        """Return a description for people."""
        return f"LaunchConfig({described(self.variable_name)})"


class EnvironmentVariable(Substitution):
    """Value of an environment variable.

    Args:
        name: Name of the variable.
        default_value: Value where it is not set; without one that is an error.
    """

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    def perform(self, context: LaunchContext) -> str:
        """Return the value; raises SubstitutionFailure if it is not set."""
        name = perform_substitutions(context, self.name)
        if name in context.environment:
            return context.environment[name]
        if self.default_value is None:
            raise SubstitutionFailure(f"the environment has no '{shown(name)}'{nearest(name, context.environment)}")
        return perform_substitutions(context, self.default_value)

    def describe(self) -> str:
        """Return a description for people."""
        return f"EnvVar({described(self.name)})"


class LocalSubstitution(Substitution):
    """Value of one of the context's locals, such as `event.returncode`.

    Args:
        expression: Name, with attributes and keys behind it.
        description: Description for people.
    """

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.expression, self.description = expression, description

    def perform(self, context: LaunchContext) -> str:
        """Return the value; raises SubstitutionFailure if there is none."""
        value: Any = context.get_locals_as_dict()
        at = 0
        while at < len(self.expression):
            step = _STEP.match(self.expression, at)
            if step is None:
                raise SubstitutionFailure(f"'{self.expression}' is not a name with attributes and keys")
            at, name = step.end(), next(each for each in step.groups() if each is not None)
            try:
                value = (
                    value[int(name)] if step[4] else value[name] if isinstance(value, dict) else getattr(value, name)
                )
            except (LookupError, AttributeError):
                raise SubstitutionFailure(f"the context has no '{self.expression}' here ({name})") from None
        return str(value)


FOR_EACH = "ForEachVar__"
"""Beginning of the names of those locals that an iteration of ForEach has."""


class ForEachVar(Substitution):
    """Value that an iteration of a ForEach of XML or YAML has.

    Args:
        name: Name of the value.
        default_value: Value of an iteration that has none of this name; without one that is an error.
    """

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    def perform(self, context: LaunchContext) -> str:
        """Return the value; raises SubstitutionFailure if there is none."""
        name, known = perform_substitutions(context, self.name), context.get_locals_as_dict()
        if FOR_EACH + name in known:
            return str(known[FOR_EACH + name])
        if self.default_value is None:
            own = [each.removeprefix(FOR_EACH) for each in known if each.startswith(FOR_EACH)]
            hint = nearest(name, own) or (f": there is {', '.join(own[:8])}" if own else "")
            raise SubstitutionFailure(f"no loop here has the value '{shown(name)}'{hint}")
        return perform_substitutions(context, self.default_value)


class ForLoopIndex(ForEachVar):
    """Number that an iteration of a ForLoop of XML or YAML has.

    Args:
        name: Name of the loop.
    """

    def __init__(self, name: SomeSubstitutionsType) -> None:
        super().__init__(name)


class PathJoinSubstitution(Substitution):
    """Path of several parts; `/` adds another one.

    Args:
        substitutions: The parts; one that is a list is joined to a single part.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        self.substitutions = [normalize_to_list_of_substitutions(each) for each in substitutions]

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        parts = [perform_substitutions(context, each) for each in self.substitutions]
        return os.path.join(*parts) if parts else ""  # noqa: PTH118 - it is a text, whose slashes stay as they are

    def __truediv__(self, part: SomeSubstitutionsType) -> PathJoinSubstitution:
        """Return the path with one more `part`."""
        return PathJoinSubstitution([*self.substitutions, part])


class PathSubstitution(PathJoinSubstitution):
    """Path to which `/` adds parts.

    Args:
        path: Its beginning.
    """

    def __init__(self, path: SomeSubstitutionsType) -> None:
        super().__init__([path])


class StringJoinSubstitution(Substitution):
    """Texts with a delimiter between them.

    Args:
        substitutions: The texts; one that is a list is joined first.
        delimiter: Text between them.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType], delimiter: SomeSubstitutionsType = "") -> None:
        self.substitutions = [normalize_to_list_of_substitutions(each) for each in substitutions]
        self.delimiter = normalize_to_list_of_substitutions(delimiter)

    def perform(self, context: LaunchContext) -> str:
        """Return the joined text."""
        parts = [perform_substitutions(context, each) for each in self.substitutions]
        return perform_substitutions(context, self.delimiter).join(parts)


class ThisLaunchFile(Substitution):
    """Path of the launch file in which this stands."""

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return _of_file(context, "current_launch_file_path")


class ThisLaunchFileDir(Substitution):
    """Folder of the launch file in which this stands."""

    def perform(self, context: LaunchContext) -> str:
        """Return the folder."""
        return _of_file(context, "current_launch_file_directory")

    def __truediv__(self, part: SomeSubstitutionsType) -> PathJoinSubstitution:
        """Return the path with one more `part`."""
        return PathJoinSubstitution([self, part])


class LaunchLogDir(Substitution):
    """Folder of the logs: `ROS_LOG_DIR`, or that of robolink's launcher, in which each run has a folder of its own."""

    def perform(self, context: LaunchContext) -> str:
        """Return the folder."""
        named = context.environment.get("ROBOLINK_LOG_DIR") or context.environment.get("ROS_LOG_DIR")
        return named or str(Path("~/.robolink/log").expanduser())


class AnonName(Substitution):
    """Name that no other process has, on this machine or another: the same one for the same name in a launch.

    Args:
        name: Its beginning.
    """

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.name = normalize_to_list_of_substitutions(name)

    def perform(self, context: LaunchContext) -> str:
        """Return the name."""
        key = f"anon{perform_substitutions(context, self.name)}"
        if key not in context.launch_configurations:
            import socket

            base = re.sub(r"\W", "_", f"{key.removeprefix('anon')}_{socket.gethostname()}", flags=re.ASCII)
            context.launch_configurations[key] = f"{base}_{os.getpid()}_{next(_numbers)}"
        return str(context.launch_configurations[key])


def _of_file(context: LaunchContext, name: str) -> str:
    values = context.get_locals_as_dict()
    if name not in values:
        raise SubstitutionFailure("there is no launch file here: the description was made by a program")
    return str(values[name])


def _plain(value: Any) -> list[Substitution]:
    """Return the list for a default, which may be a plain value or a list of these."""
    if is_substitution(value) or isinstance(value, (str, os.PathLike)):
        return normalize_to_list_of_substitutions(value)
    if isinstance(value, Iterable):
        return [each for part in value for each in _plain(part)]
    return normalize_to_list_of_substitutions(str(value))
