"""Facts about this machine and its network, and verdicts on them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from robolink.cli.doctor.dds import Dds
from robolink.cli.doctor.ports import Holder
from robolink.networks.port_probe import Port
from robolink.networks.request import FIRST_PORT
from robolink.system.terminal import shown
from robolink.transport import shared_memory
from robolink.transport.reach import Link, Reach
from robolink.wire import BridgeToken, EndpointToken, NodeToken


class Settings(NamedTuple):
    """Settings that the environment asks for."""

    domain: int = 0
    network: str = "localhost"
    """Network as it was asked for: see `robolink.networks.request.NetworkRequest`."""
    origin: str = ""
    """Environment variable that asks for this network; empty for the default."""
    transport: str = "zenoh"
    """`zenoh`, the name of a network of another kind, or what ROBOLINK_TRANSPORT says."""
    whom: str = ""
    """Whom a session meets on a network of another kind than Zenoh's, in words; empty for Zenoh."""
    meets: bool = True
    """True if processes find each other at the rendezvous port."""
    shared_memory: bool = True
    """True if sessions use shared memory for large messages."""
    errors: tuple[str, ...] = ()
    """Errors in the settings, with which no node starts."""

    @property
    def port(self) -> int:
        """Rendezvous port of the domain."""
        return FIRST_PORT + self.domain


class ClockOffset(NamedTuple):
    """Offset of another process's clock: how far it is ahead of this one's."""

    node: str
    seconds: float
    uncertainty: float
    """Half of the round trip, in seconds."""


class Seen(NamedTuple):
    """Result of a look at the running system."""

    session: str = ""
    tokens: tuple[NodeToken | EndpointToken, ...] = ()
    malformed: tuple[str, ...] = ()
    other_domains: Mapping[int, int] = {}
    """Number of nodes on each domain but the own one, as far as they are visible from it."""
    clocks: tuple[ClockOffset, ...] = ()
    links: tuple[Link, ...] = ()
    """Connections to other sessions."""
    bridges: tuple[BridgeToken, ...] = ()
    """Bridges to other networks, such as DDS."""
    stopped: bool = False
    """True if STOP holds."""
    error: str = ""
    """Reason why the system could not be looked at; empty if it could."""


class Facts(NamedTuple):
    """All facts that the checks and the report are made from."""

    environ: Mapping[str, str] = {}
    platform: str = "linux"
    python: tuple[int, ...] = (3, 10)
    versions: Mapping[str, str] = {}
    """Versions of the distributions, by name; empty if not installed."""
    namesakes: tuple[str, ...] = ()
    """Other distributions, with their versions, that install a module `robolink`."""
    extensions: tuple[str, ...] = ()
    """Problems with what other packages add to robolink, one line each."""
    opencv: Mapping[str, str] = {}
    """Versions of the distributions that install the module cv2, by name."""
    settings: Settings = Settings()
    reach: Reach = Reach()
    """Range of a session with these settings: which others it can meet."""
    certificate_errors: tuple[str, ...] = ()
    """Errors of the settings' certificates, and reasons why others refuse them."""
    certificate_warnings: tuple[str, ...] = ()
    loopback: bool = True
    router_port: int = 7447
    """Port of a ROS 2 router."""
    ports: Mapping[int, Port] = {}
    """Ports of this machine that something listens on, of those that were probed."""
    keyed_ports: frozenset[int] = frozenset()
    """Of the router's port and the domain's, those that ask for a certificate: of processes with security."""
    holders: Mapping[int, Holder | None] = {}
    """Processes that hold the ports; None if unknown."""
    router_open_at: tuple[str, ...] = ()
    """Addresses at which other machines reach the router on this one."""
    router_owner: str = ""
    """User whose the router is, if that is neither this one nor root; else empty."""
    far_router: Port | None = None
    """Port of the router that the settings name, if it listens."""
    other_domains: Mapping[int, int | None] = {}
    """Number of nodes on each other domain in use; None if they could not be counted."""
    seen: Seen = Seen()
    dds: Dds = Dds()
    """Processes that speak DDS on this machine."""
    by_multicast: frozenset[str] = frozenset()
    """Ids of the sessions that answer a multicast, as far as that is used."""
    machine: shared_memory.Machine = shared_memory.Machine()
    """Limits that decide whether shared memory is used."""
    memory: shared_memory.Decision = shared_memory.Decision(False, "not looked at")
    """Use of shared memory: by these limits, or by the settings."""


OK, WARNING, ERROR, UNKNOWN = "ok", "warning", "error", "unknown"

MOST_SHOWN = 8
"""Upper bound of the findings of a check that are listed; the rest is counted."""

LONGEST = 400
"""Upper bound of a finding's length, in characters: names on the network can be of any length."""


class Verdict(NamedTuple):
    """Outcome of a check."""

    summary: str
    """Summary that is shown if nothing is wrong."""
    errors: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    unknown: bool = False
    """True if the check could not be made."""

    @property
    def level(self) -> str:
        """OK, WARNING, ERROR or UNKNOWN."""
        return ERROR if self.errors else WARNING if self.warnings else UNKNOWN if self.unknown else OK

    @property
    def findings(self) -> list[str]:
        """Errors and warnings, the worst first, shortened if there are many."""
        found = [shown(each, LONGEST) for each in (*self.errors, *self.warnings)]
        rest = len(found) - MOST_SHOWN
        return [*found[:MOST_SHOWN], f"and {rest} more"] if rest > 0 else found


class Check(NamedTuple):
    """A check: its name, and the function that decides it from the facts."""

    name: str
    module: str
    """Name in the line `Failed modules:`, in ros2 doctor's words."""
    decide: Callable[[Facts], Verdict]


def count(number: int, noun: str) -> str:
    """Return ``1 node`` or ``3 nodes``.

    >>> count(2, "node")
    '2 nodes'
    """
    return f"{number} {noun if number == 1 else noun + 's'}"


def listed(names: Iterable[str], most: int = 4) -> str:
    """Return names as text, sorted, each once, and `most` of them at most.

    >>> listed(["/b", "/a"])
    '/a and /b'
    """
    found = sorted(set(names))
    shown = [*found[:most], f"{len(found) - most} more"] if len(found) > most else found
    return " and ".join(filter(None, (", ".join(shown[:-1]), shown[-1]))) if shown else ""
