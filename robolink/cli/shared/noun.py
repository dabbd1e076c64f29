"""Command group of a noun, which takes ros2's flags for the graph on either side of the verb."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

import typer.core

from robolink.cli.shared.added import added_command, added_names
from robolink.exceptions import nearest

HIDDEN = ("--include-hidden-topics", "--include-hidden-services", "--include-hidden-nodes", "--include-hidden-actions")
"""Flags that ros2 takes before the verb, too."""
WITHOUT_EFFECT = {"--no-daemon": False, "--use-sim-time": False, "--spin-time": True, **dict.fromkeys(HIDDEN, False)}
"""Flags that ros2's verbs take, by whether a value follows: a verb that knows none of them goes without."""


class Noun(typer.core.TyperGroup):
    """Command group whose verbs take ros2's flags as ros2 does; other packages may add verbs."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of the verbs, those of other packages last."""
        own = super().list_commands(ctx)
        return [*own, *(each for each in added_names(_name(self, ctx)) if each not in own)]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a verb; None for an unknown name."""
        return super().get_command(ctx, cmd_name) or added_command(cmd_name, _name(self, ctx))

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Return the command of the first word; end with a usage error that has the nearest name if it is unknown."""
        if self.get_command(ctx, args[0]) is None:
            ctx.fail(f"no command named '{ctx.info_name} {args[0]}'{nearest(args[0], self.list_commands(ctx))}")
        return super().resolve_command(ctx, args)

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments."""
        verb = next((each for each in args if not each.startswith("-")), None)
        command = None if verb is None else self.get_command(ctx, verb)
        if verb is not None and command is not None:
            known = {flag for each in command.params for flag in each.opts}
            args = arranged(args, args.index(verb), known)
        left: list[str] = super().parse_args(ctx, args)
        return left


def _name(noun: Noun, context: Any) -> str:
    """Return the word that a noun was called by; typer asks without a context, too."""
    return str((context.info_name if context is not None else noun.name) or "")


def arranged(args: Sequence[str], verb: int, known: Collection[str]) -> list[str]:
    """Return the arguments with ros2's flags behind the verb, and without those that it does not know.

    >>> arranged(["--include-hidden-topics", "list", "--no-daemon"], 1, {"--include-hidden-topics"})
    ['list', '--include-hidden-topics']

    Args:
        args: Words after the noun.
        verb: Index of the verb.
        known: Flags of the verb.
    """
    moved = [each for each in args[:verb] if each in HIDDEN]
    rest = [*(each for each in args[:verb] if each not in HIDDEN), args[verb]]
    words = iter([*moved, *args[verb + 1 :]])
    for each in words:
        flag, equals, _ = each.partition("=")
        if each == "--":
            return [*rest, each, *words]
        if flag not in WITHOUT_EFFECT or flag in known:
            rest.append(each)
        elif WITHOUT_EFFECT[flag] and not equals:
            next(words, None)
    return rest
