"""Look-up of the program of a launch file's node, and of its parameters."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from robolink.arguments.command_line import CHILD_PARAMETER
from robolink.arguments.overrides import Override
from robolink.arguments.parameter_file import parse_parameter_file, parse_parameter_value, read_parameter_file
from robolink.companions.ament_index import get_search_paths, package_not_here
from robolink.compat.names import snake_case
from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError, NotFoundError, closest, nearest
from robolink.launch.ros.launch.bases import LaunchContext, LaunchError
from robolink.launch.ros.launch.utilities import performed, read_otherwise
from robolink.launch.ros.launch_ros.parameter_descriptions import Parameter
from robolink.launch.ros.launch_ros.parameters import values_for_node
from robolink.launch.ros.launch_ros.settings import PARAMETERS, as_set
from robolink.system.files import LONGEST_SOURCE, read_plain
from robolink.system.terminal import shown
from robolink.workspace import (
    NodeSource,
    RosProgramError,
    component,
    executables,
    find_executable,
    find_package,
    instead_of,
    list_packages,
)

_ALIKE = 0.85
"""Similarity from 0 to 1 above which a name is taken for a misspelt one of the workspace's."""


class Program(NamedTuple):
    """Program of a node: one of `source` and `path` is there, or else the reason why it is left out."""

    source: NodeSource | None = None
    path: str = ""
    """Path of a compiled program of an installed package."""
    absent: str = ""
    """Reason why it is left out, with what serves instead."""


def program_of(package: str, executable: str, home: Path | None) -> Program:
    """Return the program of an executable of a package.

    Args:
        package: Name of the package.
        executable: Name of the executable.
        home: Workspace in which packages are looked for; None looks for the nearest.

    Raises:
        NotFoundError: with the nearest name, for a misspelt package or an executable that its package lacks.
    """
    try:
        return Program(source=find_executable(package, executable, workspace=home))
    except NotFoundError as error:
        compiled = _installed(package, executable)
        if compiled is not None:
            return Program(path=str(compiled))
        if isinstance(error, RosProgramError):
            return Program(absent=str(error))
        folder = find_package(package, workspace=home)
        if folder is None:
            return Program(absent=_why_no_package(package, executable, home, error))
        if (folder / "CMakeLists.txt").is_file() and not closest(executable, executables(folder), _ALIKE):
            return Program(
                absent=f"{package} {executable} is not Python program here, and robolink builds nothing with CMake"
            )
        raise


def component_of(package: str, plugin: str, home: Path | None) -> Program:
    """Return the Python class of a component, its counterpart, or the reason why it is left out.

    Args:
        package: Name of the package.
        plugin: Name of its class, with or without the package and the module: `bot::Talker`, `bot.talker.Talker`.
        home: Workspace in which packages are looked for; None looks for the nearest.
    """
    folder, known = find_package(package, workspace=home), component(plugin)
    if folder is None:
        return Program(absent=include_absent(package)) if known is None else Program(known)
    name = re.split(r"::|[./]", plugin)[-1]
    defined = re.compile(rf"^class\s+{re.escape(name)}\b".encode(), re.MULTILINE)
    for source in executables(folder).values():
        if source.path.suffix == ".py" and defined.search(_text(source.path)):
            return Program(NodeSource(snake_case(name), source.path, name, module=source.module, root=source.root))
    return Program(absent=f"package {package} has no Python class of this name, and robolink builds no C++")


def _text(path: Path) -> bytes:
    try:
        return read_plain(path, LONGEST_SOURCE)
    except (OSError, ValueError):
        return b""


def include_absent(package: str) -> str:
    """Return why a launch file of a package that is not here is left out."""
    advice = instead_of(package)
    return f"package {package} is not here" + (f": {advice}" if advice else "")


def _why_no_package(package: str, executable: str, home: Path | None, error: NotFoundError) -> str:
    if error.kind == "executable":
        return str(error)
    if closest(package, list_packages(workspace=home), _ALIKE):
        raise error
    return f"{package} {executable} is not here: no package of this name is in the workspace"


def _installed(package: str, executable: str) -> Path | None:
    """Return the compiled program of a package in ROS 2's own index, where ROS 2 is installed."""
    for prefix in get_search_paths():
        path = Path(prefix) / "lib" / package / executable
        if path.is_file():
            return path
    return None


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

    def without_children(self) -> dict[str, Any]:
        """Return the values without those for nodes that the node makes itself, whose spelling rcl does not know."""
        return {name: value for name, value in self.values.items() if ":" not in name}


def parameters_of(
    parameters: Iterable[Any], full_name: str, is_named: bool, context: LaunchContext, say: Say, *, is_full: bool = True
) -> Parameters:
    """Return the parameters of a node as rcl chooses them.

    All are given for a pattern of node names: mappings for the node itself or, unless its name is known in full, for
    every node; those of SetParameter and `Parameter`s for every node; those of files as the sections say. The patterns
    count in the order in which they first come, and within each the later value wins.

    Args:
        parameters: What the action has, normalized: mappings, files, `Parameter`s.
        full_name: Full name of the node.
        is_named: True if the launch file names it, so that the sections of files can be chosen here.
        context: The context with whose values they are performed.
        say: Called with a line about each file that is not there, and each value that ROS 2 reads otherwise.
        is_full: True if the launch file gives it a name and a namespace.

    Raises:
        LaunchError: for a value that no parameter can have.
        DocumentError: with the place in a parameter file.
    """
    gathered = _Gathered(full_name, is_named, say)
    for each in context.launch_configurations.get(PARAMETERS, []):
        if isinstance(each, tuple):
            gathered.add([Override(_EVERY, each[0], as_set(*each))])
        else:
            gathered.add_file(Path(each), None)
    wide = set(gathered.values())
    own = full_name if is_named and is_full else _EVERY
    for each in parameters:
        if isinstance(each, Mapping):
            found = [Override(own, name, value) for name, value in values_for_node(context, each)]
            gathered.add(found, warn=True)
        elif isinstance(each, Parameter):
            found = [Override(_EVERY, *each.for_node(context))]
            gathered.add(found, warn=True)
        else:
            found = gathered.add_file(each.path(context), each.substituted(context))
            wide.update(each.name for each in found if "*" in each.pattern)
            found = [each for each in found if "*" not in each.pattern]
        wide.difference_update(each.name for each in found)
    wide.update(name for name in gathered.values() if ":" in name)
    return Parameters(gathered.values(), frozenset(wide), gathered.words, gathered.files)


class _Gathered:
    """Parameters of one node, in the order in which they come.

    Args:
        full_name: Full name of the node.
        is_named: True if the launch file names it.
        say: Called with lines for people.
    """

    def __init__(self, full_name: str, is_named: bool, say: Say) -> None:
        self._name, self._is_named, self._say = full_name, is_named, say
        self._by_pattern: dict[str, dict[str, Any]] = {}
        self._of_children: dict[str, Any] = {}
        """Parameters of nodes that the node may make itself, such as `/local_costmap/local_costmap:width`."""
        self.words: list[str] = []
        self.files: list[Path] = []

    def values(self) -> dict[str, Any]:
        """Return the values of the node."""
        found: dict[str, Any] = {}
        for values in self._by_pattern.values():
            for name, value in values.items():
                found.pop(name, None)
                found[name] = value
        return {**self._of_children, **found}

    def add(self, found: Iterable[Override], *, warn: bool = False) -> None:
        """Add those of `found` that are for the node; `warn` tells of texts that a node of ROS 2 reads otherwise."""
        for each in found:
            if each.is_for(self._name):
                values = self._by_pattern.setdefault(each.pattern, {})
                values.pop(each.name, None)
                values[each.name] = _checked(each.name, each.value)
                if warn:
                    self._warn(each.name, each.value)

    def _warn(self, name: str, value: Any) -> None:
        for text, read in read_otherwise(value).items():
            self._say(f"parameter '{shown(name)}': ROS 2 hands the text '{shown(text)}' over as {read!r}")

    def add_file(self, path: Path, text: str | None) -> list[Override]:
        """Add a file, whose text is `text` if it is known, or leave it to a nameless node; return what was added."""
        overrides = _read(path, text, self._say)
        if overrides is None:
            return []
        self.files.append(path)
        if self._is_named or text is not None or all(each.pattern in ("/**", "/*") for each in overrides):
            self.add(overrides)
            for each in overrides:
                if each.is_for_child(self._name):
                    self._of_children[f"{each.pattern}:{each.name}"] = _checked(each.name, each.value)
            return [each for each in overrides if each.is_for(self._name)]
        for name, value in self.values().items():  # what was given before comes before the file
            self.words.extend((CHILD_PARAMETER if ":" in name else "-p", f"{name}:={spell(value)}"))
        self._by_pattern.clear()
        self.words.extend(("--params-file", os.fspath(path)))
        return []


_EVERY = "/**"


def _read(path: Path, text: str | None, say: Say) -> list[Override] | None:
    """Return the overrides in a parameter file; None, with a line, for a missing one: ROS 2 goes on without it."""
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
        raise LaunchError(f"'{shown(name)}' is not a name for a parameter")
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
