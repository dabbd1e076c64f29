"""Components that packages offer: nodes in Python that a container can load, and those in C++ that were installed."""

from __future__ import annotations

from collections.abc import Iterator

from robolink.companions.ament_index import (
    get_package_prefix,
    get_packages_with_prefixes,
    get_resource,
    get_resources,
)
from robolink.workspace import (
    NodeLoadError,
    NodeSource,
    find_package,
    named_executables,
    own_process_needed,
    sources_of,
)

RESOURCE = "rclcpp_components"
"""Type of the resource by which packages in C++ register theirs, a line ``TYPE;LIBRARY`` for each."""


def offered(package: str = "") -> Iterator[tuple[str, list[str]]]:
    """Yield the packages that offer components, by name, with these; only `package`, if one is named.

    Raises PackageNotFoundError for a package that is not there.
    """
    if package:
        get_package_prefix(package)  # raises
    registered = get_resources(RESOURCE)
    for name in [package] if package else sorted(get_packages_with_prefixes()):
        found = [each for source in _sources(name) for each in _in_python(source)]
        if name in registered:
            lines = get_resource(RESOURCE, name)[0].splitlines()
            found += [each.partition(";")[0] for each in lines if each]
        if found:
            yield name, sorted(found)


def _sources(package: str) -> list[NodeSource]:
    folder = find_package(package)
    own = [] if folder is None else named_executables(folder)
    return [*own, *sources_of(package).values()]


def _in_python(source: NodeSource) -> Iterator[str]:
    """Yield the name of an executable that is a Node class: only such a one can share a process."""
    try:
        if not own_process_needed(source):
            yield source.name
    except NodeLoadError:  # a file with a mistake
        return
