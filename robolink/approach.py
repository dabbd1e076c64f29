"""The law by which a robot that turns on the spot drives to a pose: `decide`, called at each message of odometry.

On the way it aims beside the goal, so that it comes round to the goal's heading; at the place it turns on the spot.
Pure functions: the node goto feeds them, and publishes what they give.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from robolink.plane import Pose, Speeds, clipped, seen_from, wrapped

K_TURN = 2.5
"""1/s: how fast it turns for each radian that it is off."""

K_SLOW = 1.5
"""1/s: near the goal it drives so fast for each metre that is left."""

K_SWING = 1.5
"""How far it swings out for each radian that the goal's heading differs from the direction to it (more than 1)."""

TURN_FIRST = math.radians(60)
"""Off its direction by this or more it turns on the spot."""

SETTLED = 0.3
"""It drives on until it is within this share of the tolerances."""


class Left(NamedTuple):
    """What is left to a goal: metres, the direction to it as seen by the robot, and the turn at the end, in radians."""

    distance: float
    bearing: float
    turn: float


class Limits(NamedTuple):
    """How the robot may drive: m/s, m/s², rad/s, rad/s², and metres and radians of the way to the goal and at it."""

    speed: float = 0.4
    acceleration: float = 0.8
    turn_speed: float = 1.2
    turn_acceleration: float = 4.0
    swing: float = 0.4
    position_tolerance: float = 0.05
    heading_tolerance: float = 0.1


def left_to(goal: Pose, pose: Pose) -> Left:
    """Tell how far it is from a pose to a goal."""
    seen = seen_from(pose, goal)
    return Left(math.hypot(seen.x, seen.y), math.atan2(seen.y, seen.x), seen.theta)


def has_arrived(left: Left, limits: Limits, already: bool) -> bool:
    """Say whether the robot is at the place and has only to turn; once it was, a little drift does not count."""
    near = left.distance <= limits.position_tolerance
    is_passing = abs(left.bearing) > math.pi / 2
    return near and (already or is_passing or left.distance <= SETTLED * limits.position_tolerance)


def is_reached(left: Left, limits: Limits, share: float = 1.0) -> bool:
    """Say whether the goal is reached within the tolerances, that of the heading taken by a share of it."""
    return left.distance <= limits.position_tolerance and abs(left.turn) <= share * limits.heading_tolerance


def decide(left: Left, speeds: Speeds, limits: Limits, room: float, arrived: bool, dt: float) -> Speeds:
    """Give the next speeds, `dt` seconds after `speeds`; `room` is what is free ahead, in metres.

    On the way it aims beside the goal, so that it comes round to the goal's heading, but never off the straight line
    by much more than `swing` metres. At the place it turns on the spot.
    """
    if arrived:
        return Speeds(slowed(0.0, speeds.v, limits, dt), turning(left.turn, speeds.w, limits, dt))
    off = wrapped(left.bearing - swing(left, limits))
    most = min(limits.speed, K_SLOW * left.distance, braking(left.distance, limits))
    v = slowed(most * max(0.0, 1.0 - abs(off) / TURN_FIRST), speeds.v, limits, dt)
    return Speeds(min(v, braking(room, limits)), turning(off, speeds.w, limits, dt))


def swing(left: Left, limits: Limits) -> float:
    """Give the angle by which to aim beside the goal: it fades out near the goal, which would be circled otherwise."""
    most = math.atan2(limits.swing, left.distance) * min(1.0, left.distance / (4.0 * limits.position_tolerance))
    return clipped(K_SWING * wrapped(left.turn - left.bearing), most)


def braking(distance: float, limits: Limits) -> float:
    """Give the greatest speed from which the robot can stop within a distance."""
    return math.sqrt(1.6 * limits.acceleration * distance) if distance > 0.0 else 0.0


def slowed(wanted: float, speed: float, limits: Limits, dt: float) -> float:
    """Give the speed ahead after `dt` seconds, which cannot change faster than the limit allows."""
    return speed + clipped(wanted - speed, limits.acceleration * dt)


def turning(off: float, speed: float, limits: Limits, dt: float) -> float:
    """Give the turning speed after `dt` seconds: it falls in time not to turn too far."""
    most = min(limits.turn_speed, math.sqrt(1.6 * limits.turn_acceleration * abs(off)))
    return speed + clipped(clipped(K_TURN * off, most) - speed, limits.turn_acceleration * dt)
