"""The network `dds`: a session on DDS as the environment requests it, by ROS 2's own variables.

Nothing leaves the machine by default. Where ROS_AUTOMATIC_DISCOVERY_RANGE says SUBNET, or ROS_STATIC_PEERS names
machines, one interface beside loopback is used: that of ROBOLINK_DDS_INTERFACE, else the one that leads there. An
interface alone means SUBNET.
"""

from __future__ import annotations

import socket
from collections.abc import Mapping

from robolink.dds.transport import DdsTransport
from robolink.exceptions import SecurityError, TransportError
from robolink.networks.kinds import Kind
from robolink.networks.request import RANGE, checked_domain
from robolink.rtps import Participant, Range, Reach
from robolink.rtps.reach import LOOPBACK, SEARCHED, ports

STATIC_PEERS = "ROS_STATIC_PEERS"
"""ROS 2's variable with the machines to look for, `HOST;HOST`."""

INTERFACE = "ROBOLINK_DDS_INTERFACE"
"""Variable with the name or address of the interface that is used beside loopback."""

UNSECURED = "ROBOLINK_DDS_UNSECURED"
"""Variable by which a user of security has DDS nevertheless: 1."""

_GROUP = "239.255.0.1"
_ANY_PORT = 9
_LAST_PORT = 0xFFFF
_LOCAL = ("", "SYSTEM_DEFAULT", "LOCALHOST")


def open_session(
    domain: int, environ: Mapping[str, str], enclave: str | None = None, *, mark: bytes = b""
) -> DdsTransport:
    """Open a session on DDS.

    Args:
        domain: ROS domain id.
        environ: Environment.
        enclave: Enclave that others are told; None is /.
        mark: What the participant's user data has beside that: a bridge's mark.

    Raises:
        TransportError: if settings are wrong, or the domain cannot be joined.
        SecurityError: where security is on, unless ROBOLINK_DDS_UNSECURED is 1.
    """
    checked_domain(domain)
    refuse_security(environ)
    reach = reach_of(environ)

    def join(number: int, *, user_data: bytes, **options: object) -> Participant:
        announced = user_data.rstrip(b"\0") + mark + b"\0" if mark else user_data
        return Participant(number, reach=reach, user_data=announced, **options)  # type: ignore[arg-type]

    is_alone = reach.range is Range.OFF
    return DdsTransport(join, domain, enclave or "/", (lambda: 1) if is_alone else lambda: count_here(domain))


def count_here(domain: int) -> int:
    """Return the number of participants that hold a port on this machine, of those that are looked for."""
    return sum(map(_is_taken, (ports(domain, index)[0] for index in range(SEARCHED))))


def _is_taken(port: int) -> bool:
    if port > _LAST_PORT:
        return False
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind((LOOPBACK, port))
        except OSError:
            return True
    return False


def refuse_security(environ: Mapping[str, str]) -> None:
    """Raise SecurityError where security is on: whoever is on DDS would get past the rights of the enclaves."""
    if environ.get("ROS_SECURITY_ENABLE", "false") in ("", "false") or environ.get(UNSECURED) == "1":
        return
    raise SecurityError(
        "ROS_SECURITY_ENABLE is true, and robolink has no security on DDS: set it to false to go there, or"
        f" {UNSECURED}=1 to go there although keys are used elsewhere"
    )


def reach_of(environ: Mapping[str, str]) -> Reach:
    """Return how far a participant reaches; raises TransportError for variables that are wrong."""
    text = environ.get(RANGE, "").upper()
    if text not in (*_LOCAL, "OFF", "SUBNET"):
        raise TransportError(
            f"{RANGE} must be one of SYSTEM_DEFAULT, LOCALHOST, SUBNET, OFF, got {environ[RANGE][:40]!r}"
        )
    if text == "OFF":
        return Reach(range=Range.OFF)
    peers = tuple(filter(None, (each.strip() for each in environ.get(STATIC_PEERS, "").split(";"))))
    interface = environ.get(INTERFACE, "").strip()
    wide = text == "SUBNET" or bool(interface and text != "LOCALHOST")  # who names one wants to be met there
    if not (wide or peers):
        return Reach(interface, range=Range.LOCALHOST)
    if not interface:
        interface = (_way_to(_GROUP) or _only_interface()) if wide else _way_to(peers[0])
    return Reach(interface, peers, Range.SUBNET if wide else Range.LOCALHOST)


def _only_interface() -> str:
    """Return the address of the one interface beside loopback: a cable to a robot has no route for multicast."""
    import psutil  # here: it takes 20 ms

    up = {name for name, stats in psutil.net_if_stats().items() if stats.isup}
    found = [
        each.address
        for name, addresses in psutil.net_if_addrs().items()
        for each in addresses
        if name in up and each.family == socket.AF_INET and not each.address.startswith("127.")
    ]
    return found[0] if len(found) == 1 else ""


def _way_to(address: str) -> str:
    """Return the address of the interface by which another is reached; "" for this machine, or if none is."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect((address, _ANY_PORT))  # nothing is sent: UDP only looks up the way
            found = str(probe.getsockname()[0])
        except OSError:
            return ""
    return "" if found.startswith("127.") else found


def meets(environ: Mapping[str, str]) -> str:
    """Return in words whom a session meets; raises what `open_session` does for settings."""
    refuse_security(environ)
    reach = reach_of(environ)
    if reach.range is Range.OFF:
        return "no other process"
    whom = ["nodes of ROS 2 over DDS on this machine"]
    if reach.interface and reach.range is Range.SUBNET:
        whom.append(f"those that multicast reaches on {reach.interface}")
    if reach.interface and reach.peers:
        whom.append(f"those at {', '.join(reach.peers)}")
    return " and ".join(whom) if len(whom) > 1 else f"{whom[0]} only"


NETWORK = Kind(open_session, meets)
"""The network `dds`."""
