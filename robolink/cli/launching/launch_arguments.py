"""Words behind `launch` and `simulate`: a launch file, by name, path or package, and its arguments."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import typer

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
