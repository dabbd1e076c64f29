"""Nodes of this session as DDS is told of them: one message with all nodes and what belongs to which."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable
from typing import NamedTuple

from robolink.dds.entities import NodeEntities, ParticipantEntities, encode
from robolink.dds.worker import Worker
from robolink.system.waits import fork_lock
from robolink.wire import EndpointToken, NodeToken


class Guids(NamedTuple):
    """GUIDs of what one endpoint of ROS has on DDS: a service has two, and a subscription may have several."""

    readers: tuple[bytes, ...] = ()
    writers: tuple[bytes, ...] = ()


class OwnNodes:
    """Nodes that this session announces, and their endpoints; written once for each bundle of changes."""

    def __init__(self, guid: bytes, write: Callable[[bytes], object], worker: Worker) -> None:
        self._guid, self._write, self._worker = guid, write, worker
        self._lock = fork_lock()
        self._numbers = itertools.count()
        self._nodes: dict[int, NodeToken] = {}
        self._endpoints: dict[int, tuple[EndpointToken, Guids]] = {}
        self._written = b""
        worker.post_idle(self._tell)  # that there are none is news too: others wait for it

    def add_node(self, token: NodeToken) -> int:
        """List a node; return the number by which it is removed."""
        with self._lock:
            number = next(self._numbers)
            self._nodes[number] = token
        self._worker.post_idle(self._tell)
        return number

    def add(self, token: EndpointToken, guids: Guids) -> int:
        """List an endpoint under its node; return the number by which it is changed and removed."""
        number = next(self._numbers)
        self.change(number, token, guids)
        return number

    def change(self, number: int, token: EndpointToken, guids: Guids) -> None:
        """List other GUIDs for an endpoint."""
        with self._lock:
            self._endpoints[number] = token, guids
        self._worker.post_idle(self._tell)

    def remove(self, number: int) -> None:
        """List a node or an endpoint no longer."""
        with self._lock:
            self._nodes.pop(number, None)
            self._endpoints.pop(number, None)
        self._worker.post_idle(self._tell)

    def _tell(self) -> None:
        with self._lock:
            nodes = list(self._nodes.values())
            endpoints = list(self._endpoints.values())
        by_node: dict[tuple[str, str], list[Guids]] = {}
        for token, guids in endpoints:
            by_node.setdefault((token.session, token.node_id), []).append(guids)
        listed = tuple(_entities(node, by_node.get((node.session, node.node_id), ())) for node in nodes)
        message = encode(ParticipantEntities(self._guid, listed))
        if message != self._written:
            self._written = message
            self._write(message)


def _entities(node: NodeToken, owned: Iterable[Guids]) -> NodeEntities:
    all_of = tuple(owned)
    readers = itertools.chain.from_iterable(each.readers for each in all_of)
    writers = itertools.chain.from_iterable(each.writers for each in all_of)
    return NodeEntities(node.namespace or "/", node.node_name, tuple(readers), tuple(writers))
