"""robolink top: what nodes use and what topics carry, again and again. Here are the arguments."""

from __future__ import annotations

from typing import Annotated

import typer

app = typer.Typer()


@app.command("top")
def top(
    once: Annotated[bool, typer.Option("--once", help="Measure one interval, print it and exit.")] = False,
    every: Annotated[float, typer.Option("--every", "-e", min=0.1, help="Interval in seconds.")] = 1.0,
    sort: Annotated[
        str, typer.Option("--sort", "-s", help="Sort by name, cpu, memory, rate, bandwidth, age or lost.")
    ] = "name",
    filter_: Annotated[
        str,
        typer.Option(
            "--filter", "-f", metavar="TEXT", help="Show only nodes and topics with this text in their name or type."
        ),
    ] = "",
    show_all: Annotated[bool, typer.Option("--all", "-a", help="Include hidden names, which begin with _.")] = False,
    no_traffic: Annotated[
        bool, typer.Option("--no-traffic", help="Do not subscribe: show no rate, bandwidth, age and loss.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON object for each interval.")] = False,
) -> None:
    """Show CPU and memory of nodes; rate, bandwidth, age and loss of topics; until q or Ctrl-C."""
    from robolink.cli.top import screen
    from robolink.cli.top.table import ORDERS, View
    from robolink.exceptions import nearest

    if sort not in ORDERS:
        raise typer.BadParameter(
            f"no order named '{sort}'{nearest(sort, ORDERS)}: {', '.join(ORDERS)}", param_hint="--sort"
        )
    view = View(order=sort, filter=filter_, hidden=show_all)
    screen.top(view, every, once=once, json=as_json, with_traffic=not no_traffic)
