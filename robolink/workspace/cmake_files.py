"""Parser of a package's CMakeLists.txt for what it installs. Nothing is run: `if` and `foreach` are not followed.

Variables are known if the file sets them: `set`, `list(APPEND)`, `file(GLOB)`, and the names of CMake for the package's
folder and name.
"""

from __future__ import annotations

import contextlib
import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from robolink.system.plainfile import read_plain
from robolink.workspace.literals import MOST_FILES

LONGEST = 200_000
"""Largest file that is read, in bytes."""
MOST_FILES_READ = 50
"""Upper bound of the CMakeLists.txt of a package that are read: its own, and those of `add_subdirectory`."""
MOST = 2000
"""Upper bound of the commands and of the words of a command that are read."""

_COMMAND = re.compile(r"([A-Za-z_]\w*)\s*\(((?:[^()\"]|\"(?:[^\"\\]|\\.)*\")*)\)")
_COMMENT = re.compile(r"(\"(?:[^\"\\]|\\.)*\")|#[^\n]*")
_WORD = re.compile(r"\"((?:[^\"\\]|\\.)*)\"|([^\s\"]+)")
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_KEYWORD = re.compile(
    "DESTINATION|RENAME|PERMISSIONS|USE_SOURCE_PERMISSIONS|PATTERN|REGEX|FILES_MATCHING|EXCLUDE|OPTIONAL|COMPONENT|TYPE|"
    "CONFIGURATIONS|RUNTIME|LIBRARY|ARCHIVE|EXPORT|INCLUDES|FILE_PERMISSIONS|DIRECTORY_PERMISSIONS"
)
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
        self.installs: list[Install] = []
        self.compiled: list[str] = []
        """Names of the executables that are compiled."""
        self._read_folder("")

    def scripts(self) -> dict[str, Path]:
        """Return the Python programs that are installed: name to file."""
        found: dict[str, Path] = {}
        for each in self.installs:
            if each.destination.startswith("lib/") and each.kind in ("PROGRAMS", "FILES", "DIRECTORY"):
                for path in self._files(each):
                    if is_python(path):
                        found.setdefault(each.rename or path.name, path)
        return dict(itertools.islice(found.items(), MOST))

    def _read_folder(self, at: str) -> None:
        """Read the file in a folder of the package, `at`, whose paths are relative to that."""
        above, self._at = self._at, at
        self._files_left -= 1
        text = _COMMENT.sub(lambda match: match[1] or "", _read(self._folder / at / "CMakeLists.txt"))
        for command in itertools.islice(_COMMAND.finditer(text), MOST if self._files_left >= 0 else 0):
            self._run(command[1].lower(), self._words(command[2]))
        self._at = above

    def _files(self, install: Install) -> Iterator[Path]:
        for each in install.sources:
            path = self._folder / each
            if install.kind == "DIRECTORY":
                yield from sorted(found for found in itertools.islice(path.rglob("*"), MOST) if found.is_file())
            elif path.is_file():
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
            case "add_subdirectory", [name, *_] if ".." not in name.split("/") and not name.startswith("/"):
                self._read_folder(f"{self._at}{name.rstrip('/')}/")
            case _, [name, *_] if command.endswith("add_executable"):
                self.compiled.append(name)
            case "rclcpp_components_register_node", _ if "EXECUTABLE" in words[:-1]:
                self.compiled.append(words[words.index("EXECUTABLE") + 1])

    def _note(self, install: Install) -> None:
        if install.kind == "TARGETS":
            self.compiled += install.sources if install.destination.startswith("lib/") else []
        else:
            sources = [each if each.startswith("/") else self._at + each for each in install.sources]
            self.installs.append(replace(install, sources=sources))

    def _globbed(self, patterns: list[str], recursive: bool) -> Iterator[str]:
        for each in patterns:
            if not each.startswith("/") and ".." not in each.split("/"):
                here = self._folder / self._at
                with contextlib.suppress(ValueError, NotImplementedError):  # no pattern at all
                    listed = itertools.islice(here.rglob(each) if recursive else here.glob(each), MOST_FILES)
                    yield from sorted(path.relative_to(here).as_posix() for path in listed)

    def _words(self, text: str) -> list[str]:
        """Return the words of a command, with the values of variables; unknown ones are left out."""
        words: list[str] = []
        for quoted, plain in itertools.islice(_WORD.findall(text), MOST):
            whole = _VARIABLE.fullmatch(plain)
            if whole is not None:
                words += self._variables.get(whole[1], [])
            else:
                words.append(_VARIABLE.sub(lambda match: ";".join(self._variables.get(match[1], [])), quoted or plain))
        return [each.removeprefix("./") for each in words[:MOST]]


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
        return read_plain(path, LONGEST).decode("utf-8-sig", errors="replace")
    except (OSError, ValueError):
        return ""
