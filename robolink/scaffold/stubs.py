"""Type stubs for a workspace: with them editors and type checkers know rclpy, the message packages and its own types.

An import hook gives `import rclpy` its module when a program runs, which no type checker sees. A stub is a module of
ROS 2's name that says where robolink has each thing (`from robolink.node import Node as Node`), so that checkers find
one class by both names; types of the workspace's own files are written out. Format: PEP 484, "Stub Files", and PEP 561.
"""

from __future__ import annotations

import ast
import functools
import importlib
import importlib.util
import pkgutil
import shutil
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import robolink
from robolink import interfaces
from robolink.compat.names import ROOMS
from robolink.exceptions import MessageError
from robolink.interfaces.standard import added_types, packages, types_of
from robolink.message.stub import stub_of
from robolink.workspace.interfaces import WORKSPACE_TYPES, use_interfaces

FOLDER = "typings"
"""Folder of the stubs in a workspace: where pyright looks by default."""
SETTINGS = {
    "mypy.ini": "[mypy]\nmypy_path = typings\n",
    "pyrightconfig.json": '{"reportMissingModuleSource": false, "ignore": ["typings"]}\n',
}
"""Settings of the two checkers: mypy's says where to look, pyright's that the source of a stub is elsewhere."""
OTHER_SETTINGS = {
    "mypy.ini": {".mypy.ini": "[mypy", "pyproject.toml": "[tool.mypy", "setup.cfg": "[mypy"},
    "pyrightconfig.json": {"pyproject.toml": "[tool.pyright"},
}
"""Other files that may have a checker's settings, each with the section that shows it."""


def write_stubs(workspace: Path) -> list[str]:
    """Write the stubs of a workspace anew, and the settings of checkers that have none.

    Args:
        workspace: Folder of the workspace; its `typings/` is replaced, with a `.gitignore` in it.

    Returns:
        What was written, relative to the workspace: `typings`, and each file of settings that was not there.

    Raises:
        OSError: if the files cannot be written.
        DefinitionError: if a type of the workspace has a mistake.
    """
    folder = workspace / FOLDER
    use_interfaces(workspace)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # modules that are older names of others say so when they are imported
        texts = {**_modules(), **_standard_types(), **_own_types()}
    if folder.exists():
        shutil.rmtree(folder)
    for name, text in {**_packages(texts), **texts}.items():
        _write(folder / name, text)
    _write(folder / ".gitignore", "*\n")  # each clone writes its own
    lacking = [name for name in SETTINGS if not _settings_of(workspace, name)]
    for name in lacking:
        _write(workspace / name, SETTINGS[name])
    return [FOLDER, *lacking]


def settings_to_change(workspace: Path) -> dict[str, str]:
    """Return the settings that are a user's own and do not name the stubs: their file, and what to add to it.

    Args:
        workspace: Folder of the workspace.
    """
    words = {"mypy.ini": "mypy_path", "pyrightconfig.json": "reportMissingModuleSource"}
    found = {name: _settings_of(workspace, name) for name in SETTINGS}
    return {
        file.name: SETTINGS[name].splitlines()[-1].strip("{}")
        for name, file in found.items()
        if file is not None and words[name] not in _text(file)
    }


def _settings_of(workspace: Path, name: str) -> Path | None:
    """Return the file that has the settings of a checker, which is named by the file that is its own."""
    others = [
        workspace / other for other, section in OTHER_SETTINGS[name].items() if section in _text(workspace / other)
    ]
    return next((each for each in (workspace / name, *others) if each.is_file()), None)


def _text(file: Path) -> str:
    return file.read_text(encoding="utf-8", errors="replace") if file.is_file() else ""


def _write(file: Path, text: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8", newline="\n")


def _packages(texts: Mapping[str, str]) -> dict[str, str]:
    """Return an empty `__init__.pyi` for each folder that has none."""
    folders = {folder for name in texts for folder in list(Path(name).parents)[:-1]}
    return {f"{each.as_posix()}/__init__.pyi": "" for each in folders if f"{each.as_posix()}/__init__.pyi" not in texts}


# Modules of ROS 2's packages


def _modules() -> dict[str, str]:
    """Return the stub of each module of rclpy and its companions, by its path."""
    found: dict[str, str] = {}
    for name, room in ROOMS.items():
        if room and not _is_message_package(room):
            for module, source in _below(name, room):
                if module not in found:
                    found[module] = source
    inside: dict[str, list[str]] = {}
    for each in sorted(found):
        package, _, name = each.rpartition(".")
        inside.setdefault(package, []).append(name)
    return {_path(name, name in inside): _module(name, room, inside.get(name, [])) for name, room in found.items()}


def _is_message_package(room: str) -> bool:
    return room.startswith("robolink.interfaces")


def _below(name: str, room: str) -> Iterator[tuple[str, str]]:
    """Yield a module's name and robolink's, and those of what is in it."""
    yield name, room
    spec = importlib.util.find_spec(room)
    for each in pkgutil.iter_modules((spec and spec.submodule_search_locations) or []):
        inner = f"{name}.{each.name}"
        if not each.name.startswith("_") and inner not in ROOMS and (room != "robolink" or _is_rclpys(each)):
            yield from _below(inner, f"{room}.{each.name}")


def _is_rclpys(module: pkgutil.ModuleInfo) -> bool:
    """True if a module of robolink's root has a name of rclpy's: the other folders are rooms of robolink's own."""
    return module.name in robolink._ROOMS or not module.ispkg


def _path(name: str, is_package: bool) -> str:
    return f"{name.replace('.', '/')}{'/__init__' if is_package else ''}.pyi"


def _module(name: str, room: str, inside: list[str]) -> str:
    """Return the text of a stub: each public name, from the module of robolink's that defines it, and its modules."""
    try:
        module = importlib.import_module(room)
    except ImportError:  # it needs a library that is not installed
        return "from typing import Any\n\ndef __getattr__(name: str) -> Any: ...\n"
    homes = dict(_homes(module))
    for each in inside:
        if isinstance(getattr(module, each, None), ModuleType):
            homes.pop(each, None)  # the checker finds the stub of a module that robolink has in the same file
    lines = [f"from {source} import {inner} as {outer}" for outer, (source, inner) in sorted(homes.items())]
    lines += [f"from {name} import {each} as {each}" for each in inside if each not in homes]
    return "\n".join(lines) + "\n"


@functools.cache  # several packages of ROS 2 are one of robolink's, and tests make many projects
def _homes(module: ModuleType) -> dict[str, tuple[str, str]]:
    """Return the public names of a module, each with the module and the name that a checker finds it by."""
    tree = ast.parse(Path(str(module.__file__)).read_text(encoding="utf-8"))
    found: dict[str, tuple[str, str]] = {}
    for statement in _statements(tree.body):
        if isinstance(statement, ast.ImportFrom) and (statement.module or "").startswith("robolink"):
            found.update({each.asname or each.name: (str(statement.module), each.name) for each in statement.names})
        else:
            found.update({each: (module.__name__, each) for each in _defined(statement)})
    return {name: home for name, home in found.items() if not name.startswith("_") and hasattr(module, name)}


def _statements(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield the statements of a module, with those under `if TYPE_CHECKING:`, where a lazy name has its type."""
    for each in body:
        if isinstance(each, ast.If):
            yield from _statements([*each.body, *each.orelse])
        else:
            yield each


def _defined(statement: ast.stmt) -> list[str]:
    if isinstance(statement, (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)):
        return [statement.name]
    if isinstance(statement, ast.Assign):
        names = [each for target in statement.targets for each in ast.walk(target)]
        return [each.id for each in names if isinstance(each, ast.Name)]
    if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
        return [statement.target.id]
    return []


# Types


def _standard_types() -> dict[str, str]:
    """Return the stubs of the message packages that come with robolink: the same classes by ROS 2's names."""
    return {
        f"{package}/{kind}.pyi": "".join(
            f"from robolink.interfaces.{package}.{kind} import {each} as {each}\n" for each in names
        )
        for kind in interfaces.KINDS
        for package in packages()
        if (names := types_of(package, kind))
    }


def _own_types() -> dict[str, str]:
    """Return the stubs of the workspace's own packages, of the built-in workspace's, and of installed ones."""
    found: dict[str, str] = {}
    for kind in interfaces.KINDS:
        own = WORKSPACE_TYPES.names(kind)
        for package, names in {**added_types(kind), **own}.items():
            if names and package not in packages():
                types = [_found(f"{package}/{kind}/{each}", kind, package in own) for each in sorted(set(names))]
                found[f"{package}/{kind}.pyi"] = stub_of([each for each in types if each is not None], kind)
    return found


def _found(name: str, kind: str, is_own: bool) -> type[Any] | None:
    """Return the class of a type; None for one of an installed package that is wrong, which its user cannot mend."""
    try:
        return interfaces.find(name, kind)
    except MessageError:
        if is_own:
            raise
        return None
