"""Commands that other packages add: nouns, and verbs of robolink's own nouns (`robolink.extensions.COMMANDS`)."""

from __future__ import annotations

from typing import Any

import typer
import typer.main

from robolink.extensions import COMMANDS, ExtensionError, added, load


def added_names(noun: str = "") -> list[str]:
    """Return the names of the nouns, or of the verbs of a noun, that other packages add.

    Args:
        noun: A noun such as topic; '' for the nouns.
    """
    prefix = f"{noun}." if noun else ""
    names = [each.removeprefix(prefix) for each in added(COMMANDS) if each.startswith(prefix)]
    return [each for each in names if "." not in each]


def added_command(name: str, noun: str = "", kind: type[Any] | None = None) -> Any:
    """Return a command that another package adds; None if none does.

    Args:
        name: Its name.
        noun: The noun whose verb it is; '' if it is a noun itself.
        kind: Class of a noun's command.

    Raises:
        ExtensionError: If it cannot be loaded, or is neither a typer.Typer nor a function.
    """
    full_name = f"{noun}.{name}" if noun else name
    found = load(COMMANDS, full_name)
    if found is None:
        return None
    app = found
    if not isinstance(app, typer.Typer):
        if not callable(found):
            what = type(found).__name__
            raise ExtensionError(f"'{full_name}' ({COMMANDS}) is a {what}; a command is a typer.Typer or a function")
        app = typer.Typer()
        app.command(name)(found)
    elif kind is not None and app.registered_groups + app.registered_commands and not _is_one(app):
        app.info.cls = kind
    app.rich_markup_mode = None  # plain help, as of robolink's own commands
    app._add_completion = False
    command = typer.main.get_command(app)
    command.name = name
    return command


def added_help(name: str, noun: str = "") -> str:
    """Return the first line of the help of such a command; the reason, if it cannot be loaded.

    Args:
        name: Its name.
        noun: The noun whose verb it is; '' if it is a noun itself.
    """
    try:
        command = added_command(name, noun)
    except ExtensionError as error:
        return str(error)
    return str(command.get_short_help_str(limit=100))


def _is_one(app: typer.Typer) -> bool:
    """True if an app is a single command without verbs."""
    return len(app.registered_commands) == 1 and not app.registered_groups and app.registered_callback is None
