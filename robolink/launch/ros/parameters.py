"""Parameters of a node of a ROS 2 launch file: from mappings, files, and the actions around it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from robolink.arguments.overrides import Override
from robolink.arguments.parameter_file import parse_parameter_file, parse_parameter_value, read_parameter_file
from robolink.companions.ament_index.packages import package_not_here
from robolink.companions.launch.bases import LaunchContext, LaunchError
from robolink.companions.launch.utilities import performed
from robolink.companions.launch_ros.actions.scope import PARAMETERS
from robolink.companions.launch_ros.parameter_descriptions import Parameter, ParameterFile, evaluated
from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError, nearest
from robolink.system.terminal import shown

Say: TypeAlias = "Callable[[str], object]"


class Parameters(NamedTuple):
    """Parameters of a node, as far as they are known before it runs."""

    values: dict[str, Any]
    wide: frozenset[str]
    """Names of those that were given to more than this node."""
    words: list[str]
    """Words behind `--ros-args` that are read before the values: files whose sections only the node itself can choose,
    since the launch file does not name it."""
    files: list[Path]


def parameters_of(
    parameters: Iterable[Any], full_name: str, is_named: bool, context: LaunchContext, say: Say
) -> Parameters:
    """Return the parameters of a node; later ones win, and its own win over those of SetParameter.

    Args:
        parameters: What the action has: mappings, files, `Parameter`s.
        full_name: Full name of the node.
        is_named: True if the launch file names it, so that the sections of files can be chosen here.
        context: The context with whose values they are performed.
        say: Called with a line about each file that is not there.

    Raises:
        LaunchError: for a value that no parameter can have.
        DocumentError: with the place in a parameter file.
    """
    found = Parameters({}, frozenset(), [], [])
    wide: set[str] = set()
    around = context.launch_configurations.get(PARAMETERS, [])
    for each in around:
        is_pair = isinstance(each, tuple)
        given = [each] if is_pair else _of_file(Path(each), None, full_name, is_named, found, say)
        wide.update(name for name, _ in given)
        _add(found, given)
    for each in parameters:
        given = _given(each, full_name, is_named, context, found, say)
        _add(found, given)
        wide.difference_update(name for name, _ in given)
    return found._replace(wide=frozenset(wide))


def _add(found: Parameters, given: Iterable[tuple[str, Any]]) -> None:
    for name, value in given:
        found.values.pop(name, None)
        found.values[name] = _checked(name, value)


def _given(
    said: Any, full_name: str, is_named: bool, context: LaunchContext, found: Parameters, say: Say
) -> list[tuple[str, Any]]:
    """Return the pairs that one element of a node's parameters stands for."""
    if isinstance(said, Mapping):
        return list(evaluated(said, context))
    if isinstance(said, Parameter):
        return [said.evaluate(context)]
    file = said if isinstance(said, ParameterFile) else ParameterFile(said)
    return _of_file(file.evaluate(context), file.substituted(context), full_name, is_named, found, say)


def _of_file(
    path: Path, text: str | None, full_name: str, is_named: bool, found: Parameters, say: Say
) -> list[tuple[str, Any]]:
    """Return what a file has for a node; of one without a name, leave the choice to the node where there is any."""
    overrides = _read(path, text, say)
    if overrides is None:
        return []
    found.files.append(path)
    if is_named or text is not None or all(each.pattern in ("/**", "/*") for each in overrides):
        return [(each.name, each.value) for each in overrides if each.is_for(full_name)]
    for name, value in found.values.items():  # what was given before must not win over the file
        found.words.extend(("-p", f"{name}:={spell(value)}"))
    found.values.clear()
    found.words.extend(("--params-file", os.fspath(path)))
    return []


def _read(path: Path, text: str | None, say: Say) -> list[Override] | None:
    """Return what a parameter file holds; None, with a line, for one that is not there: ROS 2 goes on without it."""
    if text is not None:
        return parse_parameter_file(text, os.fspath(path))
    package = package_not_here(os.fspath(path))
    if package:
        say(f"left out: the parameters in {path.name}, since package {package} is not here")
        return None
    if not path.is_file():
        beside = nearest(path.name, [each.name for each in path.parent.glob("*")] if path.parent.is_dir() else [])
        say(f"left out: there is no parameter file {shown(str(path), 300)}{beside}")
        return None
    return read_parameter_file(path)


def _checked(name: str, value: Any) -> Any:
    """Return a value, if it arrives at the node as it is; raises LaunchError otherwise."""
    if not name or any(each in ":*=" or each.isspace() or not each.isprintable() for each in name):
        raise LaunchError(f"'{shown(name)}' is no name for a parameter")
    if value is None:
        raise LaunchError(f"parameter '{shown(name)}' cannot be None: give a value, or leave it out")
    for each in value if isinstance(value, list) else [value]:
        if isinstance(each, int) and not -(2**63) <= each < 2**63:
            raise LaunchError(f"parameter '{shown(name)}': {each} is more than a 64-bit integer holds")
    if not isinstance(value, str):
        try:
            parse_parameter_value(spell(value), "")
        except DocumentError as error:
            raise LaunchError(f"parameter '{shown(name)}': {error.message}") from None
    return value


def texts_of(words: Iterable[Any], context: LaunchContext) -> Iterator[str]:
    """Yield the words of a command line, each performed with the values of `context`."""
    for each in words:
        yield str(each) if isinstance(each, (int, float)) else performed(context, each)
