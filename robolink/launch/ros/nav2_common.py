"""nav2_common: the substitutions of Nav2's launch files (`nav2_common.launch`)."""

from __future__ import annotations

import atexit
import os
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from robolink.documents.yamlfile import parse, read_text, spell
from robolink.exceptions import DocumentError
from robolink.launch.ros.launch.bases import Condition, LaunchContext, LaunchError, SomeSubstitutionsType, Substitution
from robolink.launch.ros.launch.substitutions import LaunchConfiguration
from robolink.launch.ros.launch.utilities import normalize_to_list_of_substitutions, performed
from robolink.system.terminal import shown

__all__ = [
    "HasNodeParams",
    "LaunchConfigAsBool",
    "ParseMultiRobotPose",
    "ReplaceString",
    "RewrittenYaml",
]


YES = ("true", "1", "yes", "on")
"""Spellings of true in a launch configuration."""
PARAMETERS = "ros__parameters"
"""Key of a node's parameters in a parameter file: only paths with it are added to a file."""


class RewrittenYaml(Substitution):
    """Path of a changed copy of a YAML file, usually one of parameters. The copy is removed when the launcher ends.

    Args:
        source_file: The file.
        param_rewrites: New values by names of parameters, wherever they stand, or by paths such as
            ``amcl.ros__parameters.use_sim_time``. A path that is not in the file is added.
        root_key: Key to put all of the content under, such as a namespace; none if it is empty or None.
        key_rewrites: New keys by keys.
        value_rewrites: New values by the texts of the old ones.
        convert_types: True makes new values numbers where they spell one. True and false are truth values in any case.
        out_dir: Folder of the copy; None is that of temporary files.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        param_rewrites: Mapping[str, SomeSubstitutionsType],
        root_key: SomeSubstitutionsType | None = None,
        key_rewrites: Mapping[str, SomeSubstitutionsType] | None = None,
        value_rewrites: Mapping[str, SomeSubstitutionsType] | None = None,
        convert_types: bool = False,
        out_dir: SomeSubstitutionsType | None = None,
    ) -> None:
        self.source_file = normalize_to_list_of_substitutions(source_file)
        self.param_rewrites, self.convert_types = param_rewrites, convert_types
        self.root_key, self.out_dir = root_key or "", out_dir or ""
        self.key_rewrites, self.value_rewrites = key_rewrites or {}, value_rewrites or {}

    @property
    def name(self) -> list[Substitution]:
        """The file's path, before it is performed."""
        return self.source_file

    def perform(self, context: LaunchContext) -> str:
        """Write the copy with the values of `context`; return its path. Raises LaunchError."""
        data = _read(performed(context, self.source_file))
        values = {
            name: _value(performed(context, each), self.convert_types) for name, each in self.param_rewrites.items()
        }
        _set_names(data, values)
        _set_paths(data, values)
        data = _renamed(data, {key: performed(context, each) for key, each in self.key_rewrites.items()})
        texts = {
            text: _value(performed(context, each), self.convert_types) for text, each in self.value_rewrites.items()
        }
        data = _replaced(data, texts)
        root = performed(context, self.root_key)
        return _written(spell({root: data} if root else data), performed(context, self.out_dir))


class ReplaceString(Substitution):
    """Path of a copy of a file with other texts in it. The copy is removed when the launcher ends.

    Args:
        source_file: The file.
        replacements: New texts by texts.
        condition: Condition without which the file itself is taken.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        replacements: Mapping[str, SomeSubstitutionsType],
        condition: Condition | None = None,
    ) -> None:
        self.source_file = normalize_to_list_of_substitutions(source_file)
        self.replacements, self.condition = replacements, condition

    @property
    def name(self) -> list[Substitution]:
        """The file's path, before it is performed."""
        return self.source_file

    def perform(self, context: LaunchContext) -> str:
        """Write the copy with the values of `context`; return its path. Raises LaunchError."""
        path = performed(context, self.source_file)
        if self.condition is not None and not self.condition.evaluate(context):
            return path
        text = _text(path)
        for old, new in self.replacements.items():
            text = text.replace(old, performed(context, new))
        return _written(text)


class HasNodeParams(Substitution):
    """``True`` if a parameter file has an entry of a node, else ``False``.

    Args:
        source_file: The file.
        node_name: The node's key in the file.
    """

    def __init__(self, source_file: SomeSubstitutionsType, node_name: str) -> None:
        self.source_file, self.node_name = normalize_to_list_of_substitutions(source_file), node_name

    def perform(self, context: LaunchContext) -> str:
        """Read the file; raises LaunchError."""
        path = performed(context, self.source_file)
        return str(bool(_text(path).strip()) and self.node_name in _read(path))


class LaunchConfigAsBool(Substitution):
    """``True`` if a launch configuration spells true, such as ``yes`` or ``1``, else ``False``.

    Args:
        name: Name of the configuration.
    """

    def __init__(self, name: str) -> None:
        self.configuration = LaunchConfiguration(name)

    def perform(self, context: LaunchContext) -> str:
        """Return the value with the configurations of `context`; raises LaunchError if there is none of this name."""
        return str(performed(context, self.configuration).strip().lower() in YES)


class ParseMultiRobotPose(Substitution):
    """Poses of several robots by their names, of a text ``ada={x: 1.0, yaw: 1.57}; bob={x: 2.0}``.

    Args:
        robots_argument: The text, as a substitution; or, as in Jazzy, the name of the launch argument that has it on
            the command line.
    """

    def __init__(self, robots_argument: str | Substitution) -> None:
        self.robots_argument = robots_argument

    def perform(self, context: LaunchContext) -> Any:
        """Return the poses with the values of `context`; what a pose leaves out is 0. Raises LaunchError."""
        given = self.robots_argument
        return _poses(performed(context, LaunchConfiguration(given, default="") if isinstance(given, str) else given))

    def value(self) -> dict[str, Any]:
        """Return the poses of the launch argument on the command line, before anything is executed, as in Jazzy.

        Raises LaunchError.
        """
        if not isinstance(self.robots_argument, str):
            raise LaunchError("value() needs the name of a launch argument: perform(context) reads a substitution")
        start = f"{self.robots_argument}:="
        return _poses(next((each.removeprefix(start) for each in sys.argv if each.startswith(start)), ""))


_POSE = ("x", "y", "z", "roll", "pitch", "yaw")


def _poses(text: str) -> dict[str, Any]:
    """Return poses by name. Raises LaunchError for a text that has none."""
    found = {}
    for part in filter(str.strip, text.split(";")):
        name, equals, pose = part.partition("=")
        try:
            values = parse(pose, name="") if equals else None
        except DocumentError:
            values = None
        if not isinstance(values, dict):
            raise LaunchError(f"a robot is NAME={{x: 1.0, y: 1.0, yaw: 0.0}}, got '{shown(part.strip(), 60)}'")
        found[name.strip()] = {**dict.fromkeys(_POSE, 0.0), **values}
    return found


def _text(path: str) -> str:
    try:
        return read_text(path)
    except DocumentError as error:
        raise LaunchError(str(error)) from None


def _read(path: str) -> dict[str, Any]:
    try:
        data = parse(_text(path), name=path)
    except DocumentError as error:
        raise LaunchError(str(error)) from None
    if not isinstance(data, dict):
        raise LaunchError(f"{path}: expected a mapping of names to values")
    return data


def _value(text: str, convert: bool) -> Any:
    """Return the value that a text spells: a truth value, or, with `convert`, a number."""
    if text.strip().lower() in ("true", "false"):
        return text.strip().lower() == "true"
    if convert:
        try:
            return float(text) if "." in text else int(text)
        except ValueError:
            pass
    return text


def _set_names(data: dict[str, Any], values: Mapping[str, Any]) -> None:
    """Set the values of names, at any depth."""
    for name, inner in data.items():
        if isinstance(inner, dict):
            _set_names(inner, values)
        if name in values:
            data[name] = values[name]


def _set_paths(data: dict[str, Any], values: Mapping[str, Any]) -> None:
    """Set the values of paths; those of parameters are added where they are missing."""
    there = set(_paths(data))
    for path, value in values.items():
        steps = path.split(".")
        if len(steps) > 1 and (path in there or PARAMETERS in steps):
            _set(data, steps, value, path)


def _paths(data: Any, above: str = "") -> Iterator[str]:
    """Yield the paths of all values that are neither mappings nor lists."""
    pairs: Sequence[tuple[Any, Any]] | None = None
    if isinstance(data, dict):
        pairs = list(data.items())
    elif isinstance(data, list):
        pairs = list(enumerate(data))
    if pairs is None:
        yield above
        return
    for key, value in pairs:
        yield from _paths(value, f"{above}.{key}" if above else str(key))


def _set(data: Any, steps: Sequence[str], value: Any, path: str) -> None:
    """Set a value by its path, through mappings, which are made where they are missing, and lists."""
    for step, last in ((step, number == len(steps) - 1) for number, step in enumerate(steps)):
        try:
            key: Any = int(step) if isinstance(data, list) else step
            if last:
                data[key] = value
            else:
                data = data.setdefault(key, {}) if isinstance(data, dict) else data[key]
        except (TypeError, ValueError, IndexError):
            raise LaunchError(f"the parameter file has no place for '{path}'") from None


def _renamed(data: Any, keys: Mapping[str, str]) -> Any:
    """Return data with other keys, at any depth of mappings."""
    if not isinstance(data, dict):
        return data
    return {keys.get(key, key): _renamed(value, keys) for key, value in data.items()}


def _replaced(data: Any, values: Mapping[str, Any]) -> Any:
    """Return data with other values, by the values' texts."""
    if isinstance(data, dict):
        return {key: _replaced(value, values) for key, value in data.items()}
    if isinstance(data, list):
        return [_replaced(each, values) for each in data]
    return values.get(str(data), data)


def _written(text: str, folder: str = "") -> str:
    """Write a temporary file; return its path. It is removed when this process ends. Raises LaunchError."""
    try:
        handle, path = tempfile.mkstemp(prefix="robolink-", suffix=".yaml", dir=folder or None)
    except OSError as error:
        raise LaunchError(f"no file can be written in '{folder or tempfile.gettempdir()}': {error.strerror}") from None
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(text)
    atexit.register(Path(path).unlink, missing_ok=True)
    return path
