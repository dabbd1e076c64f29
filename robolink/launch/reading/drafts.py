"""Second pass over a launch file: resolves names, parameters and readiness conditions once all nodes are known."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any, TypeAlias

from robolink.exceptions import DocumentError
from robolink.launch.entry import Entry, NodeToStart, Respawn
from robolink.launch.reading.description import NodeDescription
from robolink.launch.reading.inherited import Inherited
from robolink.launch.reading.parameters import Given, Parameter, parameters_for
from robolink.launch.reading.section import Place, Section
from robolink.launch.reading.start_after import Known, resolved
from robolink.launch.reading.substitution import Step
from robolink.system.terminal import shown
from robolink.workspace import NodeSource

Refuse: TypeAlias = "Callable[[DocumentError], object]"
"""Error callback: raises the error or collects it."""

_NODES_ONLY = ("process", "log_level", "enclave")


@dataclass(frozen=True, eq=False)
class Draft:
    """A node or command after the first pass: its keys, what it inherits, its own parameters, and its source.

    `command` is the command line of a command; `chain` is its launch file and those that include it.
    """

    section: Section
    said: NodeDescription
    inherited: Inherited
    own: Sequence[Given]
    source: NodeSource | None
    home: Path | None
    command: Sequence[str] = ()
    chain: Sequence[Path] = ()

    @property
    def name(self) -> str:
        """Name in messages to people: with the namespace in front, but without the first slash."""
        return self._named(self.source.name if self.source else shown(PurePath(str(self.said.run[0])).stem))

    @property
    def name_within_file(self) -> str:
        """Like `name`, for one of several nodes of a file: its class's or function's name if it has no other."""
        return self._named(self.source.attribute) if self.source and self.source.attribute else self.name

    def _named(self, default: str) -> str:
        return f"{self.inherited.namespace}/{self.said.name or default}".removeprefix("/")


def entries_of(drafts: Iterable[Draft], off: Collection[str], refuse: Refuse) -> list[Entry]:
    """Return the entries of a whole system; `off` are the full names that its conditions switch off.

    Duplicate names and names that do not exist go to `refuse`; if that does not raise, the entry is left out.
    """
    named: dict[str, Draft] = {}
    for name, each in _named(list(drafts)):
        if name in named:
            refuse(_twice(name, each, named[name]))
        named.setdefault(name, each)
    nodes = {f"/{name}": None for name, each in named.items() if each.source}
    commands = {f"/{name}": None for name, each in named.items() if not each.source}
    known = Known(nodes, commands, off)
    return [entry for name, each in named.items() for entry in _entries(name, each, known, refuse)]


def _entries(name: str, draft: Draft, known: Known, refuse: Refuse) -> Iterator[Entry]:
    try:
        yield _entry(name, draft, known)
    except DocumentError as error:
        refuse(error)


def _named(drafts: Sequence[Draft]) -> Iterator[tuple[str, Draft]]:
    """Yield each draft with its name; FILE:Class and FILE:Other, which share a file's name, are Class and Other."""
    specs: dict[str, set[str]] = {}
    for each in drafts:
        specs.setdefault(each.name, set()).add(each.source.spec if each.source else "")
    for each in drafts:
        yield each.name if len(specs[each.name]) == 1 else each.name_within_file, each


def _twice(name: str, draft: Draft, other: Draft) -> DocumentError:
    section = draft.section
    what = "nodes" if draft.source else "commands"
    is_copy = (section.steps, section.file.path) == (other.section.steps, other.section.file.path)
    if is_copy and section.file is not other.section.file:
        reason = f"two {what} are called '{name}', since this file is included twice: give each its `namespace`"
        return section.error([], reason)
    if is_copy:
        at = ["count"] if "count" in section else []
        return section.error(at, f"two of the copies are called '{name}': put {{i}} into `name` or `namespace`")
    key = next(each for each in ("name", "node", "run") if each in section)
    return section.error([key], f"two {what} are called '{name}': give this one another `name`")


def _entry(name: str, draft: Draft, known: Known) -> Entry:
    parameters = parameters_for(f"/{name}", draft.inherited.given, draft.own) if draft.source else {}
    node = NodeToStart(
        node=draft.said.node,
        run=list(draft.command),
        name=draft.said.name,
        namespace=draft.inherited.namespace,
        parameters={each: parameter.value for each, parameter in parameters.items()},
        remappings={match: each.value for match, each in draft.inherited.remappings.items()} if draft.source else {},
        args=list(map(str, draft.said.args)),
        env={variable: str(each.value) for variable, each in draft.inherited.env.items()},
        interactive=draft.said.interactive is True,
        start_after=tuple(dict.fromkeys(resolved(draft.inherited.awaited, f"/{name}", known))),
        **_settings(draft),
    )
    wide = frozenset(each for each, parameter in parameters.items() if parameter.is_wide)
    files = frozenset([*draft.chain, *(each.file for each in (*draft.inherited.given, *draft.own) if each.file)])
    return Entry(name, node, draft.source, draft.home, _Places(draft, parameters).error, wide, files)


def _settings(draft: Draft) -> dict[str, Any]:
    """Return the settings that belong to a process, from the node or inherited."""
    said = {key: each.value for key, each in draft.inherited.settings.items()}
    if draft.source is None:
        said = {key: value for key, value in said.items() if key not in _NODES_ONLY}
    if isinstance(said.get("respawn"), str):
        said["respawn"] = Respawn(when=said["respawn"])
    if isinstance(said.get("cpu"), int):
        said["cpu"] = [said["cpu"]]
    said["cpu"] = tuple(dict.fromkeys(said.get("cpu") or ()))
    return {key: value for key, value in said.items() if value is not None}


class _Places:
    """Source places of a node's keys: at the node itself, or in an enclosing group."""

    def __init__(self, draft: Draft, parameters: dict[str, Parameter]) -> None:
        inherited = draft.inherited
        self._section = draft.section
        self._places: dict[tuple[Step, ...], Place] = {
            **{(key,): each.place for key, each in inherited.settings.items()},
            **{("remappings", name): each.place for name, each in inherited.remappings.items()},
            **{("env", name): each.place for name, each in inherited.env.items()},
            **{("parameters", name): each.place for name, each in parameters.items()},
        }
        for index, each in enumerate(inherited.awaited):
            self._places.setdefault(("start_after",), each.place)
            self._places[("start_after", index)] = each.place

    def error(self, steps: Sequence[Step], message: str, key: bool) -> DocumentError:
        """Return an error about the value at these steps, with its place in the file."""
        for end in range(len(steps), 0, -1):
            place = self._places.get(tuple(steps[:end]))
            if place is not None:
                return place.error(message, steps[end:], key=key)
        return self._section.error(steps, message, key=key)
