"""robolink network: where this session may listen and go, whom it has found and how, and what the rest would need."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from robolink.cli.doctor.limit import limit
from robolink.system.terminal import shown

if TYPE_CHECKING:
    from robolink.cli.doctor.facts import Facts
    from robolink.transport.reach import Link

app = typer.Typer(no_args_is_help=False)
app.command("limit")(limit)

LONGEST = 600
"""Upper bound of a line's length, in characters."""


@app.callback(invoke_without_command=True)
def network(
    context: typer.Context, as_json: Annotated[bool, typer.Option("--json", help="A JSON object.")] = False
) -> None:
    """Show where this session may listen and go, whom it has found and how, and what the rest would need."""
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
    asked_by: str
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
    """Return what there is to say, from the facts and by the checks of `robolink doctor`."""
    from robolink.cli.doctor import checks
    from robolink.wire import NodeToken

    verdicts = [check(facts) for check in (checks.settings, checks.reach, checks.router, checks.domains)]
    settings, reach = facts.settings, facts.reach
    return Description(
        settings.network,
        settings.asked_by,
        settings.domain,
        str(reach),
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
    asked = f"asked for by {found.asked_by}" if found.asked_by else "the default"
    goes = [*([f"multicast {found.multicast}"] if found.multicast else []), *found.connects]
    sessions = {each["session"] for each in found.links}
    whom = f"{len(sessions)} session{'s' * (len(sessions) != 1)}, {found.nodes} node{'s' * (found.nodes != 1)}"
    result = [
        f"network   {found.network} ({asked}), domain {found.domain}",
        f"meets     {found.meets}",
        f"listens   {', '.join(found.listens) or 'nowhere'}",
        f"goes to   {', '.join(goes) or 'nobody'}",
        f"found     {f'not known: {found.unseen}' if found.unseen else whom}",
    ]
    result += [f"          {each['role']} at {each['address']}: {each['found']}{_named(each)}" for each in found.links]
    result += [f"WARN      {each}" for each in found.warnings]
    return [shown(each, LONGEST) for each in (*result, *(f"FAIL      {each}" for each in found.errors))]


def _named(link: dict[str, Any]) -> str:
    return f", with the certificate of {link['certificate']}" if link["certificate"] else ""
