"""Standard types: classes made of the .msg, .srv and .action files beside this module, each when it is first used.

`robolink.interfaces.geometry_msgs.msg` is not a file: an import finder makes the module, and its attributes on demand
of `geometry_msgs/msg/*.msg`. A program pays for the types that it uses, and a package is added as data. The stubs
`geometry_msgs/msg/__init__.pyi`, made by tools/interface_stubs.py, are for type checkers.
"""

from __future__ import annotations

import functools
import os
import sys
import threading
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any

from robolink.exceptions import NotFoundError, nearest

FOLDER = Path(__file__).parent
KINDS = ("msg", "srv", "action")
ROOT = "robolink.interfaces"

PARTS = ("Request", "Response", "Goal", "Result", "Feedback")

_made: dict[tuple[str, str, str], type[Any]] = {}
_homes: dict[tuple[str, str], Callable[[str], str]] = {}
_lock = threading.RLock()
"""Held while a class is made: two threads that use a type first must get one class."""


@functools.cache
def packages() -> tuple[str, ...]:
    """Return the names of the packages, sorted."""
    with os.scandir(FOLDER) as entries:
        return tuple(sorted(each.name for each in entries if each.is_dir() and not each.name.startswith("_")))


@functools.cache
def types_of(package: str, kind: str) -> tuple[str, ...]:
    """Return the names of a package's types of a kind, sorted; none where it has none.

    Args:
        package: Name of the package.
        kind: msg, srv or action.
    """
    try:
        with os.scandir(FOLDER / package / kind) as entries:
            return tuple(
                sorted(each.name.removesuffix(f".{kind}") for each in entries if each.name.endswith(f".{kind}"))
            )
    except OSError:
        return ()


def standard_type(package: str, kind: str, short: str) -> type[Any] | None:
    """Return the class of a standard type; None if there is none of this name."""
    found = _made.get((package, kind, short))
    if found is not None or package not in packages() or short not in types_of(package, kind):
        return found
    with _lock:
        return _made.get((package, kind, short)) or _make(package, kind, short)


def _make(package: str, kind: str, short: str) -> type[Any]:
    from robolink.message.building import build  # late: messages import this package
    from robolink.message.definition import parse

    path = FOLDER / package / kind / f"{short}.{kind}"
    made = build(parse(path.read_text(encoding="utf-8"), f"{package}/{kind}/{short}", str(path)), _nested)
    _place(made, package, kind, short)
    _made[package, kind, short] = made
    return made


def _nested(type_name: str) -> type[Any]:
    """Return the class of a message within a message."""
    found = standard_type(*type_name.split("/"))
    if found is None:
        raise NotFoundError("message type", type_name, ())
    return found


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
        if package not in packages() or (kind and not types_of(package, kind)):
            return None
        spec = ModuleSpec(fullname, self, is_package=True)  # type: ignore[arg-type] # importlib.abc takes 2 ms to import
        spec.submodule_search_locations = [str(FOLDER / package)] if not kind else []
        return spec

    def create_module(self, _: ModuleSpec) -> None:
        """Leave it to Python to make an empty module."""

    def exec_module(self, module: ModuleType) -> None:
        """Fill a package with its README as docstring, or a module with its types, each made when it is first used."""
        package, _, kind = module.__name__[len(ROOT) + 1 :].partition(".")
        module.__file__ = str(FOLDER / package / kind)
        if not kind:
            module.__doc__ = (FOLDER / package / "README.md").read_text(encoding="utf-8")
            return
        names = types_of(package, kind)
        vars(module)["__all__"] = list(names)
        module.__getattr__ = lambda name: _attribute(module, package, kind, name)  # type: ignore[method-assign]
        module.__dir__ = lambda: sorted({*vars(module), *names})  # type: ignore[method-assign]


def _attribute(module: ModuleType, package: str, kind: str, name: str) -> Any:
    """Return a type of a module, or the part of one that pickle looks for: `SetBool_Request`."""
    short, _, part = name.partition("_")
    found: Any = None if name.startswith("_") else standard_type(package, kind, short)
    if found is not None and part:
        found = vars(found).get(part)
    if found is None:
        raise AttributeError(f"module '{module.__name__}' has no attribute '{name}'{nearest(name, module.__all__)}")
    vars(module)[name] = found
    return found


sys.meta_path.insert(0, StandardFinder())  # first: Python takes a folder for a package, too
