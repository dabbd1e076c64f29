"""Words of the commands that pages show: whether robolink has such a command, and whether it runs until Ctrl-C."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

from robolink.cli.root import command
from tests.support.page_kinds import read
from tests.support.page_shell import Shell, lines_of, without_settings
from tools.docs_site.markdown import Block

ENDS = {
    "launch": (
        *("--duration", "--validate", "--status", "--list", "--stop", "stop", "restart"),
        *("--graph", "--schema", "--show-args", "-s"),
    ),
    "echo": ("--once", "--timeout"),
    "pub": ("-1", "--once", "--times", "-t"),
    "plot": ("--duration",),
}
"""Verbs that go on, and what ends them; others end by themselves."""
GO_ON = ("run", "launch", "view", "router", "top", "pub", "plot")
GO_ON_OF_A_NOUN = ("echo", "hz", "record", "pub", "monitor", "show")


def goes_on(words: list[str]) -> bool:
    """Return True if a command runs until Ctrl-C."""
    words = without_settings(words)
    if words[0] not in ("robolink", "ros2") or "--help" in words:
        return False
    words = without_network(words[1:])
    if words[:2] in (["bag", "play"], ["interface", "show"]):
        return bool({"-l", "--loop"} & set(words))
    verb = next((each for each, verbs in zip(words[:2], (GO_ON, GO_ON_OF_A_NOUN), strict=False) if each in verbs), "")
    return bool(verb) and not set(ENDS.get(verb, ())) & set(words)


def without_network(words: list[str]) -> list[str]:
    """Return words without the option that stands before the command."""
    return words[2:] if words[:1] == ["--network"] else words


def check(block: Block) -> None:
    """Look at a block that is not run: it can be read, and robolink has its commands."""
    if block.language not in ("sh", "console", "powershell"):
        read(block)
        return
    prompt = "$ " if block.language == "console" else ""
    for line in [each for each in lines_of(block.text) if each.startswith(prompt)]:
        for words in Shell(Path.cwd()).commands(line.removeprefix(prompt)):
            words = without_settings(words)
            if words[0] == "robolink":
                found = problem(words[1:])
                assert not found, f"'{line}': {found}"


@functools.cache
def root() -> Any:
    """Return robolink's command line."""
    return command()


def problem(words: list[str]) -> str:
    """Return the command line's error about the words after `robolink`; '' if there is none."""
    each, name, context = root(), "robolink", None
    try:
        while hasattr(each, "list_commands"):  # with its parent: a command keeps the first names of its help option
            context = each.make_context(name, list(words), parent=context)
            rest = [*getattr(context, "_protected_args", []), *context.args]
            if not rest:
                return ""  # the noun alone does something
            name, each, words = each.resolve_command(context, rest)
        each.make_context(name, list(words), parent=context)
    except Exception as error:  # typer's own errors moved with its copy of click
        if type(error).__name__ in ("Exit", "NoArgsIsHelpError"):
            return ""
        return f"{type(error).__name__}: {getattr(error, 'message', error)}"
    return ""
