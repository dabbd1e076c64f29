"""Ports of this machine: which process and which user listens on one, and at which addresses it can be reached."""

from __future__ import annotations

import contextlib
import os
import socket
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from robolink.networks.port_probe import HOST, Port, listening

MOST_ADDRESSES = 8
"""Upper bound of the addresses of this machine that are tried."""


class Holder(NamedTuple):
    """The process that listens on a port."""

    pid: int
    command: str


def also_open_at(port: Port, within: float) -> tuple[str, ...]:
    """Return this machine's other addresses at which the same session answers: there other machines can reach it."""
    found = []
    for address in _own_addresses():
        with contextlib.suppress(OSError):
            other = listening([port.number], within, address).get(port.number)
            found += [address] if other is not None and other.session == port.session else []
    return tuple(found)


def _own_addresses() -> list[str]:
    """Return this machine's addresses, but for loopback and link-local ones."""
    import psutil

    families = (socket.AF_INET, socket.AF_INET6)
    each_of_all = (each for addresses in psutil.net_if_addrs().values() for each in addresses)
    found = {each.address for each in each_of_all if each.family in families}
    return sorted(each for each in found if not each.startswith(("127.", "::1", "fe80:")))[:MOST_ADDRESSES]


def loopback_works() -> bool:
    """True if this machine can connect to itself."""
    try:
        with socket.create_server((HOST, 0)) as server, socket.create_connection(server.getsockname(), 0.5):
            return True
    except OSError:
        return False


def holder(number: int, root: Path = Path("/proc")) -> Holder | None:
    """Return the process that listens on a port: on Linux, if it is one of the user's own. Else None."""
    if not sys.platform.startswith("linux"):
        return None
    inodes = {f"socket:[{inode}]" for _, inode in _listeners(root, number)}
    for folder in root.glob("[0-9]*/fd") if inodes else ():
        with contextlib.suppress(OSError):
            if any(os.readlink(each) in inodes for each in folder.iterdir()):  # noqa: PTH115 - no path: socket:[n]
                return Holder(int(folder.parent.name), _command(folder.parent))
    return None


def owner(number: int, root: Path = Path("/proc")) -> str:
    """Return the name of another user who listens on a port; empty for oneself, for root and if not known."""
    if sys.platform == "win32" or not sys.platform.startswith("linux"):
        return ""
    import pwd

    others = sorted({int(user) for user, _ in _listeners(root, number)} - {0, os.getuid()})
    try:
        return pwd.getpwuid(others[0]).pw_name if others else ""
    except (KeyError, OverflowError):
        return f"user {others[0]}"


def _listeners(root: Path, number: int) -> Iterator[tuple[str, str]]:
    """Yield the users and inodes of the sockets that listen on a port, from the kernel's tables."""
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
    safe = ascii_only(text)
    return safe if len(safe) <= 80 else f"{safe[:30]}...{safe[-47:]}"


def ascii_only(text: str) -> str:
    """Return `text` with a question mark for each character that is not printable ASCII."""
    return "".join(each if each.isascii() and each.isprintable() else "?" for each in text)
