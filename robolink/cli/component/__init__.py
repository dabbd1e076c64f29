"""robolink component: see what containers of nodes hold, load nodes into them, and take them out."""

from __future__ import annotations

from typing import Annotated

import typer

from robolink.cli.shared import complete
from robolink.cli.shared.options import choice
from robolink.cli.shared.output import say

app = typer.Typer(no_args_is_help=True, help="See what containers of nodes hold, and load nodes into them.")

LEVELS = {"": 0, "debug": 10, "info": 20, "warn": 30, "error": 40, "fatal": 50}
"""Log levels by name, as rcl_interfaces/msg/Log has them."""

_NODE = {"metavar": "CONTAINER", "autocompletion": complete.node_names}
Container = Annotated[str, typer.Argument(help="Name of its node, such as /ComponentManager.", **_NODE)]


@app.callback()
def _noun() -> None:
    """See what containers of nodes hold, and load nodes into them."""


@app.command("list")
def list_components(
    container: Annotated[str, typer.Argument(help="Only the nodes of this one.", **_NODE)] = "",
    containers_only: Annotated[bool, typer.Option("--containers-only", help="Only the containers' names.")] = False,
) -> None:
    """List the containers that run, and the nodes in each, with their numbers."""
    from robolink.cli.component import verbs

    if containers_only:
        for each in verbs.containers():
            say(each)
        return
    for name, nodes in verbs.listed(container):
        if not container:
            say(name)
        for number, node in nodes:
            say(f"{'' if container else '  '}{number}  {node}")


@app.command("types")
def types(package: Annotated[str, typer.Argument(metavar="PACKAGE", help="Only those of this one.")] = "") -> None:
    """List the components that packages offer: in C++ those that were installed, in Python classes of nodes."""
    from robolink.cli.component import verbs

    for name, found in verbs.offered(package):
        say("\n".join([name, *(f"  {each}" for each in found)]))


Name = Annotated[str, typer.Option("--node-name", "-n", metavar="NAME", help="Another name for the node.")]
Namespace = Annotated[str, typer.Option("--node-namespace", metavar="NAME", help="The node's namespace.")]
LogLevel = Annotated[str, choice("--log-level", list(LEVELS)[1:], "The node's log level")]
Remap = Annotated[list[str] | None, typer.Option("--remap-rule", "-r", metavar="FROM:=TO", help="Rename.")]
Parameters = Annotated[
    list[str] | None, typer.Option("--parameter", "-p", metavar="NAME:=VALUE", help="Set a parameter.")
]
Extra = Annotated[
    list[str] | None, typer.Option("--extra-argument", "-e", metavar="NAME:=VALUE", help="For the container.")
]
Package = Annotated[str, typer.Argument(metavar="PACKAGE", help="Package that offers it.")]
Plugin = Annotated[str, typer.Argument(metavar="TYPE", help="Its type: an executable, or as types lists it.")]


@app.command("load")
def load(
    container: Container,
    package: Package,
    plugin: Plugin,
    name: Name = "",
    namespace: Namespace = "",
    log_level: LogLevel = "",
    remap: Remap = None,
    parameters: Parameters = None,
    extra: Extra = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Only the number.")] = False,
) -> None:
    """Load a node into a running container."""
    from robolink.cli.component import verbs

    wanted = verbs.Wanted(
        package, plugin, name, namespace, LEVELS[log_level], remap or [], parameters or [], extra or []
    )
    answer = verbs.load(container, wanted)
    text = f"Loaded component {answer.unique_id} into '{container}' container node as '{answer.full_node_name}'"
    say(str(answer.unique_id) if quiet else text)


@app.command("unload")
def unload(
    container: Container,
    numbers: Annotated[list[int], typer.Argument(metavar="NUMBER...", min=0, help="Numbers that list shows.")],
) -> None:
    """Take nodes out of a container."""
    from robolink.cli.component import verbs

    for number in numbers:
        verbs.unload(container, number)
        say(f"Unloaded component {number} from '{container}' container node")


@app.command("standalone")
def standalone(
    package: Package,
    plugin: Plugin,
    name: Name = "",
    namespace: Namespace = "",
    log_level: LogLevel = "",
    remap: Remap = None,
    parameters: Parameters = None,
    extra: Extra = None,
    container: Annotated[
        str, typer.Option("--container-node-name", "-c", metavar="NAME", help="Name of the container's node.")
    ] = "",
) -> None:
    """Run a container with one node in it, until Ctrl-C."""
    from robolink.cli.component import verbs

    wanted = verbs.Wanted(
        package, plugin, name, namespace, LEVELS[log_level], remap or [], parameters or [], extra or []
    )
    verbs.run(wanted, container)
