"""Share directory of a package in a workspace: what `get_package_share_directory` returns without a build.

Usually that is the package's own folder, since `launch/`, `config/` and `urdf/` lie there as they would be installed.
Where setup.py or CMakeLists.txt install files elsewhere or under another name, it is a folder of links to the package's
files, in which both its own layout and the installed one are found.
"""

from __future__ import annotations

import contextlib
import hashlib
import itertools
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import Any, TypeAlias

from robolink.system.files import expanded
from robolink.workspace.cmake_files import CMakeFile
from robolink.workspace.packages import package_name_of
from robolink.workspace.setup_files import data_files

HOME = "ROBOLINK_SHARE_DIR"
"""Environment variable with the folder of the folders of links; ~/.robolink/share by default."""
MOST = 2000
"""Upper bound of the files of a package that are installed elsewhere."""
DEEPEST = 12
"""Upper bound of folders within folders of such files."""

Tree: TypeAlias = "dict[str, Tree | Path]"
"""Files and folders to add to a folder, by their names."""


def share_directory(folder: Path) -> Path:
    """Return the share directory of the package in `folder`: `folder` itself, or a folder of links to its files.

    If the links cannot be made, a warning says so, and it is `folder`.
    """
    name = package_name_of(folder)
    added = dict(itertools.islice(_added(folder, name), MOST))
    if not added:
        return folder
    listed = "\n".join(f"{place} {source}" for place, source in sorted(added.items()))
    beside = "\n".join(sorted(each.name for each in folder.iterdir()))
    digest = hashlib.sha256(f"{folder}\n{listed}\n{beside}".encode("utf-8", "surrogateescape")).hexdigest()[:16]
    target = expanded(os.environ.get(HOME) or "~/.robolink/share") / digest / name
    try:
        if not target.is_dir():
            _make(target, folder, _tree(added))
    except OSError as error:
        from robolink.logging import get_logger  # late: hardly ever needed

        get_logger("robolink.workspace").warning(f"files that {name} installs elsewhere are not there: {error}")
        return folder
    return target


def _added(folder: Path, name: str) -> Iterator[tuple[str, Path]]:
    """Yield what is installed into share/NAME and not in the package's folder under that path: path and file."""
    for place, source in _installed(folder, name):
        if ".." not in PurePosixPath(place).parts:
            yield from _missing(folder, PurePosixPath(place), source, 0)


def _missing(folder: Path, place: PurePosixPath, source: Path, depth: int) -> Iterator[tuple[str, Path]]:
    here = folder / place
    if not here.exists():
        yield str(place), source
    elif here.is_dir() and source.is_dir() and depth < DEEPEST and not here.samefile(source):
        for each in sorted(source.iterdir()):
            yield from _missing(folder, place / each.name, each, depth + 1)


def _installed(folder: Path, name: str) -> Iterator[tuple[str, Path]]:
    """Yield the existing files and folders that a package installs into share/NAME: path below it, and source."""
    for place, files in data_files(folder):
        for each in files:
            yield from _below(place, PurePosixPath(each).name, folder / each, name)
    for install in CMakeFile(folder).installs:
        for each in install.sources if install.kind in ("FILES", "PROGRAMS", "DIRECTORY") else ():
            is_content = install.kind == "DIRECTORY" and each.endswith("/")
            as_name = "." if is_content else install.rename or PurePosixPath(each).name
            yield from _below(install.destination, as_name, folder / each, name)


def _below(destination: str, as_name: str, source: Path, package: str) -> Iterator[tuple[str, Path]]:
    parts = PurePosixPath(destination.replace("\\", "/")).parts
    with contextlib.suppress(OSError, ValueError):  # a name that is none
        if parts[:2] == ("share", package) and source.exists():
            yield PurePosixPath(*parts[2:], as_name).as_posix(), source.absolute()


def _tree(added: Mapping[str, Path]) -> Tree:
    tree: Tree = {}
    for place, source in added.items():
        *above, last = PurePosixPath(place).parts
        here = tree
        for each in above:
            below = here.setdefault(each, {})
            if isinstance(below, Path):
                break
            here = below
        else:
            here.setdefault(last, source)
    return tree


def _make(target: Path, folder: Path, tree: Tree) -> None:
    """Make the folder of links beside its place, and move it there, so that nobody sees half of it."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=target.parent, prefix=".", ignore_cleanup_errors=True) as made:
        _fill(Path(made, target.name), folder, tree)
        try:
            Path(made, target.name).rename(target)
        except OSError:
            if not target.is_dir():  # else another process was faster
                raise


def _fill(target: Path, folder: Path | None, tree: Tree) -> None:
    target.mkdir()
    own = {} if folder is None else {each.name: each for each in folder.iterdir()}
    for name, source in own.items():
        below = tree.get(name)
        if isinstance(below, dict) and source.is_dir():
            _fill(target / name, source, below)
        else:
            _link(source, target / name)
    for name, source_or_tree in tree.items():
        if name not in own:
            if isinstance(source_or_tree, Path):
                _link(source_or_tree, target / name)
            else:
                _fill(target / name, None, source_or_tree)


def _link(source: Path, target: Path) -> None:
    """Link a file or folder, by what the system and the user's rights allow; copy it where nothing is allowed."""
    ways: list[Callable[[Path, Path], Any]] = [lambda source, target: target.symlink_to(source, source.is_dir())]
    ways += [_junction, shutil.copytree] if source.is_dir() else [os.link, shutil.copy2]
    for way in ways[:-1]:
        with contextlib.suppress(OSError):
            way(source, target)
            return
    ways[-1](source, target)


def _junction(source: Path, target: Path) -> None:
    """Link a folder on Windows, where a symbolic link needs a right that few have."""
    try:
        import _winapi
    except ImportError:
        raise OSError("no junctions here") from None
    getattr(_winapi, "CreateJunction")(str(source), str(target))  # noqa: B009 - it is on Windows only
