"""What `robolink doctor` looks at: the facts, gathered once, from which every check decides."""

from __future__ import annotations

import functools
import os
import re
import sys
import threading
from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeVar

from robolink.cli.doctor.probes import Holder, Port, also_open_at, holder, listening, loopback_works, owner
from robolink.context import LAST_DOMAIN
from robolink.exceptions import TransportError
from robolink.transport import certificates, lifetime, network
from robolink.transport.reach import Link, Reach, reach
from robolink.wire import EndpointToken, NodeToken

ANSWER_WITHIN = 0.3
"""Seconds that a port has to answer; what speaks Zenoh takes a few milliseconds."""

LOOK_WITHIN = 3.5
"""Seconds that joining a network and looking around may take; usually 0.2."""

COUNT_WITHIN = 1.0
"""Seconds that looking into the other domains may take; usually 0.1."""

MOST_DOMAINS = 8
"""So many other domains are looked into."""

DISTRIBUTIONS = (
    "robolink",
    "eclipse-zenoh",
    "msgspec",
    "numpy",
    "typer",
    "PyYAML",
    "xxhash",
    "pymunk",
    "psutil",
    "rich",
)

ResultT = TypeVar("ResultT")


class Settings(NamedTuple):
    """What the environment asks for."""

    domain: int = 0
    network: str = "localhost"
    """One of `network.NAMES`, the endpoint of a router, or the path of a file."""
    asked_by: str = ""
    """The variable that asks for this network; empty for the default."""
    transport: str = "zenoh"
    meets: bool = True
    """Whether processes find each other at the rendezvous port."""
    shared_memory: bool = True
    errors: tuple[str, ...] = ()
    """What keeps nodes from starting at all."""

    @property
    def port(self) -> int:
        """The rendezvous port."""
        return network.FIRST_PORT + self.domain


class ClockOffset(NamedTuple):
    """How far the clock of another process is ahead of this one's."""

    node: str
    seconds: float
    uncertainty: float
    """Half of the time that the answer took."""


class Seen(NamedTuple):
    """What a look at the running system showed."""

    session: str = ""
    tokens: tuple[NodeToken | EndpointToken, ...] = ()
    malformed: tuple[str, ...] = ()
    other_domains: Mapping[int, int] = {}
    """Number of nodes on each domain but the own one, as far as they are visible from it."""
    clocks: tuple[ClockOffset, ...] = ()
    links: tuple[Link, ...] = ()
    """The connections to other sessions."""
    error: str = ""
    """Why nothing could be looked at."""


class Space(NamedTuple):
    """Bytes of /dev/shm."""

    total: int
    free: int


class Facts(NamedTuple):
    """All that the checks and the report know."""

    environ: Mapping[str, str] = {}
    platform: str = "linux"
    python: tuple[int, ...] = (3, 10)
    versions: Mapping[str, str] = {}
    """Distribution to version; empty for what is not installed."""
    namesakes: tuple[str, ...] = ()
    """Other distributions, with their versions, that install a module `robolink`."""
    settings: Settings = Settings()
    reach: Reach = Reach()
    """Whom a session with these settings can meet."""
    certificate_errors: tuple[str, ...] = ()
    """What is wrong with the settings' certificates, and why others refuse them."""
    certificate_warnings: tuple[str, ...] = ()
    loopback: bool = True
    router_port: int = 7447
    """Where a ROS 2 router listens."""
    ports: Mapping[int, Port] = {}
    """What listens on this machine, of the ports that matter here."""
    holders: Mapping[int, Holder | None] = {}
    """Whose they are, where that can be found out."""
    router_open_at: tuple[str, ...] = ()
    """Addresses at which other machines reach the router on this one."""
    router_owner: str = ""
    """The user whose it is, if that is somebody else and not root."""
    far_router: Port | None = None
    """The router that the settings name, if it listens."""
    other_domains: Mapping[int, int | None] = {}
    """Number of nodes on each other domain in use; None where that could not be counted."""
    seen: Seen = Seen()
    shared_memory: Space | None = None
    """None where there is no /dev/shm."""


def gather() -> Facts:
    """Find out everything, in well under a second where nothing hangs."""
    settings = read_settings(os.environ)
    facts = Facts(
        environ={name: shown(value) for name, value in os.environ.items()},
        platform=sys.platform,
        python=tuple(sys.version_info[:3]),
        versions=versions(),
        namesakes=namesakes(),
        settings=settings,
        reach=_reach(settings),
        loopback=loopback_works(),
        router_port=int(network.ROS_ROUTER.rpartition(":")[2]),
        shared_memory=shared_memory(),
    )
    if settings.transport == "zenoh":
        facts = _with_certificates(_with_ports(facts))
    return _with_graph(facts)


def shown(value: str) -> str:
    """Give the value of a variable as one may show it to others: readable, and without passwords."""
    text = "".join(each if each.isascii() and each.isprintable() else "?" for each in value)
    return re.sub(r"(?i)(password|secret)[^;}]*", r"\1...", text)


def read_settings(environ: Mapping[str, str]) -> Settings:
    """Read what the environment asks for, as nodes do; what they would refuse is in `errors`."""
    errors: list[str] = []
    domain = _try(errors, 0, lambda: network.domain_id(environ))
    asked_by, value = _try(errors, network.Wanted("", "localhost"), lambda: network.wanted(None, environ))
    shared = _try(errors, True, lambda: _shares_memory(domain, environ)) if not errors else True
    return Settings(
        domain=domain,
        network=value,
        asked_by=asked_by if environ.get(asked_by) else "",
        transport=environ.get("ROBOLINK_TRANSPORT") or "zenoh",
        meets=network.meets_at_port(value, environ),
        shared_memory=shared,
        errors=tuple(errors),
    )


def _try(errors: list[str], otherwise: ResultT, action: Callable[[], ResultT]) -> ResultT:
    try:
        return action()
    except TransportError as error:
        errors.append(str(error))
        return otherwise


def _shares_memory(domain: int, environ: Mapping[str, str]) -> bool:
    config = network.load(None, domain, environ)
    return bool(config.get_json("transport/shared_memory/enabled") == "true")


def _reach(settings: Settings) -> Reach:
    if settings.errors or settings.transport != "zenoh":
        return Reach()
    return reach(network.load(None, settings.domain, os.environ))


def versions() -> dict[str, str]:
    """Give the versions of what robolink is made of."""
    from importlib.metadata import PackageNotFoundError, version

    found = {}
    for name in DISTRIBUTIONS:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = ""
    return found


def namesakes() -> tuple[str, ...]:
    """Find other distributions that install a module `robolink`, as robodk does, by what they list as theirs."""
    from importlib.metadata import distributions

    theirs = re.compile(r"^robolink(/|\.py\b)", re.MULTILINE)
    return tuple(
        f"{each.metadata['Name']} {each.version}"
        for each in distributions()
        if theirs.search(each.read_text("RECORD") or "") and each.metadata["Name"] != "robolink"
    )


def shared_memory(folder: str = "/dev/shm") -> Space | None:
    """Give the space that shared memory has; None where it is not a folder of its own, as on Windows and macOS."""
    if not hasattr(os, "statvfs"):
        return None
    try:
        found = os.statvfs(folder)
    except OSError:
        return None
    return Space(found.f_blocks * found.f_frsize, found.f_bavail * found.f_frsize)


def _with_ports(facts: Facts) -> Facts:
    """Add who listens: on the ports of all domains, the ROS 2 router's, and the router that is asked for."""
    numbers = [facts.router_port, *(network.FIRST_PORT + domain for domain in range(LAST_DOMAIN + 1))]
    ports = listening(numbers, ANSWER_WITHIN)
    router = ports.get(facts.router_port)
    return facts._replace(
        ports=ports,
        holders={number: holder(number) for number in ports if number in (facts.router_port, facts.settings.port)},
        router_open_at=also_open_at(router, ANSWER_WITHIN) if router and router.speaks_zenoh else (),
        router_owner=owner(facts.router_port) if router else "",
        far_router=_far_router(facts.settings.network),
    )


def _with_certificates(facts: Facts) -> Facts:
    """Add what keeps a session with these settings out where TLS is used."""
    if facts.settings.errors:
        return facts
    config = network.load(None, facts.settings.domain, os.environ)
    errors = certificates.faults(config) or certificates.refusals(config)
    return facts._replace(
        certificate_errors=tuple(errors), certificate_warnings=tuple(certificates.doubts(config) if not errors else ())
    )


def _far_router(endpoint: str) -> Port | None:
    protocol, _, address = endpoint.partition("/")
    host, _, number = address.rpartition(":")
    if protocol != "tcp" or not number.isdigit():
        return None
    found: list[Port] = []

    def ask() -> None:
        try:
            found.extend(listening([int(number)], ANSWER_WITHIN, host.strip("[]")).values())
        except (OSError, OverflowError):  # no such host, no such port
            return

    _within(2 * ANSWER_WITHIN, ask)
    return found[0] if found else None


def _with_graph(facts: Facts) -> Facts:
    """Add what the running system shows, and how many nodes the other domains have."""
    from robolink.cli.doctor.look import count_nodes, look

    why_not = _why_not_to_look(facts)
    if why_not:
        return facts._replace(seen=Seen(error=why_not))
    domain, transport = facts.settings.domain, facts.settings.transport
    seen: list[Seen] = []
    others: dict[int, int | None] = dict.fromkeys(_other_domains(facts))

    def look_at(other: int) -> None:
        others[other] = count_nodes(other)

    counts = [functools.partial(look_at, each) for each in list(others)[:MOST_DOMAINS]]
    _within(LOOK_WITHIN, lambda: seen.append(look(transport, domain)))  # first, and alone: the rest delays its news
    _within(COUNT_WITHIN, *counts)
    if not seen:
        return facts._replace(seen=Seen(error=f"joining the network took more than {LOOK_WITHIN:g} s"))
    for each, count in seen[0].other_domains.items():
        others[each] = max(count, others.get(each) or 0)
    return facts._replace(seen=seen[0], other_domains=others)


def _other_domains(facts: Facts) -> list[int]:
    """The domains at whose rendezvous port somebody answers."""
    domains = (number - network.FIRST_PORT for number, port in facts.ports.items() if port.speaks_zenoh)
    return sorted(each for each in domains if 0 <= each <= LAST_DOMAIN and each != facts.settings.domain)


def _why_not_to_look(facts: Facts) -> str:
    settings = facts.settings
    if settings.errors:
        return "the settings are wrong"
    if settings.transport != "zenoh":
        return ""
    if not facts.loopback and settings.meets:
        return "this machine cannot connect to itself"
    port = facts.ports.get(settings.port)
    if settings.meets and port is not None and not port.speaks_zenoh:
        return f"port {port.number} is taken by a stranger"
    if settings.network.startswith("tcp/") and (facts.far_router is None or not facts.far_router.speaks_zenoh):
        return f"no router answers at {settings.network}"
    return ""


def _within(seconds: float, *works: Callable[[], object]) -> None:
    """Do all of this at the same time, but wait no longer; what is late goes on in the background."""

    def all_of_it() -> None:
        threads = [threading.Thread(target=work, daemon=True) for work in works]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    lifetime.finish(all_of_it, seconds)
