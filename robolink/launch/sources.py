"""Where the nodes and files are that a launch file names."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from robolink.exceptions import NotFoundError, nearest
from robolink.launch.find import YAML
from robolink.workspace import (
    Folder,
    NodeSource,
    built_in_workspace,
    canonical,
    executable,
    executables,
    find_launch,
    find_node,
    find_package,
    find_ros_node,
    list_packages,
    user_workspace,
    workspace_of,
)

WHERE_PROGRAMS_ARE = "a name is looked up on the PATH, a path from the working directory ({here} is the file's folder)"
_OURS = {
    "robolink": (sys.executable, "-m", "robolink"),
    "python": (sys.executable,),
    "python3": (sys.executable,),
}


NOT_FOUND = (NotFoundError, OSError, ValueError, RuntimeError)
"""What looking for a file raises: it is not there, or what is asked for can be no file's name."""


def reason_of(error: Exception) -> str:
    """Say why something was not found."""
    return (error.strerror if isinstance(error, OSError) else None) or str(error)


def home_of(path: Path, workspace: Folder) -> Path | None:
    """Give the workspace in which a launch file's nodes, worlds and files are looked up first.

    Its own or, when it came with robolink, the user's. Raises `NotFoundError` when that is named and no folder.
    """
    own = workspace_of(path.parent)
    return user_workspace(workspace) if own is None or own == built_in_workspace() else own


def source_of(name: str, home: Path | None, folder: Path) -> NodeSource:
    """Find a node; a file that has no workspace around it is looked for beside the launch file, in `folder`, too.

    Two words are a package and an executable of it, as `robolink run` takes them. Raises `NotFoundError` with the
    nearest name.
    """
    package, _, its_name = name.partition(" ")
    if its_name and canonical(package).isidentifier():
        return _executable(package, its_name.strip(), home)
    file, colon, attribute = name.rpartition(":") if ".py:" in name else (name, "", "")
    beside = folder / file
    if home is None and file.endswith(".py") and beside.is_file():
        return NodeSource(beside.stem, beside.resolve(), attribute if colon else "")
    return find_node(name, workspace=home)


def _executable(package: str, name: str, home: Path | None) -> NodeSource:
    folder = find_package(package, workspace=home)
    source = find_ros_node(package, name) if folder is None else executable(folder, name)
    if source is not None:
        return source
    if folder is None:
        raise NotFoundError("package", package, list_packages(workspace=home), "the workspace")
    raise NotFoundError("executable", name, executables(folder), f"package {package}")


def included_file(name: str, home: Path | None, folder: Path) -> Path:
    """Find a launch file that another one in `folder` includes: beside it, with or without `.yaml`, or by name.

    Raises `NotFoundError` with the nearest name.
    """
    found = _first_file(folder / Path(f"{name}{suffix}").expanduser() for suffix in ("", *YAML))
    if found is not None:
        return found
    try:
        return find_launch(name, workspace=home)
    except NotFoundError as error:
        beside = [text for each in folder.glob("*") if each.suffix in YAML for text in (each.name, each.stem)]
        raise (NotFoundError("launch file", name, beside) if nearest(name, beside) else error) from None


def parameter_file(name: str, home: Path | None, folder: Path) -> Path:
    """Find a parameter file: from the launch file's `folder`, or from the workspace.

    Raises `NotFoundError` with the nearest name beside it.
    """
    path = Path(name).expanduser()
    folders = [folder] if home is None else [folder, home]
    found = _first_file(each / path for each in folders)
    if found is None:
        beside = (str(path.with_name(each.name)) for each in (folder / path).parent.glob("*") if each.suffix in YAML)
        raise NotFoundError("file", name, beside, " or ".join(map(str, folders)))
    return found


def command_of(run: Sequence[str], path: str | None) -> list[str] | None:
    """Give how a command is started, None if there is no such program; `path` is its PATH, or None for ours.

    `robolink` and `python` are those of this process where the PATH has none.
    """
    if shutil.which(run[0], path=path) is not None:
        return list(run)
    ours = _OURS.get(run[0])
    return None if ours is None else [*ours, *run[1:]]


def _first_file(candidates: Iterable[Path]) -> Path | None:
    return next((each for each in candidates if each.is_file()), None)
