"""robolink plot: draw where robots go, and values over time. Here are the arguments; the other files do the work."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from robolink.cli.shared import complete
from robolink.cli.shared.options import seconds

app = typer.Typer(
    no_args_is_help=True, help="Plot trajectories of robots, and fields of messages over time (needs matplotlib)."
)

Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", metavar="FILE", help="Write a .png, .svg or .pdf file instead of opening a window."),
]
Duration = Annotated[float | None, seconds("--duration", "Seconds to listen; until Ctrl-C by default.")]
Recording = Annotated[
    Path | None,
    typer.Option("--bag", metavar="FOLDER|FILE", help="Plot this bag instead of live topics."),
]
World = Annotated[
    str,
    typer.Option(
        "--world",
        metavar="NAME",
        help="World to draw below; the simulated one by default, 'none' for none.",
        autocompletion=complete.world_files,
    ),
]


@app.command("odom")
def plot_odometry(
    topics: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="TOPIC...",
            help="Topics such as /odom /ground_truth; all of a bag by default.",
            autocompletion=complete.topic_names,
        ),
    ] = None,
    out: Out = None,
    duration: Duration = None,
    world: World = "",
    bag: Recording = None,
) -> None:
    """Plot the trajectories of Odometry, PoseStamped and other messages with a pose."""
    from robolink.cli.plot import drawing, messages

    drawing.plot_trajectories(topics or [], drawing.POSES, world, messages.Request(out, duration, bag))


@app.command("path")
def plot_path(
    topics: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="TOPIC...",
            help="Topics of type nav_msgs/msg/Path, such as /plan; all of a bag by default.",
            autocompletion=complete.topic_names,
        ),
    ] = None,
    out: Out = None,
    duration: Duration = None,
    world: World = "",
    bag: Recording = None,
) -> None:
    """Plot the latest nav_msgs/msg/Path of topics, over the world."""
    from robolink.cli.plot import drawing, messages

    drawing.plot_trajectories(topics or [], drawing.PATHS, world, messages.Request(out, duration, bag))


@app.command("topic")
def plot_topic(
    fields: Annotated[
        list[str],
        typer.Argument(
            metavar="TOPIC.FIELD...",
            help="Fields such as /odom.twist.twist.linear.x or /cmd_vel/linear/x.",
            autocompletion=complete.topic_names,
        ),
    ],
    out: Out = None,
    duration: Duration = None,
    bag: Recording = None,
) -> None:
    """Plot fields of messages over time."""
    from robolink.cli.plot import drawing, messages

    drawing.plot_fields(fields, messages.Request(out, duration, bag))
