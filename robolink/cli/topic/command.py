"""robolink topic: see and send what nodes publish. Here are the arguments; the other files do the work."""

from __future__ import annotations

import sys

import typer

from robolink.cli.shared import options
from robolink.cli.topic import options as opt

app = typer.Typer(no_args_is_help=True, help="List topics, print and publish messages, measure rates.")


@app.command("list")
def list_topics(
    types: opt.ShowTypes = False,
    count: opt.Count = False,
    verbose: opt.Verbose = False,
    hidden: opt.Hidden = False,
    as_json: opt.AsJson = False,
) -> None:
    """List the topics that have publishers or subscriptions."""
    from robolink.cli.topic import listing

    listing.list_topics(types=types, count=count, verbose=verbose, hidden=hidden, json=as_json)


@app.command("info")
def show_info(
    topic: opt.Topic,
    verbose: opt.Verbose = False,
    as_json: opt.AsJson = False,
) -> None:
    """Show the type of a topic, and its publishers and subscriptions."""
    from robolink.cli.topic import listing

    listing.show_info(topic, verbose=verbose, json=as_json)


@app.command("type")
def show_type(topic: opt.Topic, as_json: opt.AsJson = False) -> None:
    """Print the type of a topic."""
    from robolink.cli.topic import listing

    listing.show_type(topic, json=as_json)


@app.command("find")
def find(
    type_: opt.Type,
    count: opt.Count = False,
    hidden: opt.Hidden = False,
    as_json: opt.AsJson = False,
) -> None:
    """List the topics of a message type."""
    from robolink.cli.topic import listing

    listing.find_topics(type_, count=count, hidden=hidden, json=as_json)


@app.command("hz")
def hz(
    ctx: typer.Context,
    topics: opt.TopicsOrAll = None,
    every: opt.AllTopics = False,
    window: int = opt.window(10_000),
    filter_: opt.Filter = "",
    wall_time: opt.WallTime = False,
    sim_time: opt.SimTime = False,
    as_json: opt.AsJson = False,
) -> None:
    """Print the publishing rate of topics, once a second."""
    from robolink.cli.topic import meters

    meters.hz(opt.topics_or_all(ctx, topics, every), meters.Flags(window, as_json, sim_time and not wall_time), filter_)


@app.command("bw")
def bw(
    ctx: typer.Context,
    topics: opt.TopicsOrAll = None,
    every: opt.AllTopics = False,
    window: int = opt.window(100, least=2),
    sim_time: opt.SimTime = False,
    as_json: opt.AsJson = False,
) -> None:
    """Print the bandwidth of topics, once a second."""
    from robolink.cli.topic import meters

    meters.bw(opt.topics_or_all(ctx, topics, every), meters.Flags(window, as_json, sim_time))


@app.command("delay")
def delay(
    topic: opt.Topic, window: int = opt.window(10_000), sim_time: opt.SimTime = False, as_json: opt.AsJson = False
) -> None:
    """Print the delay of messages since the stamp in their header, once a second."""
    from robolink.cli.topic import meters

    meters.delay(topic, meters.Flags(window, as_json, sim_time))


@app.command("echo")
def echo_messages(
    ctx: typer.Context,
    topic: opt.Topic,
    type_: opt.TypeOfTopic = "",
    once: opt.OneMessage = False,
    timeout: opt.Timeout = None,
    field: opt.Field = "",
    filter_: opt.Filter = "",
    csv: opt.Csv = False,
    as_json: opt.AsJson = False,
    raw: opt.Raw = False,
    info: opt.MessageInfo = False,
    full_length: options.FullLength = False,
    length: options.Length = 128,
    no_arr: options.NoArr = False,
    no_str: options.NoStr = False,
    flow: options.Flow = False,
    clear: opt.Clear = False,
    image: opt.AsImage = False,
    no_lost: opt.NoLost = False,
    node_name: opt.NodeName = "",
    qos_profile: opt.Profile = "",
    qos_depth: opt.Depth = None,
    qos_history: opt.History = "",
    qos_reliability: opt.Reliability = "",
    qos_durability: opt.Durability = "",
    qos_liveliness: opt.Liveliness = "",
    qos_lease: opt.Lease = None,
) -> None:
    """Print the messages of a topic, until Ctrl-C."""
    from robolink.cli.shared.messages import Style
    from robolink.cli.topic.echo import Format, Request, run

    opt.refuse_together(ctx, {"--csv": csv, "--json": as_json, "--raw": raw, "--image": image})
    opt.refuse_together(ctx, {"--raw": raw, "--field or --filter": field or filter_})
    if image:
        from robolink.cli.shared.picture import check_terminal

        check_terminal(sys.stdout.isatty())
    flags = opt.flags_of(ctx.params)
    style = Style(None if full_length else length, not no_arr, not no_str, flow)
    request = Request(type_, once, timeout, filter_, not no_lost, node_name, flags)
    run(topic, request, Format(field, style, as_json, csv, raw, info, clear or image, image))


@app.command("pub")
def publish(
    ctx: typer.Context,
    topic: opt.Topic,
    type_: opt.TypeOrValues = "",
    values: opt.Values = None,
    stdin: opt.Stdin = False,
    yaml_file: opt.YamlFile = "",
    once: opt.PublishOnce = False,
    rate: opt.Rate = 1.0,
    times: opt.Times = 0,
    wait: opt.Wait = None,
    max_wait: opt.MaxWait = None,
    keep_alive: opt.KeepAlive = 0.1,
    print_every: opt.PrintEvery = 1,
    node_name: opt.NodeName = "",
    sim_time: opt.SimTime = False,
    qos_profile: opt.Profile = "",
    qos_depth: opt.Depth = None,
    qos_history: opt.History = "",
    qos_reliability: opt.Reliability = "",
    qos_durability: opt.Durability = "",
    qos_liveliness: opt.Liveliness = "",
    qos_lease: opt.Lease = None,
) -> None:
    """Publish messages to a topic, until Ctrl-C. `header: auto` and `stamp: now` become the time of sending."""
    from robolink.cli.topic.pub import Request, run

    if values is None and opt.are_values(type_):
        type_, values = "", type_
    opt.refuse_together(ctx, {"--stdin": stdin, "--yaml-file": yaml_file, "VALUES": values is not None})
    opt.refuse_together(ctx, {"--once": once, "--times": times})
    flags = opt.flags_of(ctx.params)
    request = Request(rate, 1 if once else times, wait, max_wait, keep_alive, print_every, node_name, flags, sim_time)
    run(topic, type_, None if stdin or yaml_file else values or "{}", request, file=yaml_file)
