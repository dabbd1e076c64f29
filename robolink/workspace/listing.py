"""Directory listings of a package, with one upper bound of the work for all that is asked about it."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from fnmatch import translate
from pathlib import Path, PurePosixPath
from typing import NamedTuple

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
        """Yield what is in the folder at a relative path, `at`, by name; with `is_deep` in those inside, too."""
        self._left -= 1
        if self._left >= 0:
            key = (str(PurePosixPath(at)), is_deep)
            if key not in self._known:
                self._known[key] = _read(self._folder / at, is_deep)
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


def _read(folder: Path, is_deep: bool) -> list[Listed]:
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
    """Yield what is in a folder, by name; a link to a folder is none, since it may lead back."""
    try:
        with os.scandir(folder) as entries:
            listed = sorted((each.name, each.is_file()) for each in entries if each.is_file() or not each.is_symlink())
    except (OSError, ValueError):  # it is none, or no name at all
        return
    for name, is_file in listed:
        yield Listed(f"{at}/{name}" if at else name, is_file)
