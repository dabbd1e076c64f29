"""robolink image: see and save what cameras publish. Here are the arguments; the other files do the work."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from robolink.cli.shared import complete
from robolink.cli.shared.options import seconds

app = typer.Typer(no_args_is_help=True, help="Show and save images of cameras.")

Topic = Annotated[
    str,
    typer.Argument(
        help="Topic of type Image or CompressedImage, such as /camera/image_raw.",
        metavar="TOPIC",
        autocompletion=complete.topic_names,
    ),
]
Timeout = Annotated[float | None, seconds("--timeout", "Exit after this number of seconds without an image.")]


@app.command("save")
def save(
    topic: Topic,
    file: Annotated[
        str, typer.Argument(metavar="[FILE]", help="File to write, .png or .jpg; {} is replaced by the number, from 1.")
    ] = "image_{}.png",
    count: Annotated[int, typer.Option("--count", "-c", metavar="N", help="Number of images.", min=1, max=10**6)] = 1,
    timeout: Timeout = None,
) -> None:
    """Save the next images of a topic to files. Depth images (32FC1, in m) are saved in mm, with 16 bits."""
    from robolink.cli.image.verbs import Files, each_image

    each_image(topic, count, timeout, Files(file, count).save)


@app.command("show")
def show(
    topic: Topic,
    once: Annotated[bool, typer.Option("--once", help="Show one image and exit.")] = False,
    timeout: Timeout = None,
) -> None:
    """Show the images of a topic in the terminal, until Ctrl-C; `robolink view` shows them in the browser."""
    from robolink.cli.image.verbs import each_image
    from robolink.cli.shared.output import clear, say
    from robolink.cli.shared.picture import PictureError, check_terminal, drawn
    from robolink.image import ImageError, to_array, to_message
    from robolink.interfaces.sensor_msgs.msg import CompressedImage

    check_terminal(sys.stdout.isatty())

    def draw(message: object) -> None:
        try:
            if isinstance(message, CompressedImage):
                message = to_message(to_array(message, "bgr8"))
            text = drawn(message)
        except (ImageError, PictureError) as error:
            if once:
                raise
            text = str(error)  # the next image may be a good one
        clear()
        say(text, colours=True)

    each_image(topic, 1 if once else None, timeout, draw)
