"""What a lidar can see: the fixed shapes, and where the moving ones are now."""

from __future__ import annotations

import numpy as np
import pymunk

from robolink.sim.description import Pose, Shape, WorldDescription
from robolink.sim.geometry import Array, Corners, edges, fixed_circles, fixed_segments


class Scene:
    """All shapes of a world as arrays of segments and circles, read anew when `step` has changed."""

    def __init__(self, description: WorldDescription) -> None:
        self.fixed_segments = fixed_segments(description)
        self.fixed_circles = fixed_circles(description)
        self._discs: list[tuple[pymunk.Body, float]] = []
        self._boxes: list[tuple[pymunk.Body, Corners]] = []
        self._segments, self._circles = self.fixed_segments, self.fixed_circles
        self.step, self._seen = 0, -1

    def add(self, body: pymunk.Body, shape: Shape) -> None:
        """Add something that moves."""
        if shape.circle is not None:
            self._discs.append((body, shape.circle))
        else:
            self._boxes.append((body, shape.corners()))
        self._seen = -1

    def around(self, body: pymunk.Body) -> tuple[Array, Array]:
        """Give the segments (x1, y1, x2, y2) and circles (x, y, radius) of all but `body`."""
        if self._seen != self.step:
            self._update()
            self._seen = self.step
        return self._segments_without(body), self._circles_without(body)

    def _update(self) -> None:
        if self._discs:
            rows = [[*body.position, radius] for body, radius in self._discs]
            self._circles = np.concatenate((self.fixed_circles, rows))
        if self._boxes:
            boxes = [edges(corners, Pose(*body.position, body.angle)) for body, corners in self._boxes]
            self._segments = np.concatenate((self.fixed_segments, *boxes))

    def _circles_without(self, body: pymunk.Body) -> Array:
        for index, (each, _) in enumerate(self._discs):
            if each is body:
                return np.delete(self._circles, len(self.fixed_circles) + index, axis=0)
        return self._circles

    def _segments_without(self, body: pymunk.Body) -> Array:
        for index, (each, _) in enumerate(self._boxes):
            if each is body:
                first = len(self.fixed_segments) + 4 * index
                return np.delete(self._segments, slice(first, first + 4), axis=0)
        return self._segments
