"""robolink daemon: ros2's words for the process that remembers the graph, of which robolink needs none."""

from __future__ import annotations

import typer

from robolink.cli.shared.output import say

app = typer.Typer(no_args_is_help=True, help="Says that no daemon is needed: each command looks by itself.")

_NONE = "robolink needs no daemon: each command looks at the network by itself"


@app.command("status")
def status() -> None:
    """Show that no daemon runs, since none is needed."""
    say(f"The daemon is not running: {_NONE}")


@app.command("start")
def start() -> None:
    """Start nothing, since nothing is needed."""
    say(f"Nothing to start: {_NONE}")


@app.command("stop")
def stop() -> None:
    """Stop nothing, since nothing runs."""
    say(f"Nothing to stop: {_NONE}")
