"""robolink service: see which services there are, and call them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli.shared import complete, options

if TYPE_CHECKING:
    from robolink.context import Context

app = typer.Typer(no_args_is_help=True, help="List services, call them, print requests and responses.")

Service = Annotated[
    str,
    typer.Argument(
        help="Name of the service, such as /reset.", metavar="SERVICE", autocompletion=complete.service_names
    ),
]
Hidden = Annotated[bool, typer.Option("--include-hidden-services", help="Include hidden names, which begin with _.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Count = Annotated[bool, typer.Option("--count-services", "-c", help="Print only the number.")]


@app.callback()
def _noun() -> None:
    """List services, call them, print requests and responses."""


@app.command("list")
def list_services(
    show_types: Annotated[bool, typer.Option("--show-types", "-t", help="Print the types too.")] = False,
    count: Count = False,
    hidden: Hidden = False,
    as_json: AsJson = False,
) -> None:
    """List the services that have servers or clients."""
    from robolink.cli.shared.graph import show_names
    from robolink.cli.shared.session import looking

    with looking() as context:
        services = _types(context, hidden=hidden)
    show_names(services, types=show_types, count=count, json=as_json)


@app.command("type")
def show_type(service: Service, hidden: Hidden = False, as_json: AsJson = False) -> None:
    """Print the type of a service."""
    from robolink.cli.shared.graph import show_types
    from robolink.cli.shared.session import looking

    with looking() as context:
        services = _types(context)
        name = _known(context, service, services)
    show_types(services[name], json=as_json)


@app.command("find")
def find(
    type_: Annotated[
        str,
        typer.Argument(
            help="Service type, such as std_srvs/srv/Trigger or Trigger.",
            metavar="TYPE",
            autocompletion=complete.service_types,
        ),
    ],
    count: Count = False,
    hidden: Hidden = False,
    as_json: AsJson = False,
) -> None:
    """List the services of a service type."""
    from robolink.cli.shared.graph import show_of_type
    from robolink.cli.shared.session import looking

    with looking() as context:
        services = _types(context, hidden=hidden)
    show_of_type(services, type_, count=count, json=as_json)


@app.command("info")
def show_info(
    service: Service,
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Print details of each server and client.")] = False,
    as_json: AsJson = False,
) -> None:
    """Show the type of a service, and the number of its servers and clients."""
    from robolink.cli.service.verbs import show

    show(service, verbose=verbose, as_json=as_json)


@app.command("call")
def call_service(
    ctx: typer.Context,
    service: Service,
    type_: Annotated[
        str,
        typer.Argument(
            help="Its type; looked up on the network by default.",
            metavar="[TYPE]",
            autocompletion=complete.type_of_service,
        ),
    ] = "",
    values: Annotated[
        str | None, typer.Argument(help="Request in YAML, such as '{data: true}'.", metavar="[VALUES]")
    ] = None,
    from_stdin: Annotated[bool, typer.Option("--stdin", help="Read the request from standard input.")] = False,
    rate: Annotated[
        float | None, typer.Option("--rate", "-r", metavar="HZ", help="Repeat the call at this rate, in Hz.")
    ] = None,
    timeout: Annotated[
        float, typer.Option("--timeout", metavar="S", help="Longest time to wait for a response, in seconds.")
    ] = 5.0,
    node_name: Annotated[
        str, typer.Option("--node-name", "-n", metavar="NAME", help="Name of the node of this command.")
    ] = "",
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON object for each call.")] = False,
) -> None:
    """Call a service and print the response."""
    from robolink.cli.service import verbs
    from robolink.cli.shared.messages import is_type, read_stdin

    if values is None and not is_type(type_):  # SERVICE VALUES: the type was left out
        type_, values = "", type_
    if from_stdin and values:
        ctx.fail("either VALUES or --stdin, not both")
    mode = verbs.Mode(rate, timeout, as_json, node_name)
    if mode.problem():
        ctx.fail(mode.problem())
    verbs.call(service, type_, read_stdin("request") if from_stdin else values or "", mode)


@app.command("echo")
def echo_events(
    ctx: typer.Context,
    service: Service,
    type_: Annotated[
        str,
        typer.Argument(
            help="Its type; looked up on the network by default.",
            metavar="[TYPE]",
            autocompletion=complete.type_of_service,
        ),
    ] = "",
    once: Annotated[bool, typer.Option("--once", help="Print one event and exit.")] = False,
    csv: Annotated[
        bool, typer.Option("--csv", help="Print the fields of an event in one line, separated by commas.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON object for each event.")] = False,
    full_length: options.FullLength = False,
    length: options.Length = 128,
    no_arr: options.NoArr = False,
    no_str: options.NoStr = False,
    flow: options.Flow = False,
) -> None:
    """Print requests and responses of a service whose introspection is enabled, until Ctrl-C."""
    from robolink.cli.service import verbs
    from robolink.cli.shared.messages import Style

    if csv and as_json:
        ctx.fail("--csv and --json do not go together")
    style = Style(None if full_length else length, not no_arr, not no_str, flow)
    verbs.echo(service, type_, verbs.Format(style, csv, as_json), once=once)


def _types(context: Context, *, hidden: bool = True) -> dict[str, list[str]]:
    """Return every service with its types, sorted; also those that are only called, as in ros2."""
    from robolink.cli.shared.graph import endpoints, is_hidden
    from robolink.graph.graph import names_and_types
    from robolink.wire import EndpointKind

    found = names_and_types(endpoints(context, EndpointKind.SERVICE, EndpointKind.CLIENT))
    return {name: types for name, types in found if hidden or not is_hidden(name)}


def _known(context: Context, service: str, services: dict[str, list[str]]) -> str:
    """Return the full name of a service. Raises NotFoundError if there is none."""
    from robolink.cli.shared.graph import absolute
    from robolink.exceptions import NotFoundError
    from robolink.system.terminal import shown

    name = absolute(service)
    if name not in services:
        raise NotFoundError("service", shown(name), services, f"domain {context.get_domain_id()}")
    return name
