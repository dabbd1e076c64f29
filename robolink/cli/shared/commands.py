"""Registry of the commands: the table of robolink's nouns, and the nouns and verbs that other packages add."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer
import typer.main

from robolink.exceptions import RobolinkError
from robolink.extensions import ExtensionError, Registry
from robolink.extensions.optional import is_here
from robolink.system.terminal import fit

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
    "launch": Entry("robolink.cli.launching.launch", "Start the nodes of a launch file."),
    "simulate": Entry("robolink.cli.launching.simulate", "Run a launch file in virtual time, with injected faults."),
    "new": Entry("robolink.cli.new", "Create a project, a node or a world."),
    "pkg": Entry("robolink.cli.pkg", "Create packages, list them and their executables."),
    "learn": Entry("robolink.cli.learn", "Learn by exercises that are checked in a simulated world."),
    "race": Entry("robolink.cli.race", "Race programs in a simulated world, with a score for each seed."),
    "race-run": Entry("robolink.cli.race.serving", ""),
    "run-together": Entry("robolink.cli.running_nodes.run_together", ""),
    "look-into": Entry("robolink.cli.running_nodes.look_into", ""),
    "pub": Entry("robolink.cli.topic.command", "Publish a message to a topic (short for topic pub).", "pub"),
    "topic": Entry("robolink.cli.topic.command", "List topics, print and publish messages, measure rates."),
    "node": Entry("robolink.cli.node", "List nodes, and show the topics, services and actions of a node."),
    "service": Entry("robolink.cli.service", "List services, call them, print requests and responses."),
    "param": Entry("robolink.cli.param", "List, get, set, dump and load parameters of nodes."),
    "lifecycle": Entry("robolink.cli.lifecycle", "Show the states of lifecycle nodes, and trigger transitions."),
    "action": Entry("robolink.cli.action", "List actions, send goals, print feedback and results."),
    "learn-check": Entry("robolink.cli.learn.serving", ""),
    "bag": Entry("robolink.cli.bag", "Record, play, inspect, convert and repair bags."),
    "tf": Entry("robolink.cli.tf", "Show transforms between frames, and the tree of frames."),
    "top": Entry("robolink.cli.top", "Show CPU and memory of nodes, rate and bandwidth of topics, live."),
    "image": Entry("robolink.cli.image", "Show and save images of cameras."),
    "plot": Entry("robolink.cli.plot", "Plot trajectories of robots, and fields of messages over time."),
    "view": Entry("robolink.cli.view", "Show a running system, or a bag, in the browser."),
    "world": Entry("robolink.cli.world", "Check, draw and list simulated worlds."),
    "interface": Entry("robolink.cli.interface", "Show the definitions of messages, services and actions."),
    "security": Entry("robolink.cli.security", "Create keys, certificates and permissions for nodes (SROS 2)."),
    "component": Entry("robolink.cli.component", "List component containers, load nodes into them and unload them."),
    "multicast": Entry("robolink.cli.multicast", "Send or receive a multicast packet, to test the network."),
    "network": Entry("robolink.cli.doctor.network", "Show the network settings and the discovered sessions."),
    "router": Entry("robolink.cli.router", "Run a Zenoh router between machines."),
    "bridge": Entry("robolink.cli.bridge", "Join nodes of ROS 2 over DDS to this network."),
    "doctor": Entry("robolink.cli.doctor", "Check settings, network and running nodes for problems."),
    "shim": Entry("robolink.cli.shim", "Install a ros2 or colcon command that runs robolink."),
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


def _is_own(name: str) -> bool:
    noun, _, verb = name.partition(".")
    if noun not in NOUNS or not is_here(NOUNS[noun].module):
        return False
    app: typer.Typer = importlib.import_module(NOUNS[noun].module).app
    return not verb or verb in getattr(typer.main.get_command(app), "commands", ())


COMMANDS: Registry[Entry | typer.Typer] = Registry("robolink.commands", lambda: NOUNS, _app, _is_own)
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

    @app.command(name, short_help=fit(str(error)), context_settings={"ignore_unknown_options": True})
    def fail(words: Annotated[list[str] | None, typer.Argument()] = None) -> None:
        raise error

    return typer.main.get_command(app)


def _is_one(app: typer.Typer) -> bool:
    """Return whether an app is a single command without verbs."""
    return len(app.registered_commands) == 1 and not app.registered_groups and app.registered_callback is None
