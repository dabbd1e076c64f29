"""What the files of a package say of it: its name, and its programs. Everything is read, nothing is run."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

LONGEST = 2**20
"""Bytes of a file that is read."""

_NAME = re.compile(r"<name>\s*([A-Za-z0-9][\w-]*)\s*</name>")
_ENTRY = re.compile(r"\s*([\w.-]+)\s*=\s*([A-Za-z_][\w.]*)\s*(?::\s*([A-Za-z_][\w.]*))?\s*(?:\[[^\]]*\]\s*)?")
_TOML_TABLE = re.compile(r"^\[(.+?)\]\s*(?:#.*)?$", re.MULTILINE)
_TOML_ENTRY = re.compile(r"""^\s*["']?([\w.-]+)["']?\s*=\s*["']([^"'\n]*)["']""", re.MULTILINE)
_TOML_SCRIPTS = ("project.scripts", 'project.entry-points."console_scripts"', "project.entry-points.console_scripts")
_CMAKE_PROGRAMS = re.compile(r"\binstall\s*\(\s*PROGRAMS\b([^)]*?)\bDESTINATION\s+\"?lib/", re.IGNORECASE)


def package_name(folder: Path) -> str:
    """Give the name in a folder's package.xml; '' where there is none."""
    found = _NAME.search(_read(folder / "package.xml"))
    return found[1] if found else ""


def console_scripts(folder: Path) -> dict[str, tuple[str, str]]:
    """Give the programs that a Python package names: name to module and function (``main`` where it names none)."""
    lines = [
        *_setup_py(_read(folder / "setup.py")),
        *_setup_cfg(_read(folder / "setup.cfg")),
        *_pyproject(_read(folder / "pyproject.toml")),
    ]
    found = (_ENTRY.fullmatch(each) for each in lines)
    return {match[1]: (match[2], match[3] or "main") for match in found if match}


def installed_scripts(folder: Path) -> dict[str, Path]:
    """Give the Python files that a CMakeLists.txt installs as programs: name, with its suffix, to file."""
    text = re.sub(r"#.*", "", _read(folder / "CMakeLists.txt"))
    files = (folder / each.strip('"') for listed in _CMAKE_PROGRAMS.findall(text) for each in listed.split())
    return {each.name: each for each in files if each.suffix == ".py" and each.is_file()}


def _read(file: Path) -> str:
    try:
        if file.is_file() and file.stat().st_size <= LONGEST:
            return file.read_text(encoding="utf-8-sig", errors="replace")
    except (OSError, ValueError):
        pass
    return ""


def _setup_py(text: str) -> Iterator[str]:
    """Yield the console scripts that a setup.py gives to `setup()`, as far as they are plain text in it."""
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    known = dict(_assignments(tree))
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and getattr(call.func, "id", getattr(call.func, "attr", "")) == "setup":
            for keyword in call.keywords:
                if keyword.arg == "entry_points":
                    yield from _scripts_in(value_of(keyword.value, known))


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


def value_of(node: ast.expr, known: Mapping[str, ast.expr], depth: int = 0) -> Any:
    """Give what an expression of literals and of names in `known` stands for; None for what only running would tell."""
    if depth > 20:
        return None

    def inner(each: ast.expr) -> Any:
        return value_of(each, known, depth + 1)

    readers: dict[type, Callable[[Any], Any]] = {
        ast.Constant: lambda it: it.value,
        ast.Name: lambda it: inner(known[it.id]) if it.id in known else None,
        ast.List: lambda it: [inner(each) for each in it.elts],
        ast.Tuple: lambda it: [inner(each) for each in it.elts],
        ast.Dict: lambda it: {
            inner(key): inner(value) for key, value in zip(it.keys, it.values, strict=True) if _is_text(key)
        },
        ast.JoinedStr: lambda it: _joined([inner(each) for each in it.values]),
        ast.FormattedValue: lambda it: inner(it.value),
        ast.BinOp: lambda it: _added(inner(it.left), inner(it.right)) if isinstance(it.op, ast.Add) else None,
    }
    read = readers.get(type(node))
    return None if read is None else read(node)


def _is_text(key: ast.expr | None) -> bool:
    return isinstance(key, ast.Constant) and isinstance(key.value, str)


def _joined(parts: list[Any]) -> str | None:
    return "".join(parts) if all(isinstance(each, str) for each in parts) else None


def _added(left: Any, right: Any) -> Any:
    return left + right if type(left) is type(right) and isinstance(left, (str, list)) else None


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
