"""Launch descriptions, the files that they are in, and inclusion (`launch.launch_description_sources`)."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple, TypeAlias

from robolink.exceptions import nearest
from robolink.launch.ros.launch.bases import (
    Action,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    Place,
    SomeSubstitutionsType,
)
from robolink.launch.ros.launch.inner_names import inner_names
from robolink.launch.ros.launch.registry import registered
from robolink.launch.ros.launch.settings import DeclareLaunchArgument, SetLaunchConfiguration
from robolink.launch.ros.launch.utilities import normalize_to_list_of_substitutions, performed
from robolink.system.terminal import shown

__all__ = [
    "AnyLaunchDescriptionSource",
    "FrontendLaunchDescriptionSource",
    "InvalidLaunchFileError",
    "InvalidPythonLaunchFileError",
    "LaunchDescriptionSource",
    "LaunchFileNotFoundError",
    "PythonLaunchDescriptionSource",
    "get_launch_description_from_any_launch_file",
    "get_launch_description_from_frontend_launch_file",
    "get_launch_description_from_python_launch_file",
    "load_python_launch_file_as_module",
]


DEEPEST = 50
"""Deepest nesting of included files."""
FILES = ("current_launch_file_path", "current_launch_file_directory")
"""Locals of a launch file; those of the file around count again behind the included one."""
MOST_DESCRIBED = 10_000
"""Upper bound of the entities that are looked through."""


class Described(NamedTuple):
    """Entity of a launch description.

    Args:
        entity: The entity.
        files: Paths of the launch files around it, the outermost first.
        is_certain: True if no condition stands before it.
        circle: Sentence about the launch file that includes itself here; '' elsewhere.
        place: Place of that inclusion.
    """

    entity: LaunchDescriptionEntity
    files: tuple[str, ...] = ()
    is_certain: bool = True
    circle: str = ""
    place: Place = Place()


def described(top: Described, context: LaunchContext) -> Iterator[Described]:
    """Yield an entity, `top`, and what it holds and includes, in its order; `context` has the values for paths."""
    left, waiting = MOST_DESCRIBED, [top]
    while waiting and left:
        each = waiting.pop(0)
        left -= 1
        yield each
        if not each.circle:
            waiting[:0] = _inside(each, context)


def _inside(each: Described, context: LaunchContext) -> Iterator[Described]:
    if isinstance(each.entity, Action) and hasattr(each.entity, "launch_description_source"):
        yield from _included(each, each.entity, context)
        return
    certain = [(one, each.is_certain) for one in each.entity.describe_sub_entities()]
    uncertain = [(one, False) for _, some in each.entity.describe_conditional_sub_entities() for one in some]
    for one, is_certain in (*certain, *uncertain):
        if isinstance(one, LaunchDescriptionEntity):
            yield Described(one, each.files, is_certain)


def _included(each: Described, action: Action, context: LaunchContext) -> Iterator[Described]:
    """Yield the description that an action includes; nothing if its file cannot be read, or is not known yet."""
    source, files = getattr(action, "launch_description_source"), each.files  # noqa: B009 - only inclusions have it
    if files:
        context.extend_locals({FILES[0]: files[-1], FILES[1]: str(Path(files[-1]).parent)})
    try:
        description = source.get_launch_description(context)
    except Exception:  # noqa: BLE001 - the file is a program
        return
    path = os.path.abspath(source.location) if Path(source.location).is_file() else ""  # noqa: PTH100 - links stay
    is_certain = each.is_certain and action.condition is None
    if len(files) <= DEEPEST:
        own = (*files, path) if path else files
        yield Described(description, own, is_certain, circle(files, path), action.place)


def circle(files: Sequence[str], path: str) -> str:
    """Return the sentence that launch files include each other; '' if they do not.

    Args:
        files: Paths of the files around, the outermost first.
        path: Path of the file that is included.
    """
    if path not in files:
        return ""
    names = [Path(each).name for each in (*files[files.index(path) :], path)]
    return f"a launch file cannot include itself: {' -> '.join(names)}"


class LaunchDescription(LaunchDescriptionEntity):
    """List of what is to be done.

    Args:
        initial_entities: The actions and descriptions in it.
        deprecated_reason: Reason why it should not be used any more; None for none.
    """

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self.entities = list(initial_entities or ())
        self.deprecated_reason = deprecated_reason

    @property
    def deprecated(self) -> bool:
        """True if it should not be used any more."""
        return self.deprecated_reason is not None

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        """Add an action or a description, `entity`."""
        self.entities.append(entity)

    def add_action(self, action: LaunchDescriptionEntity) -> None:
        """Add an `action`."""
        self.entities.append(action)

    def describe(self) -> str:
        """Return a description for people."""
        return type(self).__name__

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities in it."""
        return list(self.entities)

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        """Return the entities in it."""
        return list(self.entities)

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[Any]:
        """Return the DeclareLaunchArgument actions in it, and in what it holds and includes, each name once.

        Args:
            conditional_inclusion: True if the description itself is there only on a condition; of no effect here.
        """
        found: dict[str, DeclareLaunchArgument] = {}
        for each in _described(self):
            if isinstance(each, DeclareLaunchArgument):
                found.setdefault(each.name, each)
        return list(found.values())


class LaunchIntrospector:
    """Printer of launch descriptions."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """Return the actions in `launch_description`, and in what it holds and includes, one a line."""
        return "\n".join(each.describe() for each in _described(launch_description))


def _described(top: LaunchDescription) -> Iterator[LaunchDescriptionEntity]:
    return (each.entity for each in described(Described(top), LaunchContext()))


SomePath: TypeAlias = "str | os.PathLike[str]"
MAKER = "generate_launch_description"
"""Name of the function in a Python launch file."""

_FRONTENDS = {
    **dict.fromkeys((".xml", ".launch"), "parser of xml"),
    **dict.fromkeys((".yaml", ".yml"), "parser of yaml"),
}
"""Names of the parsers in the registry, by the ends of file names: they need this file."""


class InvalidLaunchFileError(LaunchError):
    """A file is not a launch file, or one of a kind that cannot be read.

    Args:
        extension: End of the file's name.
        likely_errors: Errors of those that have tried to read it.
        reason: Sentence about it; '' makes one of the errors.
    """

    def __init__(self, extension: str = "", *, likely_errors: Iterable[BaseException] = (), reason: str = "") -> None:
        errors = list(likely_errors)
        found = "; ".join(f"{type(each).__name__}: {each}" for each in errors)
        kind = f" of the kind '{shown(extension)}'" if extension else ""
        super().__init__(reason or f"not a launch file{kind}{': ' if found else ''}{found}")
        self.extension, self.likely_errors = extension, errors


class InvalidPythonLaunchFileError(InvalidLaunchFileError):
    """A Python file has no `generate_launch_description`, or one that returns something else."""


class LaunchFileNotFoundError(LaunchError, FileNotFoundError):
    """A launch file does not exist; `path` is where it should be."""

    def __init__(self, path: Path) -> None:
        beside = [each.name for each in path.parent.glob("*.launch.*")] if path.parent.is_dir() else []
        LaunchError.__init__(self, f"there is no launch file {shown(str(path), 300)}{nearest(path.name, beside)}")
        self.path = path


@inner_names("method", location="_location", launch_description="_description")
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
        return get_launch_description_from_any_launch_file(path)


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """Launch file in Python.

    Args:
        launch_file_path: Path of the file.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(None, launch_file_path, "interpreted python launch file")

    def _read(self, path: Path) -> LaunchDescription:
        return get_launch_description_from_python_launch_file(path)


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
        parser: Parser of it; None takes that of files with such a name.
    """

    def __init__(
        self,
        launch_file_path: SomeSubstitutionsType,
        *,
        method: str = "interpreted frontend launch file",
        parser: Any = None,
    ) -> None:
        super().__init__(None, launch_file_path, method)
        self._parser = parser

    def _read(self, path: Path) -> LaunchDescription:
        return get_launch_description_from_frontend_launch_file(path, parser=self._parser)


def get_launch_description_from_any_launch_file(launch_file_path: SomePath, *, parser: Any = None) -> LaunchDescription:
    """Return the description in a launch file of any kind.

    Args:
        launch_file_path: Path of the file.
        parser: Parser of one in XML, YAML or the like; None takes that of files with such a name.

    Raises:
        LaunchError: for a file that is none, or is not there; besides, whatever a Python file raises.
    """
    if Path(launch_file_path).suffix == ".py":
        return get_launch_description_from_python_launch_file(launch_file_path)
    return get_launch_description_from_frontend_launch_file(launch_file_path, parser=parser)


def get_launch_description_from_frontend_launch_file(
    launch_file_path: SomePath, *, parser: Any = None
) -> LaunchDescription:
    """Return the description in a launch file in XML, YAML or the like.

    Args:
        launch_file_path: Path of the file.
        parser: Parser of it; None takes that of files with such a name.

    Raises:
        LaunchError: for a file that is none, or is not there.
        DocumentError: for a mistake in it, with its line.
    """
    path = Path(launch_file_path)
    if not path.is_file():
        raise LaunchFileNotFoundError(path)
    entity, found = (parser or _parser_of(path)).load(path)
    description: LaunchDescription = found.parse_description(entity)
    return description


def _parser_of(path: Path) -> Any:
    """Return the parser of files with such a name; other packages may have some, which takes a while to find out."""
    if path.suffix in _FRONTENDS:
        return registered(_FRONTENDS[path.suffix])
    for each in registered("parser").get_parsers_from_filename(path.name):
        return each
    raise InvalidLaunchFileError(reason=f"{path} is not a launch file: expected .py, {', '.join(_FRONTENDS)}")


def get_launch_description_from_python_launch_file(python_launch_file_path: SomePath) -> LaunchDescription:
    """Run a Python launch file and return its description; raises LaunchError and whatever it raises.

    Args:
        python_launch_file_path: Path of the file.
    """
    path = Path(python_launch_file_path)
    module = load_python_launch_file_as_module(path)
    maker = getattr(module, MAKER, None)
    if maker is None:
        raise InvalidPythonLaunchFileError(reason=f"{path}: it has no function {MAKER}(){_instead_of_maker(module)}")
    made = maker()
    if not isinstance(made, LaunchDescription):
        kind = type(made).__name__
        reason = f"{path}: {MAKER}() returned {kind}, and a LaunchDescription was expected"
        raise InvalidPythonLaunchFileError(reason=reason)
    return made


def _instead_of_maker(module: ModuleType) -> str:
    if callable(getattr(module, "launch", None)):
        return ": launch(launch_descriptor, argv) is of ROS 2 before Bouncy (2018), and nodes are Node(...) actions now"
    if hasattr(module, "generate_test_description"):
        return f"; it is a launch test: pytest {Path(str(module.__file__)).name}"
    return "; a node is run by 'robolink run'"


def load_python_launch_file_as_module(python_launch_file_path: SomePath) -> ModuleType:
    """Load a file as a module of its own: two packages may each have a `robot.launch.py`; no bytecode is stored.

    Args:
        python_launch_file_path: Path of the file.

    Raises:
        LaunchFileNotFoundError: if it is not there; besides, whatever the file raises.
    """
    path = Path(python_launch_file_path)
    if not path.is_file():
        raise LaunchFileNotFoundError(path)
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


@inner_names("launch_description_source", "launch_arguments")
class IncludeLaunchDescription(Action):
    """Another launch file, or another description, with arguments.

    Args:
        launch_description_source: The source, or the path of a file of any kind.
        launch_arguments: Its arguments, as pairs of name and value; what they set goes on behind it, as in ROS 2.
        **kwargs: `condition`.
    """

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeSubstitutionsType,
        *,
        launch_arguments: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        is_source = isinstance(launch_description_source, LaunchDescriptionSource)
        self.launch_description_source: LaunchDescriptionSource = (
            launch_description_source if is_source else AnyLaunchDescriptionSource(launch_description_source)  # type: ignore[arg-type,assignment]
        )
        self.launch_arguments = list(launch_arguments or ())

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the description if its path is known before the launch runs."""
        found = self.launch_description_source.try_get_launch_description_without_context()
        return [] if found is None else [found]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Read the file with the values of `context`; return its arguments and its description."""
        source = self.launch_description_source
        around = context.get_locals_as_dict()
        chain: tuple[str, ...] = around.get("launch_files", ())
        description = source.get_launch_description(context)
        arguments = [SetLaunchConfiguration(*each) for each in self.launch_arguments]
        if not source.location:
            return [*arguments, description]
        own: dict[str, Any] = dict.fromkeys(FILES, source.location)  # a word such as <script>
        if Path(source.location).is_file():
            path = os.path.abspath(source.location)  # noqa: PTH100 - a link stays a link
            if circle(chain, path):
                raise LaunchError(circle(chain, path))
            if len(chain) > DEEPEST:
                raise LaunchError(f"launch files are included over {DEEPEST} deep")
            own = {FILES[0]: path, FILES[1]: str(Path(path).parent), "launch_files": (*chain, path)}
        back = {name: around.get(name) for name in own if name in around}
        # ROS 2 performs an argument's value where the included file counts already: ThisLaunchFileDir is its folder.
        context.extend_locals(own)
        return [*arguments, description, *([_Locals(back)] if back else [])]


class _Locals(Action):
    """Set locals of the context."""

    def __init__(self, values: dict[str, Any]) -> None:
        super().__init__()
        self._values = values

    def execute(self, context: LaunchContext) -> None:
        context.extend_locals(self._values)
