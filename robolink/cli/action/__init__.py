"""robolink action: see which actions there are, send goals, and see those of others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli.shared import complete, options

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robolink.context import Context

app = typer.Typer(no_args_is_help=True, help="List actions, send goals, print feedback and results.")


def action_names(incomplete: str) -> list[str]:
    """Return the names of the actions that are served."""
    names = {name for name, _ in _served()}
    if incomplete and not incomplete.startswith("/"):
        names = {each.removeprefix("/") for each in names}
    return complete.offered(names, incomplete)


def type_of_action(ctx: typer.Context, incomplete: str) -> list[str]:
    """Return the types of the action on the command line; all action types if it has none."""
    full_name = "/" + str(ctx.params.get("action") or "").lstrip("/")
    types = {type_ for name, type_ in _served() if name == full_name}
    return complete.offered(types, incomplete) or complete.action_types(incomplete)


def _served() -> Iterator[tuple[str, str]]:
    from robolink.graph.action_names import GOAL_TYPE, MARK, SEND_GOAL
    from robolink.wire import EndpointKind, EndpointToken

    for each in complete.announced():
        if isinstance(each, EndpointToken) and each.kind is EndpointKind.SERVICE:
            name, _, part = each.name.rpartition(MARK)
            if name and part == SEND_GOAL:
                yield name, each.type_name.removesuffix(GOAL_TYPE)


Action = Annotated[
    str,
    typer.Argument(help="Name of the action, such as /dock.", metavar="ACTION", autocompletion=action_names),
]
Type = Annotated[
    str,
    typer.Argument(
        help="Its type; looked up on the network by default.", metavar="[TYPE]", autocompletion=type_of_action
    ),
]
ShowTypes = Annotated[bool, typer.Option("--show-types", "-t", help="Print the types too.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Count = Annotated[bool, typer.Option("--count-actions", "-c", help="Print only the number.")]


@app.callback()
def _noun() -> None:
    """List actions, send goals, print feedback and results."""


@app.command("list")
def list_actions(show_types: ShowTypes = False, count: Count = False, as_json: AsJson = False) -> None:
    """List the actions that have servers or clients."""
    from robolink.cli.shared.graph import show_names
    from robolink.cli.shared.session import looking

    with looking() as context:
        actions = _types(context)
    show_names(actions, types=show_types, count=count, json=as_json)


@app.command("type")
def show_type(action: Action, as_json: AsJson = False) -> None:
    """Print the type of an action."""
    from robolink.cli.shared.graph import absolute, show_types
    from robolink.cli.shared.session import looking
    from robolink.exceptions import NotFoundError
    from robolink.system.terminal import shown

    name = absolute(action)
    with looking() as context:
        actions = _types(context)
    if name not in actions:
        raise NotFoundError("action", shown(name), actions, f"domain {context.get_domain_id()}")
    show_types(actions[name], json=as_json)


@app.command("find")
def find(
    type_: Annotated[
        str,
        typer.Argument(
            help="Action type, such as example_interfaces/action/Fibonacci or Fibonacci.",
            metavar="TYPE",
            autocompletion=complete.action_types,
        ),
    ],
    count: Count = False,
    as_json: AsJson = False,
) -> None:
    """List the actions of an action type."""
    from robolink.cli.shared.graph import show_of_type
    from robolink.cli.shared.session import looking

    with looking() as context:
        actions = _types(context)
    show_of_type(actions, type_, count=count, json=as_json)


@app.command("info")
def show_info(
    action: Action,
    show_types: ShowTypes = False,
    count: Annotated[bool, typer.Option("--count", "-c", help="Print only the number.")] = False,
    as_json: AsJson = False,
) -> None:
    """Show the servers and the clients of an action."""
    from robolink.cli.action.verbs import show

    show(action, types=show_types, count=count, as_json=as_json)


@app.command("send_goal")
def send_goal(
    ctx: typer.Context,
    action: Action,
    type_: Type = "",
    values: Annotated[
        str | None, typer.Argument(help="Goal in YAML, such as '{order: 10}'.", metavar="[VALUES]")
    ] = None,
    from_stdin: Annotated[bool, typer.Option("--stdin", help="Read the goal from standard input.")] = False,
    feedback: Annotated[bool, typer.Option("--feedback", "-f", help="Print the feedback too.")] = False,
    timeout: Annotated[
        float, typer.Option("--timeout", metavar="S", help="Longest time to wait for an action server, in seconds.")
    ] = 5.0,
    node_name: Annotated[
        str, typer.Option("--node-name", "-n", metavar="NAME", help="Name of the node of this command.")
    ] = "",
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON object for each event of the goal.")] = False,
) -> int:
    """Send a goal and print its result; Ctrl-C cancels it. The exit code is 1 unless it succeeds."""
    from robolink.cli.action import verbs
    from robolink.cli.shared.messages import is_type, read_stdin

    if values is None and not is_type(type_):  # ACTION VALUES: the type was left out
        type_, values = "", type_
    if from_stdin and values:
        ctx.fail("either VALUES or --stdin, not both")
    if not 0 < timeout <= 1e9:
        ctx.fail(f"--timeout: expected a number of seconds above 0, got {timeout:g}")
    mode = verbs.Mode(feedback, timeout, as_json, node_name)
    return verbs.run(action, type_, read_stdin("goal") if from_stdin else values or "", mode)


@app.command("echo")
def echo_messages(
    ctx: typer.Context,
    action: Action,
    type_: Type = "",
    interfaces: Annotated[
        str | None,
        typer.Option(
            "--interfaces",
            "-i",
            metavar="A|B",
            help="Print only these, separated by |: GOAL_SERVICE, CANCEL_SERVICE, RESULT_SERVICE, FEEDBACK_TOPIC,"
            " STATUS_TOPIC.",
        ),
    ] = None,
    csv: Annotated[
        bool, typer.Option("--csv", help="Print the fields of a message in one line, separated by commas.")
    ] = False,
    full_length: options.FullLength = False,
    length: options.Length = 128,
    no_arr: options.NoArr = False,
    no_str: options.NoStr = False,
    flow: options.Flow = False,
) -> None:
    """Print feedback and status of an action, and goals, cancellations and results if introspection is enabled."""
    from robolink.cli.action.echo import INTERFACES, Format, echo
    from robolink.cli.shared.messages import Style

    chosen = INTERFACES if interfaces is None else [each.strip() for each in interfaces.split("|")]
    for each in chosen:
        if each.upper() not in INTERFACES:
            ctx.fail(f"--interfaces: expected {', '.join(INTERFACES)}, got '{each}'")
    style = Style(None if full_length else length, not no_arr, not no_str, flow)
    echo(action, type_, list(dict.fromkeys(map(str.upper, chosen))), Format(style, csv))


def _types(context: Context) -> dict[str, list[str]]:
    """Return the types of every action, by name, sorted."""
    from robolink.cli.shared.graph import endpoints
    from robolink.graph.action_names import actions
    from robolink.graph.graph import names_and_types
    from robolink.wire import EndpointKind

    ends = endpoints(context)
    of = {kind: [each for each in ends if each.kind is kind] for kind in EndpointKind}
    services = names_and_types(of[EndpointKind.SERVICE] + of[EndpointKind.CLIENT])
    topics = names_and_types(of[EndpointKind.PUBLISHER] + of[EndpointKind.SUBSCRIPTION])
    return dict(actions(services, topics))
