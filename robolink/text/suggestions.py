"""Lazy imports of a package's names, and errors with suggestions for names that a module does not have."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Collection, Iterable, Mapping
from types import FrameType, ModuleType
from typing import Any

from robolink.exceptions import RobolinkError, nearest


class LackingNameError(RobolinkError):
    """A missing name. The text is built when it is read, since `hasattr` raises often and reads none."""

    def __init__(self, full: str, known: Callable[[], Iterable[str]], hint: str = "") -> None:
        self.full, self.known, self.hint = full, known, hint
        super().__init__(full)

    def __str__(self) -> str:
        from robolink.text.advice import home_of  # late: most programs lack no name

        module, _, name = self.full.rpartition(".")
        statement = "" if self.hint else home_of(name, module)
        hint = self.hint or (f"write `{statement}`" if statement else "")
        near = "" if hint else nearest(name, self.known())
        return f"robolink {installed_version()} has no {self.full}{near}" + (f"; {hint}" if hint else "")


class LackingAttributeError(LackingNameError, AttributeError):
    """A module does not have this attribute."""

    def __init__(self, full: str, known: Callable[[], Iterable[str]], hint: str = "") -> None:
        super().__init__(full, known, hint)
        self.name = full.rpartition(".")[2]  # with a name there, Python adds no suggestion of its own


class LackingImportError(LackingNameError, ImportError):
    """`from MODULE import NAME` of a name that the module does not have."""


class LackingModuleError(LackingNameError, ModuleNotFoundError):
    """A module that does not exist."""

    def __init__(self, full: str, known: Callable[[], Iterable[str]], hint: str = "") -> None:
        super().__init__(full, known, hint)
        self.name = full


def lacking(
    module: str, name: str, known: Callable[[], Iterable[str]], asker: FrameType | None, hint: str = ""
) -> AttributeError | ImportError:
    """Return the error for a module's `__getattr__` to raise; `asker` is the frame that called it.

    Python drops the text of an AttributeError in `from MODULE import NAME`, so that statement gets an ImportError.
    """
    if name.startswith("__"):  # Python's own questions: nobody reads the answer
        return AttributeError(f"module '{module}' has no attribute '{name}'")
    if asker is not None and imports_a_name(asker):
        return LackingImportError(f"{module}.{name}", known, hint)
    return LackingAttributeError(f"{module}.{name}", known, hint)


def imports_a_name(frame: FrameType) -> bool:
    """True if a frame is just importing one name in a `from ... import` statement."""
    from opcode import opmap

    return frame.f_lasti >= 0 and frame.f_code.co_code[frame.f_lasti] == opmap["IMPORT_FROM"]


def lazily(
    package: str, homes: Mapping[str, str], rooms: Collection[str], within: str = ""
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return the `__getattr__` and `__dir__` of a package or module whose names are imported at their first use.

    `homes` has the module of each name; `rooms` are the modules that are available as attributes, too. They are in the
    package `within`, by default in `package` itself.
    """
    within = within or package

    def get(name: str) -> Any:
        if name in rooms:
            return importlib.import_module(f"{within}.{name}")
        if name not in homes:
            raise lacking(package, name, lambda: [*homes, *rooms], sys._getframe(1))
        value = getattr(importlib.import_module(f"{within}.{homes[name]}"), name)
        setattr(sys.modules[package], name, value)
        return value

    return get, lambda: sorted({*vars(sys.modules[package]), *homes, *rooms})


def names_in(module: ModuleType) -> list[str]:
    """Return the public names of a module."""
    return [each for each in dir(module) if not each.startswith("_")]


def installed_version() -> str:
    """Return robolink's version; '(not installed)' where it is only on the path."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("robolink")
    except PackageNotFoundError:
        return "(not installed)"
