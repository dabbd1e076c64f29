"""Sources of launch descriptions: files in Python, XML and YAML (`launch.launch_description_sources`)."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import ModuleType
from typing import Any

from robolink.companions.launch.bases import LaunchContext, LaunchDescriptionEntity, LaunchError, SomeSubstitutionsType
from robolink.companions.launch.launch_description import LaunchDescription
from robolink.companions.launch.utilities import normalize_to_list_of_substitutions, performed
from robolink.exceptions import nearest
from robolink.system.terminal import shown

__all__ = [
    "AnyLaunchDescriptionSource",
    "FrontendLaunchDescriptionSource",
    "InvalidLaunchFileError",
    "InvalidPythonLaunchFileError",
    "LaunchDescriptionSource",
    "LaunchFileNotFoundError",
    "PythonLaunchDescriptionSource",
    "read_launch_file",
    "read_python_file",
]

MAKER = "generate_launch_description"
"""Name of the function in a Python launch file."""

_FRONTEND = "robolink.companions.launch_frontend.build"
"""Module of the parser of XML and YAML, which is imported for such a file only: it needs all of the actions."""
_FRONTEND_SUFFIXES = (".xml", ".launch", ".yaml", ".yml")


class InvalidLaunchFileError(LaunchError):
    """A file is not a launch file, or one of a kind that cannot be read."""


class InvalidPythonLaunchFileError(InvalidLaunchFileError):
    """A Python file has no `generate_launch_description`, or one that returns something else."""


class LaunchFileNotFoundError(LaunchError, FileNotFoundError):
    """A launch file does not exist; `path` is where it should be."""

    def __init__(self, path: Path) -> None:
        beside = [each.name for each in path.parent.glob("*.launch.*")] if path.parent.is_dir() else []
        LaunchError.__init__(self, f"there is no launch file {shown(str(path), 300)}{nearest(path.name, beside)}")
        self.path = path


class LaunchDescriptionSource(LaunchDescriptionEntity):
    """Source of a launch description: a file, or a description as it is.

    Args:
        launch_description: The description; None reads it from the file.
        location: Path of the file.
        method: Description of how it is read.
    """

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType = "",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self._description, self.method = launch_description, method
        self._location = normalize_to_list_of_substitutions(location)
        self._path = ""

    @property
    def location(self) -> str:
        """Path of the file, once it is known; else the texts of its substitutions."""
        return self._path or "".join(getattr(each, "text", each.describe()) for each in self._location)

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """Return the description, read with the values of `context`. Raises LaunchError."""
        if self._description is None:
            self._path = performed(context, self._location)
            self._description = self._read(Path(self._path))
        return self._description

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """Return the description if its path needs no context, and if it can be read; else None."""
        try:
            return self.get_launch_description(LaunchContext())
        except Exception:  # noqa: BLE001 - the file is a program
            self._path = ""
            return None

    def _read(self, path: Path) -> LaunchDescription:
        return read_launch_file(path)


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """Launch file in Python.

    Args:
        launch_file_path: Path of the file.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(None, launch_file_path, "interpreted python launch file")

    def _read(self, path: Path) -> LaunchDescription:
        return read_python_file(path)


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """Launch file of any kind, by its suffix.

    Args:
        launch_file_path: Path of the file.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(None, launch_file_path, "launch file")


class FrontendLaunchDescriptionSource(LaunchDescriptionSource):
    """Launch file in XML or YAML.

    Args:
        launch_file_path: Path of the file.
        method: Description of how it is read.
        parser: Ignored; the suffix decides.
    """

    def __init__(
        self,
        launch_file_path: SomeSubstitutionsType,
        *,
        method: str = "interpreted frontend launch file",
        parser: Any = None,
    ) -> None:
        super().__init__(None, launch_file_path, method)


def read_launch_file(path: Path) -> LaunchDescription:
    """Read a launch file at `path` of any kind; raises LaunchError, and whatever a Python file raises."""
    if path.suffix == ".py":
        return read_python_file(path)
    if not path.is_file():
        raise LaunchFileNotFoundError(path)
    if path.suffix not in _FRONTEND_SUFFIXES:
        raise InvalidLaunchFileError(f"{path} is not a launch file: expected .py, {', '.join(_FRONTEND_SUFFIXES)}")
    parse: Callable[[Path], LaunchDescription] = importlib.import_module(_FRONTEND).parse
    return parse(path)


def read_python_file(path: Path) -> LaunchDescription:
    """Run a Python launch file at `path` and return its description; raises LaunchError and whatever it raises."""
    if not path.is_file():
        raise LaunchFileNotFoundError(path)
    module = _loaded(path)
    maker = getattr(module, MAKER, None)
    if maker is None:
        raise InvalidPythonLaunchFileError(f"{path}: it has no function {MAKER}(){_instead_of_maker(module)}")
    made = maker()
    if not isinstance(made, LaunchDescription):
        kind = type(made).__name__
        raise InvalidPythonLaunchFileError(f"{path}: {MAKER}() returned {kind}, and a LaunchDescription was expected")
    return made


def _instead_of_maker(module: ModuleType) -> str:
    if callable(getattr(module, "launch", None)):
        return ": launch(launch_descriptor, argv) is of ROS 2 before Bouncy (2018), and nodes are Node(...) actions now"
    if hasattr(module, "generate_test_description"):
        return f"; it is a launch test: pytest {Path(str(module.__file__)).name}"
    return "; a node is run by 'robolink run'"


def _loaded(path: Path) -> ModuleType:
    """Load a file as a module of its own: two packages may each have a `robot.launch.py`; no bytecode is kept."""
    name = f"launch file {path}"
    loader = SourceFileLoader(name, str(path))
    spec = spec_from_loader(name, loader)
    assert spec is not None
    module = module_from_spec(spec)
    keeps_none, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        loader.exec_module(module)
    finally:
        sys.dont_write_bytecode = keeps_none
    return module
