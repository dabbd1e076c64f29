"""Parser of a package's own files for its name and its programs. Everything is read, nothing is run."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from robolink.system.files import decoded, read_plain
from robolink.workspace.literals import Values, keywords, parsed

LONGEST = 200_000
"""Largest file that is read, in bytes: Python's parser makes 600 bytes of memory of each byte of a setup.py."""
MOST_SCRIPTS = 1000
"""Upper bound of a package's programs."""

_NAME = re.compile(r"<name>\s*([A-Za-z0-9][\w-]*)\s*</name>")
_ENTRY = re.compile(r"\s*([\w.-]+)\s*=\s*([A-Za-z_][\w.]*)\s*(?::\s*([A-Za-z_][\w.]*)\s*)?(?:\[[^\]]*\]\s*)?")
_TOML_TABLE = re.compile(r"^\[(.+?)\][ \t]*(?:#.*)?$", re.MULTILINE)
_TOML_ENTRY = re.compile(r"""^[ \t]*["']?([\w.-]+)["']?\s*=\s*["']([^"'\n]*)["']""", re.MULTILINE)
_TOML_SCRIPTS = ("project.scripts", 'project.entry-points."console_scripts"', "project.entry-points.console_scripts")


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
    return _scripts(lines)


def entry_points_file(file: Path) -> dict[str, tuple[str, str]]:
    """Return the programs in the entry_points.txt `file` of an installed package: name to module and function."""
    return _scripts(list(_ini(_read(file), "console_scripts")))


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


def _setup_py(text: str) -> Iterator[str]:
    """Yield the console scripts that a setup.py gives to `setup()`, as far as they are plain text in it."""
    tree = parsed(text)
    if tree is not None and (given := keywords(tree, "setup").get("entry_points")) is not None:
        yield from _scripts_in(Values(tree, Path()).of(given))


def _scripts_in(entry_points: Any) -> Iterator[str]:
    if isinstance(entry_points, str):  # setuptools takes the text of an .ini file too
        yield from _ini(entry_points, "console_scripts")
    elif isinstance(entry_points, dict):
        scripts = entry_points.get("console_scripts", ())
        lines = scripts.splitlines() if isinstance(scripts, str) else scripts
        yield from (each for each in lines if isinstance(each, str)) if isinstance(lines, Iterable) else ()


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
