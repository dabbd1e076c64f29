"""Groups of servers: one declaration with wildcards for the services by which a node's parameters are read and set.

Each declaration is sent to all peers, which store and look up its key: six for each node are half of what nodes
declare beside their tokens. A call's key, which has no wildcards, reaches the group as it would reach each server; one
that has some gets no answer.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from robolink.system.waits import fork_lock
from robolink.transport.base import Handle, Sink
from robolink.transport.gates import close_gate, make_gate

_TYPES = "rcl_interfaces::srv::dds_::"
"""Beginning of the types of these services in a key."""


def group_of(key: str) -> str:
    """Return the key expression of the group that serves a key, "" for one that is declared by itself.

    >>> group_of("0/robot/get_parameters/rcl_interfaces::srv::dds_::GetParameters_/RIHS01_0")
    '0/robot/*/rcl_interfaces::srv::dds_::$*/*'
    """
    base, *parts = key.rsplit("/", 3)
    return f"{base}/*/{_TYPES}$*/*" if len(parts) == 3 and parts[1].startswith(_TYPES) else ""


class Groups:
    """Groups of one session, each declared while it has a server."""

    def __init__(self) -> None:
        self._groups: dict[str, _Group] = {}
        self._lock = fork_lock()  # re-entrant: a signal handler may end a node while another one is made

    def serve(self, key: str, sink: Sink, declare: Callable[[str, Sink], Handle]) -> Handle | None:
        """Serve a key in its group.

        Args:
            key: The key.
            sink: Function that gets each call of it.
            declare: Function that declares a group: of its key expression, and of what gets each call.

        Returns:
            The handle that ends it; None for a key without a group, and for one that another server of this session
            has: both are to be called.
        """
        group = group_of(key)
        if not group:
            return None
        with self._lock:
            found = self._groups.get(group) or _Group()
            if key in found.gates:
                return None
            if found.handle is None:
                found.handle = declare(group, found)
                self._groups[group] = found
            found.gates[key] = gate = make_gate(sink)
        return _Member(gate, lambda: self._leave(group, key))

    def _leave(self, group: str, key: str) -> None:
        handle = None
        with self._lock:
            found = self._groups[group]
            del found.gates[key]
            if not found.gates:
                handle = self._groups.pop(group).handle
        if handle is not None:  # unlocked: Zenoh may be calling just now, and waits for nobody who waits for it
            handle.close()


class _Group:
    """Sink of a group: passes each call on to the server of its key, or ends it."""

    def __init__(self) -> None:
        self.handle: Handle | None = None
        self.gates: dict[str, Sink] = {}

    def __call__(self, query: Any) -> None:
        # A Python frame on Zenoh's thread, which costs 10 us: parameters are read seldom.
        gate = self.gates.get(str(query.key_expr))
        if gate is not None:  # else the server is another session's; what nobody refers to has ended without an answer
            gate(query)


class _Member:
    """Handle of a server in a group."""

    def __init__(self, gate: Sink, leave: Callable[[], None]) -> None:
        self._gate, self._leave = gate, leave
        self._lock, self._is_closed = threading.Lock(), False

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        with self._lock:
            was_closed, self._is_closed = self._is_closed, True
        close_gate(self._gate)
        if not was_closed:
            self._leave()
