"""robolink network: whom this session may meet and has found; and `network limit`, the limits of slow links."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from robolink.system.terminal import shown

if TYPE_CHECKING:
    from robolink.cli.doctor.facts import Facts
    from robolink.launch.reading.arguments import Found
    from robolink.networks.limits import Limits
    from robolink.transport.reach import Link


app = typer.Typer(no_args_is_help=False)

LONGEST = 600
"""Upper bound of a line's length, in characters."""


@app.callback(invoke_without_command=True)
def network(
    context: typer.Context, as_json: Annotated[bool, typer.Option("--json", help="Print a JSON object.")] = False
) -> None:
    """Show where this session listens and connects, which sessions it has discovered and how, and what is missing."""
    if context.invoked_subcommand is not None:
        return
    from robolink.cli.doctor.gathering import gather
    from robolink.cli.shared.output import say, say_json

    found = describe(gather())
    if as_json:
        say_json(found._asdict())
    else:
        for line in lines(found):
            say(line)
    if found.errors:
        raise typer.Exit(1)


class Description(NamedTuple):
    """Description of a session's network; the fields are those of `--json`."""

    network: str
    origin: str
    domain: int
    meets: str
    listens: list[str]
    connects: list[str]
    multicast: str
    links: list[dict[str, Any]]
    nodes: int
    unseen: str
    """Reason why the system could not be looked at; empty if it could."""
    errors: list[str]
    warnings: list[str]


def describe(facts: Facts) -> Description:
    """Return the description of the network, from the facts and by the checks of `robolink doctor`."""
    from robolink.cli.doctor import checks
    from robolink.wire import NodeToken

    verdicts = [check(facts) for check in (checks.settings, checks.reach, checks.router, checks.domains)]
    settings, reach = facts.settings, facts.reach
    return Description(
        settings.network,
        settings.origin,
        settings.domain,
        settings.whom or str(reach),
        [*reach.listens],
        [*reach.connects],
        reach.multicast,
        [
            {
                "role": each.role,
                "address": each.there,
                "session": each.session,
                "found": how(each, facts),
                "certificate": each.certificate,
            }
            for each in facts.seen.links
        ],
        sum(isinstance(each, NodeToken) for each in facts.seen.tokens),
        facts.seen.error,
        [text for each in verdicts for text in each.errors],
        [text for each in verdicts for text in each.warnings],
    )


def how(link: Link, facts: Facts) -> str:
    """Return how a session was found: by its address, at the domain's port, by a router, by multicast or gossip."""
    from robolink.networks.port_probe import ROUTER
    from robolink.transport.reach import port_of

    if link.there in facts.reach.connects:
        return "the router on this machine" if link.role == ROUTER and not link.leaves_machine else "by its address"
    if facts.reach.mode == "client":
        return "by its name or address"
    if link.role == ROUTER:
        return "a router that connected"
    if port_of(link.there) == facts.settings.port or port_of(link.here) == facts.settings.port:
        known = "multicast" if link.session in facts.by_multicast else "its address"
        return f"the domain's port, by {known}" if link.leaves_machine else "the domain's port"
    if not link.leaves_machine:
        return "gossip on this machine"
    if link.session in facts.by_multicast:
        return "multicast"
    return "gossip, for it does not answer a multicast" if facts.reach.multicast else "gossip"


def lines(found: Description) -> list[str]:
    """Return the description as lines for people."""
    from robolink.networks.kinds import kind_of
    from robolink.networks.request import NetworkRequest

    requested = f"asked for by {found.origin}" if found.origin else "the default"
    goes = [*([f"multicast {found.multicast}"] if found.multicast else []), *found.connects]
    sessions = {each["session"] for each in found.links}
    whom = f"{found.nodes} node{'s' * (found.nodes != 1)}"
    result = [
        f"network   {found.network} ({requested}), domain {found.domain}",
        f"meets     {found.meets}",
    ]
    if kind_of(NetworkRequest(found.origin, found.network)) is None:  # the others have no such addresses and links
        whom = f"{len(sessions)} session{'s' * (len(sessions) != 1)}, {whom}"
        result += [
            f"listens   {', '.join(found.listens) or 'nowhere'}",
            f"goes to   {', '.join(goes) or 'nobody'}",
        ]
    result.append(f"found     {f'not known: {found.unseen}' if found.unseen else whom}")
    result += [f"          {each['role']} at {each['address']}: {each['found']}{_named(each)}" for each in found.links]
    result += [f"WARN      {each}" for each in found.warnings]
    return [shown(each, LONGEST) for each in (*result, *(f"FAIL      {each}" for each in found.errors))]


def _named(link: dict[str, Any]) -> str:
    return f", with the certificate of {link['certificate']}" if link["certificate"] else ""


_MANUAL = "none; docs/reference/networks.md has examples for a launch file, networks.yaml and ROBOLINK_LIMITS"


@app.command()
def limit(
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE]", help="Launch file, or file of limits, to check.")
    ] = None,
    zenoh: Annotated[
        bool, typer.Option("--zenoh", help="Print the configuration for Zenoh, for a file or ZENOH_CONFIG_OVERRIDE.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON object.")] = False,
) -> None:
    """Show which topics have lower rates or priority on slow links, and check their names against the graph."""
    import os

    from robolink.cli.shared.output import say, say_json
    from robolink.networks.limits import Limits, beyond_loopback, settings
    from robolink.networks.request import domain_id

    in_force = _of_file(file) if file else _in_force()
    limits = in_force.limits or Limits()
    if zenoh:
        say_json(_nested(settings(limits, domain_id(os.environ), beyond_loopback()) if in_force.limits else {}))
        return
    here = beyond_loopback()
    warnings = [*unknown(in_force, _names_there()), *absent(in_force, here)]
    where = limits.interfaces or here
    if as_json:
        say_json({"source": in_force.source, "limits": in_force.limits, "interfaces": where, "warnings": warnings})
        return
    for line in [*limit_lines(in_force, where), *(f"WARN      {each}" for each in warnings)]:
        say(shown(line, LONGEST))


class InForce(NamedTuple):
    """Limits with what they are from: a file or a variable."""

    source: str
    limits: Limits | None
    found: Found | None = None


def _of_file(path: Path) -> InForce:
    from robolink.launch.reading.arguments import limits_of

    found = limits_of(path)
    return InForce(str(path), found.limits, found)


def _in_force() -> InForce:
    import os

    from robolink.networks.limits import VARIABLE
    from robolink.networks.request import requested
    from robolink.transport import network

    limits = network.limits_for(requested(None, os.environ), os.environ)
    return InForce(VARIABLE if os.environ.get(VARIABLE) else "networks.yaml" if limits else "", limits)


def _names_there() -> frozenset[str]:
    """Return the names of all topics and services of the running system."""
    from robolink.cli.doctor.gathering import gather
    from robolink.wire import EndpointToken

    return frozenset(each.name for each in gather().seen.tokens if isinstance(each, EndpointToken))


def unknown(in_force: InForce, names: Iterable[str]) -> list[str]:
    """Return a warning for each name or pattern that fits none of these topics; none if there are no topics."""
    from robolink.exceptions import nearest
    from robolink.security.patterns import fits

    there = sorted(names)
    warnings = []
    for steps, name in in_force.limits.topics if in_force.limits and there else ():
        if not any(fits(name, each) for each in there):
            text = f"no topic or service '{name}' is there now{nearest(name, there)}"
            warnings.append(
                str(in_force.found.error(steps, text)) if in_force.found else f"{in_force.source}: {steps[0]}: {text}"
            )
    return warnings


def absent(in_force: InForce, there: list[str] | None) -> list[str]:
    """Return a warning for each named interface that this machine has not now: there nothing is limited.

    Args:
        in_force: What is asked for, and where.
        there: Network interfaces of this machine but loopback; None where they cannot be known.
    """
    from robolink.exceptions import nearest

    warnings = []
    named = (in_force.limits.interfaces if in_force.limits else None) or ()
    for at, name in enumerate(named if there else ()):
        if there and name not in there:
            text = f"no interface '{name}' is here now{nearest(name, there)}, but {', '.join(there)}"
            steps = ("interfaces", at)
            warnings.append(
                str(in_force.found.error(steps, text)) if in_force.found else f"{in_force.source}: interfaces: {text}"
            )
    return warnings


def limit_lines(in_force: InForce, interfaces: list[str] | None) -> list[str]:
    """Return the limits as lines for people.

    Args:
        in_force: What is asked for, and where.
        interfaces: Network interfaces to which they apply; None for all.
    """
    from robolink.networks.limits import CLOCK

    if in_force.limits is None:
        return [f"limits    {_MANUAL}"]
    limits = in_force.limits
    result = [
        f"limits    {in_force.source}",
        f"at        {', '.join(interfaces) if interfaces else 'all interfaces'}",
        f"first     {', '.join(dict.fromkeys([*limits.control, CLOCK]))}",
        *(f"rate      {name}: {rate:g} a second" for name, rate in limits.rate.items()),
        *(f"size      {name}: {size:,} bytes" for name, size in limits.size.items()),
    ]
    return [*result, *([f"buffer    {limits.buffer:,} bytes"] if limits.buffer else [])]


def _nested(settings: dict[str, Any]) -> dict[str, Any]:
    """Return settings by path as the tree that a file of Zenoh's has."""
    tree: dict[str, Any] = {}
    for path, value in settings.items():
        *above, name = path.split("/")
        at = tree
        for each in above:
            at = at.setdefault(each, {})
        at[name] = value
    return tree
