"""robolink node: see which nodes there are."""

from __future__ import annotations

from typing import Annotated

import typer

app = typer.Typer(no_args_is_help=True, help="See which nodes there are.")


@app.callback()
def _noun() -> None:
    """See which nodes there are."""


@app.command("list")
def list_nodes(
    show_all: Annotated[bool, typer.Option("--all", "-a", help="Also those that begin with _.")] = False,
    count: Annotated[bool, typer.Option("--count-nodes", "-c", help="Only say how many there are.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="A JSON array.")] = False,
) -> None:
    """List the nodes by their full names."""
    from robolink.cli.session import is_hidden, nodes, opened, say

    with opened() as context:
        names = sorted(f"{each.namespace.rstrip('/')}/{each.node_name}" for each in nodes(context))
    names = [each for each in names if show_all or not is_hidden(each)]
    if as_json:
        import msgspec

        say(msgspec.json.encode(names).decode())
    elif count:
        say(str(len(names)))
    else:
        for name in names:
            say(name)
