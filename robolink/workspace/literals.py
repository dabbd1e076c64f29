"""Evaluator of the constant expressions of a setup.py: literals, names, `os.path.join` and `glob`. Nothing is run."""

from __future__ import annotations

import ast
import glob
import itertools
import posixpath
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, TypeGuard

DEEPEST = 20
"""Upper bound of expressions within expressions, and of names that stand for names."""
MOST_VALUES = 100_000
"""Upper bound of the values and letters of a setup.py: a few lines of names of lists of names would fill the memory."""
MOST_FILES = 2000
"""Upper bound of the files that a pattern matches."""


def parsed(text: str) -> ast.Module | None:
    """Return the syntax tree of a program's `text`; None if it is not Python."""
    try:
        return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def keywords(tree: ast.Module, function: str) -> dict[str, ast.expr]:
    """Return the keyword arguments of the calls of `function` in a `tree`, by name; the last one counts."""
    found = {}
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and called(call) == function:
            found.update({each.arg: each.value for each in call.keywords if each.arg is not None})
    return found


def called(call: ast.Call) -> str:
    """Return the last name of the function of a `call`: `join` for `os.path.join`."""
    return str(getattr(call.func, "id", getattr(call.func, "attr", "")))


class Values:
    """Evaluator of the expressions of a module, `tree`: None for what only running would tell.

    More than MOST_VALUES in all is None, too. Patterns of `glob` are looked up in `folder`, and never outside of it.
    """

    def __init__(self, tree: ast.Module, folder: Path) -> None:
        self._known: Mapping[str, list[ast.expr]] = _assignments(tree)
        self._folder = folder
        self._left = MOST_VALUES

    def of(self, node: ast.expr, depth: int = 0) -> Any:
        """Return the value of the expression `node`; `depth` is that of expressions around it."""
        self._left -= 1
        return None if depth > DEEPEST or self._left < 0 else self._read(node, depth + 1)

    def _read(self, node: ast.expr, depth: int) -> Any:
        match node:
            case ast.Constant(value):
                return value
            case ast.Name(name):
                return self._named(name, depth)
            case ast.List(parts) | ast.Tuple(parts):
                return [self.of(each, depth) for each in parts]
            case ast.Dict(keys, values):
                pairs = zip(keys, values, strict=True)
                return {key.value: self.of(value, depth) for key, value in pairs if _is_text(key)}
            case ast.JoinedStr(parts):
                return self._counted(_joined([self.of(each, depth) for each in parts]))
            case ast.FormattedValue(value):
                return self.of(value, depth)
            case ast.BinOp(left, ast.Add(), right):
                return self._added(self.of(left, depth), self.of(right, depth))
            case ast.Call():
                return self._called(node, [self.of(each, depth) for each in node.args])
        return None

    def _named(self, name: str, depth: int) -> Any:
        """Return the value of a name: what it was assigned, and what was appended to it."""
        assigned = self._known.get(name, [])
        value = self.of(assigned[0], depth) if assigned else None
        if not isinstance(value, list):
            return value
        added = [self.of(each, depth) for each in assigned[1:]]
        return self._counted([*value, *(each for listed in added if isinstance(listed, list) for each in listed)])

    def _called(self, call: ast.Call, values: list[Any]) -> Any:
        if not values or not all(isinstance(each, str) for each in values):
            return None
        match called(call):
            case "join":
                return self._counted(posixpath.join(*values))
            case "glob" | "iglob":
                return self._counted(list(itertools.islice(_matching(self._folder, values[0]), MOST_FILES)))
            case "str":
                return values[0]
        return None

    def _added(self, left: Any, right: Any) -> Any:
        return self._counted(left + right) if type(left) is type(right) and isinstance(left, (str, list)) else None

    def _counted(self, value: Any) -> Any:
        self._left -= len(value or ())
        return value if self._left >= 0 else None


def _assignments(tree: ast.Module) -> dict[str, list[ast.expr]]:
    """Return what a module's names are assigned; after it the lists that are added to them."""
    found: dict[str, list[ast.expr]] = {}
    for each in tree.body:
        match each:
            case ast.Assign(targets, value):
                found.update({target.id: [value] for target in targets if isinstance(target, ast.Name)})
            case ast.AugAssign(ast.Name(name), ast.Add(), value) if name in found:
                found[name].append(value)
            case ast.Expr(ast.Call(ast.Attribute(ast.Name(name), "append"), [value])) if name in found:
                found[name].append(ast.List([value], ast.Load()))
            case ast.Expr(ast.Call(ast.Attribute(ast.Name(name), "extend"), [value])) if name in found:
                found[name].append(value)
    return found


def _matching(folder: Path, pattern: str) -> Iterator[str]:
    """Yield the files of a folder that match, relative to it and with slashes, as `glob` does where setup.py runs."""
    if pattern.startswith(("/", "~")) or ".." in pattern.split("/") or ":" in pattern or "\0" in pattern:
        return
    for each in glob.iglob(glob.escape(str(folder)) + "/" + pattern, recursive=True):  # noqa: PTH207 - its patterns
        yield Path(each).relative_to(folder).as_posix()


def _is_text(key: ast.expr | None) -> TypeGuard[ast.Constant]:
    return isinstance(key, ast.Constant) and isinstance(key.value, str)


def _joined(parts: list[Any]) -> str | None:
    return "".join(parts) if all(isinstance(each, str) for each in parts) else None
