"""robolink run-together: run several nodes in this process, as `robolink launch` asks for on standard input."""

from __future__ import annotations

import typer

app = typer.Typer()


@app.command()
def run_together() -> None:
    """Run the nodes that standard input names, together in this process: what a launch file calls a `process`."""
    from robolink.cli.running_nodes import shortcut

    raise typer.Exit(shortcut.run_together())
