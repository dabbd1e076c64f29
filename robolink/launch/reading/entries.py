"""Launch file reader: walks a file and its includes, and returns the entries to start."""

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

from robolink.documents.limits import MOST_MISTAKES, first_mistakes
from robolink.exceptions import DocumentError
from robolink.launch import lookup
from robolink.launch.entry import Entry
from robolink.launch.lookup import is_of_ros
from robolink.launch.reading import limits, slow_links
from robolink.launch.reading.arguments import read_given, values_of
from robolink.launch.reading.checks import check_node, check_shared, check_terminal, check_words
from robolink.launch.reading.conditions import decided, is_wanted
from robolink.launch.reading.description import GroupDescription, IncludeDescription, NodeDescription
from robolink.launch.reading.drafts import Draft, Refuse, entries_of
from robolink.launch.reading.file import LaunchFile
from robolink.launch.reading.inherited import Inherited
from robolink.launch.reading.keys import unknown_keys
from robolink.launch.reading.parameters import given_in
from robolink.launch.reading.record import recorded
from robolink.launch.reading.section import Place, Section, copies
from robolink.launch.reading.substitution import Step, Values
from robolink.networks.limits import written
from robolink.system.terminal import shown
from robolink.workspace import Folder, NodeSource

__all__ = ["Entry", "read_launch_file", "read_with_mistakes"]

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
    return _read(LaunchFile(Path(path), text), given, workspace, _raised)


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
    found: list[DocumentError] = []
    entries: list[Entry] = []
    try:
        entries = _read(LaunchFile(Path(path), text), given, workspace, found.append)
    except DocumentError as error:
        found.append(error)
    by_place = {(each.file != os.fspath(path), each.file, each.line, each.column): each for each in reversed(found)}
    return entries, first_mistakes([by_place[place] for place in sorted(by_place)])


def _read(file: LaunchFile, given: Mapping[str, str], workspace: Folder, refuse: Refuse) -> list[Entry]:
    """Read a file. If `refuse` does not raise, the wrong sections are skipped."""
    reading = _Reading(workspace, refuse)
    drafts = list(reading.file(file, values_of(file, read_given(given)), Inherited()))
    if reading.is_refused:
        return []
    entries = entries_of(drafts, reading.off, refuse)
    check_terminal(entries)
    if not reading.network and not reading.limits:
        return entries
    return [replaced(each, network=reading.network, limits=reading.limits) for each in entries]


def _raised(error: DocumentError) -> None:
    raise error


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
    """A system is larger than `limits` allow: reading stops."""


class _Reading:
    """Recursive walk through a launch file and its includes."""

    def __init__(self, workspace: Folder, refuse: Refuse) -> None:
        self._workspace = workspace
        self._refuse = refuse
        self._parts = self._includes = self._commands = self._refused = 0
        self._processes: set[str] = set()
        self._homes: dict[Path, Path | None] = {}
        self.network = ""
        """Network of the whole system, as the outermost file that names one says."""
        self.limits = ""
        """Limits of the whole system, likewise."""
        self.is_refused = False
        """True once something was refused and left out."""
        self.off: set[str] = set()
        """Full names of the nodes that conditions switch off, as far as they are known."""
        self._sources: dict[tuple[str, Path | None, Path], NodeSource] = {}

    def file(
        self, file: LaunchFile, values: Values, inherited: Inherited, asker: _Scope | None = None
    ) -> Iterator[Draft]:
        """Yield the drafts of a file; `asker` is the file that includes it."""
        for error in unknown_keys(file):
            self._leave_out(error)
        file.value(file.data.get("description", ""), str, ["description"])
        recorded(file, values)
        self._note_network(Section(file, [], {key: file.data[key] for key in ("network",) if key in file.data}, values))
        self._note_limits(slow_links.section_of(file, values))
        if file.folder not in self._homes:
            self._homes[file.folder] = lookup.home_of(file.path, self._workspace)
        home = self._homes[file.folder]
        chain = (*(asker.chain if asker else ()), file.path.resolve())
        scope = _Scope(file, home, chain, asker is not None and asker.is_off)
        yield from self._held(scope, file.data, [], values, inherited)

    def _note_network(self, section: Section) -> None:
        """Note the network that a file names; a system has only one."""
        said: str = section.value("network", str, "")
        if self.network and said not in ("", self.network):
            reason = f"the files around it say '{shown(self.network)}', and a system has only one network"
            self._leave_out(section.error(["network"], reason))
        self.network = self.network or said

    def _note_limits(self, section: Section) -> None:
        """Note the limits that a file has; a system has only one set of them."""
        try:
            said = slow_links.read(section)
        except DocumentError as error:
            self._leave_out(error)
            return
        text = "" if said is None else written(said)
        if self.limits and text not in ("", self.limits):
            reason = "the files around it have other `limits`, and a system has only one set of them"
            self._leave_out(section.error(["limits"], reason, key=True))
        self.limits = self.limits or text

    def _held(
        self, scope: _Scope, data: Mapping[str, Any], steps: Sequence[Step], values: Values, inherited: Inherited
    ) -> Iterator[Draft]:
        """Yield the drafts of nodes, includes and groups, in the order in which these three keys are written."""
        held = {key: scope.file.value(data[key], list[dict[str, Any]], [*steps, key]) for key in data if key in _HELD}
        if not any(held.values()):
            raise scope.file.error([*steps, *list(held)[:1]], "there is nothing to start: list some `nodes`")
        for key, each in held.items():
            for index, said in enumerate(each):
                with self._forgiving(scope):
                    for section in copies(scope.file, [*steps, key, index], said, values):
                        self._count(section)
                        yield from self._section(key, scope, section, inherited)

    def _section(self, key: str, scope: _Scope, section: Section, inherited: Inherited) -> Iterator[Draft]:
        """Yield the drafts of one section; of one that is switched off, note the names only."""
        read = {"nodes": self._node, "include": self._include, "groups": self._group}
        if not scope.is_off and is_wanted(section):
            yield from read[key](scope, section, inherited)
            return
        off = replaced(scope, is_off=True)
        with self._forgiving(off):
            if key == "nodes":
                namespace = inherited.inside(section, section.value("namespace", str, ""))
                self.off.update(f"{namespace}/{name}" for name in _names_of(section))
            else:
                list(read[key](off, section, inherited))

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
        self._refuse(error)
        self.is_refused = True
        self._refused += 1
        if self._refused >= MOST_MISTAKES:
            message = f"after {MOST_MISTAKES} mistakes nothing more was read"
            raise _TooLargeError(message, error.file, error.line, error.column)

    def _node(self, scope: _Scope, section: Section, inherited: Inherited) -> Iterator[Draft]:
        check_words(section)
        has_keyboard = decided(section, "interactive", default=False)
        said: NodeDescription = replace(section.read(NodeDescription), interactive=has_keyboard)
        check_node(section, said)
        whole = inherited.with_node(section, said)
        self._count_process(section, whole)
        own = given_in(section, scope.home) if "parameters" in section else []
        if said.node:
            yield Draft(
                section, said, whole, own, self._source(scope, section, said.node), scope.home, chain=scope.chain
            )
            return
        path = whole.env["PATH"].value if "PATH" in whole.env else None
        command = lookup.command_of(list(map(str, said.run)), path)
        if command is None:
            raise section.error(["run", 0], lookup.why_no_command(str(said.run[0])))
        yield Draft(section, said, whole, own, None, scope.home, command, scope.chain)

    def _group(self, scope: _Scope, section: Section, inherited: Inherited) -> Iterator[Draft]:
        check_words(section)
        said: GroupDescription = section.read(GroupDescription, without=_HELD)
        check_shared(section, said)
        inner = inherited.within(section, said, scope.home)
        yield from self._held(scope, section.written, section.steps, section.values, inner)

    def _include(self, scope: _Scope, section: Section, inherited: Inherited) -> Iterator[Draft]:
        said: IncludeDescription = section.read(IncludeDescription)
        namespace = inherited.inside(section, said.namespace)
        try:
            path = lookup.included_file(said.file, scope.home, scope.file.folder)
        except lookup.NOT_FOUND as error:
            raise section.error(["file"], lookup.reason_of(error)) from None
        if is_of_ros(path):
            raise section.error(["file"], f"{path.name} is a launch file of ROS 2, {_BY_ITSELF}")
        if path.resolve() in scope.chain:
            names = [each.name for each in scope.chain[scope.chain.index(path.resolve()) :]]
            raise section.error(["file"], f"a file cannot include itself: {' -> '.join([*names, path.name])}")
        if len(scope.chain) > limits.DEEPEST_INCLUDES:
            raise _too_large(section, f"files are included over {limits.DEEPEST_INCLUDES} deep")
        self._includes += 1
        if self._includes > limits.MOST_INCLUDES:
            raise _too_large(section, f"more than {limits.MOST_INCLUDES:,} files are included")
        file = LaunchFile(path, above=scope.file.mentioned(section.steps))
        if too_much := section.values.budget.take(file.length, is_new=False):
            raise _too_large(section, too_much)
        values = values_of(file, section.values_in("arguments"), Place(section))
        yield from self.file(file, values, inherited.moved_to(namespace), scope)

    def _source(self, scope: _Scope, section: Section, name: str) -> NodeSource:
        """Find a node's source, once for all its copies."""
        asked = (name, scope.home, scope.file.folder)
        if asked not in self._sources:
            try:
                self._sources[asked] = lookup.source_of(*asked)
            except lookup.NOT_FOUND as error:
                raise section.error(["node"], lookup.reason_of(error)) from None
        return self._sources[asked]

    def _count(self, section: Section) -> None:
        self._parts += 1
        if self._parts > limits.MOST_PARTS:
            raise _too_large(section, f"more than {limits.MOST_PARTS:,} nodes, groups and includes")

    def _count_process(self, section: Section, inherited: Inherited) -> None:
        """Count the process that a node or command will run in: its own, or one that it shares."""
        shared = inherited.settings.get("process")
        if shared is None:
            self._commands += 1
        else:
            self._processes.add(shared.value)
        if self._commands + len(self._processes) > limits.MOST_PROCESSES:
            raise _too_large(section, f"more than {limits.MOST_PROCESSES:,} processes: `process` lets nodes share one")


def _too_large(section: Section, message: str) -> _TooLargeError:
    error = section.error([], message)
    return _TooLargeError(error.message, error.file, error.line, error.column)


def _names_of(section: Section) -> list[str]:
    """Return a node's possible names without looking it up: `name`, or that of its file, class or executable."""
    name: str = section.value("name", str, "")
    spec: str = section.value("node", str, "")
    file, _, attribute = spec.rpartition(":") if ".py:" in spec else (spec, "", "")
    return [name] if name else [PurePath(file.rpartition(" ")[2]).stem, attribute]
