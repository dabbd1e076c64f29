"""Plots of trajectories over the world, for `robolink plot odom` and `plot path`."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from robolink.cli.plot.record import PlotError, Wish, check, deadline, listen, show, wait_for
from robolink.cli.shared.graph import nodes
from robolink.cli.shared.output import tell
from robolink.cli.shared.session import node_of, opened
from robolink.exceptions import RobolinkError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from robolink.cli.plot.recorded import Recorded
    from robolink.node import Node
    from robolink.sim import WorldDescription

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


def run(topics: list[str], kind: Kind, world: str, wish: Wish) -> None:
    """Listen, or read the bag, and draw the trajectories."""
    check(wish)
    if wish.bag is not None:
        _run_bag(topics, kind, world, wish, wish.bag)
        return
    if not topics:
        raise PlotError("name the topics to draw, such as /odom, or a bag: --bag FOLDER")
    with opened() as context:
        node = node_of(context)
        until = deadline(wish)
        ways = {name: Way(name, kind) for name in map(node.resolve_topic_name, dict.fromkeys(topics))}
        heard = {name: (_fitting(wait_for(context, name, until), name, kind), ways[name].take) for name in ways}
        description = _world(node, world)
        listen(node, heard, wish.duration)
    if not any(way.points for way in ways.values()):
        raise PlotError(f"nothing was heard on {', '.join(ways)}")
    _draw(ways.values(), description, wish)


def _run_bag(topics: list[str], kind: Kind, world: str, wish: Wish, bag: Path) -> None:
    """Draw what a bag has: the topics that are named, or all that say where something is."""
    from robolink.cli.plot.recorded import recorded

    with recorded(bag) as source:
        names = [source.name_of(each) for each in dict.fromkeys(topics)] or _all_fitting(source, kind)
        ways = {name: Way(name, kind) for name in names}
        source.hear({name: (_fitting(source.type_of(name), name, kind), ways[name].take) for name in ways})
    if not any(way.points for way in ways.values()):
        found = f"no message on {', '.join(ways)} has a place" if ways else f"no topic has {kind.expected}"
        raise PlotError(f"{bag}: nothing to draw: {found}")
    description = None if world in ("", NO_WORLD) else _world_named(world)
    _draw(ways.values(), description, wish)


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


def _world(node: Node, asked: str) -> WorldDescription | None:
    """Return the world to draw over: the one that is named, or else the one that the node /world simulates.

    Raises what `find_world` and `load_world` raise for a world that was asked for by name.
    """
    name = "" if asked == NO_WORLD else asked or _simulated(node)
    if not name:
        return None
    try:
        return _world_named(name)
    except RobolinkError as error:
        if asked:
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


def _draw(ways: Iterable[Way], world: WorldDescription | None, wish: Wish) -> None:
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
    show(figure, wish)
    plt.close(figure)


def _draw_way(axes: Axes, way: Way, color: str) -> None:
    """Draw a trajectory from its beginning, a ring, to its end, a dot."""
    xs, ys = zip(*way.points, strict=True)
    length = sum(math.dist(a, b) for a, b in zip(way.points, way.points[1:], strict=False))
    axes.plot(xs, ys, color=color, linewidth=1.8, label=f"{way.topic}: {length:.2f} m", zorder=5)
    axes.plot(xs[:1], ys[:1], "o", color=color, markerfacecolor="white", markersize=7, zorder=6)
    axes.plot(xs[-1:], ys[-1:], "o", color=color, markersize=7, zorder=6)
