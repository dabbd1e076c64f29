"""Controller by pursuit of a point on the path (regulated pure pursuit): simple and quick, it never leaves the path.

The robot drives on the arc that leads to a point of the path at the lookahead distance (Coulter 1992), slower in tight
bends, near obstacles and near the goal (Macenski et al. 2023, "Regulated pure pursuit for robot path tracking"), with
the parameters of Nav2's controller of that name.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from robolink.geometry.plane import Pose, wrapped
from robolink.navigation.critics import Surroundings, costs_at, obstructed
from robolink.navigation.footprint import FREE, INSCRIBED, LETHAL, UNKNOWN, highest_costs
from robolink.navigation.grid import Floats
from robolink.navigation.local_path import LocalPath
from robolink.navigation.rollouts import Command
from robolink.navigation.singles import F

_STEP = 0.05
"""Seconds between two looks for a collision ahead, at most."""
_NEAR = 0.8
"""Share of the tolerance within which the robot stops at the goal, and turns."""
_NEARER, _TURNED = 0.5, 0.1
"""Share of the lookahead distance where an arc to it is obstructed, and the bearing in radians that needs no turn."""
_FORESIGHT = np.arange(0.0, 2.1, 0.25)
"""Times in seconds for which it is predicted where moving obstacles will be."""
_MARGIN, _SPREAD = 0.08, 0.04
"""Distance in metres from a moving obstacle that is kept, and by how much it grows in a second of foresight."""
_ESCAPE = 6
"""Of these times, how many must be free of other obstacles on a way out."""
BACK = 0.25
"""Speed in m/s of backing away from a moving obstacle."""


@dataclass(frozen=True)
class Options:
    """Parameters under Nav2's names: metres, seconds, m/s, rad, rad/s and rad/s²."""

    desired_linear_vel: float = 0.5
    lookahead_dist: float = 0.6
    min_lookahead_dist: float = 0.3
    max_lookahead_dist: float = 0.9
    lookahead_time: float = 1.5
    use_velocity_scaled_lookahead_dist: bool = False
    rotate_to_heading_angular_vel: float = 1.8
    max_angular_accel: float = 3.2
    use_rotate_to_heading: bool = True
    rotate_to_heading_min_angle: float = 0.785
    min_approach_linear_velocity: float = 0.05
    approach_velocity_scaling_dist: float = 0.6
    use_collision_detection: bool = True
    max_allowed_time_to_collision_up_to_carrot: float = 1.0
    use_regulated_linear_velocity_scaling: bool = True
    regulated_linear_scaling_min_radius: float = 0.9
    regulated_linear_scaling_min_speed: float = 0.25
    use_cost_regulated_linear_velocity_scaling: bool = True
    cost_scaling_dist: float = 0.6
    cost_scaling_gain: float = 1.0
    inflation_cost_scaling_factor: float = 3.0
    stateful: bool = True
    predict_movers: bool = True

    def limited(self, limit: float, *, percentage: bool) -> Options:
        """Return them with a lower speed; `limit` in m/s, or in percent of it with `percentage`, 0.0 for none."""
        if limit <= 0.0:
            return self
        speed = self.desired_linear_vel * limit / 100.0 if percentage else limit
        return replace(self, desired_linear_vel=min(self.desired_linear_vel, speed))


class Pursuit:
    """Controller that remembers whether it has come to the goal.

    Args:
        options: Its parameters.
        inscribed: Radius in metres of the largest circle in the footprint.
        period: Seconds between two calls of `step`.
    """

    def __init__(self, options: Options, *, inscribed: float, period: float = 0.05) -> None:
        self.options, self._inscribed, self._period = options, inscribed, period
        self.reset()

    def reset(self) -> None:
        """Forget that the goal was reached."""
        self._is_there = False

    def step(
        self, pose: Pose, speed: tuple[float, float], path: LocalPath, around: Surroundings, tolerance: float
    ) -> Command:
        """Return the command of now.

        Args:
            pose: Pose of the robot, in the frame of everything here.
            speed: Its speed in m/s and rad/s.
            path: What lies ahead.
            around: The costmap about the robot.
            tolerance: Distance to the goal in metres from which on the robot only turns.
        """
        options = self.options
        left = math.hypot(path.x[-1] - pose.x, path.y[-1] - pose.y) if path.is_whole else math.inf
        # It comes a little nearer than it must: whoever checks the goal has seen it there, though it be driven off.
        self._is_there = left < _NEAR * tolerance or (self._is_there and options.stateful and left < tolerance)
        command = self._towards(self._carrot(pose, speed, path), pose, speed, path, around)
        if command.is_valid or self._is_there or not options.use_rotate_to_heading:
            return command
        # The arc cuts a corner: nearer to the path, or turned towards it first, there may be a way.
        near = self._carrot(pose, speed, path, _NEARER)
        command = self._towards(near, pose, speed, path, around)
        bearing = math.atan2(near[1], near[0])
        if command.is_valid or abs(bearing) < _TURNED:
            return command
        return Command(0.0, self._turning(bearing, speed[1]), True, command.trajectory[:1])

    def _towards(
        self, carrot: tuple[float, float], pose: Pose, speed: tuple[float, float], path: LocalPath, around: Surroundings
    ) -> Command:
        """Return the command that leads to a point in the robot's frame, or turns it on the spot."""
        options, (x, y) = self.options, carrot
        distance, bearing = math.hypot(x, y), math.atan2(y, x)
        if options.use_rotate_to_heading and self._is_there:
            v, w = 0.0, self._turning(wrapped(float(path.theta[-1]) - pose.theta), speed[1])
        elif options.use_rotate_to_heading and abs(bearing) > options.rotate_to_heading_min_angle:
            v, w = 0.0, self._turning(bearing, speed[1])
        else:
            curvature = 2.0 * y / distance**2 if distance > 0.03 else 0.0
            v = self._regulated(curvature, pose, path, around)
            w = v * curvature
        if options.predict_movers and around.movers:
            v, w = self._yielding(pose, v, w, path, around)
        trajectory = self._ahead(pose, v, w, distance)
        is_valid = not (options.use_collision_detection and _collides(trajectory, pose, around))
        return Command(v, w, True, trajectory) if is_valid else Command(0.0, 0.0, False, trajectory)

    def _yielding(self, pose: Pose, v: float, w: float, path: LocalPath, around: Surroundings) -> tuple[float, float]:
        """Return the speeds nearest to those that were found at which nothing that moves comes near.

        The robot slows down on its arc or stands, or gets out of the way; if all of it is too near, it does what is
        least so.
        """
        curvature = w / v if v > 0.0 else 0.0
        tried = [(share * v, share * v * curvature) for share in (1.0, 0.6, 0.3, 0.0)] if v > 0.0 else [(v, w)]
        on_arc, fast = len(tried), self.options.desired_linear_vel
        tried += [(-BACK, 0.0), (fast, 0.0), (-BACK, 0.8), (-BACK, -0.8), (fast, 1.2), (fast, -1.2)]
        found, widest = (0.0, 0.0), -math.inf
        for number, speeds in enumerate(tried):
            ahead = _driven(pose, *speeds, _FORESIGHT)
            if number >= on_arc and _collides(ahead[:_ESCAPE], pose, around):
                continue
            room = _room(ahead, around)
            if room >= 0.0:
                return speeds
            if room > widest + 0.02:
                found, widest = speeds, room
        return found

    def _carrot(
        self, pose: Pose, speed: tuple[float, float], path: LocalPath, share: float = 1.0
    ) -> tuple[float, float]:
        """Return the point of the path at a share of the lookahead distance, in the robot's frame."""
        options = self.options
        reach = options.lookahead_dist
        if options.use_velocity_scaled_lookahead_dist:
            scaled = abs(speed[0]) * options.lookahead_time
            reach = min(max(scaled, options.min_lookahead_dist), options.max_lookahead_dist)
        reach *= share
        dx, dy = path.x - pose.x, path.y - pose.y
        cos, sin = math.cos(pose.theta), math.sin(pose.theta)
        x, y = cos * dx + sin * dy, cos * dy - sin * dx
        far = np.flatnonzero(np.hypot(x, y) >= reach)
        index = int(far[0]) if len(far) else len(x) - 1
        if index == 0 or not len(far):
            return float(x[index]), float(y[index])
        return _on_circle((x[index - 1], y[index - 1]), (x[index], y[index]), reach)

    def _turning(self, angle: float, turning: float) -> float:
        """Return the speed of a turn on the spot by `angle` radians, from the present turning speed on."""
        options = self.options
        most = min(options.rotate_to_heading_angular_vel, math.sqrt(2 * options.max_angular_accel * abs(angle)))
        change = options.max_angular_accel * self._period
        return min(max(math.copysign(most, angle), turning - change), turning + change)

    def _regulated(self, curvature: float, pose: Pose, path: LocalPath, around: Surroundings) -> float:
        """Return the speed ahead: slower in bends, near obstacles and near the goal."""
        options = self.options
        v = in_bends = by_costs = options.desired_linear_vel
        radius = 1.0 / max(abs(curvature), 1e-9)
        if options.use_regulated_linear_velocity_scaling and radius < options.regulated_linear_scaling_min_radius:
            in_bends = v * radius / options.regulated_linear_scaling_min_radius
        if options.use_cost_regulated_linear_velocity_scaling:
            by_costs = v * self._nearness(pose, around)
        v = max(min(in_bends, by_costs), min(v, options.regulated_linear_scaling_min_speed))
        if path.is_whole and path.length < options.approach_velocity_scaling_dist:
            left = math.hypot(path.x[-1] - pose.x, path.y[-1] - pose.y)
            share = left / options.approach_velocity_scaling_dist
            v = min(v, max(v * share, options.min_approach_linear_velocity))
        return v

    def _nearness(self, pose: Pose, around: Surroundings) -> float:
        """Return the share of the speed that the distance to obstacles allows, as the cost at the robot tells it."""
        options = self.options
        cost = int(costs_at(around.costs, np.array([pose.x], F), np.array([pose.y], F))[0])
        if cost in (FREE, UNKNOWN):
            return 1.0
        distance = self._inscribed - math.log(min(cost, INSCRIBED) / INSCRIBED) / options.inflation_cost_scaling_factor
        return min(1.0, options.cost_scaling_gain * distance / options.cost_scaling_dist)

    def _ahead(self, pose: Pose, v: float, w: float, distance: float) -> Floats:
        """Return the poses to which the command leads, up to the point that is pursued."""
        seconds = self.options.max_allowed_time_to_collision_up_to_carrot
        if v > 0.0:
            seconds = min(seconds, distance / v)
        times: Floats = np.arange(max(math.ceil(seconds / _STEP), 1) + 1, dtype=np.float64) * _STEP
        return _driven(pose, v, w, times)


def _driven(pose: Pose, v: float, w: float, times: Floats) -> Floats:
    """Return the poses of a robot after some times, in seconds, at constant speeds: rows of x, y and theta."""
    theta = pose.theta + w * times
    if abs(w) < 1e-6:
        return np.stack((pose.x + v * times * np.cos(theta), pose.y + v * times * np.sin(theta), theta), axis=1)
    x = pose.x + v / w * (np.sin(theta) - math.sin(pose.theta))
    y = pose.y - v / w * (np.cos(theta) - math.cos(pose.theta))
    return np.stack((x, y, theta), axis=1)


def _room(poses: Floats, around: Surroundings) -> float:
    """Return the least distance in metres that is left to what moves, at the poses after `_FORESIGHT`."""
    found = math.inf
    for each in around.movers:
        x, y = each.x + each.vx * _FORESIGHT, each.y + each.vy * _FORESIGHT
        far = np.sqrt((poses[:, 0] - x) ** 2 + (poses[:, 1] - y) ** 2) - each.radius
        found = min(found, float((far - _MARGIN - _SPREAD * _FORESIGHT).min()))
    return found


def _on_circle(inner: tuple[float, float], outer: tuple[float, float], radius: float) -> tuple[float, float]:
    """Return where the way from a point inside of a circle about the origin to one outside crosses it."""
    (x, y), dx, dy = inner, outer[0] - inner[0], outer[1] - inner[1]
    a, b, c = dx * dx + dy * dy, x * dx + y * dy, x * x + y * y - radius * radius
    share = (-b + math.sqrt(max(b * b - a * c, 0.0))) / a if a > 0.0 else 0.0
    return float(x + share * dx), float(y + share * dy)


def _collides(trajectory: Floats, pose: Pose, around: Surroundings) -> bool:
    x, y = trajectory[:, 0].astype(F), trajectory[:, 1].astype(F)
    found = costs_at(around.costs, x, y)
    if obstructed(around.costs, pose, x, y, found).any():
        return True
    if not len(around.outline) or found.max() < around.possible:
        return False
    return bool(highest_costs(around.costs, around.outline, trajectory, FREE).max() >= LETHAL)
