"""What a launch file's nodes and commands become once all of them are known: names, parameters, what they wait for."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any, TypeAlias

from robolink.exceptions import DocumentError, shown
from robolink.launch.reading.around import Around
from robolink.launch.reading.description import NodeDescription, Respawn
from robolink.launch.reading.entry import Entry, NodeToStart
from robolink.launch.reading.parameters import Given, Parameter, parameters_for
from robolink.launch.reading.part import Part, Place
from robolink.launch.reading.start_after import Known, resolved
from robolink.launch.reading.substitution import Step
from robolink.workspace import NodeSource

Refuse: TypeAlias = "Callable[[DocumentError], object]"
"""What is called with a mistake: it raises it, or keeps it."""

_NODES_ONLY = ("process", "log_level")


@dataclass(frozen=True, eq=False)
class Draft:
    """A node or command as it is said, what is said around it, its own parameters, and where it comes from.

    `command` is how a command is started; `chain` are the launch file that says it and those that include it.
    """

    part: Part
    said: NodeDescription
    around: Around
    own: Sequence[Given]
    source: NodeSource | None
    home: Path | None
    command: Sequence[str] = ()
    chain: Sequence[Path] = ()

    @property
    def name(self) -> str:
        """The name by which people are told of it: with the namespace in front, but for the first slash."""
        return self._named(self.source.name if self.source else shown(PurePath(str(self.said.run[0])).stem))

    @property
    def name_within_file(self) -> str:
        """The same for one of several nodes of a file: its class's or function's name, where it has no other."""
        return self._named(self.source.attribute) if self.source and self.source.attribute else self.name

    def _named(self, default: str) -> str:
        return f"{self.around.namespace}/{self.said.name or default}".removeprefix("/")


def entries_of(drafts: Iterable[Draft], off: Collection[str], refuse: Refuse) -> list[Entry]:
    """Give the entries of a whole system, `off` being the full names of what its conditions leave out.

    Names that two of them have, or nobody has, go to `refuse`; what is wrong so is left out if that does not raise.
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
    """Name each: FILE:Class and FILE:Other would both be called as their file is, so they are Class and Other."""
    specs: dict[str, set[str]] = {}
    for each in drafts:
        specs.setdefault(each.name, set()).add(each.source.spec if each.source else "")
    for each in drafts:
        yield each.name if len(specs[each.name]) == 1 else each.name_within_file, each


def _twice(name: str, draft: Draft, other: Draft) -> DocumentError:
    part = draft.part
    what = "nodes" if draft.source else "commands"
    is_copy = (part.steps, part.file.path) == (other.part.steps, other.part.file.path)
    if is_copy and part.file is not other.part.file:
        reason = f"two {what} are called '{name}', since this file is included twice: give each its `namespace`"
        return part.error([], reason)
    if is_copy:
        at = ["count"] if "count" in part else []
        return part.error(at, f"two of the copies are called '{name}': put {{i}} into `name` or `namespace`")
    key = next(each for each in ("name", "node", "run") if each in part)
    return part.error([key], f"two {what} are called '{name}': give this one another `name`")


def _entry(name: str, draft: Draft, known: Known) -> Entry:
    parameters = parameters_for(f"/{name}", draft.around.given, draft.own) if draft.source else {}
    node = NodeToStart(
        node=draft.said.node,
        run=list(draft.command),
        name=draft.said.name,
        namespace=draft.around.namespace,
        parameters={each: parameter.value for each, parameter in parameters.items()},
        remappings={match: each.value for match, each in draft.around.remappings.items()} if draft.source else {},
        args=list(map(str, draft.said.args)),
        env={variable: str(each.value) for variable, each in draft.around.env.items()},
        interactive=draft.said.interactive is True,
        start_after=tuple(dict.fromkeys(resolved(draft.around.awaited, f"/{name}", known))),
        **_settings(draft),
    )
    wide = frozenset(each for each, parameter in parameters.items() if parameter.is_wide)
    files = frozenset([*draft.chain, *(each.file for each in (*draft.around.given, *draft.own) if each.file)])
    return Entry(name, node, draft.source, draft.home, _Places(draft, parameters).error, wide, files)


def _settings(draft: Draft) -> dict[str, Any]:
    """Give what is said once for a process, by the node or around it."""
    said = {key: each.value for key, each in draft.around.settings.items()}
    if draft.source is None:
        said = {key: value for key, value in said.items() if key not in _NODES_ONLY}
    if isinstance(said.get("respawn"), str):
        said["respawn"] = Respawn(when=said["respawn"])
    if isinstance(said.get("cpu"), int):
        said["cpu"] = [said["cpu"]]
    said["cpu"] = tuple(dict.fromkeys(said.get("cpu") or ()))
    return {key: value for key, value in said.items() if value is not None}


class _Places:
    """Where each thing that is said of a node stands: at the node itself, or in a group around it."""

    def __init__(self, draft: Draft, parameters: dict[str, Parameter]) -> None:
        around = draft.around
        self._part = draft.part
        self._places: dict[tuple[Step, ...], Place] = {
            **{(key,): each.place for key, each in around.settings.items()},
            **{("remappings", name): each.place for name, each in around.remappings.items()},
            **{("env", name): each.place for name, each in around.env.items()},
            **{("parameters", name): each.place for name, each in parameters.items()},
        }
        for index, each in enumerate(around.awaited):
            self._places.setdefault(("start_after",), each.place)
            self._places[("start_after", index)] = each.place

    def error(self, steps: Sequence[Step], message: str, key: bool) -> DocumentError:
        """Make an error about what is said at these steps, at the place where it is said."""
        for end in range(len(steps), 0, -1):
            place = self._places.get(tuple(steps[:end]))
            if place is not None:
                return place.error(message, steps[end:], key=key)
        return self._part.error(steps, message, key=key)
