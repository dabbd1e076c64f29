"""Registries: each a table of what comes with robolink, and a group of entry points by which other packages add to it.

    [project.entry-points."robolink.commands"]
    hello = "my_package.hello:app"            # robolink hello
    "topic.nodes" = "my_package.nodes:nodes"  # robolink topic nodes

    [project.entry-points."robolink.programs"]
    "my_robot.drive" = "my_package.drive:Drive"  # robolink run my_robot drive

There are six: commands, programs, sensors, interfaces, nodes and networks. docs/reference/extensions.md says how to
write one.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from robolink.exceptions import NotFoundError, RobolinkError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint
    from pathlib import Path

T = TypeVar("T")


REGISTRIES = {
    "robolink.commands": "robolink.cli.shared.commands:COMMANDS",
    "robolink.programs": "robolink.workspace.programs:PROGRAMS",
    "robolink.sensors": "robolink.sim.sensors:SENSORS",
    "robolink.interfaces": "robolink.interfaces.standard:INTERFACES",
    "robolink.nodes": "robolink.workspace.programs:NODES",
    "robolink.networks": "robolink.networks.kinds:NETWORKS",
}
"""Places of the registries, by group: each is in the room of its kind, and imported when it is used."""


class ExtensionError(RobolinkError, ImportError):
    """An entry point that cannot be used; the text names the package, the entry point, the group and the reason."""


class Registry(Generic[T]):
    """Parts of one kind by name: those in the table of robolink itself, then those that other packages add.

    Reading the entry points of an environment takes some ten milliseconds, so none are read for a name in the table.
    """

    def __init__(
        self,
        group: str,
        table: Callable[[], Mapping[str, T]],
        read: Callable[[EntryPoint], T] | None = None,
        owns: Callable[[str], bool] | None = None,
    ) -> None:
        """Make a registry; nothing is read yet.

        Args:
            group: Group of the entry points, such as robolink.sensors.
            table: Function that returns robolink's own parts, by name.
            read: Function that makes a part of an entry point, and raises if it is not one; by default it is imported.
            owns: Function that returns whether robolink itself has a part of this name; by default those of the table.
        """
        self.group, self.table = group, table
        self._read = read or (lambda entry: entry.load())
        self._owns = owns or (lambda name: name in self.table())

    def names(self) -> list[str]:
        """Return the names of all parts, robolink's own first."""
        return list(dict.fromkeys([*self.table(), *self.added()]))

    def added(self) -> Mapping[str, EntryPoint]:
        """Return the entry points of other packages by name; of two with one name, the first by its package's name."""
        return {name: entries[0] for name, entries in self._entries().items()}

    def get(self, name: str) -> T | None:
        """Return the part of a name; None if there is none.

        Args:
            name: Name of the part. What comes with robolink goes first.

        Raises:
            ExtensionError: If another package adds it, and it cannot be used.
        """
        table = self.table()
        if name in table:
            return table[name]
        entry = self.added().get(name)
        return None if entry is None else self.read(entry)

    def read(self, entry: EntryPoint) -> T:
        """Return the part that an entry point adds.

        Args:
            entry: An entry point of the group.

        Raises:
            ExtensionError: If it cannot be used.
        """
        try:
            return self._read(entry)
        except (Exception, SystemExit) as error:  # another package's code may raise anything, and even leave
            reason = str(error) if isinstance(error, RobolinkError) else f"{type(error).__name__}: {error}"
            place = f"{_package(entry)} adds '{entry.name}' ({self.group}), which cannot be loaded from {entry.value}"
            raise ExtensionError(f"{place}: {' '.join(reason.split())}") from error

    def usable(self) -> dict[str, T]:
        """Return all parts by name, but for those of other packages that cannot be used."""
        found = dict(self.table())
        for name, entry in self.added().items():
            with contextlib.suppress(ExtensionError):  # one broken package must not break what lists them all
                found.setdefault(name, self.read(entry))
        return found

    def of(self, package: str) -> list[str]:
        """Return the names of the parts that an installed package adds.

        Args:
            package: Name of the distribution; `-` and `_` are the same.
        """
        expected = _canonical(package)
        return [name for name, found in self._entries().items() if expected in (_canonical(_package(e)) for e in found)]

    def problems(self) -> Iterator[str]:
        """Yield the problems with the parts of other packages, one line each: broken ones, and names given twice."""
        for name, entries in self._entries().items():
            for each in entries:
                try:
                    self.read(each)
                except ExtensionError as error:
                    yield str(error)
            takers = ["robolink", *map(_package, entries)] if self._owns(name) else [*map(_package, entries)]
            for taker in takers[1:]:
                yield f"{taker} adds '{name}' ({self.group}), which {takers[0]} has: that one is taken"

    def _entries(self) -> Mapping[str, list[EntryPoint]]:
        return _entry_points(self.group, tuple(sys.path))


@functools.lru_cache(maxsize=16)
def _entry_points(group: str, _path: tuple[str, ...]) -> Mapping[str, list[EntryPoint]]:
    """Return the entry points of a group by name, in the order of the names.

    `_path` is `sys.path`: tests and notebooks add folders while they run.
    """
    if not _may_have(group):
        return {}
    from importlib.metadata import entry_points  # late: it takes 10 ms to import, and most commands need none

    found: dict[str, list[EntryPoint]] = {}
    for each in sorted(entry_points(group=group), key=lambda each: (each.name, _package(each))):
        found.setdefault(each.name, []).append(each)
    return found


def _may_have(group: str) -> bool:
    """Return whether an installed package may have entry points of a group: a look at the files, in 2 ms.

    What `importlib.metadata` reads beside folders, such as zip files, counts as such a package.
    """
    heading = f"[{group}]".encode()
    for folder in dict.fromkeys(sys.path):
        try:
            with os.scandir(folder or ".") as found:
                packages = [each.path for each in found if each.name.endswith((".dist-info", ".egg-info"))]
        except NotADirectoryError:
            return True
        except OSError:  # it is not there
            continue
        for package in packages:
            with contextlib.suppress(OSError), open(f"{package}/entry_points.txt", "rb") as file:  # noqa: PTH123
                if heading in file.read():
                    return True
    return False


def registries() -> dict[str, Registry[Any]]:
    """Return all registries by group."""
    places = {group: place.split(":") for group, place in REGISTRIES.items()}
    return {group: getattr(importlib.import_module(module), name) for group, (module, name) in places.items()}


def module_path(module: str) -> Path:
    """Return the file of a module, or the folder of a package or of data; nothing is imported.

    Args:
        module: Dotted name.

    Raises:
        NotFoundError: If its first part is not installed.
    """
    from pathlib import Path  # late: most programs look at no package, and it takes their start 3 ms

    top, *inner = module.split(".")
    # Robolink's own finders ask the registries for names that nobody has: they would come back here.
    finders = (each for each in sys.meta_path if not str(each.__module__).startswith("robolink."))
    spec = next(filter(None, (each.find_spec(top, None) for each in finders)), None)
    if spec is None or (spec.origin is None and not spec.submodule_search_locations):
        raise NotFoundError("module", top)
    if not spec.submodule_search_locations:
        return Path(str(spec.origin))
    place = Path(next(iter(spec.submodule_search_locations)), *inner)
    return place if place.is_dir() else place.with_suffix(".py")


def _package(entry: EntryPoint) -> str:
    return entry.dist.name if entry.dist is not None else "a package"


def _canonical(package: str) -> str:
    return package.replace("_", "-").lower()
