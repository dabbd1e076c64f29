"""Programs by name: executables of packages, components, and nodes.

`robolink run turtlesim turtlesim_node` and launch files find a program of a package by one line in the file
`entry_points.txt` of the folder with its code. It has the form of the metadata of an installed package, since other
packages add theirs by entry points:

    [robolink.programs]
    turtlesim.draw_square = robolink.counterparts.turtlesim.draw_square:DrawSquare
    image_tools::Cam2Image = robolink.counterparts.image_tools:Cam2Image

The name is `PACKAGE.EXECUTABLE`, or that of a component's C++ class; the value is `MODULE:NAME` of a function without
arguments or of a Node class, or `nodes/NAME` for a file of robolink's own folder `nodes/`. Other packages add nodes for
`robolink run NAME` by the group `robolink.nodes`. What is in a user's own workspace goes first.
"""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from robolink.exceptions import NotFoundError, RobolinkError, nearest
from robolink.extensions import ExtensionError, Registry, module_path
from robolink.system.patterns import late
from robolink.workspace.installed import installed_executables
from robolink.workspace.packages import compiled_executables, executable, executables, named, named_executables
from robolink.workspace.ros_programs import CompiledProgramError, ros_program_error
from robolink.workspace.source import PACKAGE, NodeSource, built_in_workspace, canonical

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

ROOMS = ("cli", "counterparts")
"""Rooms of robolink whose folders may have a file `entry_points.txt`."""
_WORDS = late(r"(?<=[a-z0-9])(?=[A-Z])")
MOST_NAMED = 10
"""Most executables that an error lists."""


@functools.cache
def _own() -> Mapping[str, str]:
    """Return the targets in robolink's own files `entry_points.txt`: a folder that goes takes its own along."""
    found: dict[str, str] = {}
    for room in ROOMS:
        for file in sorted((PACKAGE / room).glob("*/entry_points.txt")):
            lines = file.read_text(encoding="utf-8").partition(f"[{PROGRAMS.group}]\n")[2].splitlines()
            found.update((name, target) for name, _, target in (line.partition(" = ") for line in lines) if target)
    return found


def _target(entry: EntryPoint) -> str:
    """Return the target of an entry point, with nothing imported."""
    if ("." in entry.name) == ("::" in entry.name):
        raise RobolinkError("a program's name is PACKAGE.EXECUTABLE, or PACKAGE::CLASS for a component")
    source_at(entry.value)
    return entry.value


PROGRAMS = Registry("robolink.programs", _own, _target)
"""Registry of the programs: targets by `PACKAGE.EXECUTABLE`, or by a component's class."""


def _own_nodes() -> dict[str, NodeSource]:
    return {each.name: each for each in nodes_in(built_in_workspace())}


NODES = Registry("robolink.nodes", _own_nodes, lambda entry: source_at(entry.value)._replace(name=entry.name))
"""Registry of the nodes: sources by name."""


def nodes_in(workspace: Path) -> Iterator[NodeSource]:
    """Yield the nodes in the folder `nodes/` of a workspace, by name."""
    for path in sorted((workspace / "nodes").glob("*.py")):
        if not path.name.startswith("_"):
            yield NodeSource(path.stem, path)


def program_names() -> dict[str, list[str]]:
    """Return the names of all executables, by their packages."""
    found: dict[str, list[str]] = {}
    for package, _, name in (each.partition(".") for each in PROGRAMS.names()):
        if name:
            found.setdefault(package, []).append(name)
    return found


def programs_of(package: str) -> list[str]:
    """Return the executables that `package` has here; none for a package without any."""
    return program_names().get(canonical(package), [])


def components() -> list[str]:
    """Return the names of the C++ classes of components that have a Node class here, such as `turtlesim::TurtleSim`."""
    return [each for each in PROGRAMS.names() if "::" in each]


def program(package: str, name: str) -> NodeSource | None:
    """Return the source of the executable `name` that `package` has here; None if there is none."""
    name = canonical(name).removesuffix(".py")
    found = _source(f"{canonical(package)}.{name}")
    return found._replace(name=name) if found is not None and found.attribute else found


def component(plugin: str) -> NodeSource | None:
    """Return the source of the class that does the same as the component `plugin`; None if there is none.

    >>> component("nav2_smoother::SmootherServer") is None
    True
    """
    found = _source(plugin)
    return None if found is None else found._replace(name=_WORDS.sub("_", plugin.rpartition("::")[2]).lower())


def sources_of(package: str) -> dict[str, NodeSource]:
    """Return the sources of the executables that `package` has here, by name; those that are broken are left out."""
    found = {}
    for name in programs_of(package):
        with contextlib.suppress(ExtensionError):  # one broken entry point must not break a list of others
            source = program(package, name)
            if source is not None:
                found[name] = source
    return found


@functools.cache
def launched_packages() -> frozenset[str]:
    """Return the names of the ROS packages whose launch files robolink has: some have no programs."""
    return frozenset(each.parent.name for each in (PACKAGE / "counterparts").glob("*/launch"))


def program_folder(package: str) -> Path | None:
    """Return the folder of the programs of `package`, which may have launch files; None if it has none here."""
    if canonical(package) in launched_packages() or programs_of(package):
        own = PACKAGE / "counterparts" / canonical(package)
        if own.is_dir():
            return own
    return next((each.path.parent for each in sources_of(package).values()), None)


def source_at(target: str) -> NodeSource:
    """Return the source of a target: `MODULE:NAME`, or `nodes/NAME:CLASS` for a node that comes with robolink."""
    module, _, attribute = target.partition(":")
    if module.startswith("nodes/"):
        return NodeSource(module.removeprefix("nodes/"), built_in_workspace() / f"{module}.py", attribute)
    name = module.rpartition(".")[2]
    if module.startswith(f"{PACKAGE.name}."):
        return NodeSource(name, _file(PACKAGE.parent.joinpath(*module.split("."))), attribute)
    path = module_path(module)
    return NodeSource(name, _file(path), attribute, module=module, root=path.parents[module.count(".")])


def executable_of(package: str, name: str, folder: Path | None) -> NodeSource | None:
    """Return the executable `name` of a package in `folder`, else the one it has here, else one that was installed.

    None if there is none of them.

    Args:
        package: Name of the package.
        name: Name of the executable.
        folder: Folder of the user's own package of this name; None if there is none.
    """
    own = None if folder is None else executable(folder, name)
    return own or program(package, name) or named(name, installed_executables(package))


def lacking_executable(package: str, name: str, folder: Path | None) -> NotFoundError | None:
    """Return the error for an executable that is not there; None if the package is not known, or has none at all.

    Args:
        package: Name of the package.
        name: Name of the executable.
        folder: Folder of the user's own package of this name; None if there is none.
    """
    own = executables(folder) if folder is not None else installed_executables(package)
    known = [*own, *programs_of(package)]
    if folder is None:
        of_ros = ros_program_error(package, name, by_package=not known)
        if of_ros is not None:
            return of_ros
    elif canonical(name) in map(canonical, compiled_executables(folder)):
        return CompiledProgramError(package, name)
    if not known:
        return None
    error = NotFoundError("executable", name, known, f"package {package}")
    if not nearest(name, known):
        first = [each.name for each in named_executables(folder)] if folder is not None else []
        shown = [*(first or own), *programs_of(package)]
        error.args = (f"{error}, which has {', '.join(shown[:MOST_NAMED])}{' ...' if len(shown) > MOST_NAMED else ''}",)
    return error


def _source(name: str) -> NodeSource | None:
    target = PROGRAMS.get(name)
    return None if target is None else source_at(target)


def _file(place: Path) -> Path:
    return place / "__init__.py" if place.is_dir() else place.with_suffix(".py")
