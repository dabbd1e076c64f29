"""robolink node: see which nodes there are, and what each of them does."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli.shared import complete
from robolink.cli.shared.options import GRAPH_FORMATS, choice

if TYPE_CHECKING:
    from robolink.graph.graph import Token
    from robolink.wire import EndpointToken

app = typer.Typer(no_args_is_help=True, help="List nodes, and show the topics, services and actions of a node.")


@app.callback()
def _noun() -> None:
    """List nodes, and show the topics, services and actions of a node."""


@app.command("list")
def list_nodes(
    show_all: Annotated[bool, typer.Option("--all", "-a", help="Include hidden names, which begin with _.")] = False,
    count: Annotated[bool, typer.Option("--count-nodes", "-c", help="Print only the number.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON array.")] = False,
) -> None:
    """List the running nodes."""
    from robolink.cli.shared.graph import nodes
    from robolink.cli.shared.output import say, say_json
    from robolink.cli.shared.session import looking

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
        bool, typer.Option("--include-hidden", help="Include hidden topics, services and actions.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON object.")] = False,
) -> None:
    """Show the publishers, subscriptions, services and actions of a node."""
    from robolink.cli.shared.graph import absolute, bridge_data, bridges, sections_of, through, tokens
    from robolink.cli.shared.output import say, say_json, tell
    from robolink.cli.shared.session import looking

    name = absolute(node)
    with looking() as context:
        announced = tokens(context)
        count, found = of_node(announced, name, context.get_domain_id())
        known = bridges(context)
    behind = [known.get(each.session) for each in announced if each.full_node_name == name]
    if count > 1:
        tell(f"{count} nodes are named {name}: this is what they do together")
    sections = sections_of(found, hidden)
    if as_json:
        lists = {title.lower().replace(" ", "_"): dict(listed) for title, listed in sections}
        say_json({"name": name, "count": count, **lists, **bridge_data(next(filter(None, behind), None))})
        return
    say(name)
    for text in sorted({through(each) for each in behind if each is not None}):
        say(f"  Network: {text}")
    for title, listed in sections:  # one that is empty has an empty line, as in ros2
        say(f"  {title}:")
        say("\n".join(f"    {each}: {', '.join(types)}" for each, types in listed))


@app.command("graph")
def graph(
    format_: Annotated[str, choice("--format", GRAPH_FORMATS, "Format of the graph")] = GRAPH_FORMATS[0],
    hidden: Annotated[
        bool, typer.Option("--include-hidden", help="Include hidden nodes, topics, services and actions.")
    ] = False,
) -> None:
    """Print a graph of the running nodes and the topics, services and actions between them."""
    from robolink.cli.shared.graph import is_hidden, tokens
    from robolink.cli.shared.output import say
    from robolink.cli.shared.session import looking
    from robolink.launch.looking.graph import as_text, graph_of_uses, uses_of
    from robolink.launch.looking.look import End, Look
    from robolink.wire import EndpointToken

    with looking() as context:
        found = [each for each in tokens(context) if hidden or not is_hidden(each.full_node_name)]
    ends = [each for each in found if isinstance(each, EndpointToken)]
    look = Look(
        ends=[End(each.kind.value, each.name, each.type_name, each.type_hash, each.full_node_name) for each in ends]
    )
    nodes = sorted({each.full_node_name for each in found})
    uses = [each for each in uses_of(look) if hidden or not is_hidden(each.name)]
    say(as_text(graph_of_uses(nodes, uses), format_).rstrip())


def of_node(tokens: list[Token], name: str, domain: int) -> tuple[int, list[EndpointToken]]:
    """Return the number of nodes of a full name, and their endpoints. Raises NotFoundError for an unknown name."""
    from robolink.exceptions import NotFoundError
    from robolink.system.terminal import shown
    from robolink.wire import EndpointToken, NodeToken

    names = [each.full_node_name for each in tokens if isinstance(each, NodeToken)]
    if name not in names:
        raise NotFoundError("node", shown(name), names, f"domain {domain}")
    own = [each for each in tokens if isinstance(each, EndpointToken) and each.full_node_name == name]
    return names.count(name), own


def _warn_of_twins(names: list[str]) -> None:
    from robolink.cli.shared.output import tell

    twins = [f"{name} ({count} times)" for name, count in Counter(names).items() if count > 1]
    if twins:
        more = f" and {len(twins) - 5} more" if len(twins) > 5 else ""
        tell(f"WARNING: several nodes have the exact same name: {', '.join(twins[:5])}{more}")
