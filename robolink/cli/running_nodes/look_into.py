"""robolink look-into: make the nodes that standard input names, and report their endpoints to `launch --validate`."""

from __future__ import annotations

import typer

app = typer.Typer()


@app.command()
def look_into() -> None:
    """Show what the nodes that standard input names publish, serve and declare, a line of JSON for each."""
    from robolink.cli.running_nodes import shortcut

    shortcut.look_into()
