"""Figures: values over time, and trajectories over the world."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from robolink.cli.plot.messages import PlotError, Request, check, deadline, listen, show, wait_for
from robolink.cli.shared import messages as fields
from robolink.cli.shared.graph import nodes
from robolink.cli.shared.output import tell
from robolink.cli.shared.session import node_of, opened
from robolink.exceptions import EncodeError, RobolinkError
from robolink.system import clocks
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from robolink.cli.plot.messages import Recorded
    from robolink.context import Context
    from robolink.node import Node
    from robolink.sim import WorldDescription


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


def plot_fields(requested: list[str], request: Request) -> None:
    """Listen, or read the bag, and draw the values."""
    check(request)
    curves = _from_network(requested, request) if request.bag is None else _from_bag(requested, request.bag)
    if not any(curve.values for curve in curves):
        lacked = next((curve.lacked for curve in curves if curve.lacked), "")
        raise PlotError(lacked or f"nothing was heard on {', '.join({curve.topic: None for curve in curves})}")
    _draw([curve for curve in curves if curve.values], request)


def _from_network(requested: list[str], request: Request) -> list[Curve]:
    """Return the curves of what is published until the time is over."""
    with opened() as context:
        node = node_of(context)
        until = deadline(request)
        curves = [Curve(*_parted(node, each, until)) for each in dict.fromkeys(requested)]
        types = {curve.topic: wait_for(context, curve.topic, until) for curve in curves}
        for curve in curves:
            _check_number(types[curve.topic], curve)
        listen(node, {topic: (types[topic], _all_of(topic, curves)) for topic in types}, request.duration)
    return curves


def _from_bag(requested: list[str], bag: Path) -> list[Curve]:
    """Return the curves of a recording."""
    from robolink.cli.plot.messages import recorded

    with recorded(bag) as source:
        curves = [Curve(*_parted_in(source, each)) for each in dict.fromkeys(requested)]
        types = {curve.topic: source.type_of(curve.topic) for curve in curves}
        for curve in curves:
            _check_number(types[curve.topic], curve)
        source.hear({topic: (types[topic], _all_of(topic, curves)) for topic in types})
    return curves


def _parted_in(source: Recorded, requested: str) -> tuple[str, str]:
    """Split `/odom.pose.x` or `/odom/pose/x` into topic and field: the topic is the longest name in the bag."""
    if "." in requested:
        topic, _, field = requested.partition(".")
        return source.name_of(topic), field
    name, bracket, rest = requested.partition("[")
    parts = name.strip("/").split("/")
    topic = next((each for each in _prefixes(parts) if each in source.topics), "")
    if not topic:
        raise PlotError(f"'{requested}' names no field of a topic in the bag: write TOPIC.FIELD, as in /odom.x")
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


def _parted(node: Node, requested: str, until: float | None) -> tuple[str, str]:
    """Split `/odom.pose.x` or `/odom/pose/x` into topic and field: the topic is the longest name that is published."""
    if "." in requested:
        topic, _, field = requested.partition(".")
        return node.resolve_topic_name(topic), field
    parts = node.resolve_topic_name(requested.split("[")[0]).strip("/").split("/")
    rest = requested[requested.index("[") :] if "[" in requested else ""
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
            raise PlotError(
                f"'{requested}' names no field of a topic that is published: write TOPIC.FIELD, as in /odom.x"
            )
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


def _draw(curves: list[Curve], request: Request) -> None:
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
    show(figure, request)
    plt.close(figure)


Point: TypeAlias = "tuple[float, float]"

WORLD_NODE = "world"
ANSWER_WITHIN = 2.0
NO_WORLD = "none"


class Kind(NamedTuple):
    """Kind of trajectory: how a message becomes points, and if they replace those before or are added to them."""

    points: Callable[[Any], list[Point]]
    replaces: bool
    expected: str


def positions(message: Any) -> list[Point]:
    """Return the positions in a message; none if it has no position.

    Understands all messages that hold a pose, a position or a translation, at most two levels deep, and those that
    are one themselves, such as geometry_msgs/msg/Point or turtlesim/msg/Pose.
    """
    for name in ("pose", "pose", "position", "transform", "translation", "point"):
        message = getattr(message, name, message)
    x, y = getattr(message, "x", None), getattr(message, "y", None)
    return [(x, y)] if isinstance(x, float) and isinstance(y, float) and math.isfinite(x) and math.isfinite(y) else []


def path_points(message: Any) -> list[Point]:
    """Return the points of a nav_msgs/msg/Path, or of any message with a list of `poses`."""
    return [point for pose in getattr(message, "poses", ()) for point in positions(pose)]


POSES = Kind(positions, False, "a position, such as nav_msgs/msg/Odometry or geometry_msgs/msg/PoseStamped")
PATHS = Kind(path_points, True, "a list of poses, such as nav_msgs/msg/Path")


class Way:
    """Trajectory from one topic, as far as it is known."""

    def __init__(self, topic: str, kind: Kind) -> None:
        self.topic, self.kind = topic, kind
        self.points: list[Point] = []

    def take(self, message: Any, _: float = 0.0) -> None:
        """Add the points of a message."""
        new = self.kind.points(message)
        self.points = new if self.kind.replaces else self.points + new if len(new) != 1 else self._with(new[0])

    def _with(self, point: Point) -> list[Point]:
        if not self.points or self.points[-1] != point:  # a robot that stands still adds nothing to its way
            self.points.append(point)
        return self.points


def plot_trajectories(topics: list[str], kind: Kind, world: str, request: Request) -> None:
    """Listen, or read the bag, and draw the trajectories."""
    check(request)
    if request.bag is not None:
        _run_bag(topics, kind, world, request, request.bag)
        return
    if not topics:
        raise PlotError("name the topics to draw, such as /odom, or a bag: --bag FOLDER")
    with opened() as context:
        node = node_of(context)
        until = deadline(request)
        ways = {name: Way(name, kind) for name in map(node.resolve_topic_name, dict.fromkeys(topics))}
        heard = {name: (_fitting(wait_for(context, name, until), name, kind), ways[name].take) for name in ways}
        description = _world(node, world)
        listen(node, heard, request.duration)
    if not any(way.points for way in ways.values()):
        raise PlotError(f"nothing was heard on {', '.join(ways)}")
    _draw_trajectories(ways.values(), description, request)


def _run_bag(topics: list[str], kind: Kind, world: str, request: Request, bag: Path) -> None:
    """Draw what a bag has: the topics that are named, or all that say where something is."""
    from robolink.cli.plot.messages import recorded

    with recorded(bag) as source:
        names = [source.name_of(each) for each in dict.fromkeys(topics)] or _all_fitting(source, kind)
        ways = {name: Way(name, kind) for name in names}
        source.hear({name: (_fitting(source.type_of(name), name, kind), ways[name].take) for name in ways})
    if not any(way.points for way in ways.values()):
        found = f"no message on {', '.join(ways)} has a place" if ways else f"no topic has {kind.expected}"
        raise PlotError(f"{bag}: nothing to draw: {found}")
    description = None if world in ("", NO_WORLD) else _world_named(world)
    _draw_trajectories(ways.values(), description, request)


def _all_fitting(source: Recorded, kind: Kind) -> list[str]:
    """Return the names of the topics whose messages are of this kind of trajectory."""
    found = []
    for name in source.topics:
        with contextlib.suppress(PlotError):
            _fitting(source.type_of(name), name, kind)
            found.append(name)
    return found


def _fitting(msg_type: type[Any], topic: str, kind: Kind) -> type[Any]:
    """Return a topic's class if its messages have points, which a default message shows. Else raise PlotError."""
    blank = msg_type()
    if kind.points(blank) or (kind.replaces and hasattr(blank, "poses")):
        return msg_type
    raise PlotError(f"{topic} is of {msg_type.__ros_type__}: expected one with {kind.expected}")


def _world(node: Node, requested: str) -> WorldDescription | None:
    """Return the world to draw over: the one that is named, or else the one that the node /world simulates.

    Raises what `find_world` and `load_world` raise for a world that was asked for by name.
    """
    name = "" if requested == NO_WORLD else requested or _simulated(node)
    if not name:
        return None
    try:
        return _world_named(name)
    except RobolinkError as error:
        if requested:
            raise
        tell(f"robolink: drawn without the world: {error}")
        return None


def _world_named(name: str) -> WorldDescription:
    from robolink.documents.foreign import warnings_to
    from robolink.sim import load_world
    from robolink.workspace import find_world

    with warnings_to(lambda line: tell(f"robolink: {line}")):
        return load_world(find_world(name))


def _simulated(node: Node) -> str:
    """Return the name of the world, from the node that simulates it; '' if there is none or it does not answer."""
    from robolink.executors import SingleThreadedExecutor
    from robolink.parameter_client import AsyncParameterClient

    found = sorted(each.full_node_name for each in nodes(node.context) if each.node_name == WORLD_NODE)
    if not found:
        return ""
    client = AsyncParameterClient(node, found[0])
    future = client.get_parameters(["world"])
    with SingleThreadedExecutor(context=node.context) as executor:
        executor.add_node(node)
        executor.spin_until_future_complete(future, timeout_sec=ANSWER_WITHIN)
        executor.remove_node(node)
    answer = future.result() if future.done() else None
    return answer.values[0].string_value if answer is not None and answer.values else ""


def _draw_trajectories(ways: Iterable[Way], world: WorldDescription | None, request: Request) -> None:
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7, 7))
    if world is not None:
        from robolink.sim.drawing import draw_world

        draw_world(axes, world)
    for number, way in enumerate(each for each in ways if each.points):
        _draw_way(axes, way, f"C{number}")
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False)
    show(figure, request)
    plt.close(figure)


def _draw_way(axes: Axes, way: Way, color: str) -> None:
    """Draw a trajectory from its beginning, a ring, to its end, a dot."""
    xs, ys = zip(*way.points, strict=True)
    length = sum(math.dist(a, b) for a, b in zip(way.points, way.points[1:], strict=False))
    axes.plot(xs, ys, color=color, linewidth=1.8, label=f"{way.topic}: {length:.2f} m", zorder=5)
    axes.plot(xs[:1], ys[:1], "o", color=color, markerfacecolor="white", markersize=7, zorder=6)
    axes.plot(xs[-1:], ys[-1:], "o", color=color, markersize=7, zorder=6)
