"""robolink tf: see where frames are in each other. Here are the arguments; the other files do the work."""

from __future__ import annotations

from typing import Annotated

import typer

from robolink.cli.shared.options import seconds

app = typer.Typer(no_args_is_help=True, help="Show transforms between frames, and the tree of frames.")

AsJson = Annotated[bool, typer.Option("--json", help="Print JSON; for messages and rates, one object a line.")]
TfTopic = Annotated[str, typer.Option("--tf-topic", metavar="TOPIC", help="Topic of the transforms.")]
StaticTopic = Annotated[str, typer.Option("--tf-static-topic", metavar="TOPIC", help="Topic of the static transforms.")]


@app.command("echo")
def echo_transform(
    source: Annotated[str, typer.Argument(metavar="SOURCE_FRAME", help="Reference frame, such as map.")],
    target: Annotated[
        str, typer.Argument(metavar="TARGET_FRAME", help="Frame whose pose is printed, such as base_link.")
    ],
    rate: Annotated[float, typer.Argument(metavar="[RATE]", help="Rate of the output, in Hz.")] = 1.0,
    once: Annotated[bool, typer.Option("--once", help="Print one transform and exit.")] = False,
    timeout: Annotated[float | None, seconds("--timeout", "Longest time to wait for a transform, in seconds.")] = None,
    as_json: AsJson = False,
) -> None:
    """Print the transform between two frames, as tf2_echo does: the pose of TARGET_FRAME in SOURCE_FRAME."""
    from robolink.cli.tf import watch

    watch.echo(source, target, watch.Request(rate, once, timeout, as_json))


@app.command("monitor")
def monitor_transforms(
    ctx: typer.Context,
    source: Annotated[
        str,
        typer.Argument(metavar="[SOURCE_FRAME]", help="First frame of the chain to monitor; all frames by default."),
    ] = "",
    target: Annotated[str, typer.Argument(metavar="[TARGET_FRAME]", help="Last frame of the chain.")] = "",
    period: Annotated[
        float, typer.Option("--period", metavar="S", help="Period of the reports, in seconds.", min=0.1)
    ] = 2.0,
    as_json: AsJson = False,
) -> None:
    """Print publishers, rates and delays of transforms, until Ctrl-C."""
    from robolink.cli.tf import watch

    if source and not target:
        ctx.fail("two frames, or none")
    watch.monitor(source, target, period, json=as_json)


@app.command("tree")
def show_tree(
    ctx: typer.Context,
    wait: Annotated[
        float, typer.Option("--wait-time", "-t", metavar="S", help="Seconds to listen.", min=0.05, max=1e6)
    ] = 1.0,
    tf_topic: TfTopic = "/tf",
    static_topic: StaticTopic = "/tf_static",
    dot: Annotated[bool, typer.Option("--dot", help="Print a graph for Graphviz: tree --dot | dot -Tpdf.")] = False,
    as_json: AsJson = False,
) -> None:
    """Print the tree of frames, with rates, ages, publishers and problems."""
    from robolink.cli.tf import tree

    if dot and as_json:
        ctx.fail("--dot and --json do not go together")
    tree.run(wait, (tf_topic, static_topic), "dot" if dot else "json" if as_json else "text")
