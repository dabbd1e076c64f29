"""Messages that are plotted: from topics while one listens, or from a bag."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.bag.metadata import FILE_NAME as METADATA
from robolink.bag.playing.publishers import class_of
from robolink.bag.reader import Bag, open_bag
from robolink.bag.storage.opening import ENDINGS
from robolink.cli.shared.graph import matching_qos
from robolink.cli.shared.messages import message_type
from robolink.cli.shared.output import tell
from robolink.cli.shared.picture import check_picture
from robolink.exceptions import ExternalShutdownException, RobolinkError, nearest
from robolink.executors import SingleThreadedExecutor
from robolink.serialization import deserialize_message
from robolink.system import clocks
from robolink.task import Future
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from robolink.context import Context
    from robolink.node import Node


WINDOW_NEEDED = "there is no screen to open a window on: give --out FILE.png"
DOTS_PER_INCH = 150
LEAST_WAIT = 5.0
"""Least time to wait for a publisher, in seconds."""
REPORTED_AFTER = 2.0
"""Delay until a note that a topic is waited for, in seconds."""


class PlotError(RobolinkError, ValueError):
    """A plot cannot be drawn, shown or written."""


class Request(NamedTuple):
    """Options of a plot: the picture's file (None: a window), the seconds to listen (None: until Ctrl-C), and a bag.

    With a bag nothing is listened to.
    """

    out: Path | None = None
    duration: float | None = None
    bag: Path | None = None


def check(request: Request) -> None:
    """Raise `PlotError` or `DrawingError`, before any listening, if the picture could not be made in the end."""
    if request.out is None:
        _check_window()
        return
    if not request.out.absolute().parent.is_dir():
        raise PlotError(f"no folder '{request.out.absolute().parent}' to write '{request.out.name}' to")
    check_picture(request.out)


def _check_window() -> None:
    from robolink.sim import drawing

    try:
        drawing.check_picture(Path("window.png"))  # needs what such a file would
        import matplotlib.pyplot as plt
    except drawing.DrawingError:
        raise
    except ValueError as error:
        raise PlotError(f"matplotlib does not start, see MPLBACKEND: {error}") from None
    if plt.get_backend().lower() == "agg":
        raise PlotError(WINDOW_NEEDED)


def deadline(request: Request) -> float | None:
    """Return the moment (of `clocks.monotonic`) until which there must be a publisher; None for no limit."""
    return None if request.duration is None else clocks.monotonic() + max(request.duration, LEAST_WAIT)


def wait_for(context: Context, topic: str, deadline: float | None) -> type[Any]:
    """Wait until a topic, named in full, has a publisher, and return its message class.

    Raises `PlotError` if there is none until `deadline` (of `clocks.monotonic`), and KeyboardInterrupt.
    """
    graph, begin, reported = context.graph, clocks.monotonic(), False

    def published() -> bool:
        return bool(graph.endpoints(EndpointKind.PUBLISHER, name=topic)) or not context.ok()

    if not published():
        refuse_bag(topic)
    while not published():
        left = None if deadline is None else deadline - clocks.monotonic()
        if left is not None and left <= 0:
            near = nearest(topic, {each.name for each in graph.endpoints(EndpointKind.PUBLISHER)})
            raise PlotError(f"nobody publishes {topic}{near}: see `robolink topic list`")
        graph.wait_for(published, min(0.5, left) if left is not None else 0.5)
        if not reported and clocks.monotonic() - begin > REPORTED_AFTER:
            tell(f"waiting for somebody to publish {topic}")
            reported = True
    if not context.ok():
        raise KeyboardInterrupt
    return message_type(context, topic)


def refuse_bag(topic: str) -> None:
    """Raise PlotError for a topic that nobody publishes and that is a bag in this folder: it was meant by that."""
    path = Path(topic.lstrip("/"))
    if (path / METADATA).is_file() or (path.is_file() and path.name.endswith(ENDINGS)):
        raise PlotError(f"nobody publishes {topic}, and '{path}' is a bag: write --bag {path}")


def listen(node: Node, topics: Mapping[str, tuple[type[Any], Callable[[Any], Any]]], duration: float | None) -> None:
    """Call each topic's function with its messages until `duration` has passed or Ctrl-C."""
    for name, (msg_type, take) in topics.items():
        node.create_subscription(msg_type, name, take, matching_qos(node.context, name))
    tell(f"listening to {', '.join(topics)}" + ("; Ctrl-C draws" if duration is None else f" for {duration:g} s"))
    with SingleThreadedExecutor(context=node.context) as executor:
        executor.add_node(node)
        try:
            executor.spin_until_future_complete(Future[None](), timeout_sec=duration)
        except (KeyboardInterrupt, ExternalShutdownException):
            tell("")


def show(figure: Figure, request: Request) -> None:
    """Write the picture to its file, or show it in a window until that is closed."""
    if request.out is not None:
        try:
            figure.savefig(request.out, dpi=DOTS_PER_INCH, bbox_inches="tight")
        except OSError as error:
            raise PlotError(f"{request.out}: cannot be written: {error.strerror or error}") from None
        tell(f"wrote {request.out}")
        return
    import matplotlib.pyplot as plt

    plt.show()


Take = Callable[[Any, float], Any]
"""Function that gets a message, and the time in seconds at which it was recorded."""


class Recorded:
    """Topics of an open bag.

    Args:
        bag: The bag.
    """

    def __init__(self, bag: Bag) -> None:
        self._bag = bag
        self._topics = {each.name: each for each in bag.topics}

    @property
    def topics(self) -> list[str]:
        """Names of the topics that have messages."""
        return [name for name in self._topics if self._bag.counts.get(name)]

    def name_of(self, requested: str) -> str:
        """Return the full name of a topic. Raises PlotError if the bag does not have it."""
        name = "/" + requested.lstrip("/")
        if name not in self._topics:
            known = ", ".join(self.topics[:10])
            raise PlotError(f"{self._bag.path} has no topic {name}{nearest(name, self._topics)}; it has {known}")
        return name

    def type_of(self, name: str) -> type[Any]:
        """Return the message class of a topic. Raises PlotError if the bag does not say what it is."""
        found = class_of(self._topics[name])
        if found is None:
            raise PlotError(f"{name} is of {self._topics[name].type_name}, which is neither installed nor in the bag")
        return found

    def hear(self, topics: Mapping[str, tuple[type[Any], Take]]) -> None:
        """Call each topic's function with its messages, in the order of the recording."""
        broken: dict[str, str] = {}
        for each in self._bag.messages(list(topics)):
            kind, take = topics[each.topic]
            try:
                message = deserialize_message(bytes(each.data), kind)
            except RobolinkError as error:
                broken.setdefault(each.topic, f"robolink: {each.topic}: {error}; it is left out")
                continue
            take(message, each.log_time * 1e-9)
        for line in [*broken.values(), *(f"robolink: {each}" for each in self._bag.problems)]:
            tell(line)


@contextlib.contextmanager
def recorded(path: Path) -> Iterator[Recorded]:
    """Open a bag while the block runs. Raises BagError if nothing of it can be read."""
    with open_bag(path) as bag:
        yield Recorded(bag)
