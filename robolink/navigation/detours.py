"""Detours without a map: what a scanner sees makes a costmap that moves with the robot, and a way leads through it."""

from __future__ import annotations

import math

import numpy as np

from robolink.geometry.plane import Pose
from robolink.navigation.costmap import Costmap, InflationLayer, Observation, ObstacleLayer
from robolink.navigation.footprint import INSCRIBED
from robolink.navigation.grid import Floats, Grid
from robolink.navigation.planning import PlanError, PlanOptions, plan
from robolink.navigation.tracing import Span

SIDE, CELL = 8.0, 0.05
"""Side of the costmap, and of its cells, in metres."""
EDGE = 0.3
"""Metres from the costmap's edge beyond which a goal is taken for one at the edge."""
REACH = 0.7
"""Distance in metres of the place on the way round to which the robot drives."""


class Detours:
    """Ways round everything that a scanner has seen, in the frame of odometry.

    Args:
        inscribed: Distance of the robot's middle from what it must not touch, in metres.
    """

    def __init__(self, inscribed: float) -> None:
        count = round(SIDE / CELL)
        self._layer = ObstacleLayer()
        inflation = InflationLayer(inscribed + 0.3, 5.0, inscribed)
        self._costmap = Costmap(Grid(np.zeros((count, count), np.uint8), CELL), [self._layer, inflation], rolling=True)

    def see(self, robot: Pose, ahead: Floats, left: Floats) -> None:
        """Take in the points that a scan met, in metres ahead and to the left of the robot."""
        cos, sin = math.cos(robot.theta), math.sin(robot.theta)
        x, y = robot.x + cos * ahead - sin * left, robot.y + sin * ahead + cos * left
        reach = Span(0.0, SIDE / 2)
        self._layer.observations = [Observation((robot.x, robot.y), x, y, reach, reach)]
        self._costmap.update(robot)

    def aim(self, robot: Pose, goal: Pose) -> Pose | None:
        """Return the pose to drive to now, in the frame of odometry.

        It is the goal itself if nothing is between, or a place on the way round what is; None if there is no way.
        """
        distance = math.dist(robot[:2], goal[:2])
        share = min(1.0, (SIDE / 2 - EDGE) / max(distance, 1e-9))
        near = Pose(robot.x + share * (goal.x - robot.x), robot.y + share * (goal.y - robot.y), goal.theta)
        if self._is_free(robot, near):
            return goal
        try:
            path = plan(self._costmap.grid, robot, near, PlanOptions(final_approach=True))
        except PlanError:
            return None
        ways = np.hypot(path[:, 0] - robot.x, path[:, 1] - robot.y)
        for index in np.flatnonzero(ways <= REACH)[::-1].tolist():
            place = Pose(*path[index].tolist())
            if ways[index] > 2 * CELL and self._is_free(robot, place):
                return place
        return Pose(*path[min(len(path) - 1, 4)].tolist())

    def _is_free(self, robot: Pose, place: Pose) -> bool:
        """Return whether the robot can drive straight to a place."""
        grid, count = self._costmap.grid, max(2, math.ceil(math.dist(robot[:2], place[:2]) / CELL) + 1)
        share = np.linspace(0.0, 1.0, count)
        x, y = robot.x + share * (place.x - robot.x), robot.y + share * (place.y - robot.y)
        rows, columns = grid.world_to_cell(x, y)
        inside = grid.contains(rows, columns)
        return bool(inside.all()) and bool((grid.cells[rows, columns] < INSCRIBED).all())
