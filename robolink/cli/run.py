"""robolink run: run a node."""

from __future__ import annotations

from typing import Annotated, Any

import typer
import typer.core

from robolink.cli import complete

ROS_ARGS = "--ros-args"
META = "robolink.ros_args"

app = typer.Typer()


class RunCommand(typer.core.TyperCommand):
    """A command that leaves all from `--ros-args` on alone: that is for the node."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Part the arguments; `ctx.meta` keeps those for ROS."""
        at = args.index(ROS_ARGS) if ROS_ARGS in args else len(args)
        ctx.meta[META] = args[at:]
        rest: list[str] = super().parse_args(ctx, args[:at])
        return rest


@app.command(cls=RunCommand)
def run(
    ctx: typer.Context,
    node: Annotated[
        str,
        typer.Argument(metavar="NAME|FILE[:FUNCTION]", help="The node to run.", autocompletion=complete.runnable_nodes),
    ] = "",
    args: Annotated[
        list[str] | None, typer.Argument(metavar="[ARGS]...", help="For the program; after -- whatever they are.")
    ] = None,
    parameters: Annotated[
        list[str] | None, typer.Option("--param", "-p", metavar="NAME:=VALUE", help="Set a parameter.")
    ] = None,
    remappings: Annotated[
        list[str] | None,
        typer.Option("--remap", "-r", metavar="FROM:=TO", help="Rename a topic or service."),
    ] = None,
    name: Annotated[str, typer.Option("--name", help="Another name for the node.")] = "",
    namespace: Annotated[str, typer.Option("--namespace", help="The node's namespace.")] = "",
    params_files: Annotated[
        list[str] | None, typer.Option("--params-file", metavar="FILE", help="Parameters in a YAML file.")
    ] = None,
    workspace: Annotated[str, typer.Option("--workspace", metavar="FOLDER", help="Where to look first.")] = "",
    show_list: Annotated[bool, typer.Option("--list", help="List the nodes that there are.")] = False,
) -> None:
    """Run a node: by name, or from a file. All from --ros-args on goes to the node as ROS 2 has it."""
    from robolink.cli import runner

    if show_list:
        runner.show_nodes(workspace or None)
        return
    if not node:
        ctx.fail("which node? --list shows them")
    flags = ros_flags(name, namespace, parameters or [], remappings or [], params_files or [])
    raise typer.Exit(runner.run(node, args or [], flags + ctx.meta[META], workspace or None))


def ros_flags(
    name: str, namespace: str, parameters: list[str], remappings: list[str], params_files: list[str]
) -> list[str]:
    """Spell the options of this command as ROS arguments."""
    if namespace and not namespace.startswith("/"):
        namespace = f"/{namespace}"
    flags = ["-r", f"__node:={name}"] if name else []
    flags += ["-r", f"__ns:={namespace}"] if namespace else []
    for flag, values in (("-r", remappings), ("--params-file", params_files), ("-p", parameters)):
        for value in values:
            flags += [flag, value]
    return [ROS_ARGS, *flags] if flags else []
