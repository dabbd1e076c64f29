"""Surroundings in which ROS 2 launch files run: import roots, packages that are not here, and errors in one line."""

from __future__ import annotations

import ast
import functools
import os
import pkgutil
import re
import site
import sys
import sysconfig
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import FrameType, ModuleType
from typing import Any, NoReturn

from robolink import compat
from robolink.companions.ament_index import NOT_HERE, package_not_here, packages_may_lack
from robolink.compat.hooks import names_of_launch_files
from robolink.compat.maker import TOPS
from robolink.exceptions import DocumentError, RobolinkError, closest
from robolink.interfaces.standard import FOLDER
from robolink.launch.ros.entries import placed
from robolink.launch.ros.launch.bases import (
    Event,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    Place,
    Substitution,
    no_argument,
)
from robolink.launch.ros.launch.sources import LaunchDescription
from robolink.system.terminal import shown
from robolink.text.suggestions import LackingModuleError
from robolink.workspace import VARIABLE
from robolink.workspace.modules import Filling
from robolink.workspace.packages import import_roots, source_packages

_NOT_USERS = [
    str(Path(__file__).resolve().parents[2]),
    sysconfig.get_paths()["stdlib"],
    *site.getsitepackages(),
    sys.prefix,
]
"""Folders of robolink and of libraries. Looked up early: sysconfig imports modules, and imports ask `is_users`."""
_LONGEST = 400
_UNEXPECTED = re.compile(r"(?:(\w+)\.)?(\w+)\(\) got an unexpected keyword argument '(\w+)'")
_LACKING = re.compile(r"(\w+)\.__init__\(\) missing \d+ required (?:[a-z-]+ )*arguments?: (.+)")
_PATH = re.compile("(?:" + "|".join(re.escape(str(each)) for each in (NOT_HERE, FOLDER)) + r")[^\s'\",;:]*")


def as_document_error(error: BaseException, place: Place) -> DocumentError:
    """Return an error of a launch file as one line with its place.

    Args:
        error: Error that the file, or an action of it, has raised.
        place: Place that counts if the error comes from no line of the user's.
    """
    if isinstance(error, DocumentError):
        return error
    if isinstance(error, SyntaxError) and error.filename:
        return DocumentError(error.msg, error.filename, error.lineno or 0, error.offset or 0)
    at = place if isinstance(error, LaunchError) and place.line else users_place(error) or place
    return DocumentError(reason_of(error).removeprefix(f"{at.file}: "), at.file, at.line)


def reason_of(error: BaseException) -> str:
    """Return an error's text in one line, with its kind if it is none of robolink's."""
    missing = absent_package(error)
    if missing:
        return f"package {missing} is not here, and its {_within(str(error))} is needed"
    if isinstance(error, RobolinkError):
        return shown(str(error), _LONGEST)
    refused = _UNEXPECTED.search(str(error)) if isinstance(error, TypeError) else None
    if refused is not None:
        return _no_argument(error, refused[1] or refused[2], refused[3])
    lacking = _LACKING.search(str(error)) if isinstance(error, TypeError) else None
    if lacking is not None:
        return f"{lacking[1]} needs {lacking[2]}"
    if isinstance(error, KeyError) and _is_of_environment(error):
        name = shown(str(error.args[0]))
        return f"the environment has no '{name}', which this file needs: set it, as by export {name}=VALUE"
    if isinstance(error, RecursionError):
        return "it never ends: a function or a substitution calls itself"
    if isinstance(error, SystemExit):
        return f"it ends the program: sys.exit({shown(repr(error.code), _LONGEST)})"
    if isinstance(error, MemoryError):
        return "there is not enough memory for it"
    text = shown(str(error), _LONGEST)
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def _is_of_environment(error: KeyError) -> bool:
    """True if `os.environ[NAME]` has raised an error."""
    last = [frame for frame, _ in traceback.walk_tb(error.__traceback__)][-1:]
    return any(each.f_code is os.environ.__class__.__getitem__.__code__ for each in last)


def absent_package(error: BaseException) -> str:
    """Return the package that is not here and whose file an error is about; '' if it is about something else."""
    found = _PATH.search(str(error))
    return package_not_here(found[0]) if found else ""


def _within(text: str) -> str:
    found = _PATH.search(text)
    path = found[0] if found else ""
    parts = Path(path).parts
    package = package_not_here(path)
    return shown("/".join(parts[parts.index(package) + 1 :]) if package in parts else "") or "folder"


def _no_argument(error: BaseException, name: str, argument: str) -> str:
    """Return why a call has a wrong keyword, with the nearest of the class, if it is one that the caller knows."""
    for frame, _ in traceback.walk_tb(error.__traceback__):
        cls = frame.f_globals.get(name)
        if isinstance(cls, type):
            return str(no_argument(cls, argument))
    return f"{name} has no argument '{argument}'"


def users_place(error: BaseException) -> Place | None:
    """Return the last line of the user's own code that an error came through."""
    lines = [Place(frame.f_code.co_filename, line) for frame, line in traceback.walk_tb(error.__traceback__)]
    return next((each for each in reversed(lines) if is_users(each.file)), None)


def is_users(file: str) -> bool:
    """Return whether a file of Python code is the user's: neither robolink's nor of a library."""
    if file.startswith("<"):
        return False
    return not any(Path(file).is_relative_to(each) for each in _NOT_USERS)


ALIKE = 0.8
"""Similarity from 0 to 1 above which an unknown name is taken for a misspelt one of a module that is here."""
FOREIGN = frozenset({
    "controller_manager", "launch_pal", "launch_param_builder", "moveit",
    "moveit_commander", "moveit_configs_utils", "tracetools_launch",
})  # fmt: skip
"""Modules of ROS 2 that are not here; some of their names are like those of others, or have advice for nodes."""
_CATCHING = frozenset({"ImportError", "ModuleNotFoundError", "Exception", "BaseException"})


class AbsentError(LaunchError):
    """Something needs a Python module that is not here.

    Args:
        text: The whole text, of which others may make a longer one.
        module: Full name of the module.
    """

    def __init__(self, text: str, module: str = "") -> None:
        super().__init__(text)
        self.module = module


class Absent(Substitution, LaunchDescription):
    """Value that comes from a module which is not here: in the place of a text, an action, a function or anything.

    What is taken from it is absent, too. It has no text and no number, and cannot be carried out: AbsentError.

    Args:
        module: Full name of the module.
        place: Place that counts if it is made where no line of the user's is: by robolink itself.
    """

    module = ""
    place = Place()
    deprecated_reason = None

    def __init__(self, module: str, place: Place | None = None) -> None:
        self.module, self.place = module, _calling_place() or place or Place()

    def __repr__(self) -> str:
        return f"<absent: {self.module}>"

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):  # Python's own questions
            raise AttributeError(f"'{self.module}' is not here and has no {name}")
        return self._taken()

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "around":  # it is registered as an event handler
            self._refuse()
        super().__setattr__(name, value)

    def _taken(self, *args: Any, **kwargs: Any) -> Absent:
        return Absent(self.module, self.place)

    def _refuse(self, *args: Any, **kwargs: Any) -> NoReturn:
        raise AbsentError(f"it needs the Python module {self.module}, which is not here", self.module)

    __call__ = __getitem__ = __add__ = __radd__ = __truediv__ = __rtruediv__ = __or__ = __ror__ = _taken
    __enter__ = _taken
    __str__ = __format__ = __fspath__ = __int__ = __float__ = __index__ = __mro_entries__ = _refuse

    def __exit__(self, *args: object) -> None:
        """Let errors through."""

    def __setitem__(self, key: Any, value: Any) -> None:
        """Take nothing."""

    def __bool__(self) -> bool:
        return True

    def __iter__(self) -> Iterator[Absent]:
        return iter([self._taken()])

    def __len__(self) -> int:
        return 1

    def describe(self) -> str:
        """Return a description for people."""
        return repr(self)

    text = property(describe)

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return nothing."""
        return []

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        """Take no `entity`."""

    def add_action(self, action: LaunchDescriptionEntity) -> None:
        """Take no `action`."""

    def perform(self, context: LaunchContext) -> str:
        """Refuse: raises AbsentError."""
        self._refuse()

    def visit(self, context: LaunchContext) -> NoReturn:
        """Refuse: raises AbsentError."""
        self._refuse()

    def evaluate(self, context: LaunchContext) -> bool:
        """Refuse as a condition: raises AbsentError."""
        self._refuse()

    def matches(self, event: Event) -> bool:
        """Refuse as an event handler: raises AbsentError."""
        self._refuse()


class Absences:
    """Finder, in front on `sys.meta_path`, of modules that user's launch files import and nobody has.

    Modules of nodes and libraries are none of its business: an import counts whose statement is in the user's code and
    that runs while the finder is there. An import that a `try` catches fails, as its author expects.

    Args:
        say: Called with a line for people about each module.
    """

    def __init__(self, say: Callable[[str], object] = lambda _: None) -> None:
        self.say = say
        self._made: set[str] = set()
        self._before: set[str] = set()

    def __enter__(self) -> Absences:
        self._before = set(sys.modules)
        sys.meta_path.insert(0, self)
        return self

    def __exit__(self, *_: object) -> None:
        """Remove the placeholders, and the user's modules that may hold something of them."""
        sys.meta_path.remove(self)
        if not self._made:
            return
        for name in set(sys.modules) - self._before:
            if name in self._made or is_users(getattr(sys.modules[name], "__file__", None) or "<none>"):
                del sys.modules[name]
                folder, last = name.rpartition(".")[::2]
                vars(sys.modules.get(folder, ModuleType(""))).pop(last, None)

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the spec of a module: its own, or that of a placeholder; raises ImportError for a misspelt name."""
        parent = fullname.rpartition(".")[0]
        if parent in self._made:
            return self._placeholder(fullname)
        importer = _importer()
        if importer is None or (parent and fullname not in FOREIGN and not _may_lack(parent)):
            return None
        try:
            spec = self._of_others(fullname, path, target)
        except LackingModuleError:
            if fullname not in FOREIGN or _is_caught(importer):
                raise
        else:
            if spec is not None or _is_caught(importer):
                return spec
            _refuse_misspelt(fullname)
        at = Place(importer.f_code.co_filename, importer.f_lineno)
        self.say(f"{placed(at)}{fullname} is not here: what is made with it is left out")
        return self._placeholder(fullname)

    def _of_others(self, fullname: str, path: Sequence[str] | None, target: ModuleType | None) -> ModuleSpec | None:
        for finder in sys.meta_path:
            if finder is not self and hasattr(finder, "find_spec"):
                spec = finder.find_spec(fullname, path, target)
                if spec is not None:
                    return spec
        return None

    def _placeholder(self, fullname: str) -> ModuleSpec:
        self._made.add(fullname)
        return ModuleSpec(fullname, Filling(_fill), is_package=True)  # type: ignore[arg-type]


def _fill(module: ModuleType) -> None:
    module.__getattr__ = functools.partial(_attribute, module.__name__)  # type: ignore[method-assign]


def _attribute(module: str, name: str) -> Absent:
    if name.startswith("__"):
        raise AttributeError(f"module '{module}' is not here and has no {name}")
    return Absent(module)


def _refuse_misspelt(name: str) -> None:
    """Raise ModuleNotFoundError for a name that hardly differs from that of a module that is here."""
    if name in FOREIGN:
        return
    parent, _, last = name.rpartition(".")
    beside = {each.name for each in pkgutil.iter_modules(sys.modules[parent].__path__ if parent else None)}
    known = beside if parent else {*TOPS, *sys.stdlib_module_names, *beside}
    alike = closest(last, sorted(known), ALIKE)
    if alike:
        raise ModuleNotFoundError(f"No module named '{name}' (did you mean '{alike}'?)", name=name)


def _may_lack(parent: str) -> bool:
    """True for a package in which a module may be built only by ROS 2: the user's own.

    A folder without `__init__.py`, which Python takes for a package, is one, too: that of a package in C++.
    """
    module = sys.modules.get(parent)
    if not hasattr(module, "__path__"):
        return False
    file = getattr(module, "__file__", None)
    is_made = isinstance(getattr(getattr(module, "__spec__", None), "loader", None), Filling)
    return is_users(file) if file is not None else not is_made


def _importer() -> FrameType | None:
    """Return the frame of the import statement that is being carried out, None if it is not in the user's code."""
    frame: FrameType | None = sys._getframe(2)
    while frame is not None and frame.f_code.co_filename.startswith("<frozen importlib._boot"):
        frame = frame.f_back
    return frame if frame is not None and is_users(frame.f_code.co_filename) else None


def _is_caught(importer: FrameType) -> bool:
    """True if a `try` around the import statement catches that there is no such module."""
    try:
        tree = ast.parse(Path(importer.f_code.co_filename).read_bytes())
    except (OSError, SyntaxError, ValueError):
        return False
    line = importer.f_lineno
    tries = [each for each in ast.walk(tree) if isinstance(each, ast.Try) and any(map(_catches, each.handlers))]
    return any(each.body[0].lineno <= line <= (each.body[-1].end_lineno or 0) for each in tries)


def _catches(handler: ast.ExceptHandler) -> bool:
    names = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    return any(each is None or (isinstance(each, ast.Name) and each.id in _CATCHING) for each in names)


def _calling_place() -> Place | None:
    """Return the place of the user's code from which this module was called, None if it was not called from there."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and frame.f_code.co_filename == __file__:
        frame = frame.f_back
    if frame is None or not is_users(frame.f_code.co_filename):
        return None
    return Place(frame.f_code.co_filename, frame.f_lineno)


def roots_of(home: Path | None) -> list[str]:
    """Return the folders from which the packages of a workspace are imported; None has none."""
    if home is None:
        return []
    return list(dict.fromkeys(str(root) for each in source_packages(home).values() for root in import_roots(each)))


@contextmanager
def surroundings(home: Path | None, roots: Sequence[str] | None = None) -> Iterator[Absences]:
    """Let the code of a launch file find what it would find in ROS 2, while the block runs.

    `import launch` is robolink's, modules of the workspace's packages can be imported, and the folders of packages are
    those of the workspace `home`. Modules that nobody has are placeholders, whose finder the block gets.
    The path of imports and the environment are as before afterwards. `roots` are those of `home`, if they are known
    already: to list the folders of a workspace at each event takes too long.
    """
    compat.activate(compat.ALWAYS)
    before, named = list(sys.path), os.environ.get(VARIABLE)
    if home is not None:
        sys.path.extend(each for each in (roots_of(home) if roots is None else roots) if each not in sys.path)
        os.environ[VARIABLE] = str(home)
    try:
        with packages_may_lack(), names_of_launch_files(), Absences() as absences:
            yield absences
    finally:
        sys.path[:] = before
        if named is None:
            os.environ.pop(VARIABLE, None)
        else:
            os.environ[VARIABLE] = named
