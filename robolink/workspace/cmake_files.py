"""Parser of a package's CMakeLists.txt for what it installs. Nothing is run: `if` and `foreach` are not followed.

Variables are known if the file sets them: `set`, `list(APPEND)`, `file(GLOB)`, and the names of CMake for the package's
folder and name.
"""

from __future__ import annotations

import contextlib
import itertools
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fnmatch import translate
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import NamedTuple

from robolink.system.files import decoded, read_plain

MOST_LISTED = 2000
"""Upper bound of the files and folders of one listing."""
MOST_LOOKS = 100_000
"""Upper bound of the files and folders that all listings of a package look at together."""
_WILD = re.compile(r"[*?\[]")


class Listed(NamedTuple):
    """File or folder: its path from where the listing begins, with slashes, and whether it is a file."""

    path: str
    is_file: bool


class Listing:
    """Files and folders of the package in `folder`; hidden folders are left out.

    Each is read once. After `MOST_LOOKS` of all of them there are none any more.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._left = MOST_LOOKS
        self._known: dict[tuple[str, bool], list[Listed]] = {}

    def below(self, at: str, *, is_deep: bool = True) -> Iterator[Listed]:
        """Yield the content of the folder at a relative path, `at`, by name; with `is_deep` in those inside, too."""
        self._left -= 1
        if self._left >= 0:
            key = (str(PurePosixPath(at)), is_deep)
            if key not in self._known:
                self._known[key] = _entries_of(self._folder / at, is_deep)
            for each in self._known[key]:
                self._left -= 1
                if self._left < 0:
                    return
                yield each

    def matching(self, at: str, pattern: str, *, is_deep: bool) -> Iterator[str]:
        """Yield the paths that match a pattern with wildcards, as CMake's file(GLOB) does, or GLOB_RECURSE.

        Args:
            at: Relative path of the folder from which they count, and the pattern, too.
            pattern: Path whose parts may have `*`, `?` and `[...]`.
            is_deep: True finds files in all folders below, too, and no folders.
        """
        parts = PurePosixPath(pattern).parts
        fixed = next((n for n, each in enumerate(parts[:-1]) if _WILD.search(each)), max(len(parts) - 1, 0))
        rules = [re.compile(translate(each)) for each in parts[fixed:]]
        top = "/".join(parts[:fixed])
        for found in self.below(f"{at}{top}", is_deep=is_deep or len(rules) > 1):
            if _matches(found, rules, is_deep):
                yield f"{top}/{found.path}" if top else found.path


def _matches(found: Listed, rules: list[re.Pattern[str]], is_deep: bool) -> bool:
    *above, last = found.path.split("/")
    *outer, name = rules
    if len(above) < len(outer) if is_deep else len(above) != len(outer):
        return False
    is_kind = found.is_file or not is_deep
    return is_kind and bool(name.match(last)) and all(map(re.Pattern.match, outer, above))


def _entries_of(folder: Path, is_deep: bool) -> list[Listed]:
    found: list[Listed] = []
    waiting = [""]
    while waiting and len(found) < MOST_LISTED:
        here = waiting.pop()
        inside = list(_entries(folder / here, here))
        found += inside[: MOST_LISTED - len(found)]
        if is_deep:
            folders = [each.path for each in inside if not each.is_file]
            waiting += [each for each in reversed(folders) if not PurePosixPath(each).name.startswith(".")]
    return found


def _entries(folder: Path, at: str) -> Iterator[Listed]:
    """Yield the content of a folder, by name; a link to a folder is none, since it may lead back."""
    try:
        with os.scandir(folder) as entries:
            listed = sorted((each.name, each.is_file()) for each in entries if each.is_file() or not each.is_symlink())
    except (OSError, ValueError):  # it is none, or no name at all
        return
    for name, is_file in listed:
        yield Listed(f"{at}/{name}" if at else name, is_file)


LONGEST = 200_000
"""Largest file that is read, in bytes."""
MOST_FILES_READ = 50
"""Upper bound of the CMakeLists.txt of a package that are read: its own, and those of `add_subdirectory`."""
MOST = 2000
"""Upper bound of the commands and of the words of a command that are read."""
LONGEST_WORD = 4096
"""Length to which a word with variables is cut, in letters: no path is longer."""
MOST_LETTERS = 1_000_000
"""Upper bound of the letters that the variables of a package stand for, in all."""
MOST_SOURCES = 20_000
"""Upper bound of the files and folders that a package installs, in all."""

# All take `\"` for a letter and an open quote for one that ends with the text: else each quote would be tried anew, in
# quadratic time.
_QUOTED = r'"(?:[^"\\]|\\.)*(?:"|\\?\Z)'
_COMMENT = re.compile(rf"(?P<text>{_QUOTED}|\\.)|#\[(?P<level>=*)\[.*?(?:\](?P=level)\]|\Z)|#[^\n]*", re.DOTALL)
_COMMAND = re.compile(rf'{_QUOTED}|\\.|(?<!\w)([A-Za-z_]\w*)\s*\(((?:[^()"\\]|\\.|{_QUOTED})*)\)', re.DOTALL)
_WORD = re.compile(r'"((?:[^"\\]|\\.)*)"|((?:[^\s"\\]|\\.)+)', re.DOTALL)
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_KEYWORD = re.compile(
    "DESTINATION|RENAME|PERMISSIONS|USE_SOURCE_PERMISSIONS|PATTERN|REGEX|FILES_MATCHING|EXCLUDE|OPTIONAL|COMPONENT|TYPE|"
    "CONFIGURATIONS|RUNTIME|LIBRARY|ARCHIVE|EXPORT|INCLUDES|FILE_PERMISSIONS|DIRECTORY_PERMISSIONS"
)
_COPIED = ("PROGRAMS", "FILES", "DIRECTORY")
_FOLDERS = ("CMAKE_CURRENT_SOURCE_DIR", "CMAKE_SOURCE_DIR", "PROJECT_SOURCE_DIR", "CMAKE_CURRENT_LIST_DIR")


@dataclass(frozen=True)
class Install:
    """An `install(...)`: its `kind` (PROGRAMS, FILES or DIRECTORY), `sources`, `destination` and new name."""

    kind: str
    sources: list[str]
    destination: str
    rename: str = ""


class CMakeFile:
    """CMakeLists.txt of the package in `folder`; empty if there is none."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._at = ""
        self._variables = {name: ["."] for name in _FOLDERS}
        self._files_left = MOST_FILES_READ
        self._letters_left = MOST_LETTERS
        self._sources_left = MOST_SOURCES
        self._listing = Listing(folder)
        self.installs: list[Install] = []
        self.compiled: list[str] = []
        """Names of the executables that are compiled."""
        self._read_folder("")

    def scripts(self) -> dict[str, Path]:
        """Return the Python programs that are installed: name to file."""
        found: dict[str, Path] = {}
        known: dict[Path, bool] = {}  # each file is opened once
        programs = [each for each in self.installs if each.destination.startswith("lib/") and each.kind in _COPIED]
        for install in programs:
            for path in self._files(install):
                if path not in known:
                    known[path] = is_python(path)
                if known[path]:
                    found.setdefault(install.rename or path.name, path)
        return dict(itertools.islice(found.items(), MOST))

    def _read_folder(self, at: str) -> None:
        """Read the file in a folder of the package, `at`, whose paths are relative to that."""
        above, self._at = self._at, at
        self._files_left -= 1
        text = _COMMENT.sub(lambda match: match["text"] or "", _read(self._folder / at / "CMakeLists.txt"))
        commands = (match for match in _COMMAND.finditer(text) if match[1])  # none is in a text in quotes
        for command in itertools.islice(commands, MOST if self._files_left >= 0 else 0):
            self._run(command[1].lower(), self._words(command[2]))
        self._at = above

    def _files(self, install: Install) -> Iterator[Path]:
        for each in dict.fromkeys(install.sources):
            path = self._folder / each
            if install.kind == "DIRECTORY":
                yield from (path / found.path for found in self._listing.below(each) if found.is_file)
            else:
                with contextlib.suppress(OSError, ValueError):  # no name of a file: too long, say
                    if path.is_file():
                        yield path

    def _run(self, command: str, words: list[str]) -> None:
        match command, words:
            case "project", [name, *_]:
                self._variables["PROJECT_NAME"] = self._variables["CMAKE_PROJECT_NAME"] = [name]
            case "set", [name, *values]:
                self._variables[name] = values
            case "list", ["APPEND", name, *values]:
                self._variables[name] = [*self._variables.get(name, []), *values][:MOST]
            case "file", ["GLOB" | "GLOB_RECURSE" as kind, name, *patterns]:
                self._variables[name] = list(self._globbed(patterns, kind == "GLOB_RECURSE"))
            case "install", [kind, *rest]:
                self._note(_install(kind, rest))
            case "add_subdirectory", [name, *_] if _is_inside(name):
                self._read_folder(f"{self._at}{name.rstrip('/')}/")
            case _, [name, *_] if command.endswith("add_executable"):
                self.compiled.append(name)
            case "rclcpp_components_register_node", _ if "EXECUTABLE" in words[:-1]:
                self.compiled.append(words[words.index("EXECUTABLE") + 1])

    def _note(self, install: Install) -> None:
        if install.kind == "TARGETS":
            self.compiled += install.sources if install.destination.startswith("lib/") else []
        else:
            sources = [self._at + each for each in install.sources if _is_inside(each)][: self._sources_left]
            self._sources_left -= len(sources)
            self.installs.append(replace(install, sources=sources))

    def _globbed(self, patterns: list[str], recursive: bool) -> Iterator[str]:
        for each in filter(_is_inside, patterns):
            yield from self._listing.matching(self._at, each, is_deep=recursive)

    def _words(self, text: str) -> list[str]:
        """Return the words of a command, with the values of variables; unknown ones are left out."""
        words: list[str] = []
        for quoted, plain in (match.groups("") for match in itertools.islice(_WORD.finditer(text), MOST)):
            whole = _VARIABLE.fullmatch(plain)
            words += self._values(whole[1]) if whole is not None else [self._expanded(quoted or plain)]
        return [each.removeprefix("./") for each in words[:MOST]]

    def _expanded(self, text: str) -> str:
        """Return a word with the values of its variables, cut to `LONGEST_WORD`."""
        whole = ""
        for piece in self._pieces(text):
            whole += piece[:LONGEST_WORD]
            if len(whole) >= LONGEST_WORD:
                break
        return whole[:LONGEST_WORD]

    def _pieces(self, text: str) -> Iterator[str]:
        for index, piece in enumerate(_VARIABLE.split(text)):
            if index % 2 == 0:
                yield piece
            else:
                for place, value in enumerate(self._values(piece)):
                    yield f";{value}" if place else value

    def _values(self, name: str) -> Iterator[str]:
        """Yield the words of a variable: none if it is unknown, or if `MOST_LETTERS` were read."""
        for each in self._variables.get(name, []):
            self._letters_left -= len(each) + 1
            if self._letters_left < 0:
                return
            yield each


def _is_inside(path: str) -> bool:
    """True if a path leads neither up nor to a place of its own, such as `/` or `C:`."""
    parts = PureWindowsPath(path)  # also what is relative elsewhere: no package means it
    return not parts.anchor and ".." not in parts.parts


def _install(kind: str, words: list[str]) -> Install:
    end = next((index for index, each in enumerate(words) if _KEYWORD.fullmatch(each)), len(words))
    options = dict(zip(words[end:], words[end + 1 :], strict=False))
    return Install(kind, words[:end], options.get("DESTINATION", "").rstrip("/"), options.get("RENAME", ""))


def is_python(path: Path) -> bool:
    """True if the file `path` has the suffix .py, or if its first line names Python."""
    if path.suffix == ".py":
        return not path.name.startswith("__")
    try:
        with path.open("rb") as file:
            first = file.readline(200)
    except OSError:
        return False
    return first.startswith(b"#!") and b"python" in first


def _read(path: Path) -> str:
    try:
        return decoded(read_plain(path, LONGEST), "replace")
    except (OSError, ValueError):
        return ""
