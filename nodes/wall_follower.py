"""Follow a wall: keep it at one side and at a set distance, round inner and outer corners.

The law, for a wall on the right (the left is its mirror image): the wall's nearest point lies d metres away, `off`
radians ahead of straight right, and the robot drives at v. Along a straight wall d falls by v sin(off) a second, and
`off` by the turning speed. So the robot turns by

    turn = GAIN (off - wanted),    wanted = GAIN/5 (d - distance) / v, within STEEP

which makes the error e = d - distance swing as e'' + GAIN e' + GAIN²/5 e = 0: damped well, and the same at any speed.
The nearest point's bearing is the derivative of this controller, free of noise that differences would have. (The mean
of the beams on one side, which one often sees, tells less: the same wall farther away, and turned towards the robot,
may have the same mean.) The nearest point is looked for from where the robot will be in 1/GAIN seconds: round an
outer corner that gives just the turn v/d that keeps the distance, with no error to drive it.

What has left the view of a lidar that does not see all round is remembered for a short way, and moved as the robot
was told to move: so it comes round outer corners that it no longer sees.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from robolink import Parameter
from robolink.control.laser import Array, in_view, lane_among, looks_ahead, looks_all_round, points, returns
from robolink.control.scan_controller import ScanController
from robolink.geometry.plane import clipped
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.parameters.descriptors import described

SIDE = (math.radians(-135), math.radians(30))
"""Sector in which the followed wall is searched, in radians: from the right rear to just across the heading."""

GAIN = 3.0
"""Gain of the turning speed, in 1/s; lower with fewer than five scans a second, or the robot would oscillate."""

STEEP = 1.0
"""Largest angle at which the robot drives towards the wall or away from it, in radians."""

CLEARANCE = 0.05
"""Least free space round the robot, in metres."""

NEAREST = 0.04
"""Distance beyond the nearest point, in metres, at which a point has a weight of 1/e in the mean that smooths noise."""

ACCELERATION = 1.0
"""Acceleration in m/s², low enough that the robot follows its commands, so that remembered points stay correct."""

BRAKING = 1.0
"""Time before an obstacle at which it slows down from full speed, in seconds."""

BLIND_WAY = 2.5
"""Way for which points are remembered, as a multiple of the wall's distance."""

DOUBT = 0.1
"""Share of the way by which a remembered point counts as nearer: behind a round thing's edge it bulges."""


class Goal(NamedTuple):
    """The goal; the parameters of the node have the same names. Metres, m/s, rad/s."""

    distance: float = 0.5
    speed: float = 0.3
    side: str = "right"
    robot_radius: float = 0.17
    turn_speed: float = 1.5


PARAMETERS = {
    "distance": described("metres from the lidar to the wall; 5 cm more than robot_radius at least", 0.05, 10.0),
    "speed": described("m/s along a straight wall", 0.01, 5.0),
    "side": described("on which side the wall is kept"),
    "robot_radius": described("metres from the lidar to the robot's outermost point", 0.01, 5.0),
    "turn_speed": described("rad/s at most", 0.05, 10.0),
}
PARAMETERS["side"].additional_constraints = "left or right"


class Points(NamedTuple):
    """Points near the robot: metres ahead, metres to the left, and metres driven since they were in view."""

    x: Array = np.empty(0)
    y: Array = np.empty(0)
    ago: Array = np.empty(0)

    def those(self, chosen: Any) -> "Points":
        """Return those for which `chosen` is True."""
        (which,) = chosen.nonzero()  # counted once, not by each of the three
        return Points(self.x[which], self.y[which], self.ago[which])


class Memory(NamedTuple):
    """State from one scan to the next: the wall's side, the last command, and the points that were near."""

    side: str = ""
    speed: float = 0.0
    turn: float = 0.0
    near: Points = Points()


class Pace(NamedTuple):
    """Set points made from a goal: the distance and speed to hold, in m and m/s, and the gain in 1/s."""

    distance: float
    speed: float
    gain: float


class Target(NamedTuple):
    """A point to deal with: metres (inf for none) and radians."""

    distance: float
    bearing: float


class Decision(NamedTuple):
    """A command, the state to remember, and the reason in words."""

    twist: Twist
    memory: Memory
    words: str


class WallFollower(ScanController):
    """Wall follower: turns each scan into a velocity command; stops without scans, and at its own end."""

    memory = Memory()

    def __init__(self, **options: Any) -> None:
        super().__init__("wall_follower", **options)
        self.add_on_set_parameters_callback(self.check_side)
        for name, value in Goal()._asdict().items():
            self.declare_parameter(name, value, PARAMETERS[name])

    def check_side(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        """Reject an unknown side."""
        for each in parameters:
            if each.name == "side" and each.value not in ("left", "right"):
                reason = f"side: expected 'left' or 'right', got {each.value!r}"
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def decide(self, scan: LaserScan, seconds: float) -> tuple[Twist, str]:
        """Follow the wall by a scan, and remember what is near."""
        goal = Goal(*(self.get_parameter(name).value for name in Goal._fields))
        twist, self.memory, words = follow(scan, goal, self.memory, seconds)
        return twist, words

    def forget(self) -> None:
        """Forget what was near: the robot may be elsewhere."""
        super().forget()
        self.memory = Memory()


def follow(scan: LaserScan, goal: Goal, memory: Memory, seconds: float) -> Decision:
    """Hold the wall's nearest point abeam and at the goal's distance; drive to a wall if none is near.

    `seconds` have passed since the last scan, which has left the memory (0: not known). inf, NaN, any number of
    beams, any field of view and start angle are fine; with nothing in reach the robot drives ahead. A scan that does
    not look ahead, or has measured nothing, makes it stand still.
    """
    if not looks_ahead(scan):
        return Decision(Twist(), Memory(), "no beam looks ahead: standing still")
    if memory.side != goal.side:
        memory = Memory(goal.side)
    pace = pace_for(goal, seconds)
    mirror = -1.0 if goal.side == "left" else 1.0  # what follows knows walls on the right alone
    x, y = points(scan)
    seen = Points(x, y * mirror, np.zeros(len(x)))
    near = joined(seen, unseen(memory, seconds, scan, mirror), pace)

    wall = nearest(near, memory.speed / pace.gain, pace)
    if wall.distance < 2 * pace.distance:
        off = keep(wall, room_on_the_left(near), goal, pace)
        words = f"following the wall on the {goal.side} at {wall.distance:.2f} m"
    else:
        target = easiest(scan, mirror)
        off = target.bearing
        words = f"driving to a wall {target.distance:.1f} m away" if len(x) else "no wall in reach: driving ahead"
    free = lane_among(seen.x, seen.y, goal.robot_radius + CLEARANCE / 2)
    speed, turn = drive(off, free, goal, pace)
    if speed < 0.3 * pace.speed and math.isfinite(free):
        words = f"turning {'left' if mirror * turn > 0 else 'right'}, {free:.1f} m free ahead"
    speed = min(speed, memory.speed + ACCELERATION * seconds) if seconds else speed
    twist = Twist(linear=Vector3(x=speed), angular=Vector3(z=mirror * turn))
    return Decision(twist, Memory(goal.side, speed, turn, near), words)


def keep(wall: Target, left: float, goal: Goal, pace: Pace) -> float:
    """Return the turn that holds the wall's distance, in radians to the left.

    Where things on the `left` leave no room for the distance it holds the middle.
    """
    hold = max(goal.robot_radius + CLEARANCE, min(pace.distance, (wall.distance + left) / 2))
    expected = pace.gain / 5 * (wall.distance - hold) / max(pace.speed, 0.1)
    return wall.bearing + math.pi / 2 - clipped(expected, STEEP)


def drive(off: float, free: float, goal: Goal, pace: Pace) -> tuple[float, float]:
    """Return speed and turning speed to turn by `off` radians with `free` metres ahead.

    It slows down to turn, and for what is ahead; where it must stop it turns away from the wall.
    """
    stop = max(goal.robot_radius + CLEARANCE, 0.8 * pace.distance)
    share = min(1.0, max(0.0, (free - stop) / max(goal.speed * BRAKING, 0.2 * pace.distance)))
    blocked = max(0.0, 1.0 - 2.0 * share)
    turn = (1.0 - blocked) * pace.gain * off + blocked * goal.turn_speed
    speed = pace.speed * share * math.cos(min(1.2 * abs(off), math.pi / 2))
    return speed, clipped(turn, goal.turn_speed)


def pace_for(goal: Goal, dt: float) -> Pace:
    """Return the set points of a goal with a scan every `dt` seconds (0: not known)."""
    distance = max(goal.distance, goal.robot_radius + CLEARANCE)
    if dt == 0.0:
        return Pace(distance, goal.speed, GAIN)
    return Pace(distance, min(goal.speed, distance / 4 / dt), min(GAIN, 0.6 / dt))


def nearest(near: Points, ahead: float, pace: Pace) -> Target:
    """Find the wall's nearest point as it will be seen `ahead` metres from here.

    It is the mean of the points around the nearest one, which smooths noise: the nearer the more they weigh, and
    those far from the lidar more than those close by, since they stand for more of the wall.
    """
    bearings = np.arctan2(near.y, near.x - ahead)
    beside = near.those((bearings >= SIDE[0]) & (bearings <= SIDE[1]))
    if not len(beside.x):
        return Target(math.inf, 0.0)
    x, y = beside.x - ahead, beside.y
    distances = np.hypot(x, y)
    at = distances.argmin()
    (around,) = (np.hypot(x - x[at], y - y[at]) < pace.distance / 2).nonzero()
    seen = np.array((x[around], y[around], beside.ago[around]))
    far = beside.x[around]
    weights = np.exp((distances[at] - distances[around]) / NEAREST) * (far * far + seen[1] * seen[1] + 1e-9)
    mean_x, mean_y, ago = ((seen * weights).sum(axis=1) / weights.sum()).tolist()
    return Target(math.hypot(mean_x, mean_y) - DOUBT * ago, math.atan2(mean_y, mean_x))


def room_on_the_left(near: Points) -> float:
    """Return the distance of the nearest point to the left, within 45 degrees; inf for none."""
    left = near.y > np.abs(near.x)
    return float(np.hypot(near.x[left], near.y[left]).min(initial=math.inf))


def easiest(scan: LaserScan, mirror: float) -> Target:
    """Find the return to drive to, near and not far from the heading; straight ahead when there is none.

    The heading counts so that between two walls equally far the robot makes up its mind.
    """
    angles, ranges = returns(scan)
    if not len(ranges):
        return Target(math.inf, 0.0)
    at = (ranges + 0.05 * abs(angles)).argmin()
    return Target(float(ranges[at]), mirror * float(angles[at]))


# What is around


def remembered(memory: Memory, dt: float) -> Points:
    """Return the remembered points as seen from the robot's pose `dt` seconds later, by dead reckoning."""
    if dt == 0.0:
        return Points()
    way, half = memory.speed * dt, memory.turn * dt / 2  # on an arc one drives along its chord, turned by half
    near, cos, sin = memory.near, math.cos(half), math.sin(half)
    x, y = cos * near.x + sin * near.y - way, cos * near.y - sin * near.x
    return Points(cos * x + sin * y, cos * y - sin * x, near.ago + way)


def unseen(memory: Memory, dt: float, scan: LaserScan, mirror: float) -> Points:
    """Return the remembered points that the scan does not see."""
    if looks_all_round(scan):
        return Points()
    old = remembered(memory, dt)
    return old.those(~in_view(scan, mirror * np.arctan2(old.y, old.x)))


def joined(new: Points, old: Points, pace: Pace) -> Points:
    """Join seen and remembered points, and drop those that are far away or old."""
    both = Points(*map(np.concatenate, zip(new, old, strict=True))) if len(old.x) else new
    return both.those((np.hypot(both.x, both.y) < 3 * pace.distance) & (both.ago < BLIND_WAY * pace.distance))
