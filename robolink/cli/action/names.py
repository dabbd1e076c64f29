"""Shell completion for `robolink action`: the names and types of the actions that are served."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from robolink.cli.shared import complete

if TYPE_CHECKING:
    from collections.abc import Iterator

Context = typer.Context


def action_names(incomplete: str) -> list[str]:
    """Return the names of the actions that are served."""
    names = {name for name, _ in _served()}
    if incomplete and not incomplete.startswith("/"):
        names = {each.removeprefix("/") for each in names}
    return complete.offered(names, incomplete)


def type_of_action(ctx: Context, incomplete: str) -> list[str]:
    """Return the types of the action on the command line; all action types if it has none."""
    wanted = "/" + str(ctx.params.get("action") or "").lstrip("/")
    types = {type_ for name, type_ in _served() if name == wanted}
    return complete.offered(types, incomplete) or complete.action_types(incomplete)


def _served() -> Iterator[tuple[str, str]]:
    from robolink.action.graph import GOAL_TYPE, MARK, SEND_GOAL
    from robolink.wire import EndpointKind, EndpointToken

    for each in complete.announced():
        if isinstance(each, EndpointToken) and each.kind is EndpointKind.SERVICE:
            name, _, part = each.name.rpartition(MARK)
            if name and part == SEND_GOAL:
                yield name, each.type_name.removesuffix(GOAL_TYPE)
