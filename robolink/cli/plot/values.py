"""Plots of fields of messages over time, for `robolink plot topic`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.cli.plot.record import PlotError, Wish, check, deadline, listen, show, wait_for
from robolink.cli.shared import messages as fields
from robolink.cli.shared.session import node_of, opened
from robolink.exceptions import EncodeError
from robolink.system import clocks
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.cli.plot.recorded import Recorded
    from robolink.context import Context
    from robolink.node import Node

NUMBERS = ("float", "int", "uint", "double", "bool", "byte", "char", "octet")


class Curve:
    """Curve of one field: its values, with their times of arrival and, if messages have them, stamps, in seconds."""

    def __init__(self, topic: str, field: str) -> None:
        self.topic, self.field = topic, field
        self.values: list[float] = []
        self.lacked = ""
        """Error of the last message without such a value."""
        self.arrived: list[float] = []
        self.stamped: list[float] = []

    @property
    def name(self) -> str:
        """Name of the curve: topic and field, as they were given."""
        return f"{self.topic}.{self.field}"

    def take(self, message: Any, arrived: float | None = None) -> None:
        """Add a message's value; one that lacks it, as a shorter sequence does, is left out.

        `arrived` is the time in seconds at which it came; None is now.
        """
        try:
            value = fields.field_of(message, self.field)
        except EncodeError as error:
            self.lacked = _without_option(error)
            return
        self.values.append(float(value[0] if isinstance(value, bytes) else value))  # ROS's byte is bytes
        self.arrived.append(clocks.monotonic() if arrived is None else arrived)
        stamp = getattr(getattr(message, "header", None), "stamp", None)
        if stamp is not None and (stamp.sec or stamp.nanosec):
            self.stamped.append(stamp.sec + stamp.nanosec * 1e-9)


def run(asked: list[str], wish: Wish) -> None:
    """Listen, or read the bag, and draw the values."""
    check(wish)
    curves = _from_network(asked, wish) if wish.bag is None else _from_bag(asked, wish.bag)
    if not any(curve.values for curve in curves):
        lacked = next((curve.lacked for curve in curves if curve.lacked), "")
        raise PlotError(lacked or f"nothing was heard on {', '.join({curve.topic: None for curve in curves})}")
    _draw([curve for curve in curves if curve.values], wish)


def _from_network(asked: list[str], wish: Wish) -> list[Curve]:
    """Return the curves of what is published until the time is over."""
    with opened() as context:
        node = node_of(context)
        until = deadline(wish)
        curves = [Curve(*_parted(node, each, until)) for each in dict.fromkeys(asked)]
        types = {curve.topic: wait_for(context, curve.topic, until) for curve in curves}
        for curve in curves:
            _check_number(types[curve.topic], curve)
        listen(node, {topic: (types[topic], _all_of(topic, curves)) for topic in types}, wish.duration)
    return curves


def _from_bag(asked: list[str], bag: Path) -> list[Curve]:
    """Return the curves of a recording."""
    from robolink.cli.plot.recorded import recorded

    with recorded(bag) as source:
        curves = [Curve(*_parted_in(source, each)) for each in dict.fromkeys(asked)]
        types = {curve.topic: source.type_of(curve.topic) for curve in curves}
        for curve in curves:
            _check_number(types[curve.topic], curve)
        source.hear({topic: (types[topic], _all_of(topic, curves)) for topic in types})
    return curves


def _parted_in(source: Recorded, asked: str) -> tuple[str, str]:
    """Split `/odom.pose.x` or `/odom/pose/x` into topic and field: the topic is the longest name in the bag."""
    if "." in asked:
        topic, _, field = asked.partition(".")
        return source.name_of(topic), field
    name, bracket, rest = asked.partition("[")
    parts = name.strip("/").split("/")
    topic = next((each for each in _prefixes(parts) if each in source.topics), "")
    if not topic:
        raise PlotError(f"'{asked}' names no field of a topic in the bag: write TOPIC.FIELD, as in /odom.x")
    return topic, ".".join(parts[topic.count("/") :]) + bracket + rest


def _prefixes(parts: list[str]) -> list[str]:
    """Return the names of topics that a name may begin with, the longest first."""
    return ["/" + "/".join(parts[:count]) for count in range(len(parts) - 1, 0, -1)]


def _all_of(topic: str, curves: Iterable[Curve]) -> Callable[..., None]:
    own = [curve for curve in curves if curve.topic == topic]

    def take(message: Any, arrived: float | None = None) -> None:
        for curve in own:
            curve.take(message, arrived)

    return take


def _parted(node: Node, asked: str, until: float | None) -> tuple[str, str]:
    """Split `/odom.pose.x` or `/odom/pose/x` into topic and field: the topic is the longest name that is published."""
    if "." in asked:
        topic, _, field = asked.partition(".")
        return node.resolve_topic_name(topic), field
    parts = node.resolve_topic_name(asked.split("[")[0]).strip("/").split("/")
    rest = asked[asked.index("[") :] if "[" in asked else ""
    prefixes = _prefixes(parts)

    def published() -> str:
        return next((each for each in prefixes if _is_published(node.context, each)), "")

    while not published():
        whole = "/" + "/".join(parts)
        if _is_published(node.context, whole):
            raise PlotError(f"{whole} is a topic: name a number in it, as in {whole}.FIELD")
        if not node.context.ok():
            raise KeyboardInterrupt
        if until is not None and clocks.monotonic() > until:
            raise PlotError(f"'{asked}' names no field of a topic that is published: write TOPIC.FIELD, as in /odom.x")
        node.context.graph.wait_for(lambda: bool(published()) or not node.context.ok(), 0.5)
    topic = published()
    return topic, ".".join(parts[topic.count("/") :]) + rest


def _is_published(context: Context, topic: str) -> bool:
    return bool(context.graph.endpoints(EndpointKind.PUBLISHER, name=topic))


def _check_number(msg_type: type[Any], curve: Curve) -> None:
    try:
        kind = fields.check_path(msg_type, curve.field)
    except EncodeError as error:
        raise PlotError(_without_option(error)) from None
    if kind.shape != "one":
        raise PlotError(f"{curve.name} is a sequence of {kind.base}: say which, as in {curve.name}[0]")
    if kind.message is not None or not kind.base.startswith(NUMBERS):
        if kind.message is None:
            raise PlotError(f"{curve.name} is not a number but {kind.base}")
        there = ", ".join(kind.message.__ros_fields__) or "none"
        raise PlotError(f"{curve.name} is not a number but {kind.message.__ros_type__}: name a field of it: {there}")


def _without_option(error: EncodeError) -> str:
    """Return an error about a field without the option `--field`, which it has in `topic echo`."""
    return str(error).removeprefix("--field ")


def _times(curves: list[Curve]) -> list[list[float]]:
    """Return the times of each curve's values: of the stamps if all messages had one, so that simulated time counts."""
    if all(len(curve.stamped) == len(curve.values) for curve in curves):
        return [curve.stamped for curve in curves]
    return [curve.arrived for curve in curves]


def _draw(curves: list[Curve], wish: Wish) -> None:
    import matplotlib.pyplot as plt

    times = _times(curves)
    start = min(map(min, times))
    figure, axes = plt.subplots(figsize=(9, 4.5))
    for curve, moments in zip(curves, times, strict=True):
        axes.plot([each - start for each in moments], curve.values, linewidth=1.4, label=curve.name)
    axes.set_xlabel("time [s]")
    axes.grid(alpha=0.3)
    if len(curves) > 1:
        axes.legend(frameon=False)
    else:
        axes.set_ylabel(curves[0].name)
    show(figure, wish)
    plt.close(figure)
