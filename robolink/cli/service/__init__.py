"""robolink service: see which services there are, and call them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli.shared import complete

if TYPE_CHECKING:
    from robolink.context import Context

app = typer.Typer(no_args_is_help=True, help="See which services there are, and call them.")

Service = Annotated[
    str,
    typer.Argument(
        help="Name of the service, such as /reset.", metavar="SERVICE", autocompletion=complete.service_names
    ),
]
Hidden = Annotated[bool, typer.Option("--include-hidden-services", help="Also those that begin with _.")]
AsJson = Annotated[bool, typer.Option("--json", help="JSON, for programs.")]
Count = Annotated[bool, typer.Option("--count-services", "-c", help="Only say how many there are.")]


@app.callback()
def _noun() -> None:
    """See which services there are, and call them."""


@app.command("list")
def list_services(
    show_types: Annotated[bool, typer.Option("--show-types", "-t", help="Also show the types.")] = False,
    count: Count = False,
    hidden: Hidden = False,
    as_json: AsJson = False,
) -> None:
    """List the services that are served or called."""
    from robolink.cli.shared.graph import show_names
    from robolink.cli.shared.session import looking

    with looking() as context:
        services = _types(context, hidden=hidden)
    show_names(services, types=show_types, count=count, json=as_json)


@app.command("type")
def show_type(service: Service, hidden: Hidden = False, as_json: AsJson = False) -> None:
    """Show the type of a service."""
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
        typer.Argument(help="Trigger or std_srvs/srv/Trigger.", metavar="TYPE", autocompletion=complete.service_types),
    ],
    count: Count = False,
    hidden: Hidden = False,
    as_json: AsJson = False,
) -> None:
    """List the services of a type."""
    from robolink.cli.shared.graph import show_of_type
    from robolink.cli.shared.session import looking

    with looking() as context:
        services = _types(context, hidden=hidden)
    show_of_type(services, type_, count=count, json=as_json)


@app.command("info")
def show_info(
    service: Service,
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Also show who serves and calls it.")] = False,
    as_json: AsJson = False,
) -> None:
    """Show a service's type, and how many serve and call it."""
    from robolink.cli.service.verbs import show

    show(service, verbose=verbose, as_json=as_json)


@app.command("call")
def call_service(
    ctx: typer.Context,
    service: Service,
    type_: Annotated[
        str,
        typer.Argument(
            help="Its type; found out when left out.", metavar="[TYPE]", autocompletion=complete.type_of_service
        ),
    ] = "",
    values: Annotated[
        str | None, typer.Argument(help="The request in YAML, such as '{data: true}'.", metavar="[VALUES]")
    ] = None,
    from_stdin: Annotated[bool, typer.Option("--stdin", help="Read the request from standard input.")] = False,
    rate: Annotated[float | None, typer.Option("--rate", "-r", metavar="HZ", help="Call again and again.")] = None,
    timeout: Annotated[
        float, typer.Option("--timeout", metavar="S", help="Give up after so many seconds without an answer.")
    ] = 5.0,
    node_name: Annotated[
        str, typer.Option("--node-name", "-n", metavar="NAME", help="Name of the node that calls.")
    ] = "",
    as_json: Annotated[bool, typer.Option("--json", help="A line of JSON for each call.")] = False,
) -> None:
    """Call a service and show what it answers."""
    from robolink.cli.service import verbs
    from robolink.cli.shared.messages import is_type, read_stdin

    if values is None and not is_type(type_):  # SERVICE VALUES: the type was left out
        type_, values = "", type_
    if from_stdin and values:
        ctx.fail("either VALUES or --stdin, not both")
    manner = verbs.Manner(rate, timeout, as_json, node_name)
    if manner.problem():
        ctx.fail(manner.problem())
    verbs.call(service, type_, read_stdin("request") if from_stdin else values or "", manner)


@app.command("echo")
def echo_events(
    ctx: typer.Context,
    service: Service,
    type_: Annotated[
        str,
        typer.Argument(
            help="Its type; found out when left out.", metavar="[TYPE]", autocompletion=complete.type_of_service
        ),
    ] = "",
    once: Annotated[bool, typer.Option("--once", help="Show one event and end.")] = False,
    csv: Annotated[bool, typer.Option("--csv", help="All values of an event in a line, between commas.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="A line of JSON for each event.")] = False,
    full_length: Annotated[bool, typer.Option("--full-length", "-f", help="Shorten nothing.")] = False,
    length: Annotated[
        int, typer.Option("--truncate-length", "-l", metavar="N", help="Shorten what is longer.", min=0)
    ] = 128,
    no_arr: Annotated[bool, typer.Option("--no-arr", help="Of sequences, show only type and length.")] = False,
    no_str: Annotated[bool, typer.Option("--no-str", help="Of texts, show only the length.")] = False,
    flow: Annotated[bool, typer.Option("--flow-style", help="YAML in one line: {a: [1, 2]}.")] = False,
) -> None:
    """Show what a service and its clients say to each other, where introspection is on; until Ctrl-C."""
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
