"""Interface types of a workspace: `.msg`, `.srv`, `.action` and `.idl` files in `interfaces/PACKAGE/{msg,srv,action}/`.

Those of the packages in its `src/` belong to them. They are known by name (`robolink.interfaces.find`) and importable,
`from my_msgs.msg import WheelSpeeds`, in every node that `robolink run` or `robolink launch` starts, and anywhere after
`use_interfaces()`.
"""

from __future__ import annotations

import functools
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

from robolink import interfaces
from robolink.exceptions import DefinitionError, MessageError, NotFoundError
from robolink.system.files import decoded, read_plain
from robolink.workspace.find import user_workspace
from robolink.workspace.modules import FINDER, Fill
from robolink.workspace.packages import source_packages
from robolink.workspace.source import Folder, built_in_workspace

IDL = ".idl"
"""Suffix of the files that define a type in OMG IDL, of all three kinds."""
INTERFACES = "interfaces"
"""Name of the folder of interface packages in a workspace."""
DEEPEST = 48
"""Upper bound of messages within messages; each is read while the one before is."""


class InterfaceImportError(MessageError, ImportError):
    """A type cannot be imported since its definition is wrong; the text begins with file:line:column."""


class WorkspaceTypes:
    """Registry of the types of workspaces: those that were added, the latest first, the user's, the built-in one.

    The user's is looked for anew each time, as `robolink.workspace` does: it is that of the environment, or the
    nearest. A look-up costs the listing of a few folders; a file is read when its type is first used, once.
    """

    def __init__(self) -> None:
        self._added: list[Path] = []
        self._made: dict[Path, type[Any]] = {}
        self._making: list[Path] = []
        self._lock = threading.RLock()

    def add(self, workspace: Path) -> None:
        """Search this workspace before all others."""
        self._added = [workspace, *(each for each in self._added if each != workspace)]

    @contextmanager
    def forgetting(self) -> Iterator[None]:
        """Remove, at the end of a `with`, the workspaces that were added in it."""
        before = self._added
        try:
            yield
        finally:
            self._added = before

    def names(self, kind: str) -> dict[str, list[str]]:
        """Return the types of a kind: package to the names within it."""
        found: dict[str, list[str]] = {}
        for workspace in self._workspaces():
            packages = [(name, workspace / INTERFACES / name) for name in _listed(workspace / INTERFACES)]
            for package, folder in (*packages, *source_packages(workspace).items()):
                for suffix in (f".{kind}", IDL):
                    shorts = (name.removesuffix(suffix) for name in _listed(folder / kind, suffix))
                    known = found.setdefault(package, [])
                    known.extend(each for each in shorts if each not in known)
        return {package: shorts for package, shorts in found.items() if shorts}

    def folders(self, package: str, kind: str = "") -> list[Path]:
        """Return the folders of a package, or of its types of a kind."""
        found = []
        for workspace in self._workspaces():
            if package in _listed(workspace / INTERFACES):
                found.append(workspace / INTERFACES / package)
            source = source_packages(workspace).get(package)
            if source is not None and any(each in interfaces.KINDS for each in _listed(source)):
                found.append(source)
        return [each / kind for each in found if not kind or kind in _listed(each)]

    def _workspaces(self) -> list[Path]:
        """Return the workspaces in the order in which they are searched."""
        user = user_workspace()
        return list(dict.fromkeys([*self._added, *([user] if user is not None else []), built_in_workspace()]))

    def get(self, package: str, kind: str, short: str) -> type[Any] | None:
        """Return the class of a type, None if no workspace defines it. Raises DefinitionError."""
        for folder in self.folders(package, kind):
            for suffix in (f".{kind}", IDL):  # where both are there, rosidl made the second of the first
                if short + suffix in _listed(folder, suffix):
                    return self._class_of(folder / (short + suffix), f"{package}/{kind}/{short}")
        return None

    def built_in(self, package: str, kind: str, short: str) -> type[Any]:
        """Return the class of a type of the built-in workspace, whatever others define by its name.

        Raises DefinitionError.
        """
        path = built_in_workspace() / INTERFACES / package / kind / f"{short}.{kind}"
        return self._class_of(path, f"{package}/{kind}/{short}")

    def _class_of(self, path: Path, type_name: str) -> type[Any]:
        with self._lock:
            if path in self._making:
                chain = " -> ".join(str(each) for each in [*self._making[self._making.index(path) :], path])
                raise MessageError(f"a message cannot contain itself: {chain}")
            if len(self._making) > DEEPEST:
                raise MessageError(f"messages within messages over {DEEPEST} deep")
            if path not in self._made:
                self._making.append(path)
                try:
                    self._made[path] = _build(path, type_name)
                finally:
                    self._making.pop()
            return self._made[path]


def _listed(folder: Path, suffix: str = "") -> Iterator[str]:
    """Yield the names in a folder that may be a package's or, with a suffix, a type's; nothing where it is none.

    A listing, not a look at one path: on some systems `twist.msg` would find `Twist.msg`.
    """
    try:
        names = sorted(each.name for each in folder.iterdir())
    except OSError:
        return
    for name in names:
        if name.endswith(suffix) and name.removesuffix(suffix).isidentifier():
            yield name


def _build(path: Path, type_name: str) -> type[Any]:
    from robolink.message.building import build
    from robolink.message.definition import parse
    from robolink.message.idl import parse_idl

    read = parse_idl if path.suffix == IDL else parse
    return build(read(_read(path), type_name, str(path)), interfaces.find)


def _read(path: Path) -> str:
    """Read an interface file, also one as an editor or the PowerShell of Windows writes it."""
    from robolink.message.definition import LONGEST_TEXT

    try:  # no character takes more than four bytes
        return decoded(read_plain(path, 4 * LONGEST_TEXT))
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise DefinitionError(f"{path}:{line}:1: not UTF-8 text") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise DefinitionError(f"{path}:1:1: cannot be read: {reason}") from None


WORKSPACE_TYPES = WorkspaceTypes()


def use_interfaces(workspace: Folder = None) -> None:
    """Make the types of workspaces known by name and importable in this process.

    >>> use_interfaces()  # in a conftest.py, say
    >>> from my_msgs.msg import WheelSpeeds  # interfaces/my_msgs/msg/WheelSpeeds.msg

    `workspace` is a folder that is searched first; then the user's workspace, that of ROBOLINK_WORKSPACE or the
    nearest, and the built-in one. Raises NotFoundError if one is named that is not a folder.
    """
    if workspace is not None:
        found = user_workspace(workspace)
        assert found is not None  # one was named
        WORKSPACE_TYPES.add(found)
    interfaces.add_source(WORKSPACE_TYPES)
    FINDER.add(interface_module, first=True)


def interface_module(fullname: str) -> Fill | None:
    """Return the function that fills the module `fullname` (`my_msgs`, `my_msgs.msg`); None if no workspace has it."""
    package, _, kind = fullname.partition(".")
    if kind and kind not in interfaces.KINDS:
        return None
    try:
        places = WORKSPACE_TYPES.folders(package, kind)
    except (NotFoundError, OSError):  # a workspace or working directory that is gone: other imports go on
        return None
    return functools.partial(_fill, package, kind, places[0]) if places else None


def _fill(package: str, kind: str, place: Path, module: ModuleType) -> None:
    """Set a module's place, for errors, and the types of its kind, each made when it is first used."""
    module.__file__ = str(place)
    if not kind:
        return

    def known() -> list[str]:
        start = f"{package}/{kind}/"
        return [name.removeprefix(start) for name in interfaces.names(kind) if name.startswith(start)]

    def get(name: str) -> Any:
        if name == "__all__":
            return known()
        if name.startswith("_"):
            raise AttributeError(f"module '{module.__name__}' has no attribute '{name}'")
        setattr(module, name, found := _imported(f"{package}/{kind}/{name}", kind, module))
        return found

    module.__getattr__ = get  # type: ignore[method-assign]
    module.__dir__ = lambda: sorted({*vars(module), *known()})  # type: ignore[method-assign]


def _imported(name: str, kind: str, module: ModuleType) -> type[Any]:
    try:
        return interfaces.find(name, kind)
    except NotFoundError as error:
        raise AttributeError(f"module '{module.__name__}': {error}") from None
    except MessageError as error:
        raise InterfaceImportError(str(error)) from None
