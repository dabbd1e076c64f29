"""robolink tf: see where frames are in each other. Here are the arguments; each verb's file does the work."""

from __future__ import annotations

from typing import Annotated

import typer

from robolink.cli.shared.options import seconds

app = typer.Typer(no_args_is_help=True, help="See where frames are in each other.")

AsJson = Annotated[bool, typer.Option("--json", help="JSON, for programs; of what goes on, a line each.")]
TfTopic = Annotated[str, typer.Option("--tf-topic", metavar="TOPIC", help="Where moving transforms come from.")]
StaticTopic = Annotated[str, typer.Option("--tf-static-topic", metavar="TOPIC", help="Where static ones come from.")]


@app.command("echo")
def echo_transform(
    source: Annotated[str, typer.Argument(metavar="SOURCE_FRAME", help="In this frame, such as map ...")],
    target: Annotated[str, typer.Argument(metavar="TARGET_FRAME", help="... where is this one, such as base_link?")],
    rate: Annotated[float, typer.Argument(metavar="[RATE]", help="Times a second.")] = 1.0,
    once: Annotated[bool, typer.Option("--once", help="Show one transform and end.")] = False,
    timeout: Annotated[float | None, seconds("--timeout", "Give up if there is none after so many seconds.")] = None,
    as_json: AsJson = False,
) -> None:
    """Show where TARGET_FRAME is in SOURCE_FRAME, again and again. Arguments and output are those of tf2_echo."""
    from robolink.cli.tf import watch

    watch.echo(source, target, watch.Wish(rate, once, timeout, as_json))


@app.command("monitor")
def monitor_transforms(
    ctx: typer.Context,
    source: Annotated[str, typer.Argument(metavar="[SOURCE_FRAME]", help="Only the chain from this frame ...")] = "",
    target: Annotated[str, typer.Argument(metavar="[TARGET_FRAME]", help="... to this one.")] = "",
    period: Annotated[float, typer.Option("--period", metavar="S", help="Seconds between two reports.", min=0.1)] = 2.0,
    as_json: AsJson = False,
) -> None:
    """Show who publishes transforms, how often, and how late they come, until Ctrl-C."""
    from robolink.cli.tf import watch

    if source and not target:
        ctx.fail("two frames, or none")
    watch.monitor(source, target, period, json=as_json)


@app.command("tree")
def show_tree(
    ctx: typer.Context,
    wait: Annotated[
        float, typer.Option("--wait-time", "-t", metavar="S", help="Listen for so many seconds.", min=0.05, max=1e6)
    ] = 1.0,
    tf_topic: TfTopic = "/tf",
    static_topic: StaticTopic = "/tf_static",
    dot: Annotated[bool, typer.Option("--dot", help="As a graph for Graphviz: tree --dot | dot -Tpdf.")] = False,
    as_json: AsJson = False,
) -> None:
    """Show all frames as a tree: rates, ages, publishers, and what is wrong with it."""
    from robolink.cli.tf import tree

    if dot and as_json:
        ctx.fail("--dot and --json do not go together")
    tree.run(wait, (tf_topic, static_topic), "dot" if dot else "json" if as_json else "text")
