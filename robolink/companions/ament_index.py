"""Index of packages and their folders: the API of ROS 2's ament_index_python.

A package is what `robolink run PACKAGE EXECUTABLE` takes for one (see `robolink.workspace.packages`): a folder below
the `src/` of the workspace, the workspace itself by its folder's name, `robolink`. Nothing is built or installed, so
the **share directory of a package is its own folder**: `launch/`, `config/` and `urdf/` lie there as they would after
`setup.py` has copied them to share/PACKAGE. Where it gives them other names or places, it is a folder of links that has
both (see `robolink.workspace.share`). A package that has only types, such as geometry_msgs, has the folder of its
module. After these, the folders of AMENT_PREFIX_PATH are searched, as in ROS 2.
"""

from __future__ import annotations

import contextlib
import os
import re
import warnings
from collections.abc import Iterator
from contextvars import ContextVar
from pathlib import Path
from typing import Literal

from robolink.exceptions import MessageError, NotFoundError
from robolink.interfaces import KINDS, names
from robolink.interfaces.standard import FOLDER, INTERFACES
from robolink.workspace.find import find_package, list_packages
from robolink.workspace.installed import installed_packages, prefixes
from robolink.workspace.programs import launched_packages, program_folder, program_names
from robolink.workspace.ros_programs import instead_of
from robolink.workspace.share import share_directory

__all__ = [
    "InvalidResourceNameError",
    "InvalidResourceTypeNameError",
    "PackageNotFoundError",
    "RESOURCE_INDEX_SUBFOLDER",
    "get_package_prefix",
    "get_package_share_directory",
    "get_package_share_path",
    "get_packages_with_prefixes",
    "get_resource",
    "get_resource_types",
    "get_resources",
    "get_search_paths",
    "has_resource",
]


def get_search_paths() -> list[str]:
    """Return the existing folders in AMENT_PREFIX_PATH, and those of COLCON_PREFIX_PATH; none if neither is set.

    ROS 2 raises an error then; here packages are found without it.
    """
    return prefixes()


RESOURCE_INDEX_SUBFOLDER = "share/ament_index/resource_index"
AMENT_PREFIX_PATH_ENV_VAR = "AMENT_PREFIX_PATH"


_PACKAGES, _TYPES = "packages", "rosidl_interfaces"
"""Types of the resources that exist without any index."""


class InvalidResourceTypeNameError(MessageError):
    """A resource type whose name has a path separator."""


class InvalidResourceNameError(MessageError):
    """A resource whose name has a path separator."""


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """Return the text of a resource and the prefix of its package.

    Args:
        resource_type: Type of the resource, such as ``packages``.
        resource_name: Name of the resource.

    Raises:
        NotFoundError: (a LookupError) if there is none.
        InvalidResourceTypeNameError: if the type has a path separator.
        InvalidResourceNameError: if the name has a path separator.
    """
    _check(resource_type, resource_name)
    own = _own(resource_type)
    if resource_name in own:
        text = "\n".join(_types(resource_name)) if resource_type == _TYPES else ""
        return text, own[resource_name]
    for prefix in get_search_paths():
        file = Path(prefix) / RESOURCE_INDEX_SUBFOLDER / resource_type / resource_name
        if file.is_file():
            return file.read_text(encoding="utf-8"), prefix
    raise NotFoundError(f"resource of type '{resource_type}'", resource_name, get_resources(resource_type))


def get_resources(resource_type: str) -> dict[str, str]:
    """Return all resources of the type `resource_type`: name to prefix."""
    _check(resource_type, "any")
    found = dict(_own(resource_type))
    for prefix in get_search_paths():
        for each in _listed(Path(prefix) / RESOURCE_INDEX_SUBFOLDER / resource_type):
            if each.is_file():
                found.setdefault(each.name, prefix)
    return found


def get_resource_types() -> set[str]:
    """Return the types of all resources."""
    folders = (each for prefix in get_search_paths() for each in _listed(Path(prefix) / RESOURCE_INDEX_SUBFOLDER))
    return {_PACKAGES, _TYPES, *(each.name for each in folders if each.is_dir())}


def has_resource(resource_type: str, resource_name: str) -> str | Literal[False]:
    """Return the prefix of a resource (`resource_type`, `resource_name`); False if there is none."""
    _check(resource_type, resource_name)
    return get_resources(resource_type).get(resource_name, False)


def _own(resource_type: str) -> dict[str, str]:
    """Return the resources that the packages of the workspace and robolink's own have without any index."""
    if resource_type == _PACKAGES:
        return get_packages_with_prefixes()
    if resource_type == _TYPES:
        prefixes = get_packages_with_prefixes()
        with_types = {name.partition("/")[0] for kind in KINDS for name in names(kind)}
        return {package: prefixes[package] for package in sorted(with_types) if package in prefixes}
    return {}


def _types(package: str) -> list[str]:
    start = f"{package}/"
    return [f"{name.removeprefix(start)}.{kind}" for kind in KINDS for name in names(kind) if name.startswith(start)]


def _listed(folder: Path) -> list[Path]:
    return sorted(each for each in folder.iterdir() if not each.name.startswith(".")) if folder.is_dir() else []


def _check(resource_type: str, resource_name: str) -> None:
    assert resource_type, "The resource type must not be empty"
    assert resource_name, "The resource name must not be empty"
    if "/" in resource_type or "\\" in resource_type:
        raise InvalidResourceTypeNameError(f"Resource type '{resource_type}' is invalid")
    if "/" in resource_name or "\\" in resource_name:
        raise InvalidResourceNameError(f"Resource name '{resource_name}' is invalid")


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
    for root in (NOT_HERE, Path(FOLDER)):
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
        folder = INTERFACES.get(name)  # of slam_toolbox and the like robolink has the types, and no files
        found = None if folder is None else Path(folder)
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
    names = {*program_names(), *launched_packages()}
    return {package: folder for package in sorted(names) if (folder := program_folder(package)) is not None}
