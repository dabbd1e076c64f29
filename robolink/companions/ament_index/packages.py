"""Packages by name, and their folders."""

from __future__ import annotations

import contextlib
import os
import re
import warnings
from collections.abc import Iterator
from contextvars import ContextVar
from pathlib import Path

from robolink.companions.ament_index.search_paths import get_search_paths
from robolink.exceptions import MessageError, NotFoundError
from robolink.interfaces.standard import FOLDER, INTERFACES
from robolink.workspace.find import find_package, list_packages
from robolink.workspace.installed import installed_packages
from robolink.workspace.programs import program_folder, program_names
from robolink.workspace.ros_programs import instead_of
from robolink.workspace.share import share_directory

NOT_HERE = Path(os.path.abspath(os.sep)) / "package-not-here"  # noqa: PTH100 - on Windows with its drive
"""Folder, which does not exist, of packages that are not here, while `packages_may_lack`."""
_may_lack: ContextVar[bool] = ContextVar("packages may lack", default=False)

_OF_TYPES = re.compile(r"_(msgs|interfaces|srvs|actions)$")
_NAME = re.compile(r"[a-zA-Z0-9][a-zA-Z0-9_-]+", re.ASCII)


class PackageNotFoundError(NotFoundError, KeyError):
    """There is no package of this name; the text has the nearest name and the folders that were searched."""

    __str__ = Exception.__str__  # KeyError shows its text in quotes


class PackageNameError(MessageError):
    """A text that cannot be a package's name."""


def get_packages_with_prefixes() -> dict[str, str]:
    """Return all packages: name to prefix (see `get_package_prefix`)."""
    folders = {**INTERFACES.usable(), **_counterparts(), **list_packages()}
    return {**installed_packages(), **{name: str(folder) for name, folder in folders.items()}}


def get_package_prefix(package_name: str) -> str:
    """Return the folder into which the package `package_name` is installed; its own folder if it was never built.

    Raises PackageNotFoundError (a KeyError), and PackageNameError (a ValueError) for an invalid name.
    """
    folder = _folder(package_name)
    return str(folder) if folder is not None else installed_packages()[package_name]


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:
    """Return the folder of a package's files: the package's own (see `robolink.companions.ament_index`).

    Where the package installs files elsewhere, it is a folder of links to its files (`robolink.workspace.share`). Of a
    package that was built and installed it is PREFIX/share/NAME.

    Args:
        package_name: Name of the package.
        print_warning: True warns if the folder of an installed package does not exist.

    Raises:
        PackageNotFoundError: (a KeyError) if there is no such package.
        PackageNameError: (a ValueError) if the name is invalid.
    """
    folder = _folder(package_name)
    if folder is not None:
        return str(share_directory(folder))
    path = Path(installed_packages()[package_name]) / "share" / package_name
    if print_warning and not path.exists():
        warnings.warn(f"the share directory of {package_name}, {path}, does not exist", stacklevel=2)
    return str(path)


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:
    """Return the folder of a package's files as a Path; see `get_package_share_directory`.

    Args:
        package_name: Name of the package.
        print_warning: True warns if the folder of an installed package does not exist.
    """
    return Path(get_package_share_directory(package_name, print_warning))


@contextlib.contextmanager
def packages_may_lack() -> Iterator[None]:
    """Let packages that are not here have folders below `NOT_HERE` while the block runs, which do not exist either.

    A launch file asks for the folders of all its packages first, also of those whose nodes it may do without.
    """
    token = _may_lack.set(True)
    try:
        yield
    finally:
        _may_lack.reset(token)


def package_not_here(path: str) -> str:
    """Return the package of a folder or file, `path`, that is not here; '' for any other.

    That is one below `NOT_HERE`, or a file that a package lacks of which robolink has the types alone.
    """
    for root in (NOT_HERE, FOLDER):
        parts = Path(path).parts
        is_inside = parts[: len(root.parts)] == root.parts and len(parts) > len(root.parts)
        if is_inside and not Path(path).exists():
            return parts[len(root.parts)]
    return ""


def _folder(name: str) -> Path | None:
    """Return the folder of a package that was not installed; None for one that was. Raises if there is none."""
    if _NAME.fullmatch(name) is None:
        raise PackageNameError(f"'{name}' is not a valid package name")
    found = find_package(name) or _counterparts().get(name)
    if found is None and (_OF_TYPES.search(name) or instead_of(name) is None):
        found = INTERFACES.get(name)  # of slam_toolbox and the like robolink has the types, and no files
    if found is None and name not in installed_packages():
        if _may_lack.get():
            return NOT_HERE / name
        where = [str(each) for each in dict.fromkeys(list_packages().values())][:3]
        raise PackageNotFoundError(
            "package", name, get_packages_with_prefixes(), ", ".join([*where, *get_search_paths()])
        )
    return found


def _counterparts() -> dict[str, Path]:
    """Return the ROS packages that have counterparts here, each with the folder of these."""
    return {package: folder for package in program_names() if (folder := program_folder(package)) is not None}
