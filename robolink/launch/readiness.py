"""Readiness conditions (`start_after`): hold processes back until nodes, topics or services are announced.

A launcher joins the network only while something is held back.
"""

from __future__ import annotations

import contextlib
import functools
import itertools
import os
import threading
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from robolink.arguments.remapping import RemapKind, parse_remap_rule, remap_name
from robolink.exceptions import RobolinkError, WireError
from robolink.launch.entry import Entry
from robolink.system import waits
from robolink.system.files import LONGEST_SOURCE, read_plain

if TYPE_CHECKING:
    import ast
    from pathlib import Path

    from robolink.workspace import NodeSource

PATIENCE = 5.0
"""Time after which the unmet conditions are reported once, in seconds."""

_LEAVING = 5.0
"""Timeout of leaving the network, or of giving it up while it is being opened, in seconds."""

_WAITS_FOR = {
    "node": "node {}: it is not there yet",
    "topic": "topic {}: nobody publishes it yet",
    "service": "service {}: nobody serves it yet",
}


class Awaited(NamedTuple):
    """A readiness condition of a process."""

    kind: str
    """`node`, `topic` or `service`."""
    names: tuple[str, ...]
    """Full name; several candidates for a node whose name is only in its code."""

    def __str__(self) -> str:
        return _WAITS_FOR[self.kind].format(self.names[0])


def awaited(entry: Entry, named: Mapping[str, Entry]) -> Iterator[Awaited]:
    """Yield the readiness conditions of a node or command, with its own remappings applied.

    `named` are all nodes and commands of the system, by their full names.
    """
    namespace = entry.node.namespace or "/"
    name = entry.full_name.rpartition("/")[2]
    rules = [parse_remap_rule(":=".join(each)) for each in entry.node.remappings.items()]
    for each in entry.node.start_after:
        if each.node:
            yield Awaited("node", _names_of(each.node, named.get(each.node)))
        elif each.topic:
            yield Awaited("topic", (remap_name(rules, RemapKind.TOPIC, each.topic, name, namespace),))
        else:
            yield Awaited("service", (remap_name(rules, RemapKind.SERVICE, each.service, name, namespace),))


def _names_of(full_name: str, entry: Entry | None) -> tuple[str, ...]:
    """Return the names by which a node may be announced: the launch file's, else those in its code."""
    if entry is None or entry.node.name or entry.source is None:
        return (full_name,)
    namespace = full_name.rpartition("/")[0]
    return tuple(dict.fromkeys([full_name, *(f"{namespace}/{name}" for name in names_in(entry.source))]))


def names_in(source: NodeSource) -> list[str]:
    """Return the node names that stand as literals in a node's class, or else in its file."""
    try:
        return _names_at(source.path, source.attribute, source.path.stat().st_mtime_ns)
    except (OSError, SyntaxError, ValueError, RecursionError, MemoryError):
        return []


@functools.lru_cache(maxsize=16)  # others may wait for each of a hundred copies
def _names_at(path: Path, class_name: str, changed: int) -> list[str]:
    import ast

    tree: ast.AST = ast.parse(read_plain(path, LONGEST_SOURCE))
    classes = (each for each in ast.iter_child_nodes(tree) if isinstance(each, ast.ClassDef))
    its_own = next((each for each in classes if each.name == class_name), tree)
    return [name for each in ast.walk(its_own) if isinstance(each, ast.Call) and (name := _node_name(each))]


def _node_name(call: ast.Call) -> str:
    """Return the node name in a call of ``super().__init__``, ``Node`` or ``create_node``; empty for other calls."""
    import ast

    called = getattr(call.func, "attr", getattr(call.func, "id", ""))
    first = call.args[0] if call.args else None
    named = next((each.value for each in call.keywords if each.arg == "node_name"), first)
    makes_one = called in ("__init__", "create_node") or called.endswith("Node")
    return named.value if makes_one and isinstance(named, ast.Constant) and isinstance(named.value, str) else ""


class Readiness:
    """Tracks which readiness conditions are met. Thread-safe.

    `held` has the conditions of each process by its name. `heard` is to be called for every token of the network, as
    `Transport.watch` does; a token that has gone no longer counts.
    """

    def __init__(self, held: Mapping[str, Sequence[Awaited]]) -> None:
        self._held = {name: all_of_one for name, all_of_one in held.items() if all_of_one}
        self._lock = threading.Lock()
        conditions = itertools.chain.from_iterable(held.values())
        self._awaited = {(each.kind, name) for each in conditions for name in each.names}
        self._there: Counter[tuple[str, str]] = Counter()

    @property
    def held(self) -> list[str]:
        """Names of the processes that still wait."""
        return list(self._held)

    def knows(self, text: str) -> bool:
        """True if a process waits for what a token announces."""
        return _key(text) in self._awaited

    def note_token(self, text: str, alive: bool) -> list[str]:
        """Note a token that came or went; return the processes whose conditions are all met now, each once."""
        key = _key(text)
        if key not in self._awaited:
            return []
        with self._lock:
            self._there[key] += 1 if alive else -1
            ready = [name for name, all_of_one in self._held.items() if all(map(self._is_there, all_of_one))]
            for name in ready:
                del self._held[name]
        return ready

    def missing(self) -> dict[str, list[Awaited]]:
        """Return the unmet conditions of each process that still waits."""
        with self._lock:
            return {name: [each for each in held if not self._is_there(each)] for name, held in self._held.items()}

    def _is_there(self, each: Awaited) -> bool:
        return any(self._there[each.kind, name] > 0 for name in each.names)


def _key(text: str) -> tuple[str, str]:
    """Return the kind and full name that a token announces; empty ones for tokens that no condition can name."""
    from robolink.wire import EndpointKind, NodeToken, parse_token

    try:
        token = parse_token(text)
    except WireError:
        return "", ""
    if isinstance(token, NodeToken):
        return "node", token.full_node_name
    kinds = {EndpointKind.PUBLISHER: "topic", EndpointKind.SERVICE: "service"}
    return kinds.get(token.kind, ""), token.name


@contextlib.contextmanager
def waiting(
    held: Mapping[str, Sequence[Awaited]],
    release: Callable[[str], object],
    say: Callable[[str], object],
    *,
    patience: float = PATIENCE,
    enclave: str = "",
) -> Iterator[None]:
    """Watch the network while the block runs, and release held processes as their conditions are met.

    Args:
        held: Conditions of each process that is held back, by its name.
        release: Called with the name of a process when all its conditions are met, on a thread of the network's.
        say: Called with a text for each process that still waits after `patience`, or if the network cannot be joined.
        patience: Time until then, in seconds.
        enclave: Enclave with whose keys the network is joined; '' for `/`.

    The network is left when nothing is held any more.
    """
    if not held:
        yield
        return
    watch = _Watch(held, release, enclave)
    thread = threading.Thread(target=watch.run, args=(say, patience), name="launch readiness", daemon=True)
    thread.start()
    try:
        yield
    finally:
        watch.over.set()
        waits.join(thread, _LEAVING)


class _Watch:
    """The thread that watches the network while a process is held back."""

    def __init__(
        self, held: Mapping[str, Sequence[Awaited]], release: Callable[[str], object], enclave: str = ""
    ) -> None:
        self.over = threading.Event()
        self._enclave = enclave or None
        self._readiness = Readiness(held)
        self._release = release

    def run(self, say: Callable[[str], object], patience: float) -> None:
        """Watch until nothing is held, or until the watch is stopped."""
        from robolink.networks.request import domain_id
        from robolink.transport import connect
        from robolink.wire import graph_pattern

        try:
            domain = domain_id(os.environ)
            session = connect(os.environ.get("ROBOLINK_TRANSPORT") or "zenoh", domain, enclave=self._enclave)
        except (RobolinkError, ValueError) as error:
            say(f"cannot look for what {', '.join(self._readiness.held)} waits for: {error}")
            return
        try:
            session.watch(graph_pattern(domain), self._hear)
            if not self.over.wait(patience):
                for name, held in self._readiness.missing().items():
                    say(f"{name} waits for {' and '.join(map(str, held))}")
                self.over.wait()
        finally:
            session.close()

    def _hear(self, text: str, alive: bool) -> bool:
        """Note a token that came or went; return False for one that no process waits for."""
        for name in self._readiness.note_token(text, alive):
            self._release(name)
        if not self._readiness.held:
            self.over.set()
        return self._readiness.knows(text)
