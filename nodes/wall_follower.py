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
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.laser import Array, in_view, lane_among, looks_all_round, returns
from robolink.parameter_descriptors import described
from robolink.plane import clipped
from robolink.scan_controller import ScanController

SIDE = (math.radians(-135), math.radians(30))
"""Where the followed wall is looked for: from the right rear to just across the heading."""

GAIN = 3.0
"""1/s. With fewer than five scans a second it is less, or the robot would swing."""

STEEP = 1.0
"""Radians: the most by which the robot drives towards the wall or away from it."""

CLEARANCE = 0.05
"""Metres that are to be free round the robot."""

NEAREST = 0.04
"""Metres: what lies farther than the nearest point by this has a weight of 1/e in the mean that smooths noise."""

ACCELERATION = 1.0
"""m/s²: so fast it gains speed, that the robot does what it is told, and what is remembered is where it should be."""

BRAKING = 1.0
"""Seconds: at full speed it begins so early to slow down before what is ahead."""

BLIND_WAY = 2.5
"""How far the robot drives by what it remembers, as a multiple of the distance."""

DOUBT = 0.1
"""And by this share of that way what is remembered counts as nearer: behind a round thing's edge it bulges."""


class Goal(NamedTuple):
    """What to do; the parameters of the node have the same names. Metres, m/s, rad/s."""

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
    """What is near, seen by the robot: metres ahead, metres to the left, and metres driven since it was in view."""

    x: Array = np.empty(0)
    y: Array = np.empty(0)
    ago: Array = np.empty(0)

    def those(self, chosen: Any) -> "Points":
        """Give some of them."""
        return Points(self.x[chosen], self.y[chosen], self.ago[chosen])


class Memory(NamedTuple):
    """What one scan leaves to the next: the wall's side, what the robot was told, and what was near."""

    side: str = ""
    speed: float = 0.0
    turn: float = 0.0
    near: Points = Points()


class Pace(NamedTuple):
    """What a goal comes to: the distance and speed to hold, in m and m/s, and the gain in 1/s."""

    distance: float
    speed: float
    gain: float


class Target(NamedTuple):
    """A point to deal with: metres (inf for none) and radians."""

    distance: float
    bearing: float


class Decision(NamedTuple):
    """What to do, what to remember, and why, in words."""

    twist: Twist
    memory: Memory
    words: str


class WallFollower(ScanController):
    """Turns each scan into a velocity command; stops the robot when there are no scans, and at its own end."""

    memory = Memory()

    def __init__(self, **options: Any) -> None:
        super().__init__("wall_follower", **options)
        self.add_on_set_parameters_callback(self.check_side)
        for name, value in Goal()._asdict().items():
            self.declare_parameter(name, value, PARAMETERS[name])

    def check_side(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        """Refuse a side that is none."""
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
    if not in_view(scan, np.zeros(1))[0]:
        return Decision(Twist(), Memory(), "no beam looks ahead: standing still")
    if memory.side != goal.side:
        memory = Memory(goal.side)
    pace = pace_for(goal, seconds)
    mirror = -1.0 if goal.side == "left" else 1.0  # what follows knows walls on the right alone
    angles, ranges = returns(scan)
    angles = angles * mirror
    seen = points(angles, ranges)
    near = joined(seen, unseen(memory, seconds, scan, mirror), pace)

    wall = nearest(near, memory.speed / pace.gain, pace)
    if wall.distance < 2 * pace.distance:
        off = keep(wall, room_on_the_left(near), goal, pace)
        words = f"following the wall on the {goal.side} at {wall.distance:.2f} m"
    else:
        target = easiest(angles, ranges)
        off = target.bearing
        words = f"driving to a wall {target.distance:.1f} m away" if len(ranges) else "no wall in reach: driving ahead"
    free = lane_among(seen.x, seen.y, goal.robot_radius + CLEARANCE / 2)
    speed, turn = drive(off, free, goal, pace)
    if speed < 0.3 * pace.speed and math.isfinite(free):
        words = f"turning {'left' if mirror * turn > 0 else 'right'}, {free:.1f} m free ahead"
    speed = min(speed, memory.speed + ACCELERATION * seconds) if seconds else speed
    twist = Twist(linear=Vector3(x=speed), angular=Vector3(z=mirror * turn))
    return Decision(twist, Memory(goal.side, speed, turn, near), words)


def keep(wall: Target, left: float, goal: Goal, pace: Pace) -> float:
    """Give by how much to turn to hold the wall, in radians to the left.

    Where things on the `left` leave no room for the distance it holds the middle.
    """
    hold = max(goal.robot_radius + CLEARANCE, min(pace.distance, (wall.distance + left) / 2))
    wanted = pace.gain / 5 * (wall.distance - hold) / max(pace.speed, 0.1)
    return wall.bearing + math.pi / 2 - clipped(wanted, STEEP)


def drive(off: float, free: float, goal: Goal, pace: Pace) -> tuple[float, float]:
    """Give speed and turning speed to turn by `off` radians with `free` metres ahead.

    It slows down to turn, and for what is ahead; where it must stop it turns away from the wall.
    """
    stop = max(goal.robot_radius + CLEARANCE, 0.8 * pace.distance)
    share = min(1.0, max(0.0, (free - stop) / max(goal.speed * BRAKING, 0.2 * pace.distance)))
    blocked = max(0.0, 1.0 - 2.0 * share)
    turn = (1.0 - blocked) * pace.gain * off + blocked * goal.turn_speed
    speed = pace.speed * share * math.cos(min(1.2 * abs(off), math.pi / 2))
    return speed, clipped(turn, goal.turn_speed)


def pace_for(goal: Goal, dt: float) -> Pace:
    """Give what a goal comes to with a scan every `dt` seconds (0: not known)."""
    distance = max(goal.distance, goal.robot_radius + CLEARANCE)
    if dt == 0.0:
        return Pace(distance, goal.speed, GAIN)
    return Pace(distance, min(goal.speed, distance / 4 / dt), min(GAIN, 0.6 / dt))


def nearest(near: Points, ahead: float, pace: Pace) -> Target:
    """Find the wall's nearest point as it will be seen `ahead` metres from here.

    It is the mean of the points around the nearest one, which smooths noise: the nearer the more they weigh, and
    those far from the lidar more than those close by, since they stand for more of the wall.
    """
    x, y = near.x - ahead, near.y
    bearings = np.arctan2(y, x)
    beside = np.flatnonzero((bearings >= SIDE[0]) & (bearings <= SIDE[1]))
    if not len(beside):
        return Target(math.inf, 0.0)
    x, y = x[beside], y[beside]
    distances = np.hypot(x, y)
    at = distances.argmin()
    around = np.hypot(x - x[at], y - y[at]) < pace.distance / 2
    chosen = near.those(beside[around])
    weights = np.exp((distances[at] - distances[around]) / NEAREST) * (chosen.x**2 + chosen.y**2 + 1e-9)
    seen, weight = (x[around], chosen.y, chosen.ago), weights.sum()
    mean_x, mean_y, ago = (float((each * weights).sum() / weight) for each in seen)
    return Target(math.hypot(mean_x, mean_y) - DOUBT * ago, math.atan2(mean_y, mean_x))


def room_on_the_left(near: Points) -> float:
    """Give the distance of the nearest point to the left, within 45 degrees; inf for none."""
    left = near.y > np.abs(near.x)
    return float(np.hypot(near.x[left], near.y[left]).min(initial=math.inf))


def easiest(angles: Array, ranges: Array) -> Target:
    """Find the return to drive to, near and not far from the heading; straight ahead when there is none.

    The heading counts so that between two walls equally far the robot makes up its mind.
    """
    if not len(ranges):
        return Target(math.inf, 0.0)
    at = (ranges + 0.05 * abs(angles)).argmin()
    return Target(float(ranges[at]), float(angles[at]))


# What is around


def points(angles: Array, ranges: Array) -> Points:
    """Give a scan's returns as points."""
    return Points(ranges * np.cos(angles), ranges * np.sin(angles), np.zeros(len(ranges)))


def remembered(memory: Memory, dt: float) -> Points:
    """Give what was near, as seen from where the robot must be now: `dt` seconds on, as it was told to drive."""
    if dt == 0.0:
        return Points()
    way, half = memory.speed * dt, memory.turn * dt / 2  # on an arc one drives along its chord, turned by half
    near, cos, sin = memory.near, math.cos(half), math.sin(half)
    x, y = cos * near.x + sin * near.y - way, cos * near.y - sin * near.x
    return Points(cos * x + sin * y, cos * y - sin * x, near.ago + way)


def unseen(memory: Memory, dt: float, scan: LaserScan, mirror: float) -> Points:
    """Give what was near and the scan does not see."""
    if looks_all_round(scan):
        return Points()
    old = remembered(memory, dt)
    return old.those(~in_view(scan, mirror * np.arctan2(old.y, old.x)))


def joined(new: Points, old: Points, pace: Pace) -> Points:
    """Put together what is seen and what is remembered of the surroundings, and forget what is far or long ago."""
    both = Points(*map(np.concatenate, zip(new, old, strict=True))) if len(old.x) else new
    return both.those((np.hypot(both.x, both.y) < 3 * pace.distance) & (both.ago < BLIND_WAY * pace.distance))
