"""Words behind `launch` and `simulate`: a launch file and its arguments, their completion, and option --schema."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import typer

from robolink.cli.shared import complete
from robolink.cli.shared.output import say

if TYPE_CHECKING:
    from pathlib import Path

ASSIGN = ":="


class LaunchFile(NamedTuple):
    """A launch file, and the values given for its arguments."""

    path: Path
    given: dict[str, str]


def launch_file(ctx: typer.Context, words: Sequence[str], workspace: str | None) -> LaunchFile:
    """Find the launch file that the words mean. Wrong usage ends the command; raises `NotFoundError`."""
    from robolink.launch.lookup import find

    names = [each for each in words if ASSIGN not in each]
    given = {name: value for name, _, value in (each.partition(ASSIGN) for each in words if ASSIGN in each)}
    if not names:
        listing = "--list" if ctx.info_name == "launch" else "robolink launch --list"
        ctx.fail(f"{ctx.info_name} what? {listing} shows what there is")
    if "" in given:
        ctx.fail(f"an argument has a name, as in speed:=0.5, got '{ASSIGN}{given['']}'")
    slip = next((each for each in names[1:] if "=" in each), "")
    if slip or len(names) > 2:
        ctx.fail(
            f"what is '{slip or names[2]}'? an argument is given as {slip.replace('=', ASSIGN, 1) or 'NAME:=VALUE'}"
        )
    return LaunchFile(find(names, workspace=workspace), given)


def launch_words(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the launch files known by name; after one its arguments, after stop and restart the names of what runs."""
    with contextlib.suppress(Exception):
        from robolink.workspace import find_launch, list_launches

        words, workspace = list(ctx.params.get("words") or []), ctx.params.get("workspace") or None
        if not words:
            return complete.offered((each.stem for each in list_launches(workspace=workspace)), incomplete)
        if words[0] in ("stop", "restart"):
            from robolink.cli.launching.launchers import names_for

            return complete.offered(names_for(words, complete.WITHIN), incomplete)
        if ":=" in incomplete:
            return complete.world_assignments(ctx, incomplete)
        from robolink.launch.system import arguments_of

        with contextlib.redirect_stdout(io.StringIO()):  # a launch file may print
            names = [each.name for each in arguments_of(find_launch(words[0], workspace=workspace))]
        return [f"{each}:=" for each in complete.offered(names, incomplete)]
    return []


def show_launch_schema(is_requested: bool) -> None:
    """Print the schema of launch files, if that is requested, and end."""
    if is_requested:
        from robolink.documents.json_schema import text_of
        from robolink.launch.reading.description import launch_schema

        say(text_of(launch_schema()).removesuffix("\n"))
        raise typer.Exit


def show_faults_schema(is_requested: bool) -> None:
    """Print the schema of faults files, if that is requested, and end."""
    if is_requested:
        from robolink.documents.json_schema import text_of
        from robolink.faults.file import faults_schema

        say(text_of(faults_schema()).removesuffix("\n"))
        raise typer.Exit
