"""Packages and their executables, as `ros2 run PACKAGE EXECUTABLE` names them, without a build.

A package is one of these, in the order in which a name is looked for:

1. a folder below a workspace's `src/` that holds a `package.xml` (its <name> counts) or a `setup.py` (then the
   folder's name), as `ros2 pkg create` makes it; without a `src/` that lone folder itself, or those in a repository;
2. the workspace itself, by the name of its folder;
3. `robolink`: what comes with it.

Its executables are its console scripts, the scripts that its CMakeLists.txt installs, then the Python files of its
module folder and of its `nodes/`, by their names without `.py`. `_` and `-` in names are the same.
"""

from __future__ import annotations

import contextlib
import itertools
import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from robolink.workspace.source import NodeSource, canonical

BUILT_IN = "robolink"
"""Name of the package that comes with robolink."""
DEEPEST = 8
"""Upper bound of the folders between `src/` and a package's own."""
MOST = 2000
"""Upper bound of the folders that are searched: a `src/` that has more is not a workspace's."""
MOST_BESIDE = 100
"""Upper bound of the folders in which packages are looked for where nothing shows that there are any."""
PARTS = ("nodes", "configs", "interfaces")
"""Folders of which a workspace of robolink's own has two."""
IGNORE = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
"""Names of the marker files of folders that are not packages."""
_NO_MODULES = ("launch", "test", "tests", "scripts")
"""Folders of modules that no other package imports by these names."""
_NO_PACKAGES = ("build", "install", "log", "node_modules", "__pycache__")

_known: dict[Path, tuple[dict[Path, int], dict[str, Path]]] = {}
"""Cache by workspace: the folders searched, with the time of their last change, and the packages found."""


def source_packages(top: Path) -> dict[str, Path]:
    """Return the packages in a workspace's `src/`, else `top` itself where it is one: name to folder.

    The folders are searched again only when one of them, or a package.xml, has changed.
    """
    seen, found = _known.get(top, ({}, {}))
    if not seen or any(_changed(path) != at for path, at in seen.items()):
        seen, found = {path: _changed(path) for path in (top, top / "package.xml")}, {}
        for each in _packages_below(top / "src", seen):
            found.setdefault(package_name_of(each), each)
        for each in _folders_in(top) if found else ():  # beside src/, as colcon finds them
            if (each / "package.xml").is_file() and _is_package(each):
                seen[each / "package.xml"] = _changed(each / "package.xml")
                found.setdefault(package_name_of(each), each)
        if not found and _is_package(top):
            found[package_name_of(top)] = top
        if not found and not any((top / part).is_dir() for part in PARTS):
            for each in _packages_below(top, seen):
                found.setdefault(package_name_of(each), each)
        _known[top] = seen, found
    return found


def _changed(path: Path) -> int:
    """Return when a file or folder was last changed, in ns; 0 where there is none."""
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


def is_ros_workspace(folder: Path) -> bool:
    """True if a folder's `src/` holds a ROS 2 package; a `setup.py` alone is any Python project's."""
    if not (folder / "src").is_dir():
        return False
    return any((each / "package.xml").is_file() for each in source_packages(folder).values() if each != folder)


def is_repository(folder: Path) -> bool:
    """True if a `folder` without a `src/` has packages in it, at most two deep where it is no clone of a repository."""
    if (folder / ".git").exists():
        return any((each / "package.xml").is_file() for each in source_packages(folder).values())
    inside = _folders_in(folder)[:MOST_BESIDE]
    below = itertools.islice((each for folder in inside for each in _folders_in(folder)), MOST_BESIDE)
    return any((each / "package.xml").is_file() for each in (*inside, *below))


def hides(top: Path, folder: Path) -> bool:
    """True if a package at or below `folder` is not the one of its name in the workspace `top`, which is above it."""
    known = source_packages(top)
    return any(known.get(name) != each for name, each in source_packages(folder).items())


def has_packages(folder: Path, but: Path) -> bool:
    """True if a `folder` that is not a package has packages directly in it beside `but`, none a copy of that."""
    inside = [each for each in _folders_in(folder)[:MOST_BESIDE] if each != but and (each / "package.xml").is_file()]
    names = [package_name_of(each) for each in inside if _is_package(each)]
    return bool(names) and package_name_of(but) not in names and not _is_package(folder)


def unmarked_package(name: str, top: Path) -> Path | None:
    """Return the folder that would be the package `name` but for its package.xml: `top`, or in it or its `src/`."""
    with contextlib.suppress(OSError):  # the working directory has been deleted, or may not be read
        for each in (top / "src" / name, top / name, top.resolve()):
            if canonical(each.name) == canonical(name) and each.is_dir() and not _is_marked(each):
                return each
    return None


def _is_marked(folder: Path) -> bool:
    return (folder / "package.xml").is_file() or any((folder / mark).exists() for mark in IGNORE)


def executables(folder: Path) -> dict[str, NodeSource]:
    """Return the executables of the package in `folder`: name to source."""
    from robolink.workspace.cmake_files import CMakeFile  # late: most runs read neither
    from robolink.workspace.setup_files import console_scripts

    found = {path.stem: NodeSource(path.stem, path) for path in _public(folder / "nodes")}
    for module_folder in _module_folders(folder):
        for path in _public(module_folder):
            module = f"{module_folder.name}.{path.stem}"
            found[path.stem] = NodeSource(path.stem, path, module=module, root=module_folder.parent)
    for name, path in CMakeFile(folder).scripts().items():
        found[name] = NodeSource(name, path)
    for name, (module, function) in console_scripts(folder).items():
        root, path = _file_of(folder, module)
        found[name] = NodeSource(name, path, function, module=module, root=root)
    return found


def executable(folder: Path, name: str) -> NodeSource | None:
    """Return the executable `name` of the package in `folder`, None if it has none."""
    return named(name, executables(folder))


def named(name: str, known: Mapping[str, NodeSource]) -> NodeSource | None:
    """Return that of the `known` executables which is called `name`, with or without .py; None if there is none."""
    requested = canonical(name.removesuffix(".py"))
    found = (known[each] for each in known if canonical(each.removesuffix(".py")) == requested)
    return known.get(name) or next(found, None)


def named_executables(folder: Path) -> list[NodeSource]:
    """Return the executables that the package in `folder` names and those in its `nodes/`; without any, all it has."""
    known = sorted(executables(folder).values(), key=lambda each: each.name)
    return [each for each in known if each.attribute or not each.module] or known


def import_roots(folder: Path) -> list[Path]:
    """Return the folders that must be on `sys.path` for a package's modules to be imported by their names."""
    modules = [each.parent for each in _module_folders(folder)]
    beside = [each for each in (folder, folder / "src") if any(_is_module(inside) for inside in _folders_in(each))]
    return list(dict.fromkeys([*modules, *beside]))


def compiled_executables(folder: Path) -> list[str]:
    """Return the names of the executables that the CMakeLists.txt in `folder` would compile."""
    from robolink.workspace.cmake_files import CMakeFile

    return CMakeFile(folder).compiled


def _is_module(folder: Path) -> bool:
    return folder.name.isidentifier() and folder.name not in _NO_MODULES and (folder / "__init__.py").is_file()


def _packages_below(top: Path, seen: dict[Path, int]) -> Iterator[Path]:
    """Yield the packages in a folder, the nearest first, then by name; there are none within a package.

    `seen` gets the paths whose change would change the answer, and when each last changed.
    """
    level, left = [top], MOST
    seen[top] = _changed(top)
    for _ in range(DEEPEST):
        below = []
        for each in (inside for folder in level for inside in _folders_in(folder)):
            left -= 1
            if left < 0:
                return
            seen[each] = _changed(each)
            if _is_package(each):
                seen[each / "package.xml"] = _changed(each / "package.xml")
                yield each
            elif not any((each / mark).exists() for mark in IGNORE):
                below.append(each)
        level = below


def _folders_in(folder: Path) -> list[Path]:
    try:
        with os.scandir(folder) as entries:
            names = sorted(each.name for each in entries if each.is_dir())
    except OSError:
        return []
    return [folder / name for name in names if not name.startswith(".") and name not in _NO_PACKAGES]


def _is_package(folder: Path) -> bool:
    has = any((folder / each).is_file() for each in ("package.xml", "setup.py"))
    return has and not any((folder / mark).exists() for mark in IGNORE)


def package_name_of(folder: Path) -> str:
    """Return the name of the package in `folder`: that of its package.xml, else the folder's."""
    from robolink.workspace.setup_files import package_name

    return package_name(folder) or folder.name


def _module_folders(folder: Path) -> list[Path]:
    """Return the folder of a package's modules: it has the package's name, and stands in the package or in its src/."""
    names = {canonical(package_name_of(folder)), canonical(folder.name)}
    inside = [each for each in (*_folders_in(folder), *_folders_in(folder / "src")) if canonical(each.name) in names]
    return [each for each in inside if (each / "__init__.py").is_file() or any(_public(each))]


def _public(folder: Path) -> list[Path]:
    return sorted(each for each in folder.glob("*.py") if not each.name.startswith("_"))


def _file_of(folder: Path, module: str) -> tuple[Path, Path]:
    """Return the root and the file of a module, which need not exist."""
    part = Path(*module.split("."))
    for root in (folder, folder / "src"):
        for file in (root / part.with_suffix(".py"), root / part / "__init__.py"):
            if file.is_file():
                return root, file
    return folder, folder / part.with_suffix(".py")
