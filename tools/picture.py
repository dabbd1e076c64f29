"""Generator of a picture: the path of a node that drives in a simulated world, in virtual time.

Usage: python tools/picture.py wall_follower corners docs/pictures/follow.svg --seconds 95
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

from robolink import Context, Node, VirtualTime
from robolink.control.laser import returns
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.parameter import Parameter
from robolink.sim import load_world
from robolink.sim.sensing.scene import fixed_circles, fixed_segments
from robolink.workspace import find_node, find_world, load_node

SCALE, MARGIN = 70.0, 24.0
"""Pixels a metre, and around the picture."""

Point = tuple[float, float]


def drive(controller: str, world: str, seconds: float) -> tuple[list[Point], list[Point], Point]:
    """Run the system; give the robot's path, where the last scan's beams end, and where the robot then was."""
    context = Context(transport="memory://picture", time=VirtualTime())
    context.init(args=[])
    executor = SingleThreadedExecutor(context=context)
    make_world: Callable[..., Node] = load_node(find_node("world"))
    make_controller: Callable[..., Node] = load_node(find_node(controller))
    nodes = [
        make_world(context=context, parameter_overrides=[Parameter("world", value=world)]),
        make_controller(context=context),
    ]
    path: list[Point] = []
    headings: list[tuple[float, float]] = []
    scans: list[LaserScan] = []
    eye = nodes[1]

    def on_odom(odom: Odometry) -> None:
        path.append((odom.pose.pose.position.x, odom.pose.pose.position.y))
        headings.append((odom.pose.pose.orientation.z, odom.pose.pose.orientation.w))

    eye.create_subscription(Odometry, "odom", on_odom, 10)
    eye.create_subscription(LaserScan, "scan", scans.append, 10)
    for node in nodes:
        executor.add_node(node)
    while context.time.now() < seconds * 1e9:
        executor.spin_once()
    context.shutdown()
    return path, hits(scans[-1], path[-1], headings[-1]), path[-1]


def hits(scan: LaserScan, at: Point, heading: tuple[float, float]) -> list[Point]:
    """Where the beams of a scan end, in the world."""
    import math

    turned = 2.0 * math.atan2(*heading)
    angles, ranges = returns(scan)
    return [
        (at[0] + r * math.cos(turned + a), at[1] + r * math.sin(turned + a))
        for a, r in zip(angles, ranges, strict=True)
    ]


def svg(world: str, path: list[Point], beams: list[Point], at: Point) -> str:
    """Draw all of it, north up."""
    description = load_world(find_world(world))
    if description.world.size is None:
        raise SystemExit(f"{world}: only a world with a size can be drawn")
    width, height = description.world.size
    wide, high = width * SCALE + 2 * MARGIN, height * SCALE + 2 * MARGIN

    def place(x: float, y: float) -> str:
        return f"{MARGIN + x * SCALE:.1f},{MARGIN + (height - y) * SCALE:.1f}"

    def line(points: list[Point], style: str) -> str:
        return f'<polyline points="{" ".join(place(*each) for each in points)}" fill="none" {style}/>'

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide:.0f} {high:.0f}">']
    parts.append(f'<rect width="{wide:.0f}" height="{high:.0f}" rx="10" fill="#fbfbf8"/>')
    parts += [line([at, each], 'stroke="#f4b942" stroke-width="0.6" opacity="0.5"') for each in beams[::3]]
    for x1, y1, x2, y2 in fixed_segments(description).reshape(-1, 4).tolist():
        parts.append(line([(x1, y1), (x2, y2)], 'stroke="#22303c" stroke-width="5" stroke-linecap="round"'))
    for x, y, radius in fixed_circles(description).reshape(-1, 3).tolist():
        centre = place(x, y).split(",")
        parts.append(f'<circle cx="{centre[0]}" cy="{centre[1]}" r="{radius * SCALE:.1f}" fill="#22303c"/>')
    parts.append(line(path[:: max(1, len(path) // 400)], 'stroke="#1d7fbf" stroke-width="3" stroke-linejoin="round"'))
    centre = place(*at).split(",")
    radius = description.robots[0].shape.outer_radius() * SCALE
    parts.append(f'<circle cx="{centre[0]}" cy="{centre[1]}" r="{radius:.1f}" fill="#d1495b"/>')
    return "\n".join([*parts, "</svg>", ""])


def main() -> None:
    """Read the command line, drive, draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("controller")
    parser.add_argument("world")
    parser.add_argument("out", type=Path)
    parser.add_argument("--seconds", type=float, default=100.0)
    options = parser.parse_args()
    path, beams, at = drive(options.controller, options.world, options.seconds)
    options.out.write_text(svg(options.world, path, beams, at), encoding="utf-8")


if __name__ == "__main__":
    main()
