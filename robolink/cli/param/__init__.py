"""robolink param: see and change the parameters of running nodes."""

from __future__ import annotations

from typing import Annotated, Any

import typer
import typer.core

from robolink.cli.shared import complete
from robolink.cli.shared.options import seconds

app = typer.Typer(no_args_is_help=True, help="List, get, set, dump and load parameters of nodes.")

PREFIXES = "--param-prefixes"


def _parameters(ctx: typer.Context, incomplete: str) -> list[str]:
    from robolink.cli.param.verbs import of_node

    return of_node(ctx, incomplete)


Node = Annotated[
    str, typer.Argument(help="Name of the node, such as /driver.", metavar="NODE", autocompletion=complete.node_names)
]
Parameter = Annotated[
    str, typer.Argument(help="Name of the parameter.", metavar="PARAMETER", autocompletion=_parameters)
]
Hidden = Annotated[bool, typer.Option("--include-hidden-nodes", help="Include hidden nodes, whose names begin with _.")]
Timeout = Annotated[float, seconds("--timeout", "Longest time to wait for the node, in seconds.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


class ListCommand(typer.core.TyperCommand):
    """A command that takes several words behind `--param-prefixes`, as ros2 does."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments, each of these words with a flag of its own, as typer wants it."""
        rest: list[str] = super().parse_args(ctx, each_with_its_flag(args))
        return rest


def each_with_its_flag(args: list[str]) -> list[str]:
    """Repeat the flag before each word that follows it.

    >>> each_with_its_flag(["/node", "--param-prefixes", "a", "b", "--json"])
    ['/node', '--param-prefixes', 'a', '--param-prefixes', 'b', '--json']
    """
    spread: list[str] = []
    for arg in args:
        is_more = not arg.startswith("-") and len(spread) > 1 and spread[-2] == PREFIXES
        spread += [PREFIXES, arg] if is_more else [arg]
    return spread


@app.callback()
def _noun() -> None:
    """List, get, set, dump and load parameters of nodes."""


@app.command("list", cls=ListCommand)
def list_parameters(
    node: Annotated[
        str, typer.Argument(help="Name of the node; all nodes by default.", autocompletion=complete.node_names)
    ] = "",
    hidden: Hidden = False,
    prefixes: Annotated[
        list[str] | None, typer.Option(PREFIXES, metavar="PREFIX...", help="List only parameters with these prefixes.")
    ] = None,
    show_types: Annotated[bool, typer.Option("--param-type", help="Print the types too.")] = False,
    pattern: Annotated[
        str,
        typer.Option(
            "--filter", metavar="REGEX", help="List only parameters whose names match this regular expression."
        ),
    ] = "",
    as_json: AsJson = False,
) -> None:
    """List the parameters of a node, or of all nodes."""
    from robolink.cli.param import verbs

    requested = verbs.Requested(tuple(prefixes or ()), verbs.compiled(pattern), show_types, hidden)
    verbs.show_list(node, requested, as_json=as_json)


@app.command("get")
def get(
    ctx: typer.Context,
    node: Annotated[
        str,
        typer.Argument(
            help="Name of the node, such as /driver; all nodes if only a PARAMETER follows.",
            metavar="[NODE]",
            autocompletion=complete.node_names,
        ),
    ],
    parameters: Annotated[
        list[str] | None,
        typer.Argument(help="Names of parameters.", metavar="PARAMETER...", autocompletion=_parameters),
    ] = None,
    hidden: Hidden = False,
    hide_type: Annotated[bool, typer.Option("--hide-type", help="Print the value without its type.")] = False,
    timeout: Timeout = 1.0,
    as_json: AsJson = False,
) -> None:
    """Print the values of parameters of a node, or of one parameter of all nodes."""
    from robolink.cli.param import verbs

    if parameters:
        verbs.show_values(node, parameters, timeout, hide_type=hide_type, as_json=as_json)
    elif node.startswith("/"):
        ctx.fail("Missing argument 'PARAMETER...'")
    else:
        verbs.show_value_of_all(node, hidden_nodes=hidden, hide_type=hide_type, as_json=as_json)


@app.command("describe")
def describe(
    node: Node,
    parameters: Annotated[
        list[str], typer.Argument(help="Names of parameters.", metavar="PARAMETER...", autocompletion=_parameters)
    ],
    hidden: Hidden = False,
    timeout: Timeout = 1.0,
    as_json: AsJson = False,
) -> None:
    """Show the descriptors of parameters: type, description, constraints."""
    from robolink.cli.param import verbs

    verbs.show_descriptors(node, parameters, timeout, as_json=as_json)


@app.command("dump")
def dump(node: Node, hidden: Hidden = False, timeout: Timeout = 1.0, as_json: AsJson = False) -> None:
    """Print all parameters of a node as a YAML parameter file."""
    from robolink.cli.param import verbs

    verbs.dump(node, timeout, as_json=as_json)


# A value such as -0.5 is not an option.
@app.command("set", context_settings={"ignore_unknown_options": True})
def set_parameter(
    ctx: typer.Context,
    node: Node,
    parameter: Parameter,
    value: Annotated[str, typer.Argument(help="Value in YAML, such as 0.5, true or [1, 2].", metavar="VALUE")],
    more: Annotated[
        list[str] | None,
        typer.Argument(help="Further parameters, each with its value.", metavar="PARAMETER VALUE..."),
    ] = None,
    hidden: Hidden = False,
    timeout: Timeout = 1.0,
    as_json: AsJson = False,
) -> None:
    """Set parameters."""
    from robolink.cli.param import verbs

    rest = more or []
    for each in rest[::2]:
        if each.startswith("-"):
            ctx.fail(f"No such option: {each}")
    if len(rest) % 2:
        ctx.fail(f"{rest[-1]} has no value: expected NODE PARAMETER VALUE [PARAMETER VALUE]...")
    texts = {parameter: value, **dict(zip(rest[::2], rest[1::2], strict=True))}
    raise typer.Exit(verbs.set_each(node, texts, timeout, as_json=as_json))


@app.command("load")
def load(
    node: Node,
    file: Annotated[str, typer.Argument(help="Parameter file.", metavar="FILE")],
    hidden: Hidden = False,
    no_wildcard: Annotated[
        bool, typer.Option("--no-use-wildcard", help="Ignore the parameters that the file sets for all nodes (/**).")
    ] = False,
    timeout: Timeout = 1.0,
    as_json: AsJson = False,
) -> None:
    """Load a parameter file into a node."""
    from robolink.cli.param import verbs

    raise typer.Exit(verbs.load(node, file, timeout, use_wildcard=not no_wildcard, as_json=as_json))


@app.command("delete")
def delete(
    node: Node, parameter: Parameter, hidden: Hidden = False, timeout: Timeout = 1.0, as_json: AsJson = False
) -> None:
    """Delete (undeclare) a parameter, if its type is dynamic."""
    from robolink.cli.param import verbs

    raise typer.Exit(verbs.delete(node, parameter, timeout, as_json=as_json))
