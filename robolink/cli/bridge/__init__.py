"""robolink bridge: join another network to this one. Here are the arguments."""

from __future__ import annotations

from typing import Annotated

import typer

app = typer.Typer(no_args_is_help=True, help="Join another network, such as DDS, to this one.")


@app.callback()
def _noun() -> None:
    """Join another network, such as DDS, to this one."""


@app.command("dds")
def dds(
    domain: Annotated[
        int | None, typer.Option("--domain", metavar="N", help="ROS domain id; ROS_DOMAIN_ID by default.")
    ] = None,
    network: Annotated[
        str | None, typer.Option("--network", metavar="NAME", help="Zenoh network; as for nodes by default.")
    ] = None,
    interface: Annotated[
        str,
        typer.Option(
            "--interface",
            metavar="IF",
            help="Network interface on which DDS is met, too, by its name or address; by default DDS stays on this"
            " machine.",
        ),
    ] = "",
) -> None:
    """Join the nodes of ROS 2 that speak DDS to the Zenoh network of robolink, until Ctrl-C.

    Topics, services, actions, parameters and the graph go both ways. One bridge for a machine is enough; a second one
    between the same networks refuses to start.
    """
    from robolink.cli.bridge import running

    running.run(domain, network, interface)
