"""Hosts of networks: parses HOST[:PORT], and asks a host what listens there, a robolink peer or a router."""

from __future__ import annotations

import contextlib
import queue
import re
import socket
import threading
import time
from collections.abc import Sequence
from typing import NamedTuple

from robolink.networks.port_probe import SILENT, STRANGER, Port, listening
from robolink.networks.request import FIRST_PORT, ROUTER_PORT
from robolink.system import clocks
from robolink.system.waits import get_within

ANSWER_WITHIN = 1.0
"""Timeout of a port's answer, in seconds; over a good network it takes one round trip."""

SEEK_WITHIN = 3.0
"""Timeout of the search for a host, its name included, in seconds: a robot that just starts is found, too."""

SILENT_WITHIN = 10.0
"""The same where something has accepted the connection, in seconds: a very busy machine takes its time to answer."""

MOST_ADDRESSES = 4
"""Upper bound of the addresses of a name that are tried."""

_PAUSE = 0.1
_HOST = re.compile(r"(tls/)?(?:\[([0-9A-Fa-f:.]+(?:%[\w.-]+)?)\]|([A-Za-z0-9_][A-Za-z0-9._-]*))(?::(\d{1,5}))?")
_BARE_IPV6 = re.compile(r"(tls/)?((?:[0-9A-Fa-f]{0,4}:){2,7}[0-9A-Fa-f.]*(?:%[\w.-]+)?)")


class Host(NamedTuple):
    """A host as it is asked for."""

    name: str
    port: int = 0
    """Port that was asked for; 0 if none was."""
    tls: bool = False

    def endpoint(self, port: int) -> str:
        """Return Zenoh's endpoint of one of its ports.

        >>> Host("fe80::1%eth0", tls=True).endpoint(7447)
        'tls/[fe80::1%eth0]:7447'
        """
        name = f"[{self.name}]" if ":" in self.name else self.name
        return f"{'tls' if self.tls else 'tcp'}/{name}:{port}"

    def ports(self, domain: int) -> tuple[int, ...]:
        """Return the ports to try, the best first: a robolink peer's of this domain, then a router's.

        A peer comes first since its messages go straight, while a router passes each of them on.
        """
        return (self.port,) if self.port else (FIRST_PORT + domain, ROUTER_PORT)


class UnknownHostError(OSError):
    """A name that stands for no address."""


def parse(text: str) -> Host | None:
    """Return the host that `HOST[:PORT]` or `tls/HOST[:PORT]` names; None if it cannot be one.

    >>> parse("robot.local:7447")
    Host(name='robot.local', port=7447, tls=False)
    >>> parse("tls/[::1]"), parse("robot:70000"), parse("./robot")
    (Host(name='::1', port=0, tls=True), None, None)
    """
    if bare := _BARE_IPV6.fullmatch(text):
        return Host(bare[2], 0, bool(bare[1]))
    found = _HOST.fullmatch(text)
    if found is None or int(found[4] or 1) not in range(1, 65536):
        return None
    return Host(found[2] or found[3], int(found[4] or 0), bool(found[1]))


def mistake(text: str) -> str:
    """Return the reason why a text is not HOST[:PORT], where it is known; empty otherwise.

    >>> mistake("http://robot"), mistake("robot:70000"), mistake("tcp/robot")
    ('write HOST:PORT in place of a URL', 'ports are 1 to 65535', 'write tcp/HOST:PORT, or HOST alone')
    """
    if "://" in text:
        return "write HOST:PORT in place of a URL"
    port = re.fullmatch(r".*[^:]:([^:\]]*)", text)
    if port and parse(text[: port.start(1) - 1]):
        return "ports are 1 to 65535"
    if text.startswith("tcp/") and parse(text.removeprefix("tcp/")):
        return "write tcp/HOST:PORT, or HOST alone"
    return ""


def seek(host: Host, domain: int, within: float = SEEK_WITHIN, silent_within: float = SILENT_WITHIN) -> Port | None:
    """Return the port of a host at which a Zenoh session answers, or with TLS anybody; None if nobody listens.

    If something else listens, and goes on so until the end, that port is returned: see `Port.speaks_zenoh`. With TLS
    nothing is sent: what listens can only be known to those whom it lets in.

    Args:
        host: The host.
        domain: ROS domain id.
        within: Longest time that it may take, in seconds.
        silent_within: The same where something listens that has not answered yet; it has more time at each try.

    Raises:
        UnknownHostError: for a name without an address.
    """
    begin = clocks.monotonic()
    deadline, patience = begin + within, ANSWER_WITHIN
    addresses = _addresses(host.name, within)
    ports, other = host.ports(domain), None
    while True:
        for address in addresses:
            left = max(0.05, min(patience, deadline - clocks.monotonic()))
            with contextlib.suppress(OSError):  # a kind of address that this machine has not
                found = listening(ports, left, address, first=ports[0], greet=not host.tls)
                if right := _best(host, found, domain):
                    return right
                other = next(iter(found.values()), other)
                if any(each.role == SILENT for each in found.values()):
                    deadline, patience = max(deadline, begin + silent_within), 2 * patience
        is_other = other is not None and other.role == STRANGER and not other.hung_up
        if clocks.monotonic() + _PAUSE >= deadline or (host.port and is_other):
            return other
        time.sleep(_PAUSE)


def _best(host: Host, found: dict[int, Port], domain: int) -> Port | None:
    ports = [found[number] for number in host.ports(domain) if number in found]
    return next((each for each in ports if each.speaks_zenoh or host.tls), None)


def _addresses(name: str, within: float) -> Sequence[str]:
    """Return the addresses of a name, IPv4 first; on a thread, since a name server may take its time."""
    answers: queue.SimpleQueue[list[str] | OSError] = queue.SimpleQueue()

    def look_up() -> None:
        try:
            found = socket.getaddrinfo(name, None, type=socket.SOCK_STREAM)
        except (OSError, UnicodeError) as error:
            answers.put(UnknownHostError(str(error)))
            return
        found.sort(key=lambda each: each[0] != socket.AF_INET)
        answers.put(list(dict.fromkeys(str(address[0]) for *_, address in found)))

    threading.Thread(target=look_up, name="robolink look-up", daemon=True).start()
    try:
        answer = get_within(answers, within)
    except queue.Empty:
        raise UnknownHostError("the name server does not answer") from None
    if isinstance(answer, OSError):
        raise answer
    return answer[:MOST_ADDRESSES]
