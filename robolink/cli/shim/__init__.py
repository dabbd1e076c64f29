"""robolink shim: second names of the command, so that a course's own lines work."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from robolink.cli.shared.output import say, tell
from robolink.cli.shared.process import OTHER_NAMES

app = typer.Typer(help="Write a second command, ros2, colcon or launch_test, that leads to robolink.")

TARGETS = {"ros2": "robolink.cli.main", **OTHER_NAMES}
"""Modules whose `main` the commands call."""


def _checked(name: str) -> str:
    if name not in TARGETS:
        raise typer.BadParameter(f"'{name[:50]}' is none of {', '.join(TARGETS)}")
    return name


@app.command("shim")
def shim(
    name: Annotated[
        str, typer.Argument(metavar="ros2|colcon|launch_test", help="Name of the command.", callback=_checked)
    ],
    remove: Annotated[bool, typer.Option("--remove", help="Remove the command.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Write it even if it hides a real one.")] = False,
    folder: Annotated[
        Path | None,
        typer.Option("--folder", metavar="FOLDER", help="Folder of the command; that of robolink by default."),
    ] = None,
) -> None:
    """Install a command: ros2, which runs robolink; colcon, whose build does nothing; or launch_test."""
    from robolink.cli.shim import writing

    place = folder or writing.scripts_folder()
    if remove:
        say(f"removed {writing.remove(place, name)}")
        return
    path = writing.write(place, name, TARGETS[name], force=force)
    where = "" if folder is None else f" --folder {shlex.quote(str(folder))}"
    say(f"made {path}; 'robolink shim {name} --remove{where}' takes it away")
    if not writing.is_on_path(place):
        tell(f"{place} is not on the PATH of this shell: activate its environment, or add it")
