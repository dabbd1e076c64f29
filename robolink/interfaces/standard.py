"""Standard types: classes made of the .msg, .srv and .action files beside this module, each when it is first used.

`robolink.interfaces.geometry_msgs.msg` is not a file: an import finder makes the module, and its attributes on demand
of `geometry_msgs/msg/*.msg`. A program pays for the types that it uses, and a package is added as data. The stubs
`geometry_msgs/msg/__init__.pyi`, made by tools/interface_stubs.py, are for type checkers.

Other packages add theirs, which are read and imported in the same way, by an entry point that leads to the folder:

    [project.entry-points."robolink.interfaces"]
    compass_msgs = "robolink_compass.compass_msgs"  # robolink_compass/compass_msgs/msg/Heading.msg
"""

from __future__ import annotations

import functools
import itertools
import os
import sys
import threading
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.exceptions import MessageError, NotFoundError, RobolinkError, nearest
from robolink.extensions import Registry, module_path

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

FOLDER = os.path.dirname(__file__)  # noqa: PTH120 - pathlib takes a node's start 3 ms
KINDS = ("msg", "srv", "action")
ROOT = "robolink.interfaces"

PARTS = ("Request", "Response", "Goal", "Result", "Feedback")

_made: dict[tuple[str, str, str], type[Any]] = {}
_making: list[str] = []
_homes: dict[tuple[str, str], Callable[[str], str]] = {}
_lock = threading.RLock()
"""Held while a class is made: two threads that use a type first must get one class."""


@functools.cache
def packages() -> tuple[str, ...]:
    """Return the names of the packages that come with robolink, sorted."""
    with os.scandir(FOLDER) as entries:
        return tuple(sorted(each.name for each in entries if each.is_dir() and not each.name.startswith("_")))


@functools.cache
def _own() -> dict[str, str]:
    return {package: f"{FOLDER}/{package}" for package in packages()}


def _folder(entry: EntryPoint) -> str:
    """Return the folder of a package of types that an entry point leads to."""
    if not entry.name.isidentifier():
        raise RobolinkError("a package of types has a name that programs can import, such as compass_msgs")
    folder = str(module_path(entry.value))
    if not any(_types_in(folder, kind) for kind in KINDS):
        raise RobolinkError(f"{folder} has no types, such as msg/NAME.msg")
    return folder


INTERFACES = Registry("robolink.interfaces", _own, _folder)
"""Registry of the packages of types: their folders, with `msg/`, `srv/` and `action/`, by name."""


def types_of(package: str, kind: str) -> tuple[str, ...]:
    """Return the names of a package's types of a kind, sorted; none where it has none.

    Args:
        package: Name of the package.
        kind: msg, srv or action.

    Raises:
        ExtensionError: If another package adds it, and it cannot be used.
    """
    folder = INTERFACES.get(package)
    return () if folder is None else _types_in(folder, kind)


@functools.cache
def _types_in(folder: str, kind: str) -> tuple[str, ...]:
    try:
        with os.scandir(f"{folder}/{kind}") as entries:
            return tuple(
                sorted(each.name.removesuffix(f".{kind}") for each in entries if each.name.endswith(f".{kind}"))
            )
    except OSError:
        return ()


def added_types(kind: str) -> dict[str, tuple[str, ...]]:
    """Return the types of a kind that other packages add: package to names; broken packages are left out."""
    folders = INTERFACES.usable() if INTERFACES.added() else {}
    return {package: _types_in(folder, kind) for package, folder in folders.items() if package not in packages()}


def standard_type(package: str, kind: str, short: str) -> type[Any] | None:
    """Return the class of a standard type; None if there is none of this name."""
    return _type(package, kind, short) if package in packages() else None


def added_type(package: str, kind: str, short: str) -> type[Any] | None:
    """Return the class of a type that another package adds; None if there is none of this name.

    Raises:
        ExtensionError: If the package cannot be used.
        MessageError: If the definition is wrong.
    """
    return None if package in packages() else _type(package, kind, short)


def _type(package: str, kind: str, short: str) -> type[Any] | None:
    found = _made.get((package, kind, short))
    if found is not None or short not in types_of(package, kind):
        return found
    with _lock:
        return _made.get((package, kind, short)) or _make(package, kind, short)


def _make(package: str, kind: str, short: str) -> type[Any]:
    from robolink.message.class_factory import deferred_service_class  # late: messages import this package

    folder = INTERFACES.get(package)
    assert folder is not None
    path = f"{folder}/{kind}/{short}.{kind}"
    if path in _making:
        raise MessageError(f"a message cannot contain itself: {path}")
    made: type[Any]
    if kind == "srv" and package in packages():
        made = deferred_service_class(f"{package}/{kind}/{short}", functools.partial(_complete, path))
    else:
        made = _built(path, package, kind, short)
    _place(made, package, kind, short)
    _made[package, kind, short] = made
    return made


def _text(path: str) -> str:
    with open(path, encoding="utf-8") as file:  # noqa: PTH123
        return file.read()


def _built(path: str, package: str, kind: str, short: str) -> type[Any]:
    from robolink.message.building import build
    from robolink.message.definition import parse

    _making.append(path)
    try:
        return build(parse(_text(path), f"{package}/{kind}/{short}", path), _nested)
    finally:
        _making.pop()


def _complete(path: str, service: type[Any]) -> None:
    """Make the messages of a service, unless another thread has done it meanwhile."""
    from robolink.message.class_factory import complete_service, is_deferred

    with _lock:
        if is_deferred(service):
            package, kind, short = service.__ros_type__.split("/")
            complete_service(service, _built(path, package, kind, short))


def _nested(type_name: str) -> type[Any]:
    """Return the class of a message within a message."""
    found = _type(*type_name.split("/"))
    if found is None:
        raise NotFoundError("message type", type_name, ())
    return found


def _known(type_name: str) -> type[Any] | None:
    package, kind, short = [*type_name.split("/"), "", ""][:3]
    return _made.get((package, kind, short))


class Stated(NamedTuple):
    """Properties of a standard type that are known without its fields."""

    type_hash: str
    """Its RIHS01 hash."""
    has_fixed_numbers: bool
    """True if it, or a message inside it, has a fixed number of numbers, for which its endpoints import numpy."""


HASHES = f"{FOLDER}/type_hashes.txt"
"""A line for each standard type: its name, its hash, and `numpy` for one with fixed numbers."""


def stated(cls: type[Any]) -> Stated | None:
    """Return the line of `HASHES` about a class; None for one that is not a standard type.

    To compute it, all that a type is made of is described and hashed, for which OpenSSL is loaded: 3.5 MB of a node's
    memory and a twentieth of its start.
    """
    type_name = str(cls.__ros_type__)
    if _known(type_name) is not cls or type_name.partition("/")[0] not in packages():
        return None
    with open(HASHES, "rb") as file:  # noqa: PTH123
        lines = file.read()  # not retained, nor decoded: that takes 40 us of the 55
    begin = lines.find(f"\n{type_name} ".encode())
    if begin < 0:
        return None
    _, type_hash, *more = lines[begin : lines.index(b"\n", begin + 1)].decode().split()
    return Stated(type_hash, "numpy" in more)


# Where they are


def set_home(package: str, kind: str, home: Callable[[str], str]) -> None:
    """Let the types of a module say that they are defined elsewhere: programs take a type's package from its module.

    Args:
        package: Name of the package.
        kind: msg, srv or action.
        home: Function from a type's name to the name of the module.
    """
    with _lock:
        _homes[package, kind] = home
        for (of, its_kind, short), each in _made.items():
            if (of, its_kind) == (package, kind):
                _place(each, package, kind, short)


def _place(made: Any, package: str, kind: str, short: str) -> None:
    home = _homes.get((package, kind))
    module = home(short) if home is not None else f"{ROOT}.{package}.{kind}"
    for each in (made, *(vars(made)[part] for part in PARTS if part in vars(made))):
        if isinstance(each, type):  # not what is deferred
            each.__module__ = module


class StandardFinder:
    """Finder of the modules of the standard packages, which are folders of data."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the spec of `robolink.interfaces.PACKAGE` or `robolink.interfaces.PACKAGE.KIND`; None for others."""
        if not fullname.startswith(f"{ROOT}."):
            return None
        package, _, kind = fullname[len(ROOT) + 1 :].partition(".")
        folder = INTERFACES.get(package)
        if folder is None or (kind and not _types_in(folder, kind)):
            return None
        spec = ModuleSpec(fullname, self, is_package=True)  # type: ignore[arg-type] # importlib.abc takes 2 ms to import
        spec.submodule_search_locations = [folder] if not kind else []
        return spec

    def create_module(self, _: ModuleSpec) -> None:
        """Leave it to Python to make an empty module."""

    def exec_module(self, module: ModuleType) -> None:
        """Fill a package with its README as docstring, or a module with its types, each made when it is first used."""
        package, _, kind = module.__name__[len(ROOT) + 1 :].partition(".")
        folder = INTERFACES.get(package)
        assert folder is not None
        module.__file__, readme = f"{folder}/{kind}".rstrip("/"), f"{folder}/README.md"
        if not kind:
            module.__doc__ = _text(readme) if os.path.isfile(readme) else _purpose(package, folder)  # noqa: PTH113
            return
        names = types_of(package, kind)
        vars(module)["__all__"] = list(names)
        module.__getattr__ = lambda name: _attribute(module, package, kind, name)  # type: ignore[method-assign]
        module.__dir__ = lambda: sorted({*vars(module), *names})  # type: ignore[method-assign]


def _purpose(package: str, folder: str) -> str:
    """Return the text about a package without a README: the comment at the head of its first type."""
    first = next(f"{folder}/{kind}/{short}.{kind}" for kind in KINDS for short in _types_in(folder, kind))
    lines = itertools.takewhile(lambda line: line.startswith("#"), _text(first).splitlines())
    return "\n".join([f"# {package}\n", *(line.removeprefix("#").strip() for line in lines)])


def _attribute(module: ModuleType, package: str, kind: str, name: str) -> Any:
    """Return a type of a module, or the part of one that pickle looks for: `SetBool_Request`."""
    short, _, part = name.partition("_")
    found: Any = None if name.startswith("_") else _type(package, kind, short)
    if found is not None and part:
        found = getattr(found, part) if part in vars(found) else None
    if found is None:
        raise AttributeError(f"module '{module.__name__}' has no attribute '{name}'{nearest(name, module.__all__)}")
    vars(module)[name] = found
    return found


sys.meta_path.insert(0, StandardFinder())  # first: Python takes a folder for a package, too
