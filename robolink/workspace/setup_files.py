"""Parser of a package's own files for its name and its programs. Everything is read, nothing is run."""

from __future__ import annotations

import ast
import itertools
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, TypeGuard

from robolink.system.plainfile import read_plain

LONGEST = 200_000
"""Largest file that is read, in bytes: Python's parser makes 600 bytes of memory of each byte of a setup.py."""
MOST_SCRIPTS = 1000
"""Upper bound of a package's programs."""
DEEPEST = 20
"""Upper bound of expressions within expressions, and of names that stand for names."""
MOST_VALUES = 100_000
"""Upper bound of the values and letters of a setup.py: a few lines of names of lists of names would fill the memory."""

_NAME = re.compile(r"<name>\s*([A-Za-z0-9][\w-]*)\s*</name>")
_ENTRY = re.compile(r"\s*([\w.-]+)\s*=\s*([A-Za-z_][\w.]*)\s*(?::\s*([A-Za-z_][\w.]*)\s*)?(?:\[[^\]]*\]\s*)?")
_TOML_TABLE = re.compile(r"^\[(.+?)\][ \t]*(?:#.*)?$", re.MULTILINE)
_TOML_ENTRY = re.compile(r"""^[ \t]*["']?([\w.-]+)["']?\s*=\s*["']([^"'\n]*)["']""", re.MULTILINE)
_TOML_SCRIPTS = ("project.scripts", 'project.entry-points."console_scripts"', "project.entry-points.console_scripts")
_CMAKE_PROGRAMS = re.compile(r"\binstall\s*\(\s*PROGRAMS\b([^()]*)", re.IGNORECASE)
_CMAKE_TO_LIB = re.compile(r"\bDESTINATION\s+\"?lib/", re.IGNORECASE)


def package_name(folder: Path) -> str:
    """Return the name in a folder's package.xml; '' if there is none."""
    found = _NAME.search(_read(folder / "package.xml"))
    return found[1] if found else ""


def console_scripts(folder: Path) -> dict[str, tuple[str, str]]:
    """Return the programs that a Python package names: name to module and function (``main`` if it names none)."""
    lines = [
        *itertools.islice(_setup_py(_read(folder / "setup.py")), MOST_SCRIPTS),
        *_setup_cfg(_read(folder / "setup.cfg")),
        *_pyproject(_read(folder / "pyproject.toml")),
    ]
    found = (_ENTRY.fullmatch(each) for each in lines[:MOST_SCRIPTS])
    return {match[1]: (match[2], match[3] or "main") for match in found if match}


def installed_scripts(folder: Path) -> dict[str, Path]:
    """Return the Python files that a CMakeLists.txt installs as programs: name, with its suffix, to file."""
    text = re.sub(r"#.*", "", _read(folder / "CMakeLists.txt"))
    listed = (_CMAKE_TO_LIB.split(each, maxsplit=1) for each in _CMAKE_PROGRAMS.findall(text))
    names = (name.strip('"') for parts in listed if len(parts) > 1 for name in parts[0].split())
    files = [folder / each for each in itertools.islice(names, MOST_SCRIPTS) if each.endswith(".py")]
    return {each.name: each for each in files if each.is_file()}


def _read(file: Path) -> str:
    try:
        return read_plain(file, LONGEST).decode("utf-8-sig", errors="replace")
    except (OSError, ValueError):
        return ""


def _setup_py(text: str) -> Iterator[str]:
    """Yield the console scripts that a setup.py gives to `setup()`, as far as they are plain text in it."""
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    values = _Values(dict(_assignments(tree)))
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and getattr(call.func, "id", getattr(call.func, "attr", "")) == "setup":
            for keyword in call.keywords:
                if keyword.arg == "entry_points":
                    yield from _scripts_in(values.of(keyword.value))


def _assignments(tree: ast.Module) -> Iterator[tuple[str, ast.expr]]:
    for each in tree.body:
        if isinstance(each, ast.Assign):
            yield from ((target.id, each.value) for target in each.targets if isinstance(target, ast.Name))


def _scripts_in(entry_points: Any) -> Iterator[str]:
    if isinstance(entry_points, str):  # setuptools takes the text of an .ini file too
        yield from _ini(entry_points, "console_scripts")
    elif isinstance(entry_points, dict):
        scripts = entry_points.get("console_scripts", ())
        lines = scripts.splitlines() if isinstance(scripts, str) else scripts
        yield from (each for each in lines if isinstance(each, str)) if isinstance(lines, Iterable) else ()


class _Values:
    """Evaluator of expressions that consist of literals and of names, `known`: None for what only running would tell.

    More than MOST_VALUES in all is None, too.
    """

    def __init__(self, known: Mapping[str, ast.expr]) -> None:
        self._known = known
        self._left = MOST_VALUES

    def of(self, node: ast.expr, depth: int = 0) -> Any:
        """Return the value of an expression."""
        self._left -= 1
        return None if depth > DEEPEST or self._left < 0 else self._read(node, depth + 1)

    def _read(self, node: ast.expr, depth: int) -> Any:
        match node:
            case ast.Constant(value):
                return value
            case ast.Name(name):
                return self.of(self._known[name], depth) if name in self._known else None
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
        return None

    def _added(self, left: Any, right: Any) -> Any:
        return self._counted(left + right) if type(left) is type(right) and isinstance(left, (str, list)) else None

    def _counted(self, value: Any) -> Any:
        self._left -= len(value or ())
        return value if self._left >= 0 else None


def _is_text(key: ast.expr | None) -> TypeGuard[ast.Constant]:
    return isinstance(key, ast.Constant) and isinstance(key.value, str)


def _joined(parts: list[Any]) -> str | None:
    return "".join(parts) if all(isinstance(each, str) for each in parts) else None


def _setup_cfg(text: str) -> Iterator[str]:
    yield from _ini(text, "options.entry_points", "console_scripts")


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


def _pyproject(text: str) -> Iterator[str]:
    """Yield the scripts of a pyproject.toml; Python 3.10 has no reader for TOML, and these tables are plain lines."""
    parts = _TOML_TABLE.split(text)
    for table, content in zip(parts[1::2], parts[2::2], strict=True):
        if table.strip().replace(" ", "") in _TOML_SCRIPTS:
            yield from (f"{name} = {value}" for name, value in _TOML_ENTRY.findall(content))
