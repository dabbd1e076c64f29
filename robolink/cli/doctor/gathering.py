"""Collection of the facts that `robolink doctor` decides from, once, before any check."""

from __future__ import annotations

import functools
import os
import re
import sys
import threading
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, TypeVar

from robolink.cli.doctor import dds
from robolink.cli.doctor.facts import Facts, Seen, Settings
from robolink.cli.doctor.look import count_nodes, look
from robolink.cli.doctor.ports import also_open_at, ascii_only, holder, loopback_works, owner
from robolink.constants import LAST_DOMAIN
from robolink.exceptions import SecurityError, TransportError
from robolink.extensions import ExtensionError, registries
from robolink.extensions.optional import MissingPartError
from robolink.networks.kinds import kind_of
from robolink.networks.port_probe import HOST, STRANGER, Port, listening
from robolink.networks.refusals import wants_keys
from robolink.networks.request import FIRST_PORT, RANGE, ROS_ROUTER, NetworkRequest, domain_id, requested
from robolink.security import session
from robolink.transport import certificates, lifetime, network, shared_memory
from robolink.transport.reach import Reach, answering, reach

if TYPE_CHECKING:
    import zenoh

ANSWER_WITHIN = 0.3
"""Timeout of a port's answer, in seconds; a Zenoh session takes a few milliseconds."""

LOOK_WITHIN = 3.5
"""Timeout of joining the network and listing what is announced, in seconds; usually 0.2."""

MULTICAST_WITHIN = 0.4
"""Timeout of the answers to a multicast, in seconds; usually 0.02, unless somebody is known by gossip alone."""

COUNT_WITHIN = 1.0
"""Timeout of the look at other domains, in seconds; usually 0.1."""

MOST_DOMAINS = 8
"""Upper bound of the other domains that are looked at."""

OPENCV = tuple(f"opencv{contrib}-python{headless}" for contrib in ("", "-contrib") for headless in ("", "-headless"))
"""Distributions that install the module cv2, all in the same folder."""

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


def gather() -> Facts:
    """Collect and return all facts, in well under a second if nothing hangs."""
    settings, config = read_settings(os.environ)
    if settings.transport != "zenoh":
        config = None
    machine, found = shared_memory.this_machine(), Reach() if config is None else reach(config)
    facts = Facts(
        environ={name: shown(value) for name, value in os.environ.items()},
        platform=sys.platform,
        python=tuple(sys.version_info[:3]),
        versions=versions(),
        namesakes=namesakes(),
        extensions=tuple(problem for registry in registries().values() for problem in registry.problems()),
        opencv={name: found for name, found in versions(OPENCV).items() if found},
        settings=settings,
        reach=found,
        loopback=loopback_works(),
        router_port=int(ROS_ROUTER.rpartition(":")[2]),
        machine=machine,
        memory=_memory(settings, machine, found.mode),
    )
    if not settings.errors:
        facts = facts._replace(dds=dds.look(settings.domain))
    if settings.transport == "zenoh":
        facts = _with_ports(facts)
    if config is None:
        return _with_graph(facts)
    return _with_multicast(_with_graph(_with_certificates(facts, config)), config)


def shown(value: str) -> str:
    """Return a variable's value in printable ASCII and without passwords, fit to be shown to others."""
    return re.sub(r"(?i)(password|secret)[^;}]*", r"\1...", ascii_only(value))


def read_settings(environ: Mapping[str, str]) -> tuple[Settings, zenoh.Config | None]:
    """Return the settings in an environment, read as nodes do, and the session's configuration; None if they are wrong.

    What nodes would refuse is in the settings' `errors`. A host that is named is asked what it is, once.
    """
    errors: list[str] = []
    domain = _try(errors, 0, lambda: domain_id(environ))
    origin, value = _try(errors, NetworkRequest("", "localhost"), lambda: requested(None, environ))
    kind = None if errors else _try(errors, None, lambda: kind_of(NetworkRequest(origin, value)))
    whom = "" if kind is None else _try(errors, "", lambda: kind.meets(environ))
    is_zenoh = not errors and kind is None
    found = _try(errors, None, lambda: network.plan(None, domain, environ)) if is_zenoh else None
    config = None if found is None else _try(errors, None, found.config)
    settings = Settings(
        domain=domain,
        network=value,
        origin="" if origin == RANGE and not environ.get(origin) else origin,
        transport=environ.get("ROBOLINK_TRANSPORT") or ("zenoh" if kind is None else value),
        whom=whom,
        meets=network.meets_at_port(value, environ) if found is None else found.meets,
        shared_memory=config is None or config.get_json(network.SHARES_MEMORY) == "true",
        errors=tuple(errors),
    )
    return settings, config


def _try(errors: list[str], otherwise: ResultT, action: Callable[[], ResultT]) -> ResultT:
    try:
        return action()
    except (TransportError, SecurityError, ExtensionError, MissingPartError) as error:
        errors.append(str(error))
        return otherwise


def _memory(settings: Settings, machine: shared_memory.Machine, mode: str) -> shared_memory.Decision:
    """Return the use of shared memory by sessions of this mode with these settings, and the reason."""
    found = shared_memory.decision({} if settings.errors else os.environ, machine, mode)
    if found.on == settings.shared_memory:
        return found
    by = "ZENOH_CONFIG_OVERRIDE or the network's file decides"
    return shared_memory.Decision(settings.shared_memory, by, forced=True)


def versions(names: Iterable[str] = DISTRIBUTIONS) -> dict[str, str]:
    """Return the versions of distributions by name, '' for those that are missing."""
    from importlib.metadata import PackageNotFoundError, version

    found = {}
    for name in names:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = ""
    return found


def namesakes() -> tuple[str, ...]:
    """Return other distributions that install a module `robolink`, as robodk does, by their lists of files."""
    from importlib.metadata import distributions

    theirs = re.compile(r"^robolink(/|\.py\b)", re.MULTILINE)
    return tuple(
        f"{each.metadata['Name']} {each.version}"
        for each in distributions()
        if theirs.search(each.read_text("RECORD") or "") and each.metadata["Name"] != "robolink"
    )


def _with_ports(facts: Facts) -> Facts:
    """Add what listens: on the ports of all domains, the ROS 2 router's, and that of the router in the settings."""
    numbers = [facts.router_port, *(FIRST_PORT + domain for domain in range(LAST_DOMAIN + 1))]
    ports = listening(numbers, ANSWER_WITHIN)
    router = ports.get(facts.router_port)
    meant = [ports[number] for number in (facts.router_port, facts.settings.port) if number in ports]
    return facts._replace(
        ports=ports,
        keyed_ports=frozenset(each.number for each in meant if each.role == STRANGER and wants_keys(HOST, each.number)),
        holders={each.number: holder(each.number) for each in meant},
        router_open_at=also_open_at(router, ANSWER_WITHIN) if router and router.speaks_zenoh else (),
        router_owner=owner(facts.router_port) if router else "",
        far_router=_far_router(facts.settings.network),
    )


def _with_certificates(facts: Facts, config: zenoh.Config) -> Facts:
    """Add the problems of the settings' certificates, and of the keystore's files."""
    errors = [*(certificates.faults(config) or certificates.refusals(config))]
    doubts = [] if errors else certificates.doubts(config)
    security = _try(errors, None, lambda: session.requested(os.environ, facts.settings.domain))
    return facts._replace(
        certificate_errors=tuple(errors),
        certificate_warnings=(*doubts, *(security.warnings if security else ())),
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
    """Add the look at the running system, and the number of nodes of other domains."""
    why_not = _why_not_to_look(facts)
    if why_not:
        return facts._replace(seen=Seen(error=why_not))
    domain, transport = facts.settings.domain, "zenoh" if facts.settings.whom else facts.settings.transport
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


def _with_multicast(facts: Facts, config: zenoh.Config) -> Facts:
    """Add who answers a multicast, if this network uses it and anybody is linked."""
    sought = {each.session for each in facts.seen.links}
    if not facts.reach.multicast or not sought:
        return facts

    return facts._replace(by_multicast=answering(config, sought, MULTICAST_WITHIN))


def _other_domains(facts: Facts) -> list[int]:
    """Return the domains whose rendezvous port a Zenoh session holds."""
    domains = (number - FIRST_PORT for number, port in facts.ports.items() if port.speaks_zenoh)
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
        if port.number not in facts.keyed_ports:
            return f"port {port.number} is taken by a stranger"
        if not facts.reach.secured:
            return f"port {port.number} is taken by a process with security"
    if settings.network.startswith("tcp/") and (facts.far_router is None or not facts.far_router.speaks_zenoh):
        return f"no router answers at {settings.network}"
    return ""


def _within(seconds: float, *works: Callable[[], object]) -> None:
    """Run all `works` at the same time, and wait `seconds` at most; what is late goes on in the background."""

    def all_of_it() -> None:
        threads = [threading.Thread(target=work, daemon=True) for work in works]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    lifetime.finish(all_of_it, seconds)
