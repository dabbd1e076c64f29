"""Resources: texts that packages have registered under a type and a name."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from robolink.companions.ament_index.constants import RESOURCE_INDEX_SUBFOLDER
from robolink.companions.ament_index.packages import get_packages_with_prefixes
from robolink.companions.ament_index.search_paths import get_search_paths
from robolink.exceptions import MessageError, NotFoundError
from robolink.interfaces import KINDS, names

PACKAGES, INTERFACES = "packages", "rosidl_interfaces"
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
        text = "\n".join(_types(resource_name)) if resource_type == INTERFACES else ""
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
    return {PACKAGES, INTERFACES, *(each.name for each in folders if each.is_dir())}


def has_resource(resource_type: str, resource_name: str) -> str | Literal[False]:
    """Return the prefix of a resource (`resource_type`, `resource_name`); False if there is none."""
    _check(resource_type, resource_name)
    return get_resources(resource_type).get(resource_name, False)


def _own(resource_type: str) -> dict[str, str]:
    """Return the resources that the packages of the workspace and robolink's own have without any index."""
    if resource_type == PACKAGES:
        return get_packages_with_prefixes()
    if resource_type == INTERFACES:
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
