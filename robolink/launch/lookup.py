"""Look-up of launch files of all kinds, nodes, parameter files and commands by name or path."""

from __future__ import annotations

import codecs
import itertools
import re
import shutil
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from robolink.exceptions import NotFoundError, RobolinkError, nearest
from robolink.system.files import expanded, read_plain
from robolink.system.processes import own_command
from robolink.workspace import (
    Folder,
    NodeSource,
    RosProgramError,
    built_in_workspace,
    find_launch,
    find_node,
    find_package,
    instead_of,
    list_packages,
    program_folder,
    user_workspace,
    workspace_of,
)

YAML = (".yaml", ".yml")
PROGRAMS = (".py", ".xml", ".launch")
"""Suffixes of the launch files that only ROS 2 has."""
_LAUNCH_KEY = re.compile(rb"[\"']?launch[\"']?\s*:")
_NO_KEY = re.compile(rb"\s*(?:#.*|---.*|%.*)?")
"""Lines that may stand before the first key."""
_LONGEST = 10_000_000
LAUNCH_FOLDER = "launch"
"""Folder of the launch files in a ROS 2 package."""

WHERE_PROGRAMS_ARE = "a name is looked up on the PATH, a path from the working directory ({here} is the file's folder)"
_PYTHON = ("python", "python3")

NOT_FOUND = (NotFoundError, OSError, ValueError, RuntimeError)
"""Exceptions of a look-up: the file does not exist, or the text cannot be a file's name."""

KINDS = (*YAML, *PROGRAMS)
"""Suffixes of launch files; those in front count more where two have one name."""
_MOST_NAMED, _MOST_FILES = 8, 5000


class LaunchKindError(RobolinkError, ValueError):
    """The name of a launch file is that of a node or a package."""


def is_of_ros(path: Path) -> bool:
    """True for a launch file of ROS 2: Python, XML, or YAML whose first key is `launch`."""
    if path.suffix in PROGRAMS:
        return True
    try:
        lines = read_plain(path, _LONGEST).removeprefix(codecs.BOM_UTF8).splitlines()
    except (OSError, ValueError):  # whoever reads it says what is wrong
        return False
    first = next((each for each in lines if not _NO_KEY.fullmatch(each)), b"")
    return _LAUNCH_KEY.match(first) is not None


def find(names: Sequence[str], *, workspace: Folder = None) -> Path:
    """Find a launch file by its name or path, or by a package and the file's name in it.

    Raises `NotFoundError` with the nearest name, and `LaunchKindError` for one that is a node's, or a package's.
    """
    if len(names) == 1:
        return _by_name(names[0], workspace)
    package, name = names
    folder = find_package(package, workspace=workspace) or program_folder(package)
    if folder is None:
        if advice := instead_of(package):
            raise RosProgramError(package, name, advice)
        known = list_packages(workspace=workspace)
        raise NotFoundError("package", package, known, "the workspace (an argument is given as NAME:=VALUE)")
    return _in_package(folder, package, name)


def _by_name(name: str, workspace: Folder) -> Path:
    try:
        return find_launch(name, workspace=workspace)
    except NotFoundError:
        if _is_node(name, workspace):
            raise LaunchKindError(f"'{name}' is a node, and no launch file: robolink run {name}") from None
        folder = find_package(name, workspace=workspace)
        if folder is not None and (folder / LAUNCH_FOLDER).is_dir():
            raise LaunchKindError(_which_of(folder, name)) from None
        raise


def _which_of(folder: Path, package: str) -> str:
    """Return a hint with the launch files of a package, for somebody who named only the package."""
    names = [each.name for each in _files_of(folder)]
    if names:
        return f"{package} is a package: say which of its launch files, {' or '.join(names[:_MOST_NAMED])}"
    return f"{package} is a package and has no launch file"


def _is_node(name: str, workspace: Folder) -> bool:
    try:
        find_node(name, workspace=workspace)
    except NOT_FOUND:
        return False
    return True


def _in_package(folder: Path, package: str, name: str) -> Path:
    """Find a file in a package; `robot`, `robot.yaml` and `robot.launch.py` are the same."""
    there = _files_of(folder)
    for each in there:
        if name in (each.name, each.stem, each.stem.removesuffix(".launch")):
            return each
    names = [each.name for each in there]
    listed = ", ".join(names[:_MOST_NAMED]) or "none"
    raise NotFoundError("launch file", name, names, f"package {package}, which has {listed}")


def _files_of(folder: Path) -> list[Path]:
    """Return the launch files of a package: those in its launch folder first, then robolink's own kind, then others."""
    inside = itertools.islice((folder / LAUNCH_FOLDER).rglob("*"), _MOST_FILES)
    found = [each for each in inside if each.suffix in KINDS and each.is_file() and _is_launch(each)]
    if not found:
        inside = itertools.islice(folder.rglob("*.launch.*"), _MOST_FILES)
        found = [each for each in inside if each.suffix in KINDS and each.is_file()]
    return sorted(found, key=lambda each: (len(each.parts), KINDS.index(each.suffix), each.name))


def _is_launch(path: Path) -> bool:
    return path.name != "__init__.py" and not path.name.startswith((".", "_"))


def reason_of(error: Exception) -> str:
    """Return why a look-up failed."""
    return (error.strerror if isinstance(error, OSError) else None) or str(error)


def home_of(path: Path, workspace: Folder) -> Path | None:
    """Return the workspace in which a launch file's nodes, worlds and files are looked up first.

    Its own or, when it came with robolink, the user's. Raises `NotFoundError` when that is named and no folder.
    """
    own = workspace_of(path.parent)
    return user_workspace(workspace) if own is None or own == built_in_workspace() else own


def source_of(name: str, home: Path | None, folder: Path) -> NodeSource:
    """Find a node; a file is looked for from the launch file's `folder`, or from the workspace.

    Two words are a package and an executable of it, as `robolink run` takes them. Raises `NotFoundError` with the
    nearest name.
    """
    file, colon, attribute = name.rpartition(":") if ".py:" in name else (name, "", "")
    found = _first_file(each / expanded(file) for each in _around(folder, home))
    if found is not None and file.endswith(".py"):
        return NodeSource(found.stem, found.resolve(), attribute if colon else "")
    return find_node(name, workspace=home)


def included_file(name: str, home: Path | None, folder: Path) -> Path:
    """Find a launch file that another one in `folder` includes.

    Candidates are a path from that folder, with or without `.yaml`, a path from the workspace, and a name. Raises
    `NotFoundError` with the nearest name.
    """
    path = expanded(name)
    beside_it = (folder / path.with_name(f"{path.name}{suffix}") for suffix in YAML if path.name)
    found = _first([folder / path, *beside_it, *(each / path for each in _around(folder, home)[1:])])
    if found is not None:
        return found
    try:
        return find_launch(name, workspace=home)
    except NotFoundError as error:
        beside = [text for each in folder.glob("*") if each.suffix in YAML for text in (each.name, each.stem)]
        raise (NotFoundError("launch file", name, beside) if nearest(name, beside) else error) from None


def parameter_file(name: str, home: Path | None, folder: Path) -> Path:
    """Find a parameter file: from the launch file's `folder`, or from the workspace.

    Two words are a package and a path in it, `nav2_bringup params/nav2_params.yaml`. Raises `NotFoundError` with the
    nearest name beside it.
    """
    path, folders = expanded(name), _around(folder, home)
    found = _first(each / path for each in folders)
    if found is None and (package := _package_of(name, home)) is not None:
        path, folders = Path(name.partition(" ")[2].strip()), [package]
        found = _first([package / path])
    if found is None:
        beside = (
            str(path.with_name(each.name)) for each in (folders[0] / path).parent.glob("*") if each.suffix in YAML
        )
        raise NotFoundError("file", name, beside, " or ".join(map(str, folders)))
    return found


def _package_of(name: str, home: Path | None) -> Path | None:
    """Return the folder of the package that is the first of two words; None for any other name."""
    package, _, path = name.partition(" ")
    if not path.strip() or not package.isidentifier():
        return None
    return find_package(package, workspace=home) or program_folder(package)


def command_of(run: Sequence[str], path: str | None) -> list[str] | None:
    """Return the full command line of a command, None if there is no such program; `path` is its PATH, None for ours.

    `robolink` and `python` are those of this process where the PATH has none.
    """
    found, ours = shutil.which(run[0], path=path), _ours(run[0])
    if found is not None and ours is not None and Path(found).parent.name == "WindowsApps":
        found = None  # what Windows has in place of a Python that is not installed: it leads to a shop
    if found is not None:  # Windows itself would look on our PATH, and for no `.bat`
        return [found if sys.platform == "win32" else run[0], *run[1:]]
    return None if ours is None else [*ours, *run[1:]]


def _ours(name: str) -> tuple[str, ...] | None:
    """Return the words that start this process's own Python or robolink, None for another name."""
    if name == "robolink":
        return own_command()
    return (sys.executable,) if name in _PYTHON else None


def _around(folder: Path, home: Path | None) -> list[Path]:
    """Return the base folders of a launch file's relative paths: its own and its workspace's."""
    return [folder] if home is None else [folder, home]


def why_no_command(program: str) -> str:
    """Return why `command_of` finds no such program."""
    if Path(program).name != program and Path(program).is_file():
        if sys.platform == "win32":
            return f"'{program}' is nothing that Windows starts by itself: write before it what runs it, as python"
        return f"'{program}' may not be executed: chmod +x it"
    return f"no program '{program}' is found: {WHERE_PROGRAMS_ARE}"


def _first(candidates: Iterable[Path]) -> Path | None:
    """Return the first candidate that exists and is not a folder; other problems show when it is read."""
    return next((each for each in candidates if each.exists() and not each.is_dir()), None)


def _first_file(candidates: Iterable[Path]) -> Path | None:
    return next((each for each in candidates if each.is_file()), None)
