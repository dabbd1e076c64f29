"""robolink router: lets machines meet that cannot reach each other directly, ROS 2 nodes included."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli.shared.output import say

if TYPE_CHECKING:
    from robolink.transport.reach import Link

LOOK_EVERY = 0.5
"""Interval at which who has come and gone is looked at, in seconds."""

LINKED_AFTER = 6
"""Number of looks after which the routers that it connects to should be there."""

app = typer.Typer()


@app.command("router")
def router(
    listen: Annotated[
        list[str] | None,
        typer.Option(
            "--listen",
            metavar="ADDRESS",
            help="Address to listen on: localhost (default), lan, HOST[:PORT] or tls/HOST[:PORT].",
        ),
    ] = None,
    connect: Annotated[
        list[str] | None,
        typer.Option("--connect", metavar="ROUTER", help="Router to connect to, HOST[:PORT]."),
    ] = None,
) -> None:
    """Run a Zenoh router until Ctrl-C. Nodes of this machine use it automatically, others with --network HOST.

    It listens on this machine only, unless --listen says more: --listen lan opens it to everybody who reaches its port.
    Both options may be there several times.
    """
    from robolink.networks.router import endpoint_of, target_of
    from robolink.transport.router import running

    # Not all interfaces, as ROS 2's: nodes that are confined to loopback would hear whoever reaches the router.
    here = [endpoint_of(each, "--listen") for each in listen or ["localhost"]]
    there = [target_of(each) for each in connect or []]
    try:
        with running(here, there) as it:
            say("\n".join(opening(it.listens, it.connects, it.enclave)))
            report(it.links, say, faults=it.faults, follow=it.follow)
    except KeyboardInterrupt:
        say("the router has ended")


def opening(listens: Sequence[str], connects: Sequence[str], enclave: str = "") -> list[str]:
    """Return the first lines of a router: where it listens, and who can reach it there.

    Args:
        listens: Endpoints on which it listens.
        connects: Endpoints to which it connects.
        enclave: Its enclave; '' without security, where nobody needs keys.
    """
    from robolink.transport.reach import on_this_machine

    far = [each for each in listens if not on_this_machine(each)]
    lines = [f"robolink router: listens at {', '.join(listens)}; Ctrl-C ends it"]
    if enclave:
        lines.append(f"only enclaves of the keystore of '{enclave}' get in, with their rights (docs/why/security.md)")
    elif far:
        lines.append("whoever reaches it there may hear and command all nodes behind it (docs/reference/networks.md)")
    if not far:
        lines.append("only this machine reaches it; --listen lan opens it to others")
    return [*lines, *(f"connects to {each}" for each in connects)]


def report(
    links: Callable[[], Iterable[Link]],
    say: Callable[[str], object],
    pause: Callable[[float], object] = time.sleep,
    faults: Callable[[], Iterable[str]] = tuple,
    follow: Callable[[], object] = tuple,
) -> None:
    """Report who has come and who has gone, for ever.

    Args:
        links: Function that returns the connections.
        say: Function that says a line.
        pause: Function that waits so many seconds.
        faults: Function that returns what is wrong with the routers to connect to; called once, after some seconds.
        follow: Function that is called before each look: it takes over permissions and keys that have changed.
    """
    known: dict[str, str] = {}
    for look in itertools.count(1):
        follow()
        present = {each.session: f"{each.role} {each.session[:8]} from {each.there}" for each in links()}
        for session, text in present.items():
            if session not in known:
                say(f"+ {text} ({len(present)} connected)")
        for session, text in known.items():
            if session not in present:
                say(f"- {text} ({len(present)} connected)")
        known = present
        for text in faults() if look == LINKED_AFTER else ():
            say(f"WARN {text}")
        pause(LOOK_EVERY)
