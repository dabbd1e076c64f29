"""robolink component: see what containers of nodes hold, load nodes into them, and take them out."""

from __future__ import annotations

from typing import Annotated

import typer

from robolink.cli.shared import complete
from robolink.cli.shared.options import choice
from robolink.cli.shared.output import say

app = typer.Typer(no_args_is_help=True, help="List component containers, load nodes into them and unload them.")

LEVELS = {"": 0, "debug": 10, "info": 20, "warn": 30, "error": 40, "fatal": 50}
"""Log levels by name, as rcl_interfaces/msg/Log has them."""

_NODE = {"metavar": "CONTAINER", "autocompletion": complete.node_names}
Container = Annotated[str, typer.Argument(help="Name of the container node, such as /ComponentManager.", **_NODE)]


@app.callback()
def _noun() -> None:
    """List component containers, load nodes into them and unload them."""


@app.command("list")
def list_components(
    container: Annotated[str, typer.Argument(help="List only the components of this container.", **_NODE)] = "",
    containers_only: Annotated[bool, typer.Option("--containers-only", help="List only the containers.")] = False,
) -> None:
    """List the running containers and their components, with their unique IDs."""
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
def types(
    package: Annotated[str, typer.Argument(metavar="PACKAGE", help="List only the components of this package.")] = "",
) -> None:
    """List the available components: installed ones of C++, and node classes of Python."""
    from robolink.cli.component import verbs

    for name, found in verbs.offered(package):
        say("\n".join([name, *(f"  {each}" for each in found)]))


Name = Annotated[str, typer.Option("--node-name", "-n", metavar="NAME", help="Name of the node, instead of its own.")]
Namespace = Annotated[str, typer.Option("--node-namespace", metavar="NAME", help="Namespace of the node.")]
LogLevel = Annotated[str, choice("--log-level", list(LEVELS)[1:], "Log level of the node")]
Remap = Annotated[list[str] | None, typer.Option("--remap-rule", "-r", metavar="FROM:=TO", help="Remap a name.")]
Parameters = Annotated[
    list[str] | None, typer.Option("--parameter", "-p", metavar="NAME:=VALUE", help="Set a parameter.")
]
Extra = Annotated[
    list[str] | None,
    typer.Option("--extra-argument", "-e", metavar="NAME:=VALUE", help="Extra argument for the container."),
]
Package = Annotated[str, typer.Argument(metavar="PACKAGE", help="Package of the component.")]
Plugin = Annotated[
    str, typer.Argument(metavar="TYPE", help="Type of the component, as 'component types' lists it, or an executable.")
]


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
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print only the unique ID.")] = False,
) -> None:
    """Load a component into a container."""
    from robolink.cli.component import verbs

    requested = verbs.Requested(
        package, plugin, name, namespace, LEVELS[log_level], remap or [], parameters or [], extra or []
    )
    answer = verbs.load(container, requested)
    text = f"Loaded component {answer.unique_id} into '{container}' container node as '{answer.full_node_name}'"
    say(str(answer.unique_id) if quiet else text)


@app.command("unload")
def unload(
    container: Container,
    numbers: Annotated[list[int], typer.Argument(metavar="NUMBER...", min=0, help="Unique IDs of the components.")],
) -> None:
    """Unload components from a container."""
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
        str, typer.Option("--container-node-name", "-c", metavar="NAME", help="Name of the container node.")
    ] = "",
) -> None:
    """Run a component in a container of its own, until Ctrl-C."""
    from robolink.cli.component import verbs

    requested = verbs.Requested(
        package, plugin, name, namespace, LEVELS[log_level], remap or [], parameters or [], extra or []
    )
    verbs.run(requested, container)
