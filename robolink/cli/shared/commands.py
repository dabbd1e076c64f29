"""Registry of the commands: the table of robolink's nouns, and the nouns and verbs that other packages add."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer
import typer.main

from robolink.exceptions import RobolinkError
from robolink.extensions import ExtensionError, Registry
from robolink.extensions.optional import is_here

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint


class Entry(NamedTuple):
    """Entry of a command in the table: its module and its help; `verb` picks one command out of a noun's."""

    module: str
    help: str
    verb: str = ""

    @property
    def hidden(self) -> bool:
        """True if help does not list it: an alias, a command for robolink's own processes, or one that is not here."""
        return not self.help or not is_here(self.module)


NOUNS = {
    "run": Entry("robolink.cli.running_nodes.run", "Run a node."),
    "launch": Entry("robolink.cli.launching.launch", "Run a system of nodes that a file describes."),
    "simulate": Entry(
        "robolink.cli.launching.simulate", "Run a system in virtual time, with faults, as fast as it goes."
    ),
    "new": Entry("robolink.cli.new", "Make a project, a node or a world to begin with."),
    "pkg": Entry("robolink.cli.pkg", "Make packages, and see which there are and what they have."),
    "learn": Entry("robolink.cli.learn", "Learn by exercises that are checked in a simulated world."),
    "race": Entry("robolink.cli.race", "Race programs in a simulated world: a score for a seed."),
    "race-run": Entry("robolink.cli.race.serving", ""),
    "run-together": Entry("robolink.cli.running_nodes.run_together", ""),
    "look-into": Entry("robolink.cli.running_nodes.look_into", ""),
    "pub": Entry("robolink.cli.topic.command", "Publish messages: short for topic pub.", "pub"),
    "topic": Entry("robolink.cli.topic.command", "See and send what nodes publish."),
    "node": Entry("robolink.cli.node", "See which nodes there are, and what each of them does."),
    "service": Entry("robolink.cli.service", "See which services there are, and call them."),
    "param": Entry("robolink.cli.param", "See and change the parameters of running nodes."),
    "lifecycle": Entry("robolink.cli.lifecycle", "See in which states managed nodes are, and move them on."),
    "action": Entry("robolink.cli.action", "See which actions there are, and send goals."),
    "learn-check": Entry("robolink.cli.learn.serving", ""),
    "bag": Entry("robolink.cli.bag", "Record bags of messages, look at them, convert and mend them."),
    "tf": Entry("robolink.cli.tf", "See where frames are in each other."),
    "top": Entry("robolink.cli.top", "Show what nodes use and what topics carry, again and again."),
    "image": Entry("robolink.cli.image", "See and save what cameras publish."),
    "plot": Entry("robolink.cli.plot", "Draw where robots go, and values over time."),
    "view": Entry("robolink.cli.view", "Show a running system, or a bag, in the browser."),
    "world": Entry("robolink.cli.world", "Check, draw and list the worlds that are simulated."),
    "interface": Entry("robolink.cli.interface", "See the types of messages, services and actions."),
    "security": Entry("robolink.cli.security", "Make keys for nodes, and say what each may do."),
    "component": Entry("robolink.cli.component", "See what containers hold, and load nodes into them."),
    "multicast": Entry("robolink.cli.multicast", "Try whether multicast passes between machines."),
    "network": Entry("robolink.cli.doctor.network", "See whom nodes may meet here, whom they have found, and how."),
    "router": Entry("robolink.cli.router", "Run a router, for machines that cannot reach each other directly."),
    "doctor": Entry("robolink.cli.doctor", "Find out what is wrong here or on the network."),
    "shim": Entry("robolink.cli.shim", "Write a second command, ros2 or colcon, that leads to robolink."),
    "daemon": Entry("robolink.cli.daemon", ""),
    "wtf": Entry("robolink.cli.doctor", ""),
}
"""The commands of robolink itself."""


def _app(entry: EntryPoint) -> typer.Typer:
    found = entry.load()
    app = found if isinstance(found, typer.Typer) else typer.Typer()
    if app is not found:
        if not callable(found):
            raise RobolinkError(f"a command is a typer.Typer or a function, not a {type(found).__name__}")
        app.command(entry.name.rpartition(".")[2])(found)
    app.rich_markup_mode = None  # plain help, as of robolink's own commands
    app._add_completion = False
    typer.main.get_command(app)  # raises for parameters that no command line can give
    return app


COMMANDS: Registry[Entry | typer.Typer] = Registry("robolink.commands", lambda: NOUNS, _app)
"""Registry of the commands, by NAME for a noun and NOUN.VERB for a verb that another package adds."""


def added_names(noun: str = "") -> list[str]:
    """Return the names of the nouns, or of the verbs of a noun, that other packages add.

    Args:
        noun: A noun such as topic; '' for the nouns.
    """
    prefix = f"{noun}." if noun else ""
    names = [each.removeprefix(prefix) for each in COMMANDS.added() if each.startswith(prefix)]
    return [each for each in names if "." not in each]


def added_command(name: str, noun: str = "", kind: type[Any] | None = None) -> Any:
    """Return a command that another package adds; None if none does. One that is broken says so when it is used.

    Args:
        name: Its name.
        noun: The noun whose verb it is; '' if it is a noun itself.
        kind: Class of a noun's command.
    """
    entry = COMMANDS.added().get(f"{noun}.{name}" if noun else name)
    if entry is None:
        return None
    try:
        app = COMMANDS.read(entry)
    except ExtensionError as error:
        return _broken(name, error)
    assert isinstance(app, typer.Typer)
    if kind is not None and app.registered_groups + app.registered_commands and not _is_one(app):
        app.info.cls = kind
    command = typer.main.get_command(app)
    command.name = name
    return command


def _broken(name: str, error: ExtensionError) -> Any:
    """Return a command that raises an error: help lists it with the reason, beside the commands that work."""
    app = typer.Typer(add_completion=False)

    @app.command(name, short_help=str(error), context_settings={"ignore_unknown_options": True})
    def fail(words: Annotated[list[str] | None, typer.Argument()] = None) -> None:
        raise error

    return typer.main.get_command(app)


def _is_one(app: typer.Typer) -> bool:
    """Return whether an app is a single command without verbs."""
    return len(app.registered_commands) == 1 and not app.registered_groups and app.registered_callback is None
