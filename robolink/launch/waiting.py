"""What `start_after` names: nodes of the system, topics, services, by their full names."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from robolink.exceptions import NameValidationException, nearest, shown
from robolink.expand_topic_name import expand_topic_name
from robolink.launch.around import Awaited
from robolink.launch.description import StartAfter
from robolink.validate_topic_name import validate_topic_name


def resolved(
    awaited: Iterable[Awaited], name: str, nodes: Collection[str], commands: Collection[str]
) -> Iterator[StartAfter]:
    """Yield what a node or command waits for, with full names; `name` is its own full name.

    `nodes` and `commands` are the full names of all that is started. A node is looked for in the namespace of who
    waits, then in those around it. Raises `DocumentError` for a node that there is not, and for what is no name.
    """
    namespace, _, own = name.rpartition("/")
    for each in awaited:
        said = StartAfter(node=each.said) if isinstance(each.said, str) else each.said
        if bool(said.node) + bool(said.topic) + bool(said.service) != 1:
            raise each.place.error("expected one of `node`, `topic` and `service` (several are given as a list)")
        if said.node:
            yield StartAfter(node=_node(each, said.node, namespace, nodes, commands))
        elif said.topic:
            yield StartAfter(topic=_expanded(each, "topic", said.topic, own, namespace))
        else:
            yield StartAfter(service=_expanded(each, "service", said.service, own, namespace))


def _node(each: Awaited, name: str, namespace: str, nodes: Collection[str], commands: Collection[str]) -> str:
    candidates = [name] if name.startswith("/") else [f"{above}/{name}" for above in _and_above(namespace)]
    found = next((full for full in candidates if full in nodes), None)
    if found is not None:
        return found
    steps = [] if isinstance(each.said, str) else ["node"]
    if any(full in commands for full in candidates):
        raise each.place.error(f"'{shown(name)}' is a command, of which nothing tells that it is up", steps)
    known = [*(full.rpartition("/")[2] for full in nodes), *(full.removeprefix("/") for full in nodes), *nodes]
    raise each.place.error(f"no node of this system is called '{shown(name)}'{nearest(name, known)}", steps)


def _and_above(namespace: str) -> Iterator[str]:
    """Yield a namespace and those around it: /a/b, /a and the root, which is ''."""
    while namespace:
        yield namespace
        namespace = namespace.rpartition("/")[0]
    yield ""


def _expanded(each: Awaited, kind: str, name: str, own: str, namespace: str) -> str:
    try:
        validate_topic_name(name, is_service=kind == "service")
        return expand_topic_name(name, own, namespace or "/")
    except NameValidationException as error:
        raise each.place.error(f"'{shown(error.name)}' {error.error_msg}", [kind]) from None
