"""Look-up of nodes, launch files, worlds and packages by name.

A workspace is a folder with two of `nodes/`, `configs/` and `interfaces/`, or a ROS 2 one: a folder whose `src/` holds
packages, or, where there is neither, a clone of a repository with packages, a lone package, or a folder of some. A name
is looked up (1) as a path, (2) in the nearest workspace: the one requested, `ROBOLINK_WORKSPACE`, the working
directory's or a parent's (if it can be trusted: `trust`), or the one whose `install/setup.bash` was sourced last, (3)
in the workspace that comes with robolink, (4) among the entry points `robolink.nodes` of installed packages. `_` and
`-` in names are the same.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from robolink.exceptions import NotFoundError, nearest
from robolink.system.files import expanded, is_file
from robolink.workspace.installed import COLCON
from robolink.workspace.packages import (
    BUILT_IN,
    PARTS,
    has_packages,
    hides,
    is_repository,
    is_ros_workspace,
    named_executables,
    source_packages,
)
from robolink.workspace.programs import (
    NODES,
    component,
    components,
    executable_of,
    lacking_executable,
    nodes_in,
    program_names,
)
from robolink.workspace.source import Folder, NodeSource, built_in_workspace, canonical
from robolink.workspace.trust import is_trusted, why_not

VARIABLE = "ROBOLINK_WORKSPACE"
"""Environment variable with the folder of the user's workspace."""
"""Group of the entry points of installed nodes."""
YAML = (".yaml", ".yml")
LAUNCHES = (*YAML, ".py", ".xml", ".launch")
"""Suffixes of launch files, robolink's own and those of ROS 2, which are found by their paths only."""
WORLDS = (*YAML, ".wbt")


def find_node(name: str, *, workspace: Folder = None) -> NodeSource:
    """Return the source of a node; the path in it is absolute.

    Args:
        name: Name of the node, `FILE`, `FILE:function`, `FILE:Class`, `PACKAGE EXECUTABLE`, or `PACKAGE::CLASS`, the
            C++ class of a component.
        workspace: Folder that serves as the user's workspace; None looks for it.

    Raises:
        NotFoundError: with the nearest name.
    """
    if "::" in name:
        return _component(name)
    file, attribute = _split(name)
    package, executable = two_words(name)
    if executable and not is_file(expanded(file)):
        return find_executable(package, executable, workspace=workspace)
    path = _as_path(file, workspace, (".py",))
    if path is not None:
        return NodeSource(path.stem, path, attribute)
    requested = canonical(file.removesuffix(".py"))
    for source in _node_sources(workspace):
        if canonical(source.name) == requested:
            return NodeSource(source.name, source.path, attribute)
    added = next((NODES.get(each) for each in NODES.added() if canonical(each) == requested), None)
    if added is not None:
        return added._replace(attribute=attribute or added.attribute)
    raise _no_node(file, workspace)


def _component(name: str) -> NodeSource:
    """Return the source of a component. Raises NotFoundError with the nearest name."""
    found = component(name)
    if found is None:
        package = name.partition("::")[0]
        known = components()
        raise NotFoundError("component", name, [each for each in known if each.startswith(f"{package}::")] or known)
    return found


def two_words(name: str) -> tuple[str, str]:
    """Split the `name` of a node that is a package and an executable; ('', '') for any other, as for a path.

    >>> two_words("turtlesim turtlesim_node"), two_words("my files/node.py")
    (('turtlesim', 'turtlesim_node'), ('', ''))
    """
    package, _, executable = name.partition(" ")
    is_path = any(each in name for each in "/\\")
    return ("", "") if is_path or not canonical(package).isidentifier() else (package, executable.strip())


def find_executable(package: str, name: str, *, workspace: Folder = None) -> NodeSource:
    """Return the source of an executable of a package: the user's own, or the counterpart of one of ROS 2's.

    Args:
        package: Name of the package.
        name: Name of the executable.
        workspace: Folder that serves as the user's workspace; None looks for it.

    Raises:
        NotFoundError: with the nearest name, or with what serves instead.
    """
    folder = find_package(package, workspace=workspace)
    source = executable_of(package, name, folder)
    if source is not None:
        return source
    error = lacking_executable(package, name, folder)
    if error is None and folder is not None:
        error = NotFoundError("executable", name, (), f"package {package}")
    raise error or NotFoundError("package", package, [*list_packages(workspace=workspace), *program_names()])


def find_package(name: str, *, workspace: Folder = None) -> Path | None:
    """Return the folder of a package; None if there is none of that name.

    Args:
        name: Name of the package.
        workspace: Folder that serves as the user's workspace; None looks for it.
    """
    known = list_packages(workspace=workspace)
    requested = canonical(name)
    return known.get(name) or next((known[each] for each in known if canonical(each) == requested), None)


def list_packages(*, workspace: Folder = None) -> dict[str, Path]:
    """Return all packages by name, each with its folder (see `robolink.workspace.packages`).

    `workspace` is a folder that serves as the user's workspace; None looks for it.
    """
    *own, built_in = _workspaces(workspace)
    found: dict[str, Path] = {}
    for folder in own:
        found.update({name: each for name, each in source_packages(folder).items() if name not in found})
        found.setdefault(folder.name, folder)
    found.setdefault(BUILT_IN, built_in)
    return found


def list_executables(*, workspace: Folder = None) -> dict[str, list[NodeSource]]:
    """Return the executables in the packages of the user's workspace: those that a package names, else all it has.

    `workspace` is a folder that serves as the user's workspace; None looks for it.
    """
    built_in = built_in_workspace()
    found = {}
    for package, folder in list_packages(workspace=workspace).items():
        named = [] if folder == built_in else named_executables(folder)
        if named:
            found[package] = named
    return found


def find_launch(name: str, *, workspace: Folder = None) -> Path:
    """Return the path of a launch file.

    Args:
        name: Name or path of the file.
        workspace: Folder that serves as the user's workspace; None looks for it.

    Raises:
        NotFoundError: with the nearest name.
    """
    path = _as_path(name, workspace, LAUNCHES)
    return path or _find_file("launch file", name, "configs", workspace, YAML)


def find_world(name: str, *, workspace: Folder = None) -> Path:
    """Return the path of a world file, ours or Webots'.

    Args:
        name: Name or path of the file.
        workspace: Folder that serves as the user's workspace; None looks for it.

    Raises:
        NotFoundError: with the nearest name.
    """
    return _find_file("world", name, "configs/worlds", workspace, WORLDS)


def find_faults(name: str, *, workspace: Folder = None) -> Path:
    """Return the path of a faults file.

    Args:
        name: Name or path of the file.
        workspace: Folder that serves as the user's workspace; None looks for it.

    Raises:
        NotFoundError: with the nearest name.
    """
    return _find_file("faults file", name, "configs/faults", workspace, YAML)


def list_nodes(*, workspace: Folder = None) -> list[NodeSource]:
    """Return the sources of all nodes, by name; shadowed ones are left out.

    `workspace` is a folder that serves as the user's workspace; None looks for it.
    """
    every = [*_node_sources(workspace), *NODES.usable().values()]
    return sorted(_unshadowed(every), key=lambda each: each.name)


def list_launches(*, workspace: Folder = None) -> list[Path]:
    """Return the paths of all launch files, by name.

    `workspace` is a folder that serves as the user's workspace; None looks for it.
    """
    return _list_files("configs", workspace, YAML)


def list_worlds(*, workspace: Folder = None) -> list[Path]:
    """Return the paths of all world files, by name.

    `workspace` is a folder that serves as the user's workspace; None looks for it.
    """
    return _list_files("configs/worlds", workspace, WORLDS)


def list_faults(*, workspace: Folder = None) -> list[Path]:
    """Return the paths of all faults files, by name.

    `workspace` is a folder that serves as the user's workspace; None looks for it.
    """
    return _list_files("configs/faults", workspace, YAML)


def user_workspace(workspace: Folder = None) -> Path | None:
    """Return the user's workspace: `workspace`, else that of ROBOLINK_WORKSPACE, the nearest, the sourced one, or None.

    Raises `NotFoundError` if one is named that is not a folder.
    """
    requested = workspace or os.environ.get(VARIABLE)
    if not requested:
        here = None
        with contextlib.suppress(FileNotFoundError):  # the working directory has been deleted
            here = workspace_of(Path.cwd())
        return here or _sourced_workspace()
    folder = expanded(requested)
    if not folder.is_dir():
        raise NotFoundError("workspace folder", str(requested))
    return folder.resolve()


def _sourced_workspace() -> Path | None:
    """Return the workspace whose `install/setup.bash` was sourced last; None if there is none."""
    first = os.environ.get(COLCON, "").partition(os.pathsep)[0]
    folder = Path(first).parent
    return folder.resolve() if first and _is_workspace(folder) else None


def workspace_of(path: Path) -> Path | None:
    """Return the nearest folder at or above `path` that is a workspace; None, with a warning, if it is not trusted."""
    path = path.resolve()
    above = (path, *path.parents)
    found = next((each for each in above if _is_workspace(each)), None) or _repository(above)
    return found if found is None or found == built_in_workspace() or is_trusted(found) else None


def _is_workspace(folder: Path) -> bool:
    # One of them alone means nothing: many a folder has a `configs/`. Any two: one with types may lack `configs/`.
    return sum((folder / part).is_dir() for part in PARTS) >= 2 or is_ros_workspace(folder)


def _repository(above: Sequence[Path]) -> Path | None:
    """Return the clone of a repository with packages at or above a path; else the package there, with those beside it.

    `above` are the path and its parents. A clone in which another package has the name of one here is not taken:
    courses have a copy of a package for each lesson.
    """
    package = next((each for each in above if (each / "package.xml").is_file()), None)
    clone = next((each for each in above if (each / ".git").exists()), None)
    here = package or above[0]
    if clone is not None and is_repository(clone) and (here == clone or not hides(clone, here)):
        return clone
    if package is not None:
        beside = package.parent
        return beside if has_packages(beside, but=package) and not why_not(beside) else package
    return here if is_repository(here) and not why_not(here) else None


def _workspaces(workspace: Folder) -> list[Path]:
    """Return the workspaces in the order in which they are searched; the built-in one comes last."""
    own = user_workspace(workspace)
    built_in = built_in_workspace()
    return [built_in] if own is None or own == built_in else [own, built_in]


def _split(name: str) -> tuple[str, str]:
    r"""Split `FILE:function`; the colon of `C:\nodes\a.py` separates nothing."""
    file, colon, attribute = name.rpartition(":")
    if colon and file and attribute.isidentifier() and not Path(name).exists():
        return file, attribute
    return name, ""


def _as_path(name: str, workspace: Folder, suffixes: tuple[str, ...]) -> Path | None:
    """Return the file of a path, from here or from the user's workspace; None for a mere name."""
    path = expanded(name)
    is_path = len(path.parts) > 1 or path.suffix in suffixes
    if not is_path:
        return None
    folders = [Path(), *_workspaces(workspace)]
    for candidate in (folder / path for folder in folders):
        if candidate.is_file():
            return candidate.resolve()
    if len(path.parts) > 1:
        raise NotFoundError("file", name, _files_beside(path))
    return None


def _files_beside(path: Path) -> Iterator[str]:
    return (str(each) for each in path.parent.glob("*") if each.is_file())


def _node_sources(workspace: Folder) -> Iterator[NodeSource]:
    """Yield the nodes of the workspaces in the order of the look-up."""
    for folder in _workspaces(workspace):
        yield from nodes_in(folder)


def _find_file(kind: str, name: str, inside: str, workspace: Folder, suffixes: tuple[str, ...]) -> Path:
    path = _as_path(name, workspace, suffixes)
    if path is not None:
        return path
    requested = canonical(Path(name).stem if Path(name).suffix in suffixes else name)
    for each in _files_in(inside, workspace, suffixes):
        if canonical(each.stem) == requested:
            return each
    known = [*(each.stem for each in _files_in(inside, workspace, suffixes)), *_file_names(workspace, suffixes)]
    raise _not_found(kind, name, workspace, known)


def _file_names(workspace: Folder, suffixes: tuple[str, ...]) -> Iterator[str]:
    """Yield the names that `_as_path` would have found."""
    for folder in (Path(), *_workspaces(workspace)):
        with contextlib.suppress(OSError):  # the working directory has been deleted, or may not be read
            yield from sorted(each.name for each in folder.iterdir() if each.suffix in suffixes)


def _list_files(inside: str, workspace: Folder, suffixes: tuple[str, ...]) -> list[Path]:
    first = {canonical(path.stem): path for path in reversed(list(_files_in(inside, workspace, suffixes)))}
    return sorted(first.values(), key=lambda each: each.stem)


def _files_in(inside: str, workspace: Folder, suffixes: tuple[str, ...]) -> Iterator[Path]:
    for folder in _workspaces(workspace):
        for suffix in suffixes:
            yield from sorted((folder / inside).glob(f"*{suffix}"))


def _unshadowed(sources: Iterable[NodeSource]) -> list[NodeSource]:
    first = {canonical(each.name): each for each in reversed(list(sources))}
    return list(first.values())


def _no_node(name: str, workspace: Folder) -> NotFoundError:
    known = [*(each.name for each in list_nodes(workspace=workspace)), *_file_names(workspace, (".py",))]
    error = _not_found("node", name, workspace, known)
    for package, found in list_executables(workspace=workspace).items():
        for each in found:
            if canonical(each.name) == canonical(name):
                error.args = (f"{error}; package {package} has one: '{package} {each.name}'",)
                return error
    return error


def _not_found(kind: str, name: str, workspace: Folder, known: Iterable[str]) -> NotFoundError:
    *own, _ = _workspaces(workspace)
    names = list(known)
    hidden = [each for each in (f"{name}.txt",) if name.endswith(".py") and is_file(Path(each))]
    if hidden or (not own and name.endswith(".py") and not nearest(name, names)):
        return NotFoundError(kind, name, hidden, str(Path.cwd()))  # another folder, or an ending that Windows hides
    return NotFoundError(kind, name, names, f"{own[0]} or robolink itself" if own else "")
