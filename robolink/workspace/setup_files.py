"""Parser of a package's own files for its name and its programs. Everything is read, nothing is run."""

from __future__ import annotations

import ast
import glob
import itertools
import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, TypeGuard

from robolink.system.files import decoded, read_plain
from robolink.system.patterns import late

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
    """Return the values that a module's names are assigned; after them the lists that are added to them."""
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


LONGEST = 200_000
"""Largest file that is read, in bytes: Python's parser makes 600 bytes of memory of each byte of a setup.py."""
MOST_SCRIPTS = 1000
"""Upper bound of a package's programs."""

_NAME = late(r"<name>\s*([A-Za-z0-9][\w-]*)\s*</name>")
_ENTRY = late(r"\s*([\w.-]+)\s*=\s*([A-Za-z_][\w.]*)\s*(?::\s*([A-Za-z_][\w.]*)\s*)?(?:\[[^\]]*\]\s*)?")
_TOML_TABLE = late(r"^\[(.+?)\][ \t]*(?:#.*)?$", re.MULTILINE)
_TOML_ENTRY = late(r"""^[ \t]*["']?([\w.-]+)["']?\s*=\s*["']([^"'\n]*)["']""", re.MULTILINE)


def package_name(folder: Path) -> str:
    """Return the name in a folder's package.xml; '' if there is none."""
    found = _NAME.search(_read(folder / "package.xml"))
    return found[1] if found else ""


SCRIPTS = "console_scripts"
"""Group of the entry points that are programs."""


def console_scripts(folder: Path) -> dict[str, tuple[str, str]]:
    """Return the programs that a Python package names: name to module and function (``main`` if it names none)."""
    return entry_points(folder, SCRIPTS)


def entry_points(folder: Path, group: str) -> dict[str, tuple[str, str]]:
    """Return the entry points of a Python package: name to module and function (``main`` if it names none).

    Args:
        folder: Folder of the package.
        group: Group of the entry points.
    """
    lines = [
        *itertools.islice(_setup_py(_read(folder / "setup.py"), group), MOST_SCRIPTS),
        *_ini(_read(folder / "setup.cfg"), "options.entry_points", group),
        *_pyproject(_read(folder / "pyproject.toml"), group),
    ]
    return _scripts(lines)


def entry_points_file(file: Path) -> dict[str, tuple[str, str]]:
    """Return the programs in the entry_points.txt `file` of an installed package: name to module and function."""
    return _scripts(list(_ini(_read(file), SCRIPTS)))


def _scripts(lines: list[str]) -> dict[str, tuple[str, str]]:
    found = (_ENTRY.fullmatch(each) for each in lines[:MOST_SCRIPTS])
    return {match[1]: (match[2], match[3] or "main") for match in found if match}


def data_files(folder: Path) -> list[tuple[str, list[str]]]:
    """Return the `data_files` of the setup.py in a `folder`: the destination and its files, relative to `folder`.

    What only running would tell is left out.
    """
    tree = parsed(_read(folder / "setup.py"))
    given = None if tree is None else keywords(tree, "setup").get("data_files")
    if tree is None or given is None:
        return []
    listed = Values(tree, folder).of(given)
    pairs = [each for each in listed or () if isinstance(each, list) and len(each) == 2] if listed else []
    return [
        (place, [each for each in files if isinstance(each, str)])
        for place, files in pairs
        if isinstance(place, str) and isinstance(files, list)
    ]


def _read(file: Path) -> str:
    try:
        return decoded(read_plain(file, LONGEST), "replace")
    except (OSError, ValueError):
        return ""


def _setup_py(text: str, group: str) -> Iterator[str]:
    """Yield the entry points that a setup.py gives to `setup()`, as far as they are plain text in it."""
    tree = parsed(text)
    if tree is not None and (given := keywords(tree, "setup").get("entry_points")) is not None:
        yield from _points_in(Values(tree, Path()).of(given), group)


def _points_in(given: Any, group: str) -> Iterator[str]:
    if isinstance(given, str):  # setuptools takes the text of an .ini file too
        yield from _ini(given, group)
    elif isinstance(given, dict):
        points = given.get(group, ())
        lines = points.splitlines() if isinstance(points, str) else points
        yield from (each for each in lines if isinstance(each, str)) if isinstance(lines, Iterable) else ()


def _ini(text: str, section: str, option: str = "") -> Iterator[str]:
    """Yield the lines of an option, or all of a section as ``name = value``."""
    import configparser  # late: it takes longer to import than to use, and few packages have such a file

    if not text:
        return
    parser = configparser.RawConfigParser(delimiters=("=",), strict=False)
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    try:
        parser.read_string(text)
    except configparser.Error:
        return
    if option:
        yield from parser.get(section, option, fallback="").splitlines()
    elif parser.has_section(section):
        yield from (f"{name} = {value}" for name, value in parser.items(section))


def _pyproject(text: str, group: str) -> Iterator[str]:
    """Yield a pyproject.toml's entry points; Python 3.10 has no reader for TOML, and these tables are plain lines."""
    parts = _TOML_TABLE.split(text)
    tables = [f'project.entry-points."{group}"', f"project.entry-points.{group}"]
    tables += ["project.scripts"] if group == SCRIPTS else []
    for table, content in zip(parts[1::2], parts[2::2], strict=True):
        if table.strip().replace(" ", "") in tables:
            yield from (f"{name} = {value}" for name, value in _TOML_ENTRY.findall(content))
