"""The graph: which nodes there are and what they publish, subscribe to, serve and call."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

from robolink.exceptions import WireError
from robolink.wire import EndpointKind, EndpointToken, NodeToken, graph_pattern, parse_token

if TYPE_CHECKING:
    from robolink.transport.base import Transport

Token = NodeToken | EndpointToken
NamesAndTypes = list[tuple[str, list[str]]]


SETTLED_WITHIN = 0.1
"""Seconds; it takes 2 ms."""


class Graph:
    """What is announced on a domain, kept up to date by the transport. Every question is answered from memory."""

    def __init__(self, transport: Transport, domain_id: int) -> None:
        self._tokens: dict[str, Token] = {}
        self._changed = threading.Condition()
        self.malformed: set[str] = set()
        """Announcements that could not be read."""
        self._listeners: tuple[Callable[[], None], ...] = ()
        pattern = graph_pattern(domain_id)
        known = set(transport.tokens(pattern))
        self._watch = transport.watch(pattern, self._on_change)
        # What was there before is known before the first question; a token that is lost just now costs the wait.
        self.wait_for(lambda: known <= self._tokens.keys() | self.malformed, timeout=SETTLED_WITHIN)

    def _on_change(self, text: str, alive: bool) -> None:
        with self._changed:
            if alive:
                try:
                    self._tokens[text] = parse_token(text)
                except WireError:
                    self.malformed.add(text)
                    return
            else:
                self._tokens.pop(text, None)
                self.malformed.discard(text)
            self._changed.notify_all()
            listeners = self._listeners
        for listener in listeners:
            listener()

    def listen(self, listener: Callable[[], None]) -> None:
        """Call `listener()` after each change, on the transport's thread."""
        with self._changed:
            self._listeners = (*self._listeners, listener)

    def wait_for(self, condition: Callable[[], bool], timeout: float | None) -> bool:
        """Wait, in real time, until `condition()` holds; look whenever something changed."""
        with self._changed:
            return self._changed.wait_for(condition, timeout)

    def wake(self) -> None:
        """Let whoever waits look again."""
        with self._changed:
            self._changed.notify_all()

    def nodes(self) -> list[NodeToken]:
        """All nodes."""
        return sorted({token for token in self._all() if isinstance(token, NodeToken)})

    def endpoints(self, *kinds: EndpointKind, name: str | None = None) -> list[EndpointToken]:
        """All endpoints of these kinds; of one topic or service, if named."""
        return [
            token
            for token in self._all()
            if isinstance(token, EndpointToken) and token.kind in kinds and (name is None or token.name == name)
        ]

    def of_node(self, node_name: str, namespace: str, kind: EndpointKind) -> list[EndpointToken]:
        """The endpoints of a node."""
        return [each for each in self.endpoints(kind) if (each.node_name, each.namespace) == (node_name, namespace)]

    def count(self, kind: EndpointKind, name: str) -> int:
        """How many endpoints of this kind one topic or service has."""
        return len(self.endpoints(kind, name=name))

    def text_of(self, token: Token) -> str:
        """The announcement as it stands on the wire."""
        with self._changed:
            return next(text for text, each in self._tokens.items() if each == token)

    def _all(self) -> Iterator[Token]:
        with self._changed:
            tokens = list(self._tokens.values())
        return iter(tokens)


def names_and_types(endpoints: Iterable[EndpointToken]) -> NamesAndTypes:
    """Group endpoints by name; each with the types it is used with, both sorted."""
    found: dict[str, set[str]] = {}
    for endpoint in endpoints:
        found.setdefault(endpoint.name, set()).add(endpoint.type_name)
    return [(name, sorted(types)) for name, types in sorted(found.items())]
