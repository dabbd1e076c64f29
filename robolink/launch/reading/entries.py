"""Read a launch file: all that it and the files that it includes come to."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from dataclasses import replace as replaced
from pathlib import Path, PurePath
from types import MappingProxyType
from typing import Any

from msgspec.structs import replace

from robolink.exceptions import MOST_MISTAKES, DocumentError, few
from robolink.launch.reading import limits, lookup
from robolink.launch.reading.arguments import read_given, values_of
from robolink.launch.reading.around import Around
from robolink.launch.reading.checks import check_node, check_shared, check_terminal, check_words
from robolink.launch.reading.conditions import decided, is_wanted
from robolink.launch.reading.description import GroupDescription, IncludeDescription, NodeDescription
from robolink.launch.reading.drafts import Draft, Refuse, entries_of
from robolink.launch.reading.entry import Entry
from robolink.launch.reading.file import LaunchFile
from robolink.launch.reading.keys import unknown_keys
from robolink.launch.reading.parameters import given_in
from robolink.launch.reading.part import Part, Place, copies
from robolink.launch.reading.substitution import Step, Values
from robolink.workspace import Folder, NodeSource

__all__ = ["Entry", "read_launch_file", "read_with_mistakes"]

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
    return _read(LaunchFile(Path(path), text), given, workspace, _raised)


def read_with_mistakes(
    path: str | os.PathLike[str],
    given: Mapping[str, str] = _NOTHING,
    *,
    workspace: Folder = None,
    text: str | None = None,
) -> tuple[list[Entry], list[DocumentError]]:
    """Read a launch file as `read_launch_file` does, and give all that is wrong in it, by place.

    That is one mistake of each node, group and include; then what they have to do with each other is not looked at.
    What keeps the file from being read at all is the only one: text that is no YAML, or a mapping in place of a list.
    """
    found: list[DocumentError] = []
    entries: list[Entry] = []
    try:
        entries = _read(LaunchFile(Path(path), text), given, workspace, found.append)
    except DocumentError as error:
        found.append(error)
    by_place = {(each.file != os.fspath(path), each.file, each.line, each.column): each for each in reversed(found)}
    return entries, few([by_place[place] for place in sorted(by_place)])


def _read(file: LaunchFile, given: Mapping[str, str], workspace: Folder, refuse: Refuse) -> list[Entry]:
    """Read a file; what `refuse` does not raise is left out, and nothing comes of it."""
    reading = _Reading(workspace, refuse)
    drafts = list(reading.file(file, values_of(file, read_given(given)), Around()))
    if reading.is_refused:
        return []
    entries = entries_of(drafts, reading.off, refuse)
    check_terminal(entries)
    return entries


def _raised(error: DocumentError) -> None:
    raise error


@dataclass(frozen=True)
class _Scope:
    """The file that is being read, where its nodes are looked up, and the files around it.

    `is_off` where nothing is to be started: of what is read there only the names count, and mistakes do not.
    """

    file: LaunchFile
    home: Path | None
    chain: tuple[Path, ...]
    is_off: bool = False


class _TooLargeError(DocumentError):
    """A system is larger than `limits` allow: no more of it is read."""


class _Reading:
    """The walk through a launch file and all that it includes."""

    def __init__(self, workspace: Folder, refuse: Refuse) -> None:
        self._workspace = workspace
        self._refuse = refuse
        self._parts = self._includes = self._commands = self._refused = 0
        self._processes: set[str] = set()
        self._homes: dict[Path, Path | None] = {}
        self.is_refused = False
        """Whether something was refused, and left out."""
        self.off: set[str] = set()
        """The full names of nodes that conditions leave out, as far as they can be told."""
        self._sources: dict[tuple[str, Path | None, Path], NodeSource] = {}

    def file(self, file: LaunchFile, values: Values, around: Around, asker: _Scope | None = None) -> Iterator[Draft]:
        """Yield what a file comes to; `asker` is the one that includes it."""
        for error in unknown_keys(file):
            self._leave_out(error)
        file.value(file.data.get("description", ""), str, ["description"])
        if file.folder not in self._homes:
            self._homes[file.folder] = lookup.home_of(file.path, self._workspace)
        home = self._homes[file.folder]
        chain = (*(asker.chain if asker else ()), file.path.resolve())
        scope = _Scope(file, home, chain, asker is not None and asker.is_off)
        yield from self._held(scope, file.data, [], values, around)

    def _held(
        self, scope: _Scope, data: Mapping[str, Any], steps: Sequence[Step], values: Values, around: Around
    ) -> Iterator[Draft]:
        """Yield the nodes, what is included, and the groups, in the order in which these three are written."""
        held = {key: scope.file.value(data[key], list[dict[str, Any]], [*steps, key]) for key in data if key in _HELD}
        if not any(held.values()):
            raise scope.file.error([*steps, *list(held)[:1]], "there is nothing to start: list some `nodes`")
        for key, each in held.items():
            for index, said in enumerate(each):
                with self._forgiving(scope):
                    for part in copies(scope.file, [*steps, key, index], said, values):
                        self._count(part)
                        yield from self._part(key, scope, part, around)

    def _part(self, key: str, scope: _Scope, part: Part, around: Around) -> Iterator[Draft]:
        """Yield what one part comes to; of what is switched off, note the names."""
        read = {"nodes": self._node, "include": self._include, "groups": self._group}
        if not scope.is_off and is_wanted(part):
            yield from read[key](scope, part, around)
            return
        off = replaced(scope, is_off=True)
        with self._forgiving(off):
            if key == "nodes":
                namespace = around.inside(part, part.value("namespace", str, ""))
                self.off.update(f"{namespace}/{name}" for name in _names_of(part))
            else:
                list(read[key](off, part, around))

    @contextmanager
    def _forgiving(self, scope: _Scope) -> Iterator[None]:
        """Let mistakes pass where nothing is to be started: that may be for another computer, with other files."""
        try:
            yield
        except _TooLargeError:
            raise
        except DocumentError as error:
            if not scope.is_off:
                self._leave_out(error)

    def _leave_out(self, error: DocumentError) -> None:
        self._refuse(error)
        self.is_refused = True
        self._refused += 1
        if self._refused >= MOST_MISTAKES:
            message = f"after {MOST_MISTAKES} mistakes nothing more was read"
            raise _TooLargeError(message, error.file, error.line, error.column)

    def _node(self, scope: _Scope, part: Part, around: Around) -> Iterator[Draft]:
        check_words(part)
        has_keyboard = decided(part, "interactive", default=False)
        said: NodeDescription = replace(part.read(NodeDescription), interactive=has_keyboard)
        check_node(part, said)
        whole = around.with_node(part, said)
        self._count_process(part, whole)
        own = given_in(part, scope.home) if "parameters" in part else []
        if said.node:
            yield Draft(part, said, whole, own, self._source(scope, part, said.node), scope.home, chain=scope.chain)
            return
        path = whole.env["PATH"].value if "PATH" in whole.env else None
        command = lookup.command_of(list(map(str, said.run)), path)
        if command is None:
            raise part.error(["run", 0], lookup.why_no_command(str(said.run[0])))
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
            path = lookup.included_file(said.file, scope.home, scope.file.folder)
        except lookup.NOT_FOUND as error:
            raise part.error(["file"], lookup.reason_of(error)) from None
        if path.resolve() in scope.chain:
            names = [each.name for each in scope.chain[scope.chain.index(path.resolve()) :]]
            raise part.error(["file"], f"a file cannot include itself: {' -> '.join([*names, path.name])}")
        if len(scope.chain) > limits.DEEPEST_INCLUDES:
            raise _too_large(part, f"files are included over {limits.DEEPEST_INCLUDES} deep")
        self._includes += 1
        if self._includes > limits.MOST_INCLUDES:
            raise _too_large(part, f"more than {limits.MOST_INCLUDES:,} files are included")
        file = LaunchFile(path, above=scope.file.mentioned(part.steps))
        if too_much := part.values.budget.take(file.length, is_new=False):
            raise _too_large(part, too_much)
        values = values_of(file, part.values_in("arguments"), Place(part))
        yield from self.file(file, values, around.moved_to(namespace), scope)

    def _source(self, scope: _Scope, part: Part, name: str) -> NodeSource:
        """Find a node, once for all its copies."""
        asked = (name, scope.home, scope.file.folder)
        if asked not in self._sources:
            try:
                self._sources[asked] = lookup.source_of(*asked)
            except lookup.NOT_FOUND as error:
                raise part.error(["node"], lookup.reason_of(error)) from None
        return self._sources[asked]

    def _count(self, part: Part) -> None:
        self._parts += 1
        if self._parts > limits.MOST_PARTS:
            raise _too_large(part, f"more than {limits.MOST_PARTS:,} nodes, groups and includes")

    def _count_process(self, part: Part, around: Around) -> None:
        """Count the process that a node or command will run in: its own, or one that it shares."""
        shared = around.settings.get("process")
        if shared is None:
            self._commands += 1
        else:
            self._processes.add(shared.value)
        if self._commands + len(self._processes) > limits.MOST_PROCESSES:
            raise _too_large(part, f"more than {limits.MOST_PROCESSES:,} processes: `process` lets nodes share one")


def _too_large(part: Part, message: str) -> _TooLargeError:
    error = part.error([], message)
    return _TooLargeError(error.message, error.file, error.line, error.column)


def _names_of(part: Part) -> list[str]:
    """Give what a node may be called, without looking for it: its `name`, or that of its file, class or executable."""
    name: str = part.value("name", str, "")
    spec: str = part.value("node", str, "")
    file, _, attribute = spec.rpartition(":") if ".py:" in spec else (spec, "", "")
    return [name] if name else [PurePath(file.rpartition(" ")[2]).stem, attribute]
