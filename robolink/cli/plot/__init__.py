"""robolink plot: draw where robots go, and values over time. Here are the arguments; each verb's file does the work."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from robolink.cli.shared import complete
from robolink.cli.shared.options import seconds

app = typer.Typer(no_args_is_help=True, help="Draw where robots go, and values over time (needs matplotlib).")

Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", metavar="FILE", help="Write a .png, .svg or .pdf instead of opening a window."),
]
Duration = Annotated[
    float | None, seconds("--duration", "Draw after so many seconds of listening; without it, after Ctrl-C.")
]
Recording = Annotated[
    Path | None,
    typer.Option("--bag", metavar="FOLDER|FILE", help="Draw what this bag recorded, instead of listening."),
]
World = Annotated[
    str,
    typer.Option(
        "--world",
        metavar="NAME",
        help="Draw over this world; by default the one that is simulated; 'none' for none.",
        autocompletion=complete.world_files,
    ),
]


@app.command("odom")
def plot_odometry(
    topics: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="TOPIC...",
            help="Such as /odom /ground_truth; of a bag by default all.",
            autocompletion=complete.topic_names,
        ),
    ] = None,
    out: Out = None,
    duration: Duration = None,
    world: World = "",
    bag: Recording = None,
) -> None:
    """Draw the way of whatever messages say where something is: Odometry, PoseStamped and the like."""
    from robolink.cli.plot import drawing, messages

    drawing.plot_trajectories(topics or [], drawing.POSES, world, messages.Wish(out, duration, bag))


@app.command("path")
def plot_path(
    topics: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="TOPIC...",
            help="Of nav_msgs/msg/Path, such as /plan; of a bag by default all.",
            autocompletion=complete.topic_names,
        ),
    ] = None,
    out: Out = None,
    duration: Duration = None,
    world: World = "",
    bag: Recording = None,
) -> None:
    """Draw the paths that were published last, over the world."""
    from robolink.cli.plot import drawing, messages

    drawing.plot_trajectories(topics or [], drawing.PATHS, world, messages.Wish(out, duration, bag))


@app.command("topic")
def plot_topic(
    fields: Annotated[
        list[str],
        typer.Argument(
            metavar="TOPIC.FIELD...",
            help="Such as /odom.twist.twist.linear.x or /cmd_vel/linear/x.",
            autocompletion=complete.topic_names,
        ),
    ],
    out: Out = None,
    duration: Duration = None,
    bag: Recording = None,
) -> None:
    """Draw values over time."""
    from robolink.cli.plot import drawing, messages

    drawing.plot_fields(fields, messages.Wish(out, duration, bag))
