"""Who is on a TCP port of this machine: nobody, something that speaks Zenoh, or a stranger."""

from __future__ import annotations

import contextlib
import errno
import os
import selectors
import socket
import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

HOST = "127.0.0.1"

SILENT, STRANGER, REFUSES, ROUTER, PEER, CLIENT = "silent", "stranger", "refuses", "router", "peer", "client"

_ROLES = (ROUTER, PEER, CLIENT)
"""As Zenoh numbers them."""

_HELLO = bytes([0x01, 0x09, 0x71]) + b"robolink"
"""Zenoh's InitSyn, version 9: from a peer (1) whose id has 7 + 1 bytes. Whoever answers keeps nothing."""

_INIT_ACK, _CLOSE = 0x21, 0x03

MOST_ADDRESSES = 8
"""So many addresses of this machine are tried."""

_LONGEST = 2 + 0xFFFF

_BEGUN = (0, errno.EINPROGRESS, errno.EWOULDBLOCK)
"""What `connect_ex` says of a connection that is there or under way."""


class Port(NamedTuple):
    """Something that listens."""

    number: int
    role: str = STRANGER
    """ROUTER, PEER or CLIENT for what speaks Zenoh; SILENT if it did not answer in time."""
    session: str = ""
    """The session id of what speaks Zenoh."""
    host: str = HOST

    @property
    def speaks_zenoh(self) -> bool:
        """Whether a session can join here."""
        return self.role in _ROLES


class Holder(NamedTuple):
    """The process that listens on a port."""

    pid: int
    command: str


def listening(numbers: Iterable[int], within: float, host: str = HOST) -> dict[int, Port]:
    """Say hello to these ports, all at once; give those that listen. They have `within` seconds to answer.

    Raises OSError for a host that is not known.
    """
    found: dict[int, Port] = {}
    with contextlib.ExitStack() as stack:
        waiting = stack.enter_context(selectors.DefaultSelector())
        for number in numbers:
            greeting = _Greeting(number, host)
            stack.callback(greeting.socket.close)
            if greeting.begun:
                waiting.register(greeting.socket, selectors.EVENT_WRITE, greeting)
        deadline = time.monotonic() + within
        while waiting.get_map() and (left := deadline - time.monotonic()) > 0:
            for key, _ in waiting.select(left):
                _advance(waiting, key.data, found)
    return found


class _Greeting:
    """One port that is being asked."""

    def __init__(self, number: int, host: str) -> None:
        self.number, self.host = number, host
        self.received = b""
        self.connected = False
        family, *_, address = socket.getaddrinfo(host, number, type=socket.SOCK_STREAM)[0]
        self.socket = socket.socket(family)
        self.socket.setblocking(False)
        self.begun = self.socket.connect_ex(address) in _BEGUN


def _advance(waiting: selectors.BaseSelector, greeting: _Greeting, found: dict[int, Port]) -> None:
    """Take the next step with a port: it is connected, or has answered, or is gone."""
    if not greeting.connected:
        if greeting.socket.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR):
            waiting.unregister(greeting.socket)
            return
        greeting.connected = True
        found[greeting.number] = Port(greeting.number, SILENT, host=greeting.host)
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
        found[greeting.number] = Port(greeting.number, role if complete else STRANGER, session, greeting.host)
        waiting.unregister(greeting.socket)


def read_answer(received: bytes) -> tuple[str, str, bool]:
    """Read what came back: the role, the session id, and whether that is the whole answer."""
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


def also_open_at(port: Port, within: float) -> tuple[str, ...]:
    """List this machine's other addresses at which the same session answers: there other machines can reach it."""
    found = []
    for address in _own_addresses():
        with contextlib.suppress(OSError):
            other = listening([port.number], within, address).get(port.number)
            found += [address] if other is not None and other.session == port.session else []
    return tuple(found)


def _own_addresses() -> list[str]:
    """List this machine's addresses, but for the loopback's and those of one link only, which lead to the same."""
    import psutil

    families = (socket.AF_INET, socket.AF_INET6)
    each_of_all = (each for addresses in psutil.net_if_addrs().values() for each in addresses)
    found = {each.address for each in each_of_all if each.family in families}
    return sorted(each for each in found if not each.startswith(("127.", "::1", "fe80:")))[:MOST_ADDRESSES]


def loopback_works() -> bool:
    """Whether this machine can connect to itself."""
    try:
        with socket.create_server((HOST, 0)) as server, socket.create_connection(server.getsockname(), 0.5):
            return True
    except OSError:
        return False


def holder(number: int, root: Path = Path("/proc")) -> Holder | None:
    """Find the process that listens on a port: on Linux, where it is one of the user's own. Else None."""
    if not sys.platform.startswith("linux"):
        return None
    wanted = {f"socket:[{inode}]" for _, inode in _listeners(root, number)}
    for folder in root.glob("[0-9]*/fd") if wanted else ():
        with contextlib.suppress(OSError):
            if any(os.readlink(each) in wanted for each in folder.iterdir()):  # noqa: PTH115 - no path: socket:[n]
                return Holder(int(folder.parent.name), _command(folder.parent))
    return None


def owner(number: int, root: Path = Path("/proc")) -> str:
    """Name another user who listens on a port, where Linux tells it; empty for oneself, for root and if not known."""
    if sys.platform == "win32" or not sys.platform.startswith("linux"):
        return ""
    import pwd

    others = sorted({int(user) for user, _ in _listeners(root, number)} - {0, os.getuid()})
    try:
        return pwd.getpwuid(others[0]).pw_name if others else ""
    except (KeyError, OverflowError):
        return f"user {others[0]}"


def _listeners(root: Path, number: int) -> Iterator[tuple[str, str]]:
    """The users and inodes of the sockets that listen on a port, from the kernel's tables."""
    for table in ("net/tcp", "net/tcp6"):
        try:
            lines = (root / table).read_text(encoding="utf-8").splitlines()[1:]
        except OSError:
            continue
        rows = [line.split() for line in lines]
        for row in (each for each in rows if len(each) > 9 and each[3] == "0A"):
            if int(row[1].rpartition(":")[2], 16) == number:
                yield row[7], row[9]


def _command(process: Path) -> str:
    words = (process / "cmdline").read_bytes().decode(errors="replace").rstrip("\0").split("\0")
    text = " ".join([words[0].rpartition("/")[2], *words[1:]])
    safe = "".join(each if each.isascii() and each.isprintable() else "?" for each in text)
    return safe if len(safe) <= 80 else f"{safe[:30]}...{safe[-47:]}"
