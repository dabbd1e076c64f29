"""Draws worlds with matplotlib: into axes of one's own, or into a picture file.

    draw_world(axes, load_world("configs/worlds/lab.yaml"))
    save_world(load_world("configs/worlds/lab.yaml"), Path("lab.png"))

matplotlib is an optional part: `pip install matplotlib`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.exceptions import RobolinkError
from robolink.geometry.plane import Pose, placed_on
from robolink.sim.colours import colour_of, hex_of
from robolink.sim.description import MapWalls, Obstacle, RobotDescription, Shape, Sign, WorldDescription
from robolink.sim.looks import KINDS, extent, kind_of, obstacle_colour, robot_colour, wall_colour
from robolink.sim.quantities import Point
from robolink.sim.sensors import Bumper, Looking

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patches import Patch

FORMATS = (".png", ".svg", ".pdf")

INK, VIEW, TOUCH, SIGN = "#222222", "#009E73", "#E69F00", "#C2185B"
"""Colours of outlines, tyres and names, of what a sensor sees or feels, and of signs."""

_INCH = 100.0
"""Resolution of a picture, in pixels to an inch."""

_NARROWEST = 2.5
"""Least size of a picture in both directions, in inches."""

_NAMED = 30
"""Most robots whose names are written beside them, and most tags."""

_FINEST = 2000
"""Most pixels of the floor's image along a side, of which others are left out."""


class DrawingError(RobolinkError, ValueError):
    """A picture that cannot be drawn; the text says why, and what to do."""


def check_picture(path: Path) -> None:
    """Raise `DrawingError` if no picture can be drawn into such a file, or if matplotlib is not installed."""
    if path.suffix.lower() not in FORMATS:
        raise DrawingError(f"'{path.name}' is not a picture that can be drawn: end its name in {', '.join(FORMATS)}")
    try:
        import matplotlib as _  # noqa: F401
    except ImportError:
        raise DrawingError("drawing needs matplotlib, which is not installed: pip install matplotlib") from None


def save_world(description: WorldDescription, path: Path, size: int = 1000) -> None:
    """Draw a world into a picture file; no window is opened.

    Args:
        description: The world.
        path: The file: .png, .svg or .pdf.
        size: Length of the picture's longer side, in pixels (or hundredths of an inch).

    Raises:
        DrawingError: if it is another kind of file, or matplotlib is not installed.
        OSError: if the file cannot be written.
    """
    check_picture(path)
    from matplotlib.figure import Figure

    figure = Figure(figsize=_figure_size(description, size / _INCH), dpi=_INCH, layout="constrained")
    axes = figure.add_subplot()
    kinds = draw_world(axes, description)
    axes.set_title(description.world.name)
    if len(kinds) > 1:
        figure.legend(handles=kinds, loc="outside lower center", ncols=len(kinds), frameon=False)
    figure.savefig(path)


def draw_world(axes: Axes, description: WorldDescription) -> list[Patch]:
    """Draw a world at its start: floor, walls, obstacles and their paths, signs, robots with headings and sensors.

    One metre is as long in both directions.

    Args:
        axes: The axes of matplotlib to draw into.
        description: The world.

    Returns:
        Handles for a legend: one for each kind of obstacle that there is without a colour of its own.
    """
    from matplotlib.patches import Patch

    _draw_floor(axes, description)
    _draw_walls(axes, description)
    for obstacle in description.obstacles:
        _draw_obstacle(axes, obstacle)
    for sign, origin in _signs(description):
        _draw_sign(axes, sign, origin, named=len(description.signs) <= _NAMED)
    for robot in description.robots:
        _draw_robot(axes, robot, named=len(description.robots) <= _NAMED)
    area = extent(description)
    axes.update_datalim([area[:2], area[2:]])
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.set_axisbelow(True)
    axes.grid(color="#E5E5E5", linewidth=0.6)
    kinds = {kind_of(each) for each in description.obstacles if each.colour is None}
    return [Patch(facecolor=hex_of(KINDS[kind]), edgecolor=INK, label=kind) for kind in KINDS if kind in kinds]


def _draw_floor(axes: Axes, description: WorldDescription) -> None:
    """Draw the floor's colour, and its image with all paint."""
    settings = description.world.floor
    if settings.colour is not None:
        axes.set_facecolor(hex_of(colour_of(settings.colour)))
    if not description.paint and settings.image is None:
        return
    from robolink.sim.scene.floor import painted_floor
    from robolink.sim.scene.pictures import read_picture

    picture = None if settings.image is None else read_picture(settings.image)
    floor = painted_floor(settings, description.paint, picture)
    if floor.image is None:
        return
    (rows, columns), (x, y) = floor.image.shape[:2], floor.origin
    every = -(-max(rows, columns) // _FINEST)
    extent = (x, x + columns * floor.resolution, y, y + rows * floor.resolution)
    axes.imshow(floor.image[::every, ::every], extent=extent, origin="lower", zorder=0)


def _signs(description: WorldDescription) -> Iterator[tuple[Sign, Pose]]:
    """Yield all signs, each with the pose of the frame that its own pose is in."""
    yield from ((sign, Pose()) for sign in description.signs)
    for obstacle in description.obstacles:
        yield from ((sign, obstacle.start.place) for sign in obstacle.signs)
    for robot in description.robots:
        yield from ((sign, robot.pose.place) for sign in robot.signs)


def _draw_sign(axes: Axes, sign: Sign, origin: Pose, *, named: bool) -> None:
    """Draw a sign's plate from above, with a short line to where it looks."""
    from matplotlib.patheffects import withStroke

    at = placed_on(origin, sign.pose.place)
    for end, width in ((Pose(0.0, sign.size / 2), 3.0), (Pose(0.0, -sign.size / 2), 3.0), (Pose(sign.size / 2), 1.5)):
        there = placed_on(at, end)
        axes.plot([at.x, there.x], [at.y, there.y], color=SIGN, linewidth=width, zorder=5, solid_capstyle="butt")
    if named and sign.tag is not None:
        beside = placed_on(at, Pose(sign.size))
        text = axes.text(beside.x, beside.y, sign.tag, size=7, color=SIGN, ha="center", va="center", zorder=9)
        text.set_path_effects([withStroke(linewidth=2, foreground="white")])


def _draw_walls(axes: Axes, description: WorldDescription) -> None:
    from matplotlib.collections import LineCollection
    from matplotlib.patheffects import withStroke

    for wall in description.walls:
        width = 1.0 if isinstance(wall, MapWalls) else 2.0
        colour = hex_of(wall_colour(wall))
        lines = LineCollection(wall.segments(), colors=colour, linewidths=width, capstyle="round", zorder=3)
        if wall.colour is not None:  # a light one is seen on a light floor, too
            lines.set_path_effects([withStroke(linewidth=width + 1.5, foreground=INK)])
        axes.add_collection(lines, autolim=True)


def _draw_obstacle(axes: Axes, obstacle: Obstacle) -> None:
    if obstacle.path is not None:
        points = [*obstacle.path, obstacle.path[0]] if obstacle.closed else obstacle.path
        colour = hex_of(KINDS[kind_of(obstacle)])
        axes.plot(*zip(*points, strict=True), linestyle=(0, (5, 4)), color=colour, linewidth=1.2, zorder=2)
    style = {"facecolor": hex_of(obstacle_colour(obstacle)), "edgecolor": INK, "linewidth": 0.8, "zorder": 4}
    axes.add_patch(_outline(obstacle, obstacle.start.place, style))


def _draw_robot(axes: Axes, robot: RobotDescription, *, named: bool) -> None:
    for sensor in robot.sensors:
        if isinstance(sensor, Looking):
            _draw_view(axes, robot, sensor)
    style = {"facecolor": hex_of(robot_colour(robot)), "edgecolor": INK, "linewidth": 0.8, "zorder": 6}
    parts = [_outline(robot.shape, robot.pose.place, style)]
    for wheel in robot.wheels:
        tyre = Shape(box=(2 * wheel.radius, max(wheel.radius / 2, 0.005)))
        parts.append(_outline(tyre, placed_on(robot.pose.place, wheel.at.place), {"facecolor": INK, "zorder": 7}))
    for part in parts:
        axes.add_patch(part)
    front = robot.shape.circle or max(x for x, _ in robot.shape.corners())
    nose = placed_on(robot.pose.place, Pose(front))
    axes.plot([robot.pose.x, nose.x], [robot.pose.y, nose.y], color="white", linewidth=1.6, zorder=8)
    if named:
        _write_name(axes, robot.name, parts)


def _write_name(axes: Axes, name: str, parts: Sequence[Patch]) -> None:
    """Write a robot's name below all its parts, readable on whatever lies there."""
    from matplotlib.patheffects import withStroke
    from matplotlib.transforms import Bbox

    box = Bbox.union([each.get_path().transformed(each.get_patch_transform()).get_extents() for each in parts])
    written = axes.annotate(
        name,
        ((box.x0 + box.x1) / 2, box.y0),
        (0, -3),
        textcoords="offset points",
        ha="center",
        va="top",
        zorder=9,
        size=8,
        color=INK,
    )
    written.set_path_effects([withStroke(linewidth=2, foreground="white")])


def _draw_view(axes: Axes, robot: RobotDescription, sensor: Looking) -> None:
    """Draw the sector of a sensor's view, not to its full range: that would be the whole picture."""
    from matplotlib.patches import Wedge

    reach, feels = robot.shape.outer_radius(), isinstance(sensor, Bumper)
    x, y, theta = placed_on(robot.pose.place, Pose() if sensor.mount is None else sensor.mount.place)
    radius = 1.15 * reach if feels else min(getattr(sensor, "range", (0.0, math.inf))[1], 1.5 * reach + 0.4)
    first, color = math.degrees(theta) + sensor.right, TOUCH if feels else VIEW
    axes.add_patch(Wedge((x, y), radius, first, first + sensor.fov, color=color, alpha=0.15, linewidth=0, zorder=1))


def _outline(shape: Shape, pose: Pose, style: dict[str, Any]) -> Patch:
    """Make the outline of a shape at a pose."""
    from matplotlib.patches import Circle, Polygon

    if shape.circle is not None:
        return Circle((pose.x, pose.y), shape.circle, **style)
    return Polygon([placed_on(pose, Pose(x, y))[:2] for x, y in shape.corners()], closed=True, **style)


def _figure_size(description: WorldDescription, longer: float) -> Point:
    """Return a figure's width and height in inches: the world fills it, with room for labels."""
    area = extent(description)
    scale = longer / max(area.width, area.height)
    return max(area.width * scale, _NARROWEST), max(area.height * scale, _NARROWEST)
