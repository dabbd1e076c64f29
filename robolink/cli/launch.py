"""robolink launch: run a system of nodes that a file describes."""

from __future__ import annotations

from typing import Annotated

import typer

from robolink.cli import complete

app = typer.Typer()


@app.command()
def launch(
    ctx: typer.Context,
    file: Annotated[
        str, typer.Argument(metavar="NAME|FILE", help="What to launch.", autocompletion=complete.launch_files)
    ] = "",
    duration: Annotated[
        float | None, typer.Option("--duration", metavar="S", help="End after so many seconds.", min=0.0)
    ] = None,
    workspace: Annotated[str, typer.Option("--workspace", metavar="FOLDER", help="Where to look first.")] = "",
    show_list: Annotated[bool, typer.Option("--list", help="List the launch files that there are.")] = False,
) -> None:
    """Run a system of nodes until the first of them ends, Ctrl-C, or for a while."""
    from robolink.workspace import find_launch, list_launches

    folder = workspace or None
    if show_list:
        for each in list_launches(workspace=folder):
            typer.echo(each.stem)
        return
    if not file:
        ctx.fail("launch what? --list shows what there is")
    from robolink.launch import launch as start

    raise typer.Exit(start(find_launch(file, workspace=folder), workspace=folder, duration=duration))
