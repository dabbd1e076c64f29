"""Look-up of the program of a launch file's node: its source, a compiled program, or the reason why it is left out."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

from robolink.companions.ament_index.search_paths import get_search_paths
from robolink.compat.names import snake_case
from robolink.exceptions import NotFoundError, closest
from robolink.system.files import LONGEST_SOURCE, read_plain
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
