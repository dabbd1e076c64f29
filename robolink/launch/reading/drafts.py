"""Second pass over a launch file: resolves names, parameters and readiness conditions once all nodes are known."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePath
from typing import Any, NamedTuple

from robolink.documents.mistakes import Step
from robolink.exceptions import DocumentError, NameValidationException
from robolink.expand_topic_name import expand_topic_name
from robolink.launch.entry import Entry, NodeToStart, Respawn, StartAfter
from robolink.launch.reading.description import NodeDescription
from robolink.launch.reading.inherited import Given, Inherited, Parameter, Placed, parameters_for
from robolink.launch.reading.section import Place, Section, as_bool
from robolink.system.terminal import shown
from robolink.text.names import near
from robolink.validate_topic_name import validate_topic_name
from robolink.workspace import NodeSource

_NODES_ONLY = ("process", "log_level", "enclave")


@dataclass(frozen=True, eq=False)
class Draft:
    """A node or command after the first pass: its keys, what it inherits, its own parameters, and its source.

    `command` is the command line of a command; `chain` is its launch file and those that include it.
    """

    section: Section
    described: NodeDescription
    inherited: Inherited
    own: Sequence[Given]
    source: NodeSource | None
    home: Path | None
    command: Sequence[str]
    chain: Sequence[Path]

    @property
    def name(self) -> str:
        """Name in messages to people: with the namespace in front, but without the first slash."""
        return self._named(self.source.name if self.source else shown(PurePath(str(self.described.run[0])).stem))

    @property
    def name_within_file(self) -> str:
        """Like `name`, for one of several nodes of a file: its class's or function's name if it has no other."""
        return self._named(self.source.attribute) if self.source and self.source.attribute else self.name

    def _named(self, default: str) -> str:
        return f"{self.inherited.namespace}/{self.described.name or default}".removeprefix("/")


class Known(NamedTuple):
    """Full names of all nodes and commands of a system."""

    nodes: Collection[str]
    commands: Collection[str]
    off: Collection[str]
    """Those that conditions switch off this time."""


@dataclass
class Resolved:
    """Entries of a whole system, and the mistakes because of which others are missing."""

    entries: list[Entry] = field(default_factory=list)
    mistakes: list[DocumentError] = field(default_factory=list)


def resolved(drafts: Sequence[Draft], off: Collection[str]) -> Resolved:
    """Return the entries of a whole system; `off` are the full names that its conditions switch off.

    Raises `DocumentError` if two entries want the keyboard, or one in a shared process does.
    """
    found = Resolved()
    named: dict[str, Draft] = {}
    for name, each in _named(drafts):
        if name in named:
            found.mistakes.append(_twice(name, each, named[name]))
        named.setdefault(name, each)
    nodes = {f"/{name}": None for name, each in named.items() if each.source}
    commands = {f"/{name}": None for name, each in named.items() if not each.source}
    known = Known(nodes, commands, off)
    for name, each in named.items():
        try:
            found.entries.append(_entry(name, each, known))
        except DocumentError as error:
            found.mistakes.append(error)
    if not found.mistakes:
        _check_terminal(found.entries)
    return found


def _named(drafts: Sequence[Draft]) -> Iterator[tuple[str, Draft]]:
    """Yield each draft with its name; FILE:Class and FILE:Other, which share a file's name, are Class and Other."""
    specs: dict[str, set[str]] = {}
    for each in drafts:
        specs.setdefault(each.name, set()).add(each.source.spec if each.source else "")
    for each in drafts:
        yield each.name if len(specs[each.name]) == 1 else each.name_within_file, each


def _twice(name: str, draft: Draft, other: Draft) -> DocumentError:
    section = draft.section
    kind = "nodes" if draft.source else "commands"
    is_copy = (section.steps, section.file.path) == (other.section.steps, other.section.file.path)
    if is_copy and section.file is not other.section.file:
        reason = f"two {kind} are called '{name}', since this file is included twice: give each its `namespace`"
        return section.error([], reason)
    if is_copy:
        at = ["count"] if "count" in section else []
        return section.error(at, f"two of the copies are called '{name}': put {{i}} into `name` or `namespace`")
    key = next(each for each in ("name", "node", "run") if each in section)
    return section.error([key], f"two {kind} are called '{name}': give this one another `name`")


def _check_terminal(entries: Iterable[Entry]) -> None:
    interactive = [each for each in entries if each.node.interactive]
    if len(interactive) > 1:
        raise interactive[1].error(["interactive"], f"there is one keyboard, and '{interactive[0].name}' has it")
    for each in interactive:
        if each.node.process:
            raise each.error(["interactive"], "a node with the keyboard cannot share a process: leave `process` out")


# One entry


def _entry(name: str, draft: Draft, known: Known) -> Entry:
    described, inherited = draft.described, draft.inherited
    parameters = parameters_for(f"/{name}", inherited.given, draft.own) if draft.source else {}
    node = NodeToStart(
        node=described.node,
        run=list(draft.command),
        name=described.name,
        namespace=inherited.namespace,
        parameters={each: parameter.value for each, parameter in parameters.items()},
        remappings={match: each.value for match, each in inherited.remappings.items()} if draft.source else {},
        args=list(map(str, described.args)),
        env={variable: str(each.value) for variable, each in inherited.env.items()},
        interactive=as_bool(described.interactive) is True,
        start_after=tuple(dict.fromkeys(_conditions(inherited.awaited, f"/{name}", known))),
        **_settings(draft),
    )
    wide = frozenset(each for each, parameter in parameters.items() if parameter.is_wide)
    files = frozenset([*draft.chain, *(each.file for each in (*inherited.given, *draft.own) if each.file)])
    return Entry(name, node, draft.source, draft.home, _Places(draft, parameters).error, wide, files)


def _settings(draft: Draft) -> dict[str, Any]:
    """Return the settings that belong to a process, from the node or inherited."""
    found = {key: each.value for key, each in draft.inherited.settings.items()}
    if draft.source is None:
        found = {key: value for key, value in found.items() if key not in _NODES_ONLY}
    if isinstance(found.get("respawn"), str):
        found["respawn"] = Respawn(when=found["respawn"])
    if isinstance(found.get("cpu"), int):
        found["cpu"] = [found["cpu"]]
    found["cpu"] = tuple(dict.fromkeys(found.get("cpu") or ()))
    return {key: value for key, value in found.items() if value is not None}


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


# What it waits for


def _conditions(awaited: Iterable[Placed], name: str, known: Known) -> Iterator[StartAfter]:
    """Yield the readiness conditions of a node or command, with full names; `name` is its own full name.

    A node is searched in the namespace of the one that waits, then in those around it; one that is switched off is
    not waited for. Raises `DocumentError` for an unknown node and for an invalid name.
    """
    namespace, _, own = name.rpartition("/")
    for each in awaited:
        one = StartAfter(node=each.value) if isinstance(each.value, str) else each.value
        if bool(one.node) + bool(one.topic) + bool(one.service) != 1:
            raise each.place.error("expected one of `node`, `topic` and `service` (several are given as a list)")
        if one.node:
            yield from _node(each, one.node, namespace, known)
        elif one.topic:
            yield StartAfter(topic=_expanded(each, "topic", one.topic, own, namespace))
        else:
            yield StartAfter(service=_expanded(each, "service", one.service, own, namespace))


def _node(each: Placed, name: str, namespace: str, known: Known) -> Iterator[StartAfter]:
    candidates = [name] if name.startswith("/") else [f"{above}/{name}" for above in _and_above(namespace)]
    found = next((full for full in candidates if full in known.nodes), None)
    if found is not None:
        yield StartAfter(node=found)
        return
    steps = [] if isinstance(each.value, str) else ["node"]
    if any(full in known.commands for full in candidates):
        reason = f"'{shown(name)}' is a command, of which nothing tells that it is up: wait for a {{topic: NAME}}"
        raise each.place.error(reason, steps)
    if not any(full in known.off for full in candidates):
        nearest = _nearest(name, namespace, known.nodes)
        raise each.place.error(f"no node of this system is called '{shown(name)}'{nearest}", steps)


def _nearest(name: str, namespace: str, nodes: Collection[str]) -> str:
    """Return a suggestion: the nearest node, by a name that finds it."""
    inherited = [f"{above}/" for above in _and_above(namespace)]
    short = {full: full.removeprefix(next(each for each in inherited if full.startswith(each))) for full in nodes}
    return near(name, short.values())


def _and_above(namespace: str) -> Iterator[str]:
    """Yield a namespace and those around it: /a/b, /a and the root, which is ''."""
    while namespace:
        yield namespace
        namespace = namespace.rpartition("/")[0]
    yield ""


def _expanded(each: Placed, kind: str, name: str, own: str, namespace: str) -> str:
    try:
        validate_topic_name(name, is_service=kind == "service")
        return expand_topic_name(name, own, namespace or "/")
    except NameValidationException as error:
        raise each.place.error(f"'{shown(error.name)}' {error.error_msg}", [kind]) from None
