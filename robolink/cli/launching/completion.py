"""Shell completion for `launch` and `simulate`: launch files, their arguments, and names of what runs."""

from __future__ import annotations

import contextlib
import io

import typer

from robolink.cli.shared import complete


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
