"""robolink network limit: the limits of slow links that are in force or in a file, and what of them fits no topic."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from robolink.system.terminal import shown

if TYPE_CHECKING:
    from robolink.launch.reading.arguments import Found
    from robolink.networks.limits import Limits

LONGEST = 600
"""Upper bound of a line's length, in characters."""

_MANUAL = "none; docs/reference/networks.md has examples for a launch file, networks.yaml and ROBOLINK_LIMITS"


def limit(
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE]", help="A launch file, or a file of limits, to be checked.")
    ] = None,
    zenoh: Annotated[
        bool, typer.Option("--zenoh", help="Zenoh's settings, for a file of Zenoh's or ZENOH_CONFIG_OVERRIDE.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="A JSON object.")] = False,
) -> None:
    """Show which topics are thinned or go first on slow links, and check the names against what is there."""
    import os

    from robolink.cli.shared.output import say, say_json
    from robolink.networks.asked import domain_id
    from robolink.networks.limits import Limits, beyond_loopback, settings

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
    for line in [*lines(in_force, where), *(f"WARN      {each}" for each in warnings)]:
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

    from robolink.networks.asked import wanted
    from robolink.networks.limits import VARIABLE
    from robolink.transport import network

    limits = network.limits_wanted(wanted(None, os.environ), os.environ)
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


def lines(in_force: InForce, interfaces: list[str] | None) -> list[str]:
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
