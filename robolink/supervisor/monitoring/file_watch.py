"""File watcher by polling: restarts a process when a file that it imports is saved (`launch --watch`)."""

from __future__ import annotations

import ast
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

from robolink.supervisor.monitoring.periodic import PeriodicThread

Stamp: TypeAlias = "tuple[int, int, int] | None"
"""Fingerprint of a file: modification time, size and inode; None while the file does not exist."""


class Changes:
    """Change detection of files between polls, with debouncing.

    A change counts once the file is the same in two polls: an editor may be half way through writing it, or have
    moved it aside to put a new one in its place.
    """

    def __init__(self, stamp: Callable[[Path], Stamp] | None = None) -> None:
        self._stamp = stamp or stamp_of
        self._known: dict[Path, Stamp] = {}
        self._seen: dict[Path, Stamp] = {}

    def follow(self, paths: Iterable[Path]) -> None:
        """Add files; their present content does not count as a change."""
        for path in paths:
            if path not in self._known:
                self._known[path] = self._seen[path] = self._stamp(path)

    def look(self) -> set[Path]:
        """Poll once; return the files that were saved and are stable now."""
        saved = set()
        for path, known in self._known.items():
            stamp = self._stamp(path)
            if stamp is not None and stamp != known and stamp == self._seen[path]:
                saved.add(path)
            self._seen[path] = stamp
        for path in saved:
            self._known[path] = self._seen[path]
        return saved


def stamp_of(path: Path) -> Stamp:
    """Return the fingerprint of a file."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


class Watch(PeriodicThread):
    """Periodic thread that calls `restart` with the name of each process one of whose files was saved.

    `files` are the Python files of each process; their imports, from their folder or from `roots`, are watched as well.
    A syntax error delays the restart until it is fixed, and is reported. A change of one of `settings`, which are
    read only when the whole system is started, is reported too.
    """

    def __init__(
        self,
        files: Mapping[str, Sequence[Path]],
        *,
        restart: Callable[[str], object],
        say: Callable[[str], object],
        roots: Iterable[Path] = (),
        settings: Iterable[Path] = (),
        every: float = 0.5,
        changes: Changes | None = None,
    ) -> None:
        self._files = files
        self._restart, self._say = restart, say
        self._imports = Imports(roots)
        self._settings = set(settings)
        self._broken: dict[Path, str] = {}
        self._changes = changes or Changes()
        self._made_of = self._gathered()
        super().__init__("watch", every)

    def look(self) -> None:
        """Poll once, and restart what has changed."""
        saved = self._changes.look()
        for path in sorted(saved & self._settings):
            self._say(f"{path} has changed: that counts when the system is started anew")
        concerned = {name: made_of for name, made_of in self._made_of.items() if made_of & saved}
        if not concerned:
            return
        for path in sorted(saved.intersection(set().union(*concerned.values()))):
            self._read(path)
        self._made_of = self._gathered()
        self._decide(list(concerned))

    def _read(self, path: Path) -> None:
        """Check the syntax of a Python file that was saved."""
        self._imports.forget(path)
        try:
            parse(path)
        except OSError as error:
            self._broken[path] = f"{path}: {error.strerror or error}"
        except SyntaxError as error:
            self._broken[path] = f"{path}:{error.lineno or 1}:{error.offset or 1}: {error.msg}"
        else:
            self._broken.pop(path, None)
            self._say(f"{path} was saved")

    def _decide(self, names: list[str]) -> None:
        """Restart the processes without syntax errors; report once for each broken file which ones wait for it."""
        waiting: dict[Path, list[str]] = {}
        for name in names:
            broken = sorted(self._made_of[name] & self._broken.keys())
            if broken:
                waiting.setdefault(broken[0], []).append(name)
            else:
                self._restart(name)
        for path, held in waiting.items():
            self._say(f"{self._broken[path]}: not restarted until that is mended: {', '.join(held)}")

    def _gathered(self) -> dict[str, set[Path]]:
        """Return all source files of each process, also those that do not exist yet, and follow them."""
        imports = self._imports
        made_of = {
            name: {file for path in paths for file in imports.of(path) | imports.absent_of(path)}
            for name, paths in self._files.items()
        }
        self._changes.follow(self._settings.union(*made_of.values()))
        return made_of


class Imports:
    """Cached import graph of the files in a program's own folder and in `roots`.

    Imports inside functions count as well; names that are computed at run time are not seen. A file is parsed once,
    and again after `forget`; while it has a syntax error, its former imports count.
    """

    def __init__(self, roots: Iterable[Path] = ()) -> None:
        self._roots = list(roots)
        self._read: dict[Path, set[Path]] = {}
        self._absent: dict[Path, set[Path]] = {}
        self._stale: set[Path] = set()

    def of(self, path: Path) -> set[Path]:
        """Return a program's file and all files that it imports, directly or not."""
        found, left = {path}, [path]
        while left:
            new = self._direct(left.pop()) - found
            found |= new
            left += new
        return found

    def absent_of(self, path: Path) -> set[Path]:
        """Return the files that do not exist but would be imported if they did: they may be saved later."""
        return {absent for file in self.of(path) for absent in self._absent.get(file, ())}

    def forget(self, path: Path) -> None:
        """Drop a file from the cache."""
        self._stale.add(path)

    def _direct(self, path: Path) -> set[Path]:
        if path.suffix == ".py" and (path not in self._read or path in self._stale):
            try:
                tree = parse(path)
            except (OSError, SyntaxError):
                return self._read.get(path, set())
            roots = [path.parent, _above_package(path.parent), *self._roots]
            found = [_found(names, roots) for names in _imported(tree, path)]
            self._read[path] = {file for there, _ in found for file in there}
            self._absent[path] = {file for _, absent in found for file in absent}
            self._stale.discard(path)
        return self._read.get(path, set())


def parse(path: Path) -> ast.Module:
    """Parse a file as Python does. Raises SyntaxError, for any file that is not Python, and OSError."""
    text = path.read_bytes()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an odd escape does not matter here
            tree = ast.parse(text, str(path))
            compile(tree, str(path), "exec", dont_inherit=True)  # finds a `return` outside of functions, too
    except (ValueError, RecursionError, MemoryError) as error:
        raise SyntaxError(str(error) or type(error).__name__, (str(path), 1, 1, None)) from None
    return tree


def _imported(tree: ast.Module, path: Path) -> Iterator[tuple[Path | None, list[str]]]:
    """Yield the parts of each imported module's name, with its folder if the import is relative."""
    for each in ast.walk(tree):
        if isinstance(each, ast.Import):
            for alias in each.names:
                yield None, alias.name.split(".")
        elif isinstance(each, ast.ImportFrom):
            folder = path.parents[each.level - 1] if 0 < each.level <= len(path.parents) else None
            begin = each.module.split(".") if each.module else []
            for alias in each.names:
                yield folder, begin if alias.name == "*" else [*begin, alias.name]


def _above_package(folder: Path) -> Path:
    """Return the folder from which the modules in `folder` are imported with the names of their packages."""
    while (folder / "__init__.py").is_file() and folder != folder.parent:
        folder = folder.parent
    return folder


def _found(imported: tuple[Path | None, list[str]], roots: list[Path]) -> tuple[set[Path], set[Path]]:
    """Return the files of a module and of its parent packages: those that exist, and those that do not.

    The last part of a name may be something in a module rather than a module.
    """
    folder, parts = imported
    absent: set[Path] = set()
    for root in roots if folder is None else [folder]:
        files = {root / "__init__.py"} if folder is not None else set()
        for count in range(1, len(parts) + 1):
            inner = root.joinpath(*parts[:count])
            files |= {inner.with_suffix(".py"), inner / "__init__.py"}
        there = {each for each in files if each.is_file()}
        if there:
            return there, files - there
        absent |= files
    is_pythons_own = folder is None and not sys.stdlib_module_names.isdisjoint(parts[:1])
    return set(), set() if is_pythons_own else absent
