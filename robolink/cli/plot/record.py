"""What all plots share: listen to topics for a while, and turn what was heard into a picture."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli.output import tell
from robolink.cli.pictures import check_picture
from robolink.cli.topic.echo import matching_qos
from robolink.cli.types import message_type
from robolink.exceptions import RobolinkError, nearest
from robolink.executors import SingleThreadedExecutor
from robolink.task import Future
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from robolink.context import Context
    from robolink.node import Node

WINDOW_NEEDED = "there is no screen to open a window on: give --out FILE.png"
DOTS_PER_INCH = 150
LEAST_WAIT = 5.0
"""Seconds that somebody has at least to begin to publish."""
TOLD_AFTER = 2.0
"""Seconds until it is said that a topic is waited for."""


class PlotError(RobolinkError, ValueError):
    """Something that cannot be drawn."""


class Wish(NamedTuple):
    """Where the picture goes (None: into a window), and how many seconds to listen (None: until Ctrl-C)."""

    out: Path | None = None
    duration: float | None = None


def check(wish: Wish) -> None:
    """Raise `PlotError` or `DrawingError` before any listening when the picture could not be made in the end."""
    if wish.out is None:
        _check_window()
        return
    if not wish.out.absolute().parent.is_dir():
        raise PlotError(f"no folder '{wish.out.absolute().parent}' to write '{wish.out.name}' to")
    check_picture(wish.out)


def _check_window() -> None:
    from robolink import drawing

    try:
        drawing.check_picture(Path("window.png"))  # needs what such a file would
        import matplotlib.pyplot as plt
    except drawing.DrawingError:
        raise
    except ValueError as error:
        raise PlotError(f"matplotlib does not start, see MPLBACKEND: {error}") from None
    if plt.get_backend().lower() == "agg":
        raise PlotError(WINDOW_NEEDED)


def deadline(wish: Wish) -> float | None:
    """Give the moment (of `time.monotonic`) until which somebody must publish; None while there is no hurry."""
    return None if wish.duration is None else time.monotonic() + max(wish.duration, LEAST_WAIT)


def wait_for(context: Context, topic: str, deadline: float | None) -> type[Any]:
    """Wait until somebody publishes a topic, named in full, and give its message class.

    Raises `PlotError` when nobody does until `deadline` (of `time.monotonic`), and KeyboardInterrupt.
    """
    graph, begin, told = context.graph, time.monotonic(), False

    def published() -> bool:
        return bool(graph.endpoints(EndpointKind.PUBLISHER, name=topic)) or not context.ok()

    while not published():
        left = None if deadline is None else deadline - time.monotonic()
        if left is not None and left <= 0:
            near = nearest(topic, {each.name for each in graph.endpoints(EndpointKind.PUBLISHER)})
            raise PlotError(f"nobody publishes {topic}{near}: see `robolink topic list`")
        graph.wait_for(published, min(0.5, left) if left is not None else 0.5)
        if not told and time.monotonic() - begin > TOLD_AFTER:
            tell(f"waiting for somebody to publish {topic}")
            told = True
    if not context.ok():
        raise KeyboardInterrupt
    return message_type(context, topic)


def listen(node: Node, topics: Mapping[str, tuple[type[Any], Callable[[Any], Any]]], duration: float | None) -> None:
    """Call each topic's function with its messages until `duration` has passed or Ctrl-C."""
    for name, (msg_type, take) in topics.items():
        node.create_subscription(msg_type, name, take, matching_qos(node.context, name))
    tell(f"listening to {', '.join(topics)}" + ("; Ctrl-C draws" if duration is None else f" for {duration:g} s"))
    with SingleThreadedExecutor(context=node.context) as executor:
        executor.add_node(node)
        try:
            executor.spin_until_future_complete(Future[None](), timeout_sec=duration)
        except KeyboardInterrupt:
            tell("")


def show(figure: Figure, wish: Wish) -> None:
    """Write the picture to its file, or show it in a window until that is closed."""
    if wish.out is not None:
        try:
            figure.savefig(wish.out, dpi=DOTS_PER_INCH, bbox_inches="tight")
        except OSError as error:
            raise PlotError(f"{wish.out}: cannot be written: {error.strerror or error}") from None
        tell(f"wrote {wish.out}")
        return
    import matplotlib.pyplot as plt

    plt.show()
