"""Diagnostics of a simulated world, for /diagnostics and for the log: pure functions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from robolink.interfaces.std_msgs.msg import Header
from robolink.sim import Robot, World
from robolink.world_node.messages import time_message
from robolink.world_node.simulation import Simulation

BEHIND = 0.9
"""Share of the wanted real-time factor below which a warning says that the world falls behind."""

REPORTED = 5
"""Most robots whose poses are logged."""


class Rate(NamedTuple):
    """The real-time factor: as asked for (0 is as fast as possible), and as measured; None while it is not known."""

    asked: float
    measured: float | None
    running: bool = True


def diagnostics(node_name: str, simulation: Simulation, rate: Rate) -> DiagnosticArray:
    """Return the diagnostics of a world: its real-time factor, contacts, refused commands."""
    level, message = judged(rate)
    world = simulation.world
    values = {
        "asked": f"{rate.asked:g}",
        "measured": "" if rate.measured is None else f"{rate.measured:.3g}",
        "steps": str(world.steps),
        "simulation time": f"{world.time_ns / 1e9:.3f}",
        "robots": str(len(world.robots)),
        "refused commands": str(simulation.refused),
        "contacts": str(world.contacts),
    }
    status = DiagnosticStatus(
        level=level,
        name=f"{node_name}: real-time factor",
        message=message,
        hardware_id=simulation.description.world.name,
        values=[KeyValue(key=key, value=value) for key, value in values.items()],
    )
    return DiagnosticArray(header=Header(stamp=time_message(simulation.now)), status=[status])


def judged(rate: Rate) -> tuple[bytes, str]:
    """Return the level of a rate, and a word about it."""
    if not rate.running:
        return DiagnosticStatus.OK, "paused"
    if rate.measured is None:
        return DiagnosticStatus.OK, "just started"
    if rate.measured < BEHIND * rate.asked:
        return DiagnosticStatus.WARN, f"falls behind: {rate.measured:.3g} times real time, {rate.asked:g} is asked for"
    return DiagnosticStatus.OK, f"{rate.measured:.3g} times real time"


def listed(names: Sequence[str]) -> str:
    """Return the names of robots as text, a few of them and the last if there are many."""
    if len(names) <= REPORTED + 1:
        return ", ".join(names) or "no robot"
    return f"{len(names)} robots: {', '.join(names[:REPORTED])} ... {names[-1]}"


def report(world: World) -> list[str]:
    """Return lines about the pose and motion of the first robots, and how many of the others touch something."""
    robots = list(world.robots.values())
    lines = [said(each, world.nearest_wall_distance(each.pose.x, each.pose.y)) for each in robots[:REPORTED]]
    if others := robots[REPORTED:]:
        lines.append(f"{len(others)} more robots, {sum(each.touching > 0 for each in others)} of them in contact")
    return lines


def said(robot: Robot, wall: float) -> str:
    """Return the pose and motion of a robot in words; `wall` is the distance to the nearest wall in metres, or inf."""
    pose, twist = robot.pose, robot.twist
    turning = round(math.degrees(twist.w))
    parts = [
        f"{robot.name} at ({pose.x:.2f}, {pose.y:.2f}) heading {round(math.degrees(pose.theta))} deg",
        f"{round(twist.v, 2) + 0.0:.2f} m/s",  # never -0.00
        f"{twist.sideways:.2f} m/s to the left" if abs(twist.sideways) >= 0.005 else "",
        f"turning {'left' if turning > 0 else 'right'} at {abs(turning)} deg/s" if turning else "",
        f"nearest wall {wall:.2f} m" if math.isfinite(wall) else "",
        "in contact" if robot.touching else "",
    ]
    return ", ".join(filter(None, parts))
