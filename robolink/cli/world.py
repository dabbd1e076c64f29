"""robolink world: check, draw and list the worlds that are simulated."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli.shared import complete
from robolink.cli.shared.layout import shown
from robolink.cli.shared.output import say, tell
from robolink.system.terminal import fit

if TYPE_CHECKING:
    from robolink.sim import WorldDescription
    from robolink.sim.worldfile import Checked

app = typer.Typer(no_args_is_help=True, help="Check, draw and list simulated worlds.")

Workspace = Annotated[str, typer.Option("--workspace", metavar="FOLDER", help="Workspace to search first.")]


@app.command("check")
def check_worlds(
    files: Annotated[
        list[str],
        typer.Argument(
            metavar="NAME|FILE...",
            help="World files or names, of robolink or Webots (.wbt).",
            autocompletion=complete.world_files,
        ),
    ],
    workspace: Workspace = "",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON: a list with the problems of each file.")] = False,
) -> None:
    """Check world files, and print a line for each problem; the exit code is 1 if there is any."""
    found = [_checked(each, workspace) for each in files]
    if as_json:
        import json

        report = [{"file": path, "problems": [str(each) for each in checked.errors]} for path, checked in found]
        say(json.dumps(report, ensure_ascii=False))
    else:
        for path, checked in found:
            for line in _lines(path, checked):
                say(line)
    if any(checked.errors for _, checked in found):
        raise typer.Exit(1)


@app.command("draw")
def draw_world(
    file: Annotated[
        str,
        typer.Argument(metavar="NAME|FILE", help="World file or name.", autocompletion=complete.world_files),
    ],
    out: Annotated[Path, typer.Argument(metavar="OUT", help="File to write: .png, .svg or .pdf.")],
    size: Annotated[
        int, typer.Option("--size", metavar="PIXELS", help="Length of the longer side, in pixels.", min=300, max=20_000)
    ] = 1000,
    workspace: Workspace = "",
) -> None:
    """Draw a world in its initial state (needs matplotlib: pip install matplotlib)."""
    from robolink.cli.shared.picture import check_picture
    from robolink.documents.foreign import warnings_to
    from robolink.sim.drawing import save_world
    from robolink.sim.worldfile import load_world

    check_picture(out)
    with warnings_to(_warn):
        description = load_world(_found(file, workspace))
    save_world(description, out, size)


@app.command("list")
def list_all(
    workspace: Workspace = "",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON: names, files and descriptions.")] = False,
) -> None:
    """List the available worlds."""
    from robolink.cli.shared.layout import aligned
    from robolink.workspace import list_worlds, purpose_of

    found = [(each, purpose_of(each)) for each in list_worlds(workspace=workspace or None)]
    if as_json:
        import json

        listed = [{"name": each.stem, "file": str(each), "description": purpose} for each, purpose in found]
        say(json.dumps(listed, ensure_ascii=False))
        return
    for line in aligned([(each.stem, purpose) for each, purpose in found]):
        say(line)


@app.command("schema")
def show_schema(
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="FILE", help="File to write instead of printing it.")
    ] = None,
) -> None:
    """Print the JSON schema of world files, with which editors complete and check them.

    An editor takes it from a world's first line: # yaml-language-server: $schema=world.schema.json
    """
    from robolink.sim.schema import schema_text

    if out is None:
        say(schema_text().removesuffix("\n"))
    else:
        out.write_text(schema_text(), encoding="utf-8", newline="\n")


def _found(name: str, workspace: str) -> str:
    """Return the path of a world, relative to the working directory if it is below it."""
    from robolink.workspace import find_world

    return shown(find_world(name, workspace=workspace or None))


def _checked(name: str, workspace: str) -> tuple[str, Checked]:
    """Return a world's path and its problems, one of which may be that it is not found."""
    from robolink.documents.foreign import warnings_to
    from robolink.exceptions import NotFoundError
    from robolink.sim.worldfile import Checked, check_world

    try:
        path = _found(name, workspace)
    except NotFoundError as error:
        return name, Checked(None, [error])
    with warnings_to(_warn):
        return path, check_world(path)


def _lines(path: str, checked: Checked) -> list[str]:
    if checked.description is not None:
        return [f"{path}: OK: {summary(checked.description)}"]
    return [fit(str(error), lines=False) for error in checked.errors]


def summary(description: WorldDescription) -> str:
    """Return the contents of a world in words: "4 walls, 1 robot with 2 sensors"."""
    from robolink.sim.description import MapWalls

    drawn = sum(len(each.segments()) for each in description.walls if not isinstance(each, MapWalls))
    mapped = sum(len(each.segments()) for each in description.walls if isinstance(each, MapWalls))
    sensors = sum(len(each.sensors) for each in description.robots)
    signs = len(description.signs) + sum(len(each.signs) for each in description.obstacles)
    signs += sum(len(each.signs) for each in description.robots)
    with_sensors = f" with {_counted(sensors, 'sensor')}" if sensors else ""
    parts = [
        _counted(drawn, "wall") if drawn or not mapped else "",
        f"a map of {_counted(mapped, 'wall')}" if mapped else "",
        _counted(len(description.obstacles), "obstacle") if description.obstacles else "",
        f"{painted} painted" if (painted := len(description.paint)) else "",
        _counted(signs, "sign") if signs else "",
        _counted(len(description.robots), "robot") + with_sensors,
    ]
    return ", ".join(filter(None, parts))


def _counted(count: int, word: str) -> str:
    return f"{count} {word}" + ("" if count == 1 else "s")


def _warn(text: str) -> None:
    """Write a warning about a world to standard error, as one line."""
    tell(f"robolink: {fit(text, lines=False)}")
