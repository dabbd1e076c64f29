"""robolink look-into: make the nodes that standard input names, and say what they have; `launch --validate` asks."""

from __future__ import annotations

import typer

app = typer.Typer()


@app.command()
def look_into() -> None:
    """Say what the nodes that standard input names publish, serve and declare, a line of JSON for each."""
    from robolink.cli import shortcut

    shortcut.look_into()
