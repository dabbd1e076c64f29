"""Launch file reader: walks a file and its includes, and returns the entries to start.

Each section goes one way: document, section with each `{name}` substituted, description, checks, draft with what it
inherits; when all drafts are known they become entries.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path, PurePath
from types import MappingProxyType
from typing import Any, TypeVar

from robolink.documents.mistakes import MOST_MISTAKES, Step, first_mistakes
from robolink.exceptions import DocumentError
from robolink.launch import lookup
from robolink.launch.entry import MOST_PROCESSES, Entry
from robolink.launch.reading import checks
from robolink.launch.reading.arguments import limits_in, read_given, recorded, values_of, whole
from robolink.launch.reading.description import GroupDescription, IncludeDescription, NodeDescription
from robolink.launch.reading.document import LaunchFile
from robolink.launch.reading.drafts import Draft, resolved
from robolink.launch.reading.inherited import Inherited, given_in
from robolink.launch.reading.section import Place, Problem, Section, Values, copies
from robolink.networks.limits import written
from robolink.system.terminal import shown
from robolink.workspace import Folder, NodeSource

T = TypeVar("T")

__all__ = ["Entry", "read_launch_file", "read_with_mistakes"]

MOST_PARTS = 20_000
"""Most copies of nodes, groups and includes in all: ten lines of arguments could fill the memory."""
MOST_INCLUDES = 2_000
"""Most includes, each file counted as often as it is included."""
DEEPEST_INCLUDES = 50
"""Deepest nesting of includes: each file is read while the one above it is."""

_BY_ITSELF = "and robolink's own include none of these: launch it by itself, or name its nodes here"
_HELD = ("nodes", "include", "groups")
_NOTHING: Mapping[str, str] = MappingProxyType({})


def read_launch_file(
    path: str | os.PathLike[str],
    given: Mapping[str, str] = _NOTHING,
    *,
    workspace: Folder = None,
    text: str | None = None,
) -> list[Entry]:
    """Read a launch file and return every node and command to start, fully expanded.

    Args:
        path: The launch file.
        given: Launch arguments by name, as people type them.
        workspace: Folder in which nodes of a launch file that came with robolink are looked up; None finds the nearest
            one. Other launch files use their own workspace.
        text: Content to read in place of the file's.

    Returns:
        The entries, in the order of the file; empty if conditions leave nothing to start.

    Raises:
        DocumentError: for a mistake in the file, with `file:line:column`.
        NotFoundError: for a `workspace` that is not a folder.
    """
    entries, mistakes = _read(Path(path), given, workspace, text)
    for first in mistakes:
        raise first
    return entries


def read_with_mistakes(
    path: str | os.PathLike[str],
    given: Mapping[str, str] = _NOTHING,
    *,
    workspace: Folder = None,
    text: str | None = None,
) -> tuple[list[Entry], list[DocumentError]]:
    """Read a launch file as `read_launch_file` does, but return all its mistakes, by place, instead of raising one.

    One mistake of each node, group and include is reported; relations between nodes are only checked if there is
    none. A file that cannot be read at all has a single one: invalid YAML, or a mapping in place of a list.
    """
    entries, found = _read(Path(path), given, workspace, text)
    by_place = {(each.file != os.fspath(path), each.file, each.line, each.column): each for each in reversed(found)}
    return entries, first_mistakes([by_place[place] for place in sorted(by_place)])


def _read(
    path: Path, given: Mapping[str, str], workspace: Folder, text: str | None
) -> tuple[list[Entry], list[DocumentError]]:
    """Return the entries and the mistakes, in the order in which they are found."""
    reading = _Reading(workspace)
    try:
        file = LaunchFile(path, text)
        reading.file(file, values_of(file, read_given(given)), Inherited())
        if reading.mistakes:
            return [], reading.mistakes
        system = resolved(reading.drafts, reading.off)
    except DocumentError as error:
        return [], [*reading.mistakes, error]
    entries = system.entries
    if reading.network or reading.limits:
        entries = [replace(each, network=reading.network, limits=reading.limits) for each in entries]
    return entries, system.mistakes


@dataclass(frozen=True)
class _Scope:
    """Context of the walk: the current file, the folder of its nodes, and the files that include it.

    `is_off` where a condition switched everything off: then only names are collected, and mistakes do not count.
    """

    file: LaunchFile
    home: Path | None
    chain: tuple[Path, ...]
    is_off: bool = False


class _TooLargeError(DocumentError):
    """A system has too many parts: reading stops."""


class _Reading:
    """Recursive walk through a launch file and its includes."""

    def __init__(self, workspace: Folder) -> None:
        self.drafts: list[Draft] = []
        self.mistakes: list[DocumentError] = []
        """Mistakes because of which something was left out."""
        self.network = ""
        """Network of the whole system, as the outermost file that names one says."""
        self.limits = ""
        """Limits of the whole system, likewise."""
        self.off: set[str] = set()
        """Full names of the nodes that conditions switch off, as far as they are known."""
        self._workspace = workspace
        self._parts = self._includes = self._commands = 0
        self._processes: set[str] = set()
        self._homes: dict[Path, Path | None] = {}
        self._sources: dict[tuple[str, Path | None, Path], NodeSource] = {}

    def file(self, file: LaunchFile, values: Values, inherited: Inherited, includer: _Scope | None = None) -> None:
        """Add the drafts of a file; `includer` is the file that includes it."""
        for error in checks.unknown_keys(file):
            self._leave_out(error)
        file.value(file.data.get("description", ""), str, ["description"])
        self._note_whole(whole(file, values))
        if file.folder not in self._homes:
            self._homes[file.folder] = lookup.home_of(file.path, self._workspace)
        chain = (*(includer.chain if includer else ()), file.path.resolve())
        scope = _Scope(file, self._homes[file.folder], chain, includer is not None and includer.is_off)
        self._held(scope, file.data, [], values, inherited)

    def _note_whole(self, section: Section) -> None:
        """Note the network and the limits that a file names; a system has only one of each."""
        recorded(section)
        network: str = section.value("network", str, "")
        if self.network and network not in ("", self.network):
            reason = f"the files around it say '{shown(self.network)}', and a system has only one network"
            self._leave_out(section.error(["network"], reason))
        self.network = self.network or network
        try:
            limits = limits_in(section)
        except DocumentError as error:
            self._leave_out(error)
            return
        text = "" if limits is None else written(limits)
        if self.limits and text not in ("", self.limits):
            reason = "the files around it have other `limits`, and a system has only one set of them"
            self._leave_out(section.error(["limits"], reason, key=True))
        self.limits = self.limits or text

    def _held(
        self, scope: _Scope, data: Mapping[str, Any], steps: Sequence[Step], values: Values, inherited: Inherited
    ) -> None:
        """Add the drafts of nodes, includes and groups, in the order in which these three keys are written."""
        held = {key: scope.file.value(data[key], list[dict[str, Any]], [*steps, key]) for key in data if key in _HELD}
        if not any(held.values()):
            raise scope.file.error([*steps, *list(held)[:1]], "there is nothing to start: list some `nodes`")
        for key, listed in held.items():
            for index, each in enumerate(listed):
                with self._forgiving(scope):
                    for section in copies(scope.file, [*steps, key, index], each, values):
                        self._count(section)
                        self._section(key, scope, section, inherited)

    def _section(self, key: str, scope: _Scope, section: Section, inherited: Inherited) -> None:
        """Add the drafts of one section; of one that is switched off, note the names only."""
        read = {"nodes": self._node, "include": self._include, "groups": self._group}[key]
        if not scope.is_off and section.is_on:
            read(scope, section, inherited)
            return
        off = replace(scope, is_off=True)
        with self._forgiving(off):
            if key == "nodes":
                namespace = _namespace(section, section.value("namespace", str, ""), inherited)
                self.off.update(f"{namespace}/{name}" for name in _names_of(section))
            else:
                read(off, section, inherited)

    @contextmanager
    def _forgiving(self, scope: _Scope) -> Iterator[None]:
        """Ignore mistakes in sections that are switched off: these may be for another computer, with other files."""
        try:
            yield
        except _TooLargeError:
            raise
        except DocumentError as error:
            if not scope.is_off:
                self._leave_out(error)

    def _leave_out(self, error: DocumentError) -> None:
        self.mistakes.append(error)
        if len(self.mistakes) >= MOST_MISTAKES:
            message = f"after {MOST_MISTAKES} mistakes nothing more was read"
            raise _TooLargeError(message, error.file, error.line, error.column)

    def _node(self, scope: _Scope, section: Section, inherited: Inherited) -> None:
        data = section.data()
        _refuse(section, checks.wrong_words(data))
        described: NodeDescription = section.convert(data, NodeDescription)
        _refuse(section, checks.wrong_in_node(described, data))
        joined = inherited.with_node(section, described)
        self._count_process(section, joined)
        own = given_in(section, scope.home)
        source = self._source(scope, section, described.node) if described.node else None
        command = () if source else _command(section, described, joined)
        self.drafts.append(Draft(section, described, joined, own, source, scope.home, command, scope.chain))

    def _group(self, scope: _Scope, section: Section, inherited: Inherited) -> None:
        data = section.data(without=_HELD)
        _refuse(section, checks.wrong_words(data))
        described: GroupDescription = section.convert(data, GroupDescription)
        _refuse(section, checks.wrong_in_both(described, data))
        inner = inherited.within(section, described, given_in(section, scope.home))
        self._held(scope, section.written, section.steps, section.values, inner)

    def _include(self, scope: _Scope, section: Section, inherited: Inherited) -> None:
        described: IncludeDescription = section.convert(section.data(), IncludeDescription)
        namespace = _namespace(section, described.namespace, inherited)
        path = _found(section, "file", lambda: lookup.included_file(described.file, scope.home, scope.file.folder))
        if lookup.is_of_ros(path):
            raise section.error(["file"], f"{path.name} is a launch file of ROS 2, {_BY_ITSELF}")
        if path.resolve() in scope.chain:
            names = [each.name for each in scope.chain[scope.chain.index(path.resolve()) :]]
            raise section.error(["file"], f"a file cannot include itself: {' -> '.join([*names, path.name])}")
        if len(scope.chain) > DEEPEST_INCLUDES:
            raise _too_large(section, f"files are included over {DEEPEST_INCLUDES} deep")
        self._includes += 1
        if self._includes > MOST_INCLUDES:
            raise _too_large(section, f"more than {MOST_INCLUDES:,} files are included")
        file = LaunchFile(path, above=scope.file.mentioned(section.steps))
        if too_much := section.values.budget.take(file.length, is_new=False):
            raise _too_large(section, too_much)
        values = values_of(file, section.values_in("arguments"), Place(section))
        self.file(file, values, inherited.moved_to(namespace), scope)

    def _source(self, scope: _Scope, section: Section, name: str) -> NodeSource:
        """Find a node's source, once for all its copies."""
        key = (name, scope.home, scope.file.folder)
        if key not in self._sources:
            self._sources[key] = _found(section, "node", lambda: lookup.source_of(*key))
        return self._sources[key]

    def _count(self, section: Section) -> None:
        self._parts += 1
        if self._parts > MOST_PARTS:
            raise _too_large(section, f"more than {MOST_PARTS:,} nodes, groups and includes")

    def _count_process(self, section: Section, inherited: Inherited) -> None:
        """Count the process that a node or command will run in: its own, or one that it shares."""
        shared = inherited.settings.get("process")
        if shared is None:
            self._commands += 1
        else:
            self._processes.add(shared.value)
        if self._commands + len(self._processes) > MOST_PROCESSES:
            raise _too_large(section, f"more than {MOST_PROCESSES:,} processes: `process` lets nodes share one")


def _refuse(section: Section, problems: Iterable[Problem]) -> None:
    """Raise an error about the first problem."""
    for each in problems:
        raise section.problem(each)


def _found(section: Section, key: str, look_up: Callable[[], T]) -> T:
    """Return the result of a look-up; if it fails, raise an error about the key that names it."""
    try:
        return look_up()
    except lookup.NOT_FOUND as error:
        raise section.error([key], lookup.reason_of(error)) from None


def _command(section: Section, described: NodeDescription, joined: Inherited) -> Sequence[str]:
    path = joined.env["PATH"].value if "PATH" in joined.env else None
    command = lookup.command_of(list(map(str, described.run)), path)
    if command is None:
        raise section.error(["run", 0], lookup.why_no_command(str(described.run[0])))
    return command


def _namespace(section: Section, namespace: str, inherited: Inherited) -> str:
    _refuse(section, checks.wrong_namespace(namespace))
    return inherited.inside(namespace)


def _too_large(section: Section, message: str) -> _TooLargeError:
    error = section.error([], message)
    return _TooLargeError(error.message, error.file, error.line, error.column)


def _names_of(section: Section) -> list[str]:
    """Return a node's possible names without looking it up: `name`, or that of its file, class or executable."""
    name: str = section.value("name", str, "")
    spec: str = section.value("node", str, "")
    file, _, attribute = spec.rpartition(":") if ".py:" in spec else (spec, "", "")
    return [name] if name else [PurePath(file.rpartition(" ")[2]).stem, attribute]
