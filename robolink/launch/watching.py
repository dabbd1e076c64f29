"""File sets of the processes of a launch file: what `launch --watch` watches."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from robolink.workspace.packages import import_roots, source_packages

if TYPE_CHECKING:
    from robolink.launch.entry import Entry
    from robolink.launch.planning import Launched


def files_of(launched: Iterable[Launched]) -> dict[str, list[Path]]:
    """Return the Python files of each process: of its nodes, or those that its command names.

    Nodes of an installed package have none.
    """
    return {each.name: [*_of_nodes(each.entries), *_of_command(each.command)] for each in launched}


def roots_of(launched: Iterable[Launched]) -> list[Path]:
    """Return the folders, besides a file's own, from which nodes import the user's code: those of packages."""
    entries = [entry for each in launched for entry in each.entries]
    roots = [entry.source.root for entry in entries if entry.source is not None and entry.source.root is not None]
    for home in dict.fromkeys(entry.home for entry in entries if entry.home is not None):
        roots += [root for package in source_packages(home).values() for root in import_roots(package)]
    return list(dict.fromkeys(roots))


def settings_of(launched: Iterable[Launched]) -> set[Path]:
    """Return the launch files and parameter files, which are read once, before anything is started."""
    return {file.resolve() for each in launched for entry in each.entries for file in entry.files}


def _of_nodes(entries: Sequence[Entry]) -> list[Path]:
    return [each.source.path for each in entries if each.source is not None]


def _of_command(command: Sequence[str]) -> list[Path]:
    return [Path(word).resolve() for word in command if word.endswith(".py") and Path(word).is_file()]
