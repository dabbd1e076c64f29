"""Obstacles that move along a path by themselves: their position is a function of time alone."""

from __future__ import annotations

import math
from bisect import bisect_right
from itertools import accumulate

import pymunk

from robolink.sim.description import Obstacle
from robolink.sim.physics.bodies import moving_body
from robolink.sim.quantities import Point


class Mover:
    """An obstacle that moves along its path; its heading stays as it is."""

    def __init__(self, obstacle: Obstacle, dt: float) -> None:
        self.body: pymunk.Body = moving_body(obstacle)
        self.speed, self._dt = obstacle.speed, dt
        points = obstacle.path or (self.body.position, self.body.position)
        self._points = [*points, points[0]] if obstacle.closed else [*points, *reversed(points[:-1])]
        ways = [math.dist(*pair) for pair in zip(self._points, self._points[1:], strict=False)]
        self._starts = [0.0, *accumulate(ways)]

    def place(self, step: int) -> Point:
        """Return its position at a step: on the way to the path's end, on the way back, or round and round."""
        whole = self._starts[-1]
        if whole == 0.0:
            return self._points[0]
        way = math.fmod(self.speed * (step * self._dt), whole)
        index = min(bisect_right(self._starts, way), len(self._starts) - 1) - 1
        (x1, y1), (x2, y2) = self._points[index], self._points[index + 1]
        share = (way - self._starts[index]) / (self._starts[index + 1] - self._starts[index])
        return x1 + share * (x2 - x1), y1 + share * (y2 - y1)

    def aim(self, step: int) -> None:
        """Set the velocity that leads to its position at `step`, the next one."""
        (x, y), (now_x, now_y) = self.place(step), self.body.position
        self.body.velocity = ((x - now_x) / self._dt, (y - now_y) / self._dt)
