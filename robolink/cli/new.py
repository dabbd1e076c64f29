"""robolink new: make a project, a node or a world to begin with, and stubs for editors."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli.shared.layout import shown, typed
from robolink.cli.shared.output import say

if TYPE_CHECKING:
    from robolink.scaffold import Made

app = typer.Typer(no_args_is_help=True, help="Create a project, a node, a world, or stubs for editors.")

Workspace = Annotated[str, typer.Option("--workspace", metavar="FOLDER", help="Workspace to write into.")]


@app.command("project")
def new_project(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the project, or path of its folder.")],
) -> None:
    """Create a project that runs at once: a node, a world, a launch file, a test, CI, and stubs for editors."""
    from robolink.scaffold import new_project
    from robolink.scaffold.stubs import write_stubs

    made = new_project(name)
    _tell(made)
    for each in write_stubs(made.folder):
        say(f"made {shown(made.folder / each)}")
    there = "" if made.folder.samefile(Path.cwd()) else f"  cd {typed(made.folder)}\n"
    say(f"\nnext:\n{there}  robolink simulate {made.name}    # or: launch {made.name}\n{_pytest()}")


@app.command("node")
def new_node(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the node, such as wall_watcher.")],
    workspace: Workspace = "",
) -> None:
    """Create a node and its test, in nodes/ and tests/; outside of a workspace, a file in this folder."""
    from robolink.scaffold import new_node

    made = new_node(name, workspace=workspace or None)
    _tell(made)
    in_workspace = len(made.files) > 1
    test = f"\n{_pytest()} {typed(made.folder / made.files[1])}" if in_workspace else ""
    say(f"\nnext:\n  robolink run {made.name if in_workspace else made.files[0]}{test}")


@app.command("world")
def new_world(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the world, such as kitchen.")],
    workspace: Workspace = "",
) -> None:
    """Create a world file, in configs/worlds/; outside of a workspace, a file in this folder."""
    from robolink.scaffold import new_world

    made = new_world(name, workspace=workspace or None)
    _tell(made)
    called = made.name if "/" in made.files[0] else made.files[0]
    say(f"\nnext:\n  robolink run world -p world:={called}\n  robolink world draw {called} {made.name}.png")


@app.command("stubs")
def new_stubs(workspace: Workspace = "") -> None:
    """Create typings/, with which editors and type checkers know rclpy, the message packages and your own types."""
    from robolink.scaffold.stubs import settings_to_change, write_stubs
    from robolink.workspace import user_workspace

    folder = user_workspace(workspace or None) or Path.cwd()
    for each in write_stubs(folder):
        say(f"made {shown(folder / each)}")
    for file, line in settings_to_change(folder).items():
        say(f"add this to {shown(folder / file)}: {line}")


def _pytest() -> str:
    """Return the lines that run pytest: the one of this environment, since another one's knows no robolink."""
    from importlib.util import find_spec

    lacking = "" if find_spec("pytest") else "  pip install pytest\n"
    return f"{lacking}  python -m pytest"


def _tell(made: Made) -> None:
    for each in made.files:
        say(f"made {shown(made.folder / each)}")
