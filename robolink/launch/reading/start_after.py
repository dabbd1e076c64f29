"""Name resolution of `start_after`: nodes of the system, topics and services, to full names."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import NamedTuple

from robolink.exceptions import NameValidationException
from robolink.expand_topic_name import expand_topic_name
from robolink.launch.entry import StartAfter
from robolink.launch.reading.inherited import Placed
from robolink.system.terminal import shown
from robolink.text.names import near
from robolink.validate_topic_name import validate_topic_name


class Known(NamedTuple):
    """Full names of all nodes and commands of a system."""

    nodes: Collection[str]
    commands: Collection[str]
    off: Collection[str]
    """Those that conditions switch off this time."""


def resolved(awaited: Iterable[Placed], name: str, known: Known) -> Iterator[StartAfter]:
    """Yield the readiness conditions of a node or command, with full names; `name` is its own full name.

    A node is searched in the namespace of the one that waits, then in those around it; one that is switched off is
    not waited for. Raises `DocumentError` for an unknown node and for an invalid name.
    """
    namespace, _, own = name.rpartition("/")
    for each in awaited:
        said = StartAfter(node=each.value) if isinstance(each.value, str) else each.value
        if bool(said.node) + bool(said.topic) + bool(said.service) != 1:
            raise each.place.error("expected one of `node`, `topic` and `service` (several are given as a list)")
        if said.node:
            yield from _node(each, said.node, namespace, known)
        elif said.topic:
            yield StartAfter(topic=_expanded(each, "topic", said.topic, own, namespace))
        else:
            yield StartAfter(service=_expanded(each, "service", said.service, own, namespace))


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
