"""Follow a wall: keep it at one side and at a set distance, round inner and outer corners."""

import math
from typing import Any, NamedTuple

from robolink import Node
from robolink.exceptions import InvalidParameterValueException
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.laser import Array, returns

SIDE = (math.radians(-135), math.radians(30))
"""Where the followed wall is looked for: from the right rear to just across the heading."""

AHEAD = math.radians(30)
TURN_SPEED = 1.5

K_BEARING = 3.0
"""1/s. The nearest point's bearing tells how fast the wall comes nearer: it is the D of the controller."""

K_DISTANCE = 1.8
"""1/s², over the speed: driving along a wall at v, distance and bearing swing at sqrt(K_DISTANCE) rad/s."""

K_INTEGRAL = 0.5
INTEGRAL_LIMIT = 0.1


class Nearest(NamedTuple):
    """The nearest return of a sector: metres (inf for none) and radians."""

    distance: float
    bearing: float


class Goal(NamedTuple):
    """What to hold: the distance in metres, the speed in m/s, and the side on which the wall should be."""

    distance: float = 0.5
    speed: float = 0.3
    side: str = "right"


class Decision(NamedTuple):
    """What to do, the integral of the distance error (m s) to remember, and why, in words."""

    twist: Twist
    integral: float
    words: str


class WallFollower(Node):
    """Turns each scan into a velocity command."""

    def __init__(self, **options: Any) -> None:
        super().__init__("wall_follower", **options)
        self.declare_parameter("distance", Goal().distance)
        self.declare_parameter("speed", Goal().speed)
        self.declare_parameter("side", Goal().side)
        side = self.get_parameter("side").value
        if side not in ("left", "right"):
            raise InvalidParameterValueException("side", side, "expected 'left' or 'right'")
        self.integral = 0.0
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        """Decide and act."""
        goal = Goal(*(self.get_parameter(name).value for name in Goal._fields))
        decision = follow(scan, goal, self.integral)
        self.integral = decision.integral
        self.cmd_vel.publish(decision.twist)
        self.get_logger().info(decision.words, throttle_duration_sec=2.0)


def follow(scan: LaserScan, goal: Goal, integral: float = 0.0) -> Decision:
    """Hold the nearest return of the wall's side abeam and at the goal's distance; go to a wall if none is near.

    The left side is the right one in a mirror. inf, NaN, an empty scan, any field of view are fine: with nothing
    in reach the robot drives ahead.
    """
    mirror = -1.0 if goal.side == "left" else 1.0
    angles, ranges = returns(scan)
    angles = angles * mirror
    wall = nearest(angles, ranges, *SIDE)
    ahead = nearest(angles, ranges, -AHEAD, AHEAD)
    if wall.distance < 2 * goal.distance:
        speed, turn, integral = keep(wall, goal, integral, scan.scan_time or 0.1)
        words = f"following the wall on the {goal.side} at {wall.distance:.2f} m"
    else:
        target = easiest(angles, ranges)
        speed, turn, integral = approach(target, goal.speed), 1.5 * target.bearing, 0.0
        words = f"driving to a wall {target.distance:.1f} m away" if len(ranges) else "no wall in reach: driving ahead"
    speed *= min(1.0, max(0.0, ahead.distance / max(goal.distance, 0.1) - 0.8))
    turn = mirror * min(TURN_SPEED, max(-TURN_SPEED, turn))
    if speed < 0.3 * goal.speed and math.isfinite(ahead.distance):
        words = f"turning {'left' if turn > 0 else 'right'}, {ahead.distance:.1f} m free ahead"
    return Decision(Twist(linear=Vector3(x=speed), angular=Vector3(z=turn)), integral, words)


def keep(wall: Nearest, goal: Goal, integral: float, dt: float) -> tuple[float, float, float]:
    """Give speed, turning speed and integral that hold a wall at -90 degrees and the goal's distance.

    The integral only grows near the goal, so that corners do not wind it up.
    """
    off_beam, error = wall.bearing + math.pi / 2, wall.distance - goal.distance
    if abs(off_beam) < 0.3 and abs(error) < 0.2:
        integral = min(INTEGRAL_LIMIT, max(-INTEGRAL_LIMIT, integral + error * dt))
    pull = K_DISTANCE / max(goal.speed, 0.1) * error
    return (
        approach(Nearest(wall.distance, off_beam), goal.speed),
        K_BEARING * off_beam - pull - K_INTEGRAL * integral,
        integral,
    )


def approach(target: Nearest, speed: float) -> float:
    """Give the speed for a target that should lie at bearing 0: none while it is 75 degrees off or more."""
    return speed * max(0.0, math.cos(min(1.2 * abs(target.bearing), math.pi / 2)))


def easiest(angles: Array, ranges: Array) -> Nearest:
    """Find the return to drive to, near and not far from the heading; straight ahead when there is none.

    The heading counts so that between two walls equally far the robot makes up its mind.
    """
    if not len(ranges):
        return Nearest(math.inf, 0.0)
    at = (ranges + 0.05 * abs(angles)).argmin()
    return Nearest(float(ranges[at]), float(angles[at]))


def nearest(angles: Array, ranges: Array, low: float, high: float) -> Nearest:
    """Find the nearest return between two angles."""
    inside = (angles >= low) & (angles <= high)
    if not inside.any():
        return Nearest(math.inf, 0.0)
    at = ranges[inside].argmin()
    return Nearest(float(ranges[inside][at]), float(angles[inside][at]))
