"""Root of the command line: it imports a noun when it is used (`robolink.cli.shared.commands`)."""

from __future__ import annotations

import functools
import importlib
import os
import sys
from typing import TYPE_CHECKING, Annotated, Any

import typer
import typer.core
import typer.main

from robolink.cli.shared.commands import NOUNS, added_command, added_names
from robolink.cli.shared.noun import Noun, meant
from robolink.cli.shared.output import say
from robolink.extensions.optional import check
from robolink.system.terminal import wants_colour

if TYPE_CHECKING:
    Context = Any  # typer's own moved with its copy of click


OF_ROS2 = {
    "control": "it speaks to ros2_control, which is C++; 'robolink run world' simulates a robot's drive and sensors",
    "extension_points": "'robolink --help' lists the commands, those of other packages too",
    "extensions": "'robolink --help' lists the commands, those of other packages too",
    "plugin": "plugins of pluginlib are C++; 'robolink pkg executables' lists what can be run",
    "test": "tests are pytest's, in virtual time (docs/reference/testing.md)",
    "trace": "it records traces of C++ with LTTng; 'robolink top' shows what nodes use and what topics carry",
}
"""Commands of ros2 that robolink lacks, each with what to do instead."""
VERBS_OF_ROS2 = {
    ("bag", "burst"): "'robolink bag play --rate 1000' plays as fast as it can",
    ("doctor", "hello"): "'robolink doctor' looks whom the nodes meet here, 'robolink network' shows them",
    ("security", "create_key"): "it is 'robolink security create_enclave'",
    ("security", "list_keys"): "it is 'robolink security list_enclaves'",
    ("wtf", "hello"): "'robolink doctor' looks whom the nodes meet here, 'robolink network' shows them",
}
"""Verbs of ros2 that robolink lacks, each with what to do instead."""


class Root(typer.core.TyperGroup):
    """Command group with lazy loading: it knows all commands by name, and imports only the one that is used."""

    def make_context(self, *args: Any, **extra: Any) -> Any:
        """Return the context of a command line; help has bold headings where there is a terminal."""
        base = _click_of(type(self), "core")
        plain = base.HelpFormatter
        base.Context.formatter_class = _with_bold_headings(plain) if wants_colour(sys.stdout) else plain
        return super().make_context(*args, **extra)

    def list_commands(self, ctx: Context) -> list[str]:
        """Return the names that help lists, in the order of the table, then those of other packages."""
        return [*(name for name, entry in NOUNS.items() if not entry.hidden), *_added()]

    def get_command(self, ctx: Context, cmd_name: str) -> Any:
        """Import and return a command; None for an unknown name."""
        entry = NOUNS.get(cmd_name)
        if entry is None:
            return added_command(cmd_name, kind=Noun)
        check(entry.module, f"'robolink {cmd_name}'")
        found = _command_of(entry.module)
        return found.get_command(ctx, entry.verb) if entry.verb else found

    def resolve_command(self, ctx: Context, args: list[str]) -> Any:
        """Return the command of the first word; end with a usage error that has the nearest name if it is unknown."""
        if args[0] in OF_ROS2:
            ctx.fail(f"ros2's '{args[0]}' is not here: {OF_ROS2[args[0]]}")
        verb = next((each for each in args[1:] if not each.startswith("-")), "")
        if (args[0], verb) in VERBS_OF_ROS2:
            ctx.fail(f"ros2's '{args[0]} {verb}' is not here: {VERBS_OF_ROS2[args[0], verb]}")
        if args[0] not in NOUNS and args[0] not in _added():
            shown = self.list_commands(ctx)
            ctx.fail(f"no command named '{args[0]}'{meant(args[0], shown, lambda noun: self._verbs(ctx, noun))}")
        return super().resolve_command(ctx, args)

    def _verbs(self, ctx: Context, noun: str) -> list[str]:
        command: Any = self.get_command(ctx, noun) if noun in NOUNS else None  # another package's may not even load
        return command.list_commands(ctx) if hasattr(command, "list_commands") else []

    def shell_complete(self, ctx: Context, incomplete: str) -> list[Any]:
        """Return completions of the commands' names and of the options, without importing any command."""
        base = next(each for each in type(self).__mro__ if each.__name__ == "Command")
        item = _click_of(type(self), "shell_completion").CompletionItem
        names = [name for name in self.list_commands(ctx) if name.startswith(incomplete)]
        options: list[Any] = base.shell_complete(self, ctx, incomplete)  # type: ignore[attr-defined]
        texts = {name: entry.help for name, entry in NOUNS.items()}
        return [*(item(name, help=texts.get(name, "")) for name in names), *options]

    def format_commands(self, ctx: Context, formatter: Any) -> None:
        """Write the list of commands into the help, without importing any but those of other packages."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, entry.help) for name, entry in NOUNS.items() if not entry.hidden])
        if added := _added():
            with formatter.section("Commands of other packages"):
                formatter.write_dl([(name, _help_of(name)) for name in added])


def _added() -> list[str]:
    """Return the names of the commands that other packages add, and that robolink has not."""
    return [each for each in added_names() if each not in NOUNS]


def _help_of(name: str) -> str:
    """Return the first line of the help of a command that another package adds; the reason, if it is broken."""
    return str(added_command(name).get_short_help_str(limit=100))


def _click_of(cls: type, module: str) -> Any:
    """Return a module of the click that a command class is of: typer has its own copy."""
    base = next(each for each in cls.__mro__ if each.__name__ == "Command")
    return importlib.import_module(f"{base.__module__.rpartition('.')[0]}.{module}")


@functools.cache
def _with_bold_headings(base: type) -> type:
    """Return a help formatter whose headings are bold."""

    class Formatter(base):  # type: ignore[misc]
        def write_heading(self, heading: str) -> None:
            self.write(f"{'':>{self.current_indent}}\x1b[1m{heading}:\x1b[0m\n")

        def write_usage(self, *args: Any, **options: Any) -> None:
            begin = len(self.buffer)
            super().write_usage(*args, **options)
            self.buffer[begin:] = ["".join(self.buffer[begin:]).replace("Usage:", "\x1b[1mUsage:\x1b[0m", 1)]

    return Formatter


@functools.cache
def _command_of(module: str) -> Any:
    """Import the module of a noun, and return its command; made once, for programs that call `main` again and again."""
    app: typer.Typer = importlib.import_module(module).app
    app.info.cls = Noun
    app.rich_markup_mode = None  # plain help: rich takes longer to import than most commands to run
    app._add_completion = False
    return typer.main.get_command(app)


_SETTINGS = {"help_option_names": ["-h", "--help"]}  # of all commands below it, too

app = typer.Typer(
    cls=Root, context_settings=_SETTINGS, rich_markup_mode=None, no_args_is_help=True, pretty_exceptions_enable=False
)


def _version(requested: bool) -> None:
    if requested:
        from importlib.metadata import version

        say(f"robolink {version('robolink')}")
        raise typer.Exit


@app.callback()
def root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
    network: Annotated[
        str,
        typer.Option(
            metavar="NET",
            help="Network to use: localhost, lan, off, dds, HOST[:PORT], tls/HOST, a name in networks.yaml, or a file.",
        ),
    ] = "",
) -> None:
    """ROS 2 from pip install: run, launch, inspect and record nodes."""
    if network:
        from robolink.networks.request import ask

        ask(os.environ, network, "--network")


@functools.cache
def command() -> Any:
    """Return the root command of the parser."""
    return typer.main.get_command(app)
