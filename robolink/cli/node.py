"""robolink node: see which nodes there are, and what each of them does."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli import complete

if TYPE_CHECKING:
    from robolink.graph import NamesAndTypes, Token
    from robolink.wire import EndpointToken

app = typer.Typer(no_args_is_help=True, help="See which nodes there are, and what each of them does.")


@app.callback()
def _noun() -> None:
    """See which nodes there are, and what each of them does."""


@app.command("list")
def list_nodes(
    show_all: Annotated[bool, typer.Option("--all", "-a", help="Also those that begin with _.")] = False,
    count: Annotated[bool, typer.Option("--count-nodes", "-c", help="Only say how many there are.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="A JSON array.")] = False,
) -> None:
    """List the nodes by their full names."""
    from robolink.cli.announced import nodes
    from robolink.cli.output import say, say_json
    from robolink.cli.session import looking

    with looking() as context:
        found = [each for each in nodes(context) if show_all or not each.node_name.startswith("_")]
    names = sorted(each.full_node_name for each in found)
    if as_json:
        say_json(names)
    elif count:
        say(str(len(names)))
    else:
        _warn_of_twins(names)
        for name in names:
            say(name)


@app.command("info")
def info(
    node: Annotated[str, typer.Argument(help="Name of the node, such as /robot.", autocompletion=complete.node_names)],
    hidden: Annotated[
        bool, typer.Option("--include-hidden", help="Also topics, services and actions that begin with _.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="A JSON object.")] = False,
) -> None:
    """Show what a node publishes, subscribes to, serves and calls."""
    from robolink.cli.announced import absolute, tokens
    from robolink.cli.output import say, say_json, tell
    from robolink.cli.session import looking

    name = absolute(node)
    with looking() as context:
        count, found = of_node(tokens(context), name, context.get_domain_id())
    if count > 1:
        tell(f"{count} nodes are named {name}: this is what they do together")
    sections = sections_of(found, hidden)
    if as_json:
        lists = {title.lower().replace(" ", "_"): dict(listed) for title, listed in sections}
        say_json({"name": name, "count": count, **lists})
        return
    say(name)
    for title, listed in sections:  # one that is empty has an empty line, as in ros2
        say(f"  {title}:")
        say("\n".join(f"    {each}: {', '.join(types)}" for each, types in listed))


def of_node(tokens: list[Token], name: str, domain: int) -> tuple[int, list[EndpointToken]]:
    """Count the nodes of a full name, and give their endpoints. Raises NotFoundError for an unknown name."""
    from robolink.exceptions import NotFoundError, shown
    from robolink.wire import EndpointToken, NodeToken

    names = [each.full_node_name for each in tokens if isinstance(each, NodeToken)]
    if name not in names:
        raise NotFoundError("node", shown(name), names, f"domain {domain}")
    own = [each for each in tokens if isinstance(each, EndpointToken) and each.full_node_name == name]
    return names.count(name), own


def sections_of(endpoints: Sequence[EndpointToken], hidden: bool) -> list[tuple[str, NamesAndTypes]]:
    """Give what `ros2 node info` lists of a node: six titles, each with names and types."""
    from robolink.action.graph import actions
    from robolink.cli.announced import is_hidden
    from robolink.graph import names_and_types
    from robolink.wire import EndpointKind

    of = {kind: names_and_types(each for each in endpoints if each.kind is kind) for kind in EndpointKind}
    titles = {
        "Subscribers": EndpointKind.SUBSCRIPTION,
        "Publishers": EndpointKind.PUBLISHER,
        "Service Servers": EndpointKind.SERVICE,
        "Service Clients": EndpointKind.CLIENT,
    }
    sections = [(title, of[kind]) for title, kind in titles.items()]
    sections += [
        ("Action Servers", actions(of[EndpointKind.SERVICE], of[EndpointKind.PUBLISHER])),
        ("Action Clients", actions(of[EndpointKind.CLIENT], of[EndpointKind.SUBSCRIPTION])),
    ]
    return [(title, [each for each in listed if hidden or not is_hidden(each[0])]) for title, listed in sections]


def _warn_of_twins(names: list[str]) -> None:
    from robolink.cli.output import tell

    twins = [f"{name} ({count} times)" for name, count in Counter(names).items() if count > 1]
    if twins:
        more = f" and {len(twins) - 5} more" if len(twins) > 5 else ""
        tell(f"WARNING: several nodes have the exact same name: {', '.join(twins[:5])}{more}")
