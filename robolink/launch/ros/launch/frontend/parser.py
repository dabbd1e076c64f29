"""Parser of launch files in a language of elements, such as XML."""

from __future__ import annotations

import importlib.metadata as importlib_metadata
import os
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any, TypeAlias

from robolink.exceptions import DocumentError, RobolinkError
from robolink.launch.ros.launch.bases import Action, Substitution
from robolink.launch.ros.launch.frontend.entity import Entity
from robolink.launch.ros.launch.frontend.expose import add_own, instantiate_action
from robolink.launch.ros.launch.frontend.parse_substitution import (
    parse_if_substitutions,
    parse_substitution,
    unescaped,
)
from robolink.launch.ros.launch.registry import registered
from robolink.launch.ros.launch.sources import InvalidLaunchFileError, LaunchDescription
from robolink.system.terminal import shown
from robolink.workspace import VARIABLE

__all__ = [
    "InvalidFrontendLaunchFileError",
    "Parser",
]

SomeFile: TypeAlias = "str | bytes | os.PathLike[str] | IO[str]"
"""Path of a file, or a file that is open."""
EXTENSIONS, PARSERS = "launch.frontend.launch_extension", "launch.frontend.parser"
"""Groups of entry points: modules that expose actions and substitutions, and parsers of other languages."""


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """A file is not a launch file in any language that there is a parser of."""


class Parser:
    """Parser of launch files, which makes actions of the elements in them; each language has a subclass."""

    extensions_loaded = False
    frontend_parsers: dict[str, type[Parser]] | None = None
    _workspaces: set[str] = set()

    @classmethod
    def load_launch_extensions(cls) -> None:
        """Import what exposes actions and substitutions, once: the entry points `launch.frontend.launch_extension`.

        They are those of installed packages, and of the packages in the workspace that a launch file is in.
        """
        add_own()
        if not Parser.extensions_loaded:
            Parser.extensions_loaded = True
            for each in importlib_metadata.entry_points(group=EXTENSIONS):
                _loaded(each, "launch")
        home = os.environ.get(VARIABLE, "")
        if home and home not in cls._workspaces:
            cls._workspaces.add(home)
            for module in _modules_in(Path(home)):
                _loaded(importlib_metadata.EntryPoint(module, module, EXTENSIONS), "launch")

    @classmethod
    def load_parser_implementations(cls) -> None:
        """Import the parsers, once: of XML and YAML, and the entry points `launch.frontend.parser`."""
        if Parser.frontend_parsers is None:
            others = {each.name: _loaded(each, "parser") for each in importlib_metadata.entry_points(group=PARSERS)}
            found = {name: each for name, each in others.items() if each is not None}
            own = {"xml": registered("parser of xml"), "yaml": registered("parser of yaml")}
            Parser.frontend_parsers = dict(sorted({**found, **own}.items()))

    def parse_action(self, entity: Entity) -> Action:
        """Return the action that `entity` stands for. Raises DocumentError for a mistake, at its place."""
        return instantiate_action(entity, self)

    def parse_substitution(self, value: str) -> list[Substitution]:
        """Return the substitutions in a text, `value`. Raises LaunchError."""
        return parse_substitution(value)

    def parse_if_substitutions(self, value: Any) -> Any:
        """Return `value` with the substitutions in its texts, as the function of this name does."""
        return parse_if_substitutions(value)

    def escape_characters(self, value: str) -> str:
        """Return a text, `value`, without its backslashes: each stands for the letter behind it."""
        return unescaped(value)

    def parse_description(self, entity: Entity) -> LaunchDescription:
        """Return the launch description that the outermost element, `entity`, stands for.

        Attributes that it does not have are ignored, with a line for people as in `robolink launch`.

        Raises DocumentError for a mistake, at its place.
        """
        from robolink.launch.ros.launch.actions import LogInfo

        if entity.type_name != "launch":
            raise DocumentError("a launch file begins with <launch>", entity.place.file, entity.place.line)
        reason = entity.get_attr("deprecated", optional=True)
        entity.get_attr("version", optional=True)
        actions = [self.parse_action(each) for each in entity.children]
        ignored: list[str] = entity.unread() if hasattr(entity, "unread") else []
        where = f"{Path(entity.place.file).name}:{entity.place.line}"
        said = [f"{where}: launch has no attribute '{shown(each)}': it is ignored" for each in ignored]
        return LaunchDescription([*(LogInfo(msg=each) for each in said), *actions], deprecated_reason=reason)

    @classmethod
    def get_available_extensions(cls) -> list[str]:
        """Return the names of the parsers."""
        return list(cls._parsers())

    @classmethod
    def is_extension_valid(cls, extension: str) -> bool:
        """Return whether a parser is called `extension`; deprecated, as in ROS 2."""
        warnings.warn("is_extension_valid() is deprecated: use is_filename_valid()", DeprecationWarning, stacklevel=2)
        return extension in cls._parsers()

    @classmethod
    def get_parser_from_extension(cls, extension: str) -> type[Parser]:
        """Return the parser called `extension`; deprecated, as in ROS 2. Raises InvalidFrontendLaunchFileError."""
        instead = "get_parser_from_extension() is deprecated: use get_parsers_from_filename()"
        warnings.warn(instead, DeprecationWarning, stacklevel=2)
        if extension not in cls._parsers():
            raise InvalidFrontendLaunchFileError(extension)
        return cls._parsers()[extension]

    @classmethod
    def may_parse(cls, filename: str) -> bool:
        """Return whether the file name `filename` ends as those of this parser do."""
        return any(filename.endswith(f".{each}") for each in cls.get_file_extensions())

    @classmethod
    def is_filename_valid(cls, filename: str) -> bool:
        """Return whether the file name `filename` ends as those of a parser do."""
        return bool(cls.get_parsers_from_filename(filename))

    @classmethod
    def get_parsers_from_filename(cls, filename: str) -> list[type[Parser]]:
        """Return the parsers of files whose names end as `filename` does."""
        return [each for each in cls._parsers().values() if each.may_parse(filename)]

    @classmethod
    def get_file_extensions_from_parsers(cls) -> set[str]:
        """Return the ends of file names that any parser reads, without their first points."""
        return {name for each in cls._parsers().values() for name in each.get_file_extensions()}

    @classmethod
    def _parsers(cls) -> dict[str, type[Parser]]:
        cls.load_parser_implementations()
        return Parser.frontend_parsers or {}

    @classmethod
    def load(cls, file: SomeFile) -> tuple[Entity, Parser]:
        """Return the outermost element of a launch file, and the parser of it.

        The parsers of files with such a name are tried first, then the others.

        Args:
            file: Path of the file, or a file that is open.

        Raises:
            InvalidFrontendLaunchFileError: if no parser reads it; it has the reasons.
        """
        is_path = isinstance(file, (str, bytes, os.PathLike))
        name = os.fsdecode(file) if is_path else str(getattr(file, "name", ""))  # type: ignore[arg-type]
        first = cls.get_parsers_from_filename(name)
        errors: list[Exception] = []
        for each in [*first, *(each for each in cls._parsers().values() if each not in first)]:
            try:
                return each.load(file)
            except Exception as error:  # noqa: BLE001 - parsers of other packages raise what they raise
                errors.append(error)
                if not is_path:
                    file.seek(0)  # type: ignore[union-attr]
        extension = Path(name).suffix.removeprefix(".") if first else ""
        raise InvalidFrontendLaunchFileError(extension, likely_errors=errors)

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the ends of file names that this parser reads, without their first points."""
        return set()


def _loaded(point: importlib_metadata.EntryPoint, kind: str) -> Any:
    """Return the object of an entry point; None, with a warning, if its module cannot be imported."""
    try:
        return point.load()
    except Exception as error:  # noqa: BLE001 - whatever the module raises
        reason = str(error) if isinstance(error, RobolinkError) else f"{type(error).__name__}: {error}"
        warnings.warn(f"Failed to load the {kind} extension: {point.name}: {reason}", stacklevel=3)
        return None


def _modules_in(home: Path) -> Iterator[str]:
    """Yield the modules that expose actions and substitutions in the packages of a workspace."""
    from robolink.workspace.packages import source_packages
    from robolink.workspace.setup_files import entry_points

    for folder in source_packages(home).values():
        yield from (module for module, _ in entry_points(folder, EXTENSIONS).values())
