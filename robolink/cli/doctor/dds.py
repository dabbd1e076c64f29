"""ROS 2 over DDS on this machine: who speaks it, who of them cannot be met, and what to do."""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from robolink.extensions.optional import PARTICIPANT, is_here, part
from robolink.system import clocks
from robolink.wire import mark_in

MEETS_WITHIN = 0.5
"""Timeout of the others' answers to a participant, in seconds; they take some 20 ms."""

QUIET = 0.1
"""Time without another answer after which all are taken to have answered, in seconds."""

_PORT_BASE, _DOMAIN_GAIN, _PARTICIPANT_GAIN = 7400, 250, 2
_DISCOVERY, _USER = 10, 11
MOST_PARTICIPANTS = 120
"""Number of participants of a domain that have ports of their own."""

_PORT_FILE = re.compile(r"fast(?:dds|rtps)_port(\d+)_el")
"""Lock of a port of Fast DDS in shared memory, which whoever reads from the port holds: since 3.0, and before."""


class Ways(NamedTuple):
    """Ways on which processes are that speak DDS but cannot be met: descriptions of the processes."""

    shared_memory: tuple[str, ...] = ()
    tcp: tuple[str, ...] = ()
    server: tuple[str, ...] = ()


class Dds(NamedTuple):
    """Facts about DDS on the domain of the settings."""

    nodes: int = 0
    """Number of participants of ROS 2 that are met."""
    bridges: int = 0
    """Number of robolink's bridges among the participants."""
    ways: Ways = Ways()
    receive_buffer: int | None = None
    """Upper bound of a socket's receive buffer, net.core.rmem_max, in bytes; None where there is no such bound."""


def look(domain: int) -> Dds:
    """Return the participants that speak DDS on a domain of this machine; takes half a second if anybody does."""
    linux = sys.platform.startswith("linux")
    ports = udp_ports() if linux else None
    ways = unmet_ways(domain, live_ports(), ports or ()) if linux else Ways()
    found = Dds(ways=ways, receive_buffer=receive_buffer() if linux else None)
    if not is_here(PARTICIPANT) or (ports is not None and not _are_used(domain, ports)):
        return found
    nodes, bridges = _met(domain)
    return found._replace(nodes=nodes, bridges=bridges)


def _are_used(domain: int, ports: Iterable[int]) -> bool:
    first = _PORT_BASE + _DOMAIN_GAIN * domain
    return any(first <= each < first + _DOMAIN_GAIN for each in ports)


def _met(domain: int) -> tuple[int, int]:
    """Return the numbers of participants of ROS 2, and of bridges, that answer a participant on loopback."""
    latest = begin = clocks.monotonic()

    def on_peer(peer: object, came: bool) -> None:
        nonlocal latest
        latest = clocks.monotonic()

    try:
        participant = part(PARTICIPANT, "DDS")(domain, name="robolink doctor", on_peer=on_peer)
    except OSError:  # no port is free
        return 0, 0
    try:
        while (now := clocks.monotonic()) < begin + MEETS_WITHIN and now < max(latest, begin + 2 * QUIET) + QUIET:
            time.sleep(0.02)
        announced = [each.user_data for each in participant.peers()]
    finally:
        participant.close()
    bridges = sum(bool(mark_in(each)) for each in announced)
    return sum(b"enclave=" in each and not mark_in(each) for each in announced), bridges


def udp_ports(root: Path = Path("/proc/net")) -> frozenset[int]:
    """Return the UDP ports that are bound on this machine; Linux only."""
    found: set[int] = set()
    for name in ("udp", "udp6"):
        try:
            lines = (root / name).read_text(encoding="ascii").splitlines()[1:]
        except OSError:  # no IPv6
            continue
        found.update(int(each.split()[1].rpartition(":")[2], 16) for each in lines)
    return frozenset(found)


def live_ports(shared: Path = Path("/dev/shm"), locks: Path = Path("/proc/locks")) -> dict[int, int]:
    """Return the ports of Fast DDS in shared memory that somebody reads from, each with the process; Linux only.

    What a killed process has left there is nobody's any more: its lock is gone.
    """
    try:
        held = {
            int(fields[5].rpartition(":")[2]): int(fields[4]) for fields in _fields(locks.read_text(encoding="ascii"))
        }
        files = [(match, each) for each in shared.iterdir() if (match := _PORT_FILE.fullmatch(each.name))]
    except OSError:
        return {}
    found = {}
    for match, path in files:
        try:
            inode = path.stat().st_ino
        except OSError:  # gone just now
            continue
        if inode in held:
            found[int(match[1])] = held[inode]
    return found


def _fields(text: str) -> list[list[str]]:
    """Return the fields of the lines of /proc/locks, but for those of processes that wait for one ("->")."""
    return [fields for line in text.splitlines() if len(fields := line.split()) >= 8 and fields[1] != "->"]


def unmet_ways(
    domain: int, shared: Mapping[int, int], udp: Iterable[int], environs: Mapping[int, Mapping[str, str]] | None = None
) -> Ways:
    """Return which processes are on ways on which nobody meets them but their like.

    With its usual transports Fast DDS has a port in shared memory for data, and UDP for the rest. With
    FASTDDS_BUILTIN_TRANSPORTS=SHM the port for discovery is in shared memory, too; with LARGE_DATA none is UDP's, but
    for multicast. (Fast DDS 2.14 and 3.2, on Linux.)

    Args:
        domain: ROS domain id.
        shared: Live ports in shared memory, each with its process.
        udp: UDP ports that are bound.
        environs: Environments of the processes; None reads them.
    """
    bound, first = frozenset(udp), _PORT_BASE + _DOMAIN_GAIN * domain
    memory, tcp, server = [], [], []
    for index in range(MOST_PARTICIPANTS):
        discovery, user = (first + offset + _PARTICIPANT_GAIN * index for offset in (_DISCOVERY, _USER))
        if user not in shared:
            continue
        pid = shared[user]
        name = _named(pid) if environs is None else f"pid {pid}"
        environ = _environ(pid) if environs is None else environs.get(pid, {})
        if discovery in shared and discovery not in bound:
            memory.append(name)
        elif not bound & {discovery, user}:
            tcp.append(name)
        elif environ.get("ROS_DISCOVERY_SERVER"):
            server.append(name)
    return Ways(tuple(memory), tuple(tcp), tuple(server))


def _named(pid: int) -> str:
    try:
        words = Path(f"/proc/{pid}/cmdline").read_bytes().decode(errors="replace").split("\0")
    except OSError:
        words = []
    return f"{' '.join(filter(None, words))[:80] or 'a process'}, pid {pid}"


def _environ(pid: int) -> dict[str, str]:
    """Return the environment of a process; nothing if it is another user's."""
    try:
        raw = Path(f"/proc/{pid}/environ").read_bytes().decode(errors="replace")
    except OSError:
        return {}
    return dict(each.partition("=")[::2] for each in raw.split("\0") if each)


def receive_buffer(path: Path = Path("/proc/sys/net/core/rmem_max")) -> int | None:
    """Return the upper bound of a socket's receive buffer in bytes; None if it is not known."""
    try:
        return int(path.read_text(encoding="ascii"))
    except (OSError, ValueError):
        return None
