"""The root of the command line: a table of commands, each imported when it is used."""

from __future__ import annotations

import importlib
import os
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer
import typer.core
import typer.main

from robolink.cli.output import say
from robolink.exceptions import nearest

if TYPE_CHECKING:
    Context = Any  # typer's own moved with its copy of click


class Entry(NamedTuple):
    """Where a command lives and what it does; `verb` picks one command out of a noun's."""

    module: str
    help: str
    verb: str = ""

    @property
    def hidden(self) -> bool:
        """Whether help does not list it: an alias, or what one command asks of another process."""
        return not self.help


COMMANDS = {
    "run": Entry("robolink.cli.run", "Run a node."),
    "launch": Entry("robolink.cli.launch", "Run a system of nodes that a file describes."),
    "simulate": Entry("robolink.cli.simulate", "Run a system in virtual time, with faults, as fast as it goes."),
    "run-together": Entry("robolink.cli.together", ""),
    "look-into": Entry("robolink.cli.look", ""),
    "pub": Entry("robolink.cli.topic", "Publish messages: short for topic pub.", "pub"),
    "topic": Entry("robolink.cli.topic", "See and send what nodes publish."),
    "node": Entry("robolink.cli.node", "See which nodes there are, and what each of them does."),
    "service": Entry("robolink.cli.service", "See which services there are, and call them."),
    "param": Entry("robolink.cli.param", "See and change the parameters of running nodes."),
    "lifecycle": Entry("robolink.cli.lifecycle", "See in which states managed nodes are, and move them on."),
    "action": Entry("robolink.cli.action", "See which actions there are, and send goals."),
    "tf": Entry("robolink.cli.tf", "See where frames are in each other."),
    "plot": Entry("robolink.cli.plot", "Draw where robots go, and values over time."),
    "world": Entry("robolink.cli.world", "Check, draw and list the worlds that are simulated."),
    "interface": Entry("robolink.cli.interface", "See the types of messages, services and actions."),
    "doctor": Entry("robolink.cli.doctor", "Find out what is wrong here or on the network."),
    "wtf": Entry("robolink.cli.doctor", ""),
}


OF_ROS2 = {
    "bag": "'robolink topic echo TOPIC --json' writes messages as lines; where there is ROS 2, its own hears ours too",
    "component": "nodes of a launch file share a process where it says 'process: NAME' (docs/launch.md)",
    "daemon": "there is none to start or stop: each command looks by itself",
    "multicast": "nothing is sent by multicast but with --network subnet; 'robolink doctor' looks at the network",
    "pkg": "nothing is built; 'robolink run --list' shows what can be run, and a package is a folder in src/",
    "security": "TLS and access rules are Zenoh's: --network FILE.json5 (docs/ros2.md)",
}
"""ros2's commands that robolink has not, and what to do instead."""


class Root(typer.core.TyperGroup):
    """A group that knows its commands by name, and imports only the one that is asked for."""

    def list_commands(self, ctx: Context) -> list[str]:
        """Give the names in the order of the table."""
        return [name for name, entry in COMMANDS.items() if not entry.hidden]

    def get_command(self, ctx: Context, cmd_name: str) -> Any:
        """Import a command; None for an unknown name."""
        entry = COMMANDS.get(cmd_name)
        if entry is None:
            return None
        app: typer.Typer = importlib.import_module(entry.module).app
        app.rich_markup_mode = None  # plain help: rich takes longer to import than most commands to run
        app._add_completion = False
        found = typer.main.get_command(app)
        return found.get_command(ctx, entry.verb) if entry.verb else found  # type: ignore[attr-defined]

    def resolve_command(self, ctx: Context, args: list[str]) -> Any:
        """Find the command; the nearest name is told for an unknown one."""
        if args[0] in OF_ROS2:
            ctx.fail(f"ros2's '{args[0]}' is not here: {OF_ROS2[args[0]]}")
        if args[0] not in COMMANDS:
            ctx.fail(f"no command named '{args[0]}'{nearest(args[0], COMMANDS)}")
        return super().resolve_command(ctx, args)

    def shell_complete(self, ctx: Context, incomplete: str) -> list[Any]:
        """Complete the commands' names, without importing any, and the options."""
        base = next(
            each for each in type(self).__mro__ if each.__name__ == "Command"
        )  # typer has its own copy of click
        item = importlib.import_module(f"{base.__module__.rpartition('.')[0]}.shell_completion").CompletionItem
        names = [name for name in self.list_commands(ctx) if name.startswith(incomplete)]
        options: list[Any] = base.shell_complete(self, ctx, incomplete)  # type: ignore[attr-defined]
        return [*(item(name, help=COMMANDS[name].help) for name in names), *options]

    def format_commands(self, ctx: Context, formatter: Any) -> None:
        """List the commands without importing any."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, entry.help) for name, entry in COMMANDS.items() if not entry.hidden])


_SETTINGS = {"help_option_names": ["-h", "--help"]}  # of all commands below it, too

app = typer.Typer(
    cls=Root, context_settings=_SETTINGS, rich_markup_mode=None, no_args_is_help=True, pretty_exceptions_enable=False
)


def _version(wanted: bool) -> None:
    if wanted:
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
        typer.Option(metavar="NET", help="localhost, subnet, off, a router (tcp/HOST:7447) or a file of Zenoh's."),
    ] = "",
) -> None:
    """ROS 2 nodes from pip install: run them, launch them, see and send what they publish."""
    if network:
        os.environ["ROBOLINK_NETWORK"] = network  # for the processes that a launch starts, too


def command() -> Any:
    """Give the root command."""
    return typer.main.get_command(app)
