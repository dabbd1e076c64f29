"""Probe of TCP ports: finds out with Zenoh's handshake if a port is free, a Zenoh session's, or a stranger's."""

from __future__ import annotations

import contextlib
import errno
import selectors
import socket
from collections.abc import Iterable
from typing import NamedTuple

from robolink.system import clocks
from robolink.system.waits import A_WHILE

HOST = "127.0.0.1"

SILENT, STRANGER, REFUSES, ROUTER, PEER, CLIENT = "silent", "stranger", "refuses", "router", "peer", "client"

_ROLES = (ROUTER, PEER, CLIENT)
"""Roles of a session, in the order of Zenoh's numbers."""

_HELLO = bytes([0x01, 0x09, 0x71]) + b"robolink"
"""Zenoh's InitSyn, version 9: from a peer (1) whose id has 7 + 1 bytes. It leaves no state where it is answered."""

_INIT_ACK, _CLOSE = 0x21, 0x03

_LONGEST = 2 + 0xFFFF

_BEGUN = (0, errno.EINPROGRESS, errno.EWOULDBLOCK)
"""Results of `connect_ex` for a connection that is established or under way."""


class Port(NamedTuple):
    """A TCP port that something listens on."""

    number: int
    role: str = STRANGER
    """ROUTER, PEER or CLIENT for what speaks Zenoh; SILENT if it did not answer in time."""
    session: str = ""
    """Session id, if it speaks Zenoh."""
    host: str = HOST
    hung_up: bool = False
    """True if it closed the connection without a word, as one with too many of them does."""

    @property
    def speaks_zenoh(self) -> bool:
        """True if a Zenoh session listens here, which others can join."""
        return self.role in _ROLES


def listening(
    numbers: Iterable[int], within: float, host: str = HOST, *, first: int = 0, greet: bool = True
) -> dict[int, Port]:
    """Probe these ports, all at once, and return those that listen.

    Args:
        numbers: The ports.
        within: Timeout of their answers, in seconds.
        host: Name or address of the machine.
        first: Port that makes the others needless: once a Zenoh session has answered there, they are not waited for.
        greet: False to send nothing: then all that listens is SILENT.

    Raises:
        OSError: for a host that is not known.
    """
    found: dict[int, Port] = {}
    with contextlib.ExitStack() as stack:
        waiting = stack.enter_context(selectors.DefaultSelector())
        for number in numbers:
            greeting = _Greeting(number, host)
            stack.callback(greeting.socket.close)
            if greeting.begun:
                waiting.register(greeting.socket, selectors.EVENT_WRITE, greeting)
        deadline = clocks.monotonic() + within
        while waiting.get_map() and (left := deadline - clocks.monotonic()) > 0:
            for key, _ in waiting.select(min(left, A_WHILE)):  # Windows notices a Ctrl-C between two
                _advance(waiting, key.data, found, greet)
            if first in found and found[first].speaks_zenoh:
                break
    return found


class _Greeting:
    """Probe of one port: a connection under way, and what has been received."""

    def __init__(self, number: int, host: str) -> None:
        self.number, self.host = number, host
        self.received = b""
        self.connected = False
        family, *_, address = socket.getaddrinfo(host, number, type=socket.SOCK_STREAM)[0]
        self.socket = socket.socket(family)
        self.socket.setblocking(False)
        self.begun = self.socket.connect_ex(address) in _BEGUN


def _advance(waiting: selectors.BaseSelector, greeting: _Greeting, found: dict[int, Port], greet: bool) -> None:
    """Handle the next event of a port: it is connected, has answered, or is gone."""
    if not greeting.connected:
        if greeting.socket.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR):
            waiting.unregister(greeting.socket)
            return
        greeting.connected = True
        found[greeting.number] = Port(greeting.number, SILENT, host=greeting.host)
        if not greet:
            waiting.unregister(greeting.socket)
            return
        with contextlib.suppress(OSError):
            greeting.socket.send(len(_HELLO).to_bytes(2, "little") + _HELLO)
        waiting.modify(greeting.socket, selectors.EVENT_READ, greeting)
        return
    try:
        received = greeting.socket.recv(_LONGEST)
    except OSError:
        received = b""
    greeting.received += received
    role, session, complete = read_answer(greeting.received)
    if complete or not received:
        role, hung_up = role if complete else STRANGER, not greeting.received
        found[greeting.number] = Port(greeting.number, role, session, greeting.host, hung_up)
        waiting.unregister(greeting.socket)


def read_answer(received: bytes) -> tuple[str, str, bool]:
    """Parse an answer: return the role, the session id, and True if the answer is complete."""
    if len(received) < 3:
        return SILENT, "", False
    length, kind = int.from_bytes(received[:2], "little"), received[2] & 0x3F
    if kind & 0x1F == _CLOSE and length == len(received) - 2:
        return REFUSES, "", True
    if kind != _INIT_ACK or length < 5:
        return STRANGER, "", True
    if len(received) < 5:
        return SILENT, "", False
    size, role = (received[4] >> 4) + 1, received[4] & 0x03
    if role >= len(_ROLES) or length < 3 + size:
        return STRANGER, "", True
    if len(received) < 5 + size:
        return SILENT, "", False
    return _ROLES[role], f"{int.from_bytes(received[5 : 5 + size], 'little'):x}", True
