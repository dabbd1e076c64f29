"""Read a launch file: all that it and the files that it includes come to."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from msgspec.structs import replace

from robolink.launch import sources
from robolink.launch.arguments import read_given, values_of
from robolink.launch.around import Around
from robolink.launch.checks import check_node, check_shared, check_terminal, check_words
from robolink.launch.conditions import decided, is_wanted
from robolink.launch.description import GroupDescription, IncludeDescription, NodeDescription
from robolink.launch.drafts import Draft, entries_of
from robolink.launch.entry import Entry
from robolink.launch.file import LaunchFile
from robolink.launch.keys import check_keys
from robolink.launch.parameters import given_in
from robolink.launch.part import Part, Place, copies
from robolink.launch.substitution import Step, Values
from robolink.workspace import Folder, NodeSource

__all__ = ["Entry", "read_launch_file"]

MOST_PARTS = 100_000
"""Copies of nodes, groups and includes: files that include others could fill the memory otherwise."""

_HELD = ("nodes", "include", "groups")
_NOTHING: Mapping[str, str] = MappingProxyType({})


def read_launch_file(
    path: str | os.PathLike[str],
    given: Mapping[str, str] = _NOTHING,
    *,
    workspace: Folder = None,
    text: str | None = None,
) -> list[Entry]:
    """Read a launch file (or `text` in its place): every node and command to start, with nothing left open.

    `given` are arguments as people type them, by name. Nodes are looked up in the launch file's own workspace, or,
    when it came with robolink, in the user's, which is `workspace` or the nearest. The list is empty when conditions
    leave nothing to start. Raises `DocumentError` with `file:line:column` for all that is wrong in the file, and
    `NotFoundError` for a `workspace` that is no folder.
    """
    file = LaunchFile(Path(path), text)
    reading = _Reading(workspace)
    entries = entries_of(reading.file(file, values_of(file, read_given(given)), Around()))
    check_terminal(entries)
    return entries


@dataclass(frozen=True)
class _Scope:
    """The file that is being read, where its nodes are looked up, and the files around it."""

    file: LaunchFile
    home: Path | None
    chain: tuple[Path, ...]


class _Reading:
    """The walk through a launch file and all that it includes."""

    def __init__(self, workspace: Folder) -> None:
        self._workspace = workspace
        self._parts = 0
        self._sources: dict[tuple[str, Path | None, Path], NodeSource] = {}

    def file(self, file: LaunchFile, values: Values, around: Around, chain: tuple[Path, ...] = ()) -> Iterator[Draft]:
        """Yield what a file comes to."""
        check_keys(file)
        file.value(file.data.get("description", ""), str, ["description"])
        home = sources.home_of(file.path, self._workspace)
        scope = _Scope(file, home, (*chain, file.path.resolve()))
        yield from self._held(scope, file.data, [], values, around)

    def _held(
        self, scope: _Scope, data: Mapping[str, Any], steps: Sequence[Step], values: Values, around: Around
    ) -> Iterator[Draft]:
        """Yield the nodes, what is included, and the groups, in the order in which these three are written."""
        held = {key: scope.file.value(data[key], list[dict[str, Any]], [*steps, key]) for key in data if key in _HELD}
        if not any(held.values()):
            raise scope.file.error([*steps, *list(held)[:1]], "there is nothing to start")
        read = {"nodes": self._node, "include": self._include, "groups": self._group}
        for key, each in held.items():
            for index, said in enumerate(each):
                for part in copies(scope.file, [*steps, key, index], said, values):
                    self._count(part)
                    if is_wanted(part):
                        yield from read[key](scope, part, around)

    def _node(self, scope: _Scope, part: Part, around: Around) -> Iterator[Draft]:
        check_words(part)
        has_keyboard = decided(part, "interactive", default=False)
        said: NodeDescription = replace(part.read(NodeDescription), interactive=has_keyboard)
        check_node(part, said)
        whole = around.with_node(part, said)
        own = given_in(part, scope.home) if "parameters" in part else []
        if said.node:
            yield Draft(part, said, whole, own, self._source(scope, part, said.node), scope.home, chain=scope.chain)
            return
        path = whole.env["PATH"].value if "PATH" in whole.env else None
        command = sources.command_of(list(map(str, said.run)), path)
        if command is None:
            raise part.error(["run", 0], f"no program '{said.run[0]}' is found: {sources.WHERE_PROGRAMS_ARE}")
        yield Draft(part, said, whole, own, None, scope.home, command, scope.chain)

    def _group(self, scope: _Scope, part: Part, around: Around) -> Iterator[Draft]:
        check_words(part)
        said: GroupDescription = part.read(GroupDescription, without=_HELD)
        check_shared(part, said)
        inner = around.within(part, said, scope.home)
        yield from self._held(scope, part.written, part.steps, part.values, inner)

    def _include(self, scope: _Scope, part: Part, around: Around) -> Iterator[Draft]:
        said: IncludeDescription = part.read(IncludeDescription)
        namespace = around.inside(part, said.namespace)
        try:
            path = sources.included_file(said.file, scope.home, scope.file.folder)
        except sources.NOT_FOUND as error:
            raise part.error(["file"], sources.reason_of(error)) from None
        if path.resolve() in scope.chain:
            names = [each.name for each in scope.chain[scope.chain.index(path.resolve()) :]]
            raise part.error(["file"], f"a file cannot include itself: {' -> '.join([*names, path.name])}")
        file = LaunchFile(path, above=scope.file.mentioned(part.steps))
        values = values_of(file, part.values_in("arguments"), Place(part))
        yield from self.file(file, values, around.moved_to(namespace), scope.chain)

    def _source(self, scope: _Scope, part: Part, name: str) -> NodeSource:
        """Find a node, once for all its copies."""
        asked = (name, scope.home, scope.file.folder)
        if asked not in self._sources:
            try:
                self._sources[asked] = sources.source_of(*asked)
            except sources.NOT_FOUND as error:
                raise part.error(["node"], sources.reason_of(error)) from None
        return self._sources[asked]

    def _count(self, part: Part) -> None:
        self._parts += 1
        if self._parts > MOST_PARTS:
            raise part.error([], f"more than {MOST_PARTS} nodes, groups and includes")
