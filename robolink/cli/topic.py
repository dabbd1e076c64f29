"""robolink topic: see and send what nodes publish."""

from __future__ import annotations

from typing import Annotated

import typer

app = typer.Typer(no_args_is_help=True, help="See and send what nodes publish.")

Topic = Annotated[str, typer.Argument(help="Name of the topic, such as /scan.", metavar="TOPIC")]


@app.command("list")
def list_topics(
    show_types: Annotated[bool, typer.Option("--show-types", "-t", help="Also show the types.")] = False,
    count: Annotated[bool, typer.Option("--count-topics", "-c", help="Only say how many there are.")] = False,
    hidden: Annotated[bool, typer.Option("--include-hidden-topics", help="Also those that begin with _.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="A JSON object: name to types.")] = False,
) -> None:
    """List the topics that are published or subscribed to."""
    from robolink.cli.session import endpoints, is_hidden, opened, say
    from robolink.graph import names_and_types
    from robolink.wire import EndpointKind

    with opened() as context:
        found = [
            each for each in endpoints(context) if each.kind in (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
        ]
    topics = [each for each in names_and_types(found) if hidden or not is_hidden(each[0])]
    if as_json:
        import msgspec

        say(msgspec.json.encode(dict(topics)).decode())
    elif count:
        say(str(len(topics)))
    else:
        for name, types in topics:
            say(f"{name} [{', '.join(types)}]" if show_types else name)


@app.command("echo")
def echo(
    topic: Topic,
    type_: Annotated[str, typer.Argument(help="Its type; found out when left out.", metavar="[TYPE]")] = "",
    once: Annotated[bool, typer.Option("--once", help="Show one message and end.")] = False,
    field: Annotated[
        str, typer.Option("--field", metavar="A.B", help="Show only this field: linear.x, ranges[0].")
    ] = "",
    as_json: Annotated[bool, typer.Option("--json", help="A line of JSON for each message.")] = False,
    full_length: Annotated[bool, typer.Option("--full-length", "-f", help="Do not shorten long sequences.")] = False,
) -> None:
    """Show what is published on a topic, until Ctrl-C."""
    from robolink.cli.echo import Format, run

    run(topic, type_, once=once, form=Format(field, as_json, full_length))


@app.command("pub")
def publish(
    topic: Topic,
    type_: Annotated[
        str, typer.Argument(help="Twist, geometry_msgs/Twist or geometry_msgs/msg/Twist.", metavar="TYPE")
    ],
    values: Annotated[str, typer.Argument(help="YAML, such as '{linear: {x: 0.3}}'.", metavar="[VALUES]")] = "{}",
    once: Annotated[bool, typer.Option("--once", "-1", help="Publish one message and end.")] = False,
    rate: Annotated[float, typer.Option("--rate", "-r", metavar="HZ", help="Messages a second.")] = 1.0,
    times: Annotated[int, typer.Option("--times", "-t", metavar="N", help="Publish so many and end.", min=0)] = 0,
    wait: Annotated[
        int | None,
        typer.Option("--wait-matching-subscriptions", "-w", metavar="N", help="First wait for so many subscriptions."),
    ] = None,
    print_every: Annotated[int, typer.Option("--print", "-p", metavar="N", help="Print every Nth message.", min=1)] = 1,
) -> None:
    """Publish messages on a topic, until Ctrl-C."""
    from robolink.cli.pub import run

    run(topic, type_, values, rate=rate, times=1 if once else times, wait=wait, print_every=print_every)
