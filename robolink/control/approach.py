"""Pose controller: drives a robot that can turn on the spot to a pose; call `decide` at each message of odometry.

On the way it aims beside the goal, so that it comes round to the goal's heading; at the place it turns on the spot.
Pure functions: the node goto calls them and publishes their result.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from robolink.geometry.plane import Pose, Speeds, clipped, seen_from, wrapped

K_TURN = 2.5
"""Gain of the turning speed on the error of the direction, in 1/s."""

K_SLOW = 1.5
"""Gain of the speed on the remaining distance near the goal, in 1/s."""

K_SWING = 1.5
"""Gain of the angle by which it aims beside the goal, per radian between the goal's heading and its direction (> 1)."""

TURN_FIRST = math.radians(60)
"""Error of the direction from which on it turns on the spot, in radians."""

SETTLED = 0.3
"""Share of the position tolerance within which it stops driving."""


class Left(NamedTuple):
    """Remaining way to a goal, as seen by the robot.

    Args:
        distance: Metres to the goal.
        bearing: Direction to it in radians, 0 ahead and growing to the left.
        turn: Turn at the goal to its heading, in radians, to the left if positive.
    """

    distance: float
    bearing: float
    turn: float


class Limits(NamedTuple):
    """Limits of driving.

    Args:
        speed: Highest speed, in m/s.
        acceleration: Highest acceleration, in m/s².
        turn_speed: Highest turning speed, in rad/s.
        turn_acceleration: Highest turning acceleration, in rad/s².
        swing: Largest distance from the straight line, in metres.
        position_tolerance: Distance from the goal, in metres, within which it is reached.
        heading_tolerance: Angle from the goal's heading, in radians, within which it is reached.
    """

    speed: float = 0.4
    acceleration: float = 0.8
    turn_speed: float = 1.2
    turn_acceleration: float = 4.0
    swing: float = 0.4
    position_tolerance: float = 0.05
    heading_tolerance: float = 0.1


def left_to(goal: Pose, pose: Pose) -> Left:
    """Return the remaining way from `pose` to `goal`."""
    seen = seen_from(pose, goal)
    return Left(math.hypot(seen.x, seen.y), math.atan2(seen.y, seen.x), seen.theta)


def has_arrived(left: Left, limits: Limits, already: bool) -> bool:
    """True if the robot is at the goal's position and has only to turn.

    Args:
        left: The remaining way.
        limits: The limits; the position tolerance counts.
        already: True if this was true the last time: a little drift does not count then.
    """
    near = left.distance <= limits.position_tolerance
    is_passing = abs(left.bearing) > math.pi / 2
    return near and (already or is_passing or left.distance <= SETTLED * limits.position_tolerance)


def is_reached(left: Left, limits: Limits, share: float = 1.0) -> bool:
    """True if the goal is reached within the tolerances.

    Args:
        left: The remaining way.
        limits: The limits with the tolerances.
        share: Factor of the heading's tolerance.
    """
    return left.distance <= limits.position_tolerance and abs(left.turn) <= share * limits.heading_tolerance


def decide(left: Left, speeds: Speeds, limits: Limits, room: float, arrived: bool, dt: float) -> Speeds:
    """Return the next speeds.

    On the way it aims beside the goal, so that it comes round to the goal's heading, but never off the straight line
    by much more than the limits' `swing` metres. At the place it turns on the spot.

    Args:
        left: The remaining way.
        speeds: The present speeds.
        limits: Limits of speeds and accelerations.
        room: Free distance ahead, in metres.
        arrived: True at the goal's position (`has_arrived`).
        dt: Seconds from `speeds` to the next ones.
    """
    if arrived:
        return Speeds(slowed(0.0, speeds.v, limits, dt), turning(left.turn, speeds.w, limits, dt))
    off = wrapped(left.bearing - swing(left, limits))
    most = min(limits.speed, K_SLOW * left.distance, braking(left.distance, limits))
    v = slowed(most * max(0.0, 1.0 - abs(off) / TURN_FIRST), speeds.v, limits, dt)
    return Speeds(min(v, braking(room, limits)), turning(off, speeds.w, limits, dt))


def swing(left: Left, limits: Limits) -> float:
    """Return the angle by which to aim beside the goal, in radians, for the remaining way `left` within `limits`.

    It fades out near the goal, which would be circled otherwise.
    """
    most = math.atan2(limits.swing, left.distance) * min(1.0, left.distance / (4.0 * limits.position_tolerance))
    return clipped(K_SWING * wrapped(left.turn - left.bearing), most)


def braking(distance: float, limits: Limits) -> float:
    """Return the greatest speed in m/s from which the robot can stop within `distance` metres, by `limits`."""
    return math.sqrt(1.6 * limits.acceleration * distance) if distance > 0.0 else 0.0


def slowed(expected: float, speed: float, limits: Limits, dt: float) -> float:
    """Return the speed `dt` seconds on the way from `speed` to `expected` (m/s), by the acceleration of `limits`."""
    return speed + clipped(expected - speed, limits.acceleration * dt)


def turning(off: float, speed: float, limits: Limits, dt: float) -> float:
    """Return the turning speed after `dt` seconds; it falls in time not to turn too far.

    Args:
        off: Angle still to turn, in radians.
        speed: The present turning speed in rad/s.
        limits: Limits of turning speed and acceleration.
        dt: Seconds.
    """
    most = min(limits.turn_speed, math.sqrt(1.6 * limits.turn_acceleration * abs(off)))
    return speed + clipped(clipped(K_TURN * off, most) - speed, limits.turn_acceleration * dt)
