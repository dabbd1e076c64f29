"""Groups of commands as ros2 has them: verbs of other packages, flags before the verb, options of several values."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Any

import typer.core

from robolink.cli.shared.commands import added_command, added_names
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


class ListedOptions(typer.core.TyperCommand):
    """Command in which each option that may be repeated takes all the words up to the next option."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments."""
        flags = {flag for each in self.params if getattr(each, "multiple", False) for flag in each.opts}
        left: list[str] = super().parse_args(ctx, repeated(args, flags))
        return left


def repeated(args: Sequence[str], flags: Collection[str]) -> list[str]:
    """Return the arguments with one of these flags before each of its values: click's take one value each.

    >>> repeated(["--topics", "/a", "/b", "-o", "bag"], ["--topics"])
    ['--topics', '/a', '--topics', '/b', '-o', 'bag']
    """
    result: list[str] = []
    flag, has_value = "", False
    for index, each in enumerate(args):
        if flag and not each.startswith("-"):
            result += [flag, each]
            has_value = True
            continue
        if flag and not has_value:
            result.append(flag)  # click says that its value is missing
        if each == "--":
            return [*result, *args[index:]]
        flag, has_value = (each, False) if each in flags else ("", False)
        if not flag:
            result.append(each)
    return [*result, flag] if flag and not has_value else result


MOST = 3
"""Upper bound of the nouns that are named for a verb."""
OPTIONS = {"help": "--help", "version": "--version"}
OTHERS = {
    "ros2": "robolink takes the words after it, as in 'robolink topic list'; 'robolink shim ros2' writes it",
    "colcon": "nothing has to be built; 'robolink shim colcon' writes a command that says so",
    "roscore": "none is needed: nodes find each other",
}
"""Other systems' commands, each with what stands for it."""


def meant(word: str, commands: Sequence[str], verbs: Callable[[str], Iterable[str]]) -> str:
    """Return the end of an error that names the commands near a `word`; '' if none is near.

    Args:
        word: The word.
        commands: Names of the commands that help lists.
        verbs: Function that returns the verbs of a command; it is called for a verb that lacks its noun only.
    """
    if word in OTHERS:
        return f": {OTHERS[word]}"
    if word in OPTIONS:
        return f" (did you mean '{OPTIONS[word]}'?)"
    begun = [each for each in commands if len(word) > 2 and each.startswith(word)]
    if len(begun) == 1:
        return f" (did you mean '{begun[0]}'?)"
    nouns = [each for each in commands if word in verbs(each)]
    if nouns:
        shown = ", ".join(f"'{each} {word}'" for each in nouns[:MOST])
        return f" (did you mean {shown}{' ...' if len(nouns) > MOST else ''}?)"
    return _program(word) or nearest(word, commands)


def _program(word: str) -> str:
    """Return the command for the node, launch file or program of this name, or what serves instead; else ''."""
    from robolink.workspace import instead_of, list_launches, list_nodes, program_names

    if word in program_names() or word in [each.name for each in list_nodes()]:
        return f" (did you mean 'run {word}'?)"
    if word in [each.stem for each in list_launches()]:
        return f" (did you mean 'launch {word}'?)"
    advice = instead_of(word)
    return "" if advice is None else f": {advice}"
