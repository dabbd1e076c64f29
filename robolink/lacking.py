"""Names that a module has not, or not yet: errors that say what is near, and packages that import what is used."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Collection, Iterable, Mapping
from types import FrameType, ModuleType
from typing import Any

from robolink.exceptions import RobolinkError, nearest


class LackingNameError(RobolinkError):
    """A name is asked for that is not there. The text is made when it is read: `hasattr` asks often and reads none."""

    def __init__(self, full: str, known: Callable[[], Iterable[str]], hint: str = "") -> None:
        self.full, self.known, self.hint = full, known, hint
        super().__init__(full)

    def __str__(self) -> str:
        near = "" if self.hint else nearest(self.full.rpartition(".")[2], self.known())
        return f"robolink {installed_version()} has no {self.full}{near}" + (f"; {self.hint}" if self.hint else "")


class LackingAttributeError(LackingNameError, AttributeError):
    """A module has no such attribute."""

    def __init__(self, full: str, known: Callable[[], Iterable[str]], hint: str = "") -> None:
        super().__init__(full, known, hint)
        self.name = full.rpartition(".")[2]  # with a name there, Python adds no suggestion of its own


class LackingImportError(LackingNameError, ImportError):
    """`from MODULE import NAME`, and the module has no such name."""


class LackingModuleError(LackingNameError, ModuleNotFoundError):
    """There is no such module."""

    def __init__(self, full: str, known: Callable[[], Iterable[str]], hint: str = "") -> None:
        super().__init__(full, known, hint)
        self.name = full


def lacking(
    module: str, name: str, known: Callable[[], Iterable[str]], asker: FrameType | None, hint: str = ""
) -> AttributeError | ImportError:
    """Give the error for a module's `__getattr__` to raise; `asker` is the frame that called it.

    Python drops the text of an AttributeError that answers `from MODULE import NAME`, so that gets an ImportError.
    """
    if name.startswith("__"):  # Python's own questions: nobody reads the answer
        return AttributeError(f"module '{module}' has no attribute '{name}'")
    if asker is not None and _imports_a_name(asker):
        return LackingImportError(f"{module}.{name}", known, hint)
    return LackingAttributeError(f"{module}.{name}", known, hint)


def _imports_a_name(frame: FrameType) -> bool:
    """Whether a frame is just at the part of a `from ... import` statement that takes one name."""
    from opcode import opmap

    return frame.f_lasti >= 0 and frame.f_code.co_code[frame.f_lasti] == opmap["IMPORT_FROM"]


def lazily(
    package: str, homes: Mapping[str, str], rooms: Collection[str]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Give the `__getattr__` and `__dir__` of a package whose names are imported when they are first used.

    `homes` says in which of its modules each name is; `rooms` are its modules that are there as attributes, too.
    """

    def get(name: str) -> Any:
        if name in rooms:
            return importlib.import_module(f"{package}.{name}")
        if name not in homes:
            raise lacking(package, name, lambda: [*homes, *rooms], sys._getframe(1))
        value = getattr(importlib.import_module(f"{package}.{homes[name]}"), name)
        setattr(sys.modules[package], name, value)
        return value

    return get, lambda: sorted({*vars(sys.modules[package]), *homes, *rooms})


def names_in(module: ModuleType) -> list[str]:
    """Give the public names of a module."""
    return [each for each in dir(module) if not each.startswith("_")]


def installed_version() -> str:
    """Give robolink's version; '(not installed)' where it is merely on the path."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("robolink")
    except PackageNotFoundError:
        return "(not installed)"
