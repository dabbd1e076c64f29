"""Static import analysis: finds the files that a Python program imports, without running it."""

from __future__ import annotations

import ast
import sys
import warnings
from collections.abc import Iterable, Iterator
from pathlib import Path


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
            warnings.simplefilter("ignore")  # an odd escape is no news here
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
