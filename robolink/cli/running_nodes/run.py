"""robolink run: run a node."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, NamedTuple

import typer
import typer.core

from robolink.cli.running_nodes.shortcut import ROS_ARGS
from robolink.cli.shared import complete

META = "robolink.ros_args"
FIXED = "robolink.after_two_dashes"

app = typer.Typer()


class Parts(NamedTuple):
    """Command line of `run`, split into its parts."""

    own: list[str]
    """Options of this command, with their values; that of the last one may be missing."""
    words: list[str]
    """Words that name the node, and those for its program."""
    fixed: list[str]
    """Words after `--`: the program's in any case."""
    is_cut_off: bool = False
    """True if the last option lacks its value."""


class RunCommand(typer.core.TyperCommand):
    """A command that leaves alone what is for the node: all from `--ros-args` on, after `--`, and unknown options."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Split the arguments; `ctx.meta` keeps those for ROS, and how many came after `--`."""
        at = args.index(ROS_ARGS) if ROS_ARGS in args else len(args)
        ctx.meta[META] = args[at:]
        names = ((name, each) for each in self.get_params(ctx) for name in each.opts if name.startswith("-"))
        options = [(name, each) for name, each in names if name != "-h" or args[:1] == ["-h"]]  # else the program's
        parts = part(args[:at], {name: not getattr(each, "is_flag", False) for name, each in options})
        ctx.meta[FIXED] = len(parts.fixed)
        ctx.meta[complete.NODE] = next(iter(parts.words), "")
        rest = [] if parts.is_cut_off else ["--", *parts.words, *parts.fixed]
        left: list[str] = super().parse_args(ctx, [*parts.own, *rest])
        return left


def part(args: list[str], takes_value: Mapping[str, bool]) -> Parts:
    """Split arguments into this command's options, the words and options of the program, and what comes after `--`.

    An option that this command has not is the program's if it comes after the program's name. One that is nearly one
    of this command's stays with it, which refuses it: a slip of the fingers would go unnoticed otherwise.
    """
    own: list[str] = []
    words: list[str] = []
    rest = iter(args)
    for each in rest:
        name, equals, _ = each.partition("=")
        if each == "--":
            break
        if not each.startswith("-") or each == "-":
            words.append(each)
        elif name in takes_value:
            own.append(each)
            if takes_value[name] and not equals:
                value = next(rest, None)
                if value is None:
                    return Parts(own, words, [], is_cut_off=True)
                own.append(value)
        elif each[:2] in takes_value or not words or _is_slip(name, takes_value):
            own.append(each)
        else:
            words.append(each)
    return Parts(own, words, list(rest))


def _is_slip(name: str, known: Mapping[str, bool]) -> bool:
    if not name.startswith("--"):
        return False
    import difflib

    return any(each.startswith(name) for each in known) or bool(difflib.get_close_matches(name, known, 1, 0.8))


@app.command(cls=RunCommand)
def run(
    ctx: typer.Context,
    node: Annotated[
        str,
        typer.Argument(
            metavar="NAME|FILE[:FUNCTION]|PACKAGE EXECUTABLE",
            help="Node to run.",
            autocompletion=complete.runnable_nodes,
        ),
    ] = "",
    args: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[ARGS]...",
            help="Arguments of the program; all words after -- are.",
            autocompletion=complete.package_executables,
        ),
    ] = None,
    parameters: Annotated[
        list[str] | None,
        typer.Option(
            "--param", "-p", metavar="NAME:=VALUE", help="Set a parameter.", autocompletion=complete.parameters
        ),
    ] = None,
    remappings: Annotated[
        list[str] | None,
        typer.Option("--remap", "-r", metavar="FROM:=TO", help="Remap a topic or service."),
    ] = None,
    name: Annotated[str, typer.Option("--name", help="Name of the node, instead of its own.")] = "",
    namespace: Annotated[str, typer.Option("--namespace", help="Namespace of the node.")] = "",
    params_files: Annotated[
        list[str] | None, typer.Option("--params-file", metavar="FILE", help="YAML parameter file.")
    ] = None,
    workspace: Annotated[str, typer.Option("--workspace", metavar="FOLDER", help="Workspace to search first.")] = "",
    prefix: Annotated[
        str | None,
        typer.Option("--prefix", metavar="COMMAND", help="Command to run the node with, such as 'gdb -ex run --args'."),
    ] = None,
    show_list: Annotated[bool, typer.Option("--list", help="List the available nodes.")] = False,
) -> None:
    """Run a node: by name, from a file, or an executable of a package, with ROS arguments after --ros-args."""
    from robolink.cli.running_nodes import runner

    if show_list:
        runner.show_nodes(workspace or None)
        return
    if not node:
        ctx.fail("which node? --list shows them")
    flags = ros_flags(name, namespace, parameters or [], remappings or [], params_files or [])
    given = args or []
    if prefix is not None:
        from robolink.cli.running_nodes import prefix as prefixed

        before = len(given) - ctx.meta[FIXED]
        place = ["--workspace", workspace] if workspace else []
        words = [*place, node, *given[:before], "--", *given[before:], *flags, *ctx.meta[META]]
        raise typer.Exit(prefixed.run(prefix, ["run", *words]))
    command = runner.NodeCommand(node, given, len(given) - ctx.meta[FIXED])
    raise typer.Exit(runner.run(command, flags + ctx.meta[META], workspace or None))


def ros_flags(
    name: str, namespace: str, parameters: list[str], remappings: list[str], params_files: list[str]
) -> list[str]:
    """Return the options of this command as ROS arguments."""
    if namespace and not namespace.startswith("/"):
        namespace = f"/{namespace}"
    flags = ["-r", f"__node:={name}"] if name else []
    flags += ["-r", f"__ns:={namespace}"] if namespace else []
    for flag, values in (("-r", remappings), ("--params-file", params_files), ("-p", parameters)):
        for value in values:
            flags += [flag, value]
    return [ROS_ARGS, *flags] if flags else []
