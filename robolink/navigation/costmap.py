"""Costmaps: cells with the cost of standing there, from a map and from what sensors see, inflated by distance.

A `Costmap` is written by its layers in their order, as Nav2's is: each says first which window of cells may change, and
then writes its costs into that window. Costs are 0 for free cells, 254 for obstacles, 253 for cells from which the
robot's centre touches one, 255 for unknown, and the more the nearer between.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from robolink.geometry.plane import Pose, placed_on
from robolink.navigation.footprint import FREE, INSCRIBED, LETHAL, UNKNOWN, contains
from robolink.navigation.grid import FAR, Floats, Grid, squared_distances
from robolink.navigation.tracing import Span, trace

Costs = npt.NDArray[np.uint8]

MAXIMUM, OVERWRITE, KNOWN_MAXIMUM = 1, 0, 2
"""Ways of an obstacle layer to combine costs (Nav2's): the larger one, its own, or the larger one of known cells."""


class Window(NamedTuple):
    """Rectangle of cells: rows from `bottom` to before `top`, columns from `left` to before `right`."""

    bottom: int
    top: int
    left: int
    right: int

    @property
    def cells(self) -> tuple[slice, slice]:
        """The index of these cells in an array."""
        return slice(self.bottom, self.top), slice(self.left, self.right)

    def joined(self, other: Window | None) -> Window:
        """Return the smallest window that holds both."""
        if other is None:
            return self
        low, high = (min(self.bottom, other.bottom), min(self.left, other.left)), (other.top, other.right)
        return Window(low[0], max(self.top, high[0]), low[1], max(self.right, high[1]))

    def grown(self, cells: int, shape: tuple[int, ...]) -> Window:
        """Return a window with a margin of `cells` cells, cut off at the edge of an array of `shape`."""
        bottom, left = max(self.bottom - cells, 0), max(self.left - cells, 0)
        return Window(bottom, min(self.top + cells, shape[0]), left, min(self.right + cells, shape[1]))


def whole(shape: tuple[int, ...]) -> Window:
    """Return the window of all cells of an array."""
    return Window(0, shape[0], 0, shape[1])


class Layer(Protocol):
    """A part of a costmap that writes costs into it."""

    def match(self, grid: Grid) -> None:
        """Take over a new size and place of the costmap; what was known of the old one is lost."""

    def roll(self, rows: int, columns: int) -> None:
        """Follow a costmap whose first cell has moved by some cells."""

    def look(self, grid: Grid, robot: Pose, window: Window | None) -> Window | None:
        """Take in what is new; return the window of cells that may change, which holds that of the layers before."""

    def write(self, costs: Costs, window: Window) -> None:
        """Write costs into a window of the costmap."""

    def clear(self, retained: npt.NDArray[np.bool_]) -> None:
        """Remove what was seen but in the cells that are True in `retained`."""


class Costmap:
    """A grid of costs that layers write.

    `grid` is replaced by each update and never changed, so that whoever reads one has cells that belong together.

    Args:
        grid: Geometry; its cells only say how many there are.
        layers: Layers in the order in which they write.
        default: Cost of cells that no layer knows.
        rolling: True keeps the robot in the middle, else the place is fixed.
    """

    def __init__(self, grid: Grid, layers: Sequence[Layer], *, default: int = FREE, rolling: bool = False) -> None:
        self.layers, self.default, self.rolling = list(layers), default, rolling
        self.match(grid)

    def match(self, grid: Grid) -> None:
        """Take over the size and place of `grid`: all cells have the default cost until the next update."""
        self.grid = Grid(np.full(grid.cells.shape, self.default, np.uint8), grid.resolution, grid.origin)
        self._start, self._moved = grid.origin, (0, 0)
        self._is_new = True
        for layer in self.layers:
            layer.match(self.grid)

    def update(self, robot: Pose) -> Window | None:
        """Let the layers write what is new; return the window of cells that may have changed, None for none.

        Args:
            robot: Pose of the robot in the frame of the costmap.
        """
        grid = self._followed(robot) if self.rolling else self.grid
        window: Window | None = None
        for layer in self.layers:
            window = layer.look(grid, robot, window)
        if self.rolling or self._is_new:
            window = whole(grid.cells.shape)
        self._is_new = False
        if window is not None:
            cells = grid.cells.copy()
            cells[window.cells] = self.default
            for layer in self.layers:
                layer.write(cells, window)
            self.grid = grid._replace(cells=cells)
        return window

    def clear(self, retained: npt.NDArray[np.bool_] | None = None) -> None:
        """Remove what sensors saw, but in the cells that are True in `retained`; the next update writes all anew."""
        shape = self.grid.cells.shape
        for layer in self.layers:
            layer.clear(np.zeros(shape, bool) if retained is None else retained)
        self._is_new = True

    def renew(self) -> None:
        """Write all cells anew in the next update, since what layers are made of has changed."""
        for layer in self.layers:
            if isinstance(layer, InflationLayer):
                layer.match(self.grid)
        self._is_new = True

    def square(self, x: float, y: float, side: float) -> npt.NDArray[np.bool_]:
        """Return the cells of a square: an array of the costmap's shape.

        Args:
            x: Middle of the square in metres.
            y: Middle of the square in metres.
            side: Length of a side in metres.
        """
        row, column = map(int, self.grid.world_to_cell(x, y))
        half = math.ceil(min(max(side / 2 / self.grid.resolution, 0.0), FAR))
        found = np.zeros(self.grid.cells.shape, bool)
        found[max(row - half, 0) : max(row + half, 0), max(column - half, 0) : max(column + half, 0)] = True
        return found

    def _followed(self, robot: Pose) -> Grid:
        """Return the grid, moved by whole cells so that the robot is in the middle; its cells are to be written yet."""
        height, width = self.grid.cells.shape
        resolution = self.grid.resolution
        x, y = robot.x - width * resolution / 2, robot.y - height * resolution / 2
        moved = math.floor((y - self._start[1]) / resolution), math.floor((x - self._start[0]) / resolution)
        rows, columns = moved[0] - self._moved[0], moved[1] - self._moved[1]
        if not rows and not columns:
            return self.grid
        self._moved = moved
        for layer in self.layers:
            layer.roll(rows, columns)
        # From the start, not from the last place: so errors do not add up.
        return self.grid._replace(
            origin=(self._start[0] + moved[1] * resolution, self._start[1] + moved[0] * resolution, 0.0)
        )


def rolled(cells: Costs, rows: int, columns: int, default: int) -> Costs:
    """Return cells as they are after the first one has moved by `rows` and `columns`; new ones have the default."""
    height, width = cells.shape
    found = np.full_like(cells, default)
    if abs(rows) < height and abs(columns) < width:
        found[max(-rows, 0) : height - max(rows, 0), max(-columns, 0) : width - max(columns, 0)] = cells[
            max(rows, 0) : height + min(rows, 0), max(columns, 0) : width + min(columns, 0)
        ]
    return found


class Occupancies(NamedTuple):
    """Meaning of an occupancy grid's values, by Nav2's names."""

    track_unknown_space: bool = False
    lethal_cost_threshold: int = 100
    unknown_cost_value: int = 255
    inscribed_obstacle_cost_value: int = 99
    trinary_costmap: bool = True

    def costs_of(self, cells: npt.NDArray[np.int8]) -> Costs:
        """Return the costs of the cells of an occupancy grid, of 0 to 100 or -1 for unknown."""
        value = np.arange(256)
        threshold = min(max(self.lethal_cost_threshold, 1), 100)
        between = np.where(self.trinary_costmap, FREE, LETHAL * value // threshold)
        table = np.where(value >= threshold, LETHAL, between)
        table[value == self.inscribed_obstacle_cost_value] = INSCRIBED
        table[value == self.unknown_cost_value] = UNKNOWN if self.track_unknown_space else FREE
        return np.take(table.astype(np.uint8), cells.view(np.uint8))


class StaticLayer:
    """Layer of a map. A fixed costmap has the map's own cells; one that rolls looks them up.

    Args:
        use_maximum: True keeps a cost of the layers below where it is the larger one.
    """

    def __init__(self, use_maximum: bool = False) -> None:
        self.use_maximum = use_maximum
        self.enabled = True
        self.map: Grid | None = None
        """The map's costs; a costmap that does not roll has `match`ed it."""
        self.frame: Pose | None = Pose()
        """Pose of the costmap's frame in the map's; None while it is unknown."""
        self._grid: Grid | None = None
        self._is_new = False

    def take(self, costs: Grid) -> None:
        """Take a map."""
        self.map, self._is_new = costs, True

    def match(self, grid: Grid) -> None:
        """See `Layer`."""
        self._grid = grid

    def roll(self, rows: int, columns: int) -> None:
        """See `Layer`."""

    def look(self, grid: Grid, robot: Pose, window: Window | None) -> Window | None:
        """See `Layer`."""
        self._grid = grid
        changed = whole(grid.cells.shape) if self._is_new else window
        self._is_new = False
        return changed

    def write(self, costs: Costs, window: Window) -> None:
        """See `Layer`."""
        if self.map is None or not self.enabled or self._grid is None:
            return
        if self.map.cells.shape == costs.shape and self.map[1:] == self._grid[1:]:
            own, there = self.map.cells[window.cells], None
        else:
            own, there = self._looked_up(self.map, self._grid, window)
        below = costs[window.cells]
        found = larger(below, own) if self.use_maximum else own
        costs[window.cells] = found if there is None else np.where(there, found, below)

    def _looked_up(self, map_: Grid, grid: Grid, window: Window) -> tuple[Costs, npt.NDArray[np.bool_]]:
        """Return the map's costs in a window of the costmap, and in which of these cells it has any."""
        if self.frame is None:
            shape = window.top - window.bottom, window.right - window.left
            return np.zeros(shape, np.uint8), np.zeros(shape, bool)
        # The two grids' frames differ by a rigid motion: it is cheaper to move the grid than its points.
        origin = placed_on(self.frame, Pose(*grid.origin))
        moved = grid._replace(origin=(origin.x, origin.y, origin.theta))
        rows, columns = np.mgrid[window.cells]
        row, column = map_.world_to_cell(*moved.cell_to_world(rows, columns))
        there = map_.contains(row, column)
        height, width = map_.cells.shape
        return map_.cells[row.clip(0, height - 1), column.clip(0, width - 1)], there

    def clear(self, retained: npt.NDArray[np.bool_]) -> None:
        """See `Layer`. A map is nothing that sensors saw."""


def larger(below: Costs, above: Costs) -> Costs:
    """Return the larger of two costs of each cell, where an unknown one is less than all others."""
    # By one more, unknown becomes 0.
    one = np.uint8(1)
    found: Costs = np.maximum(below + one, above + one) - one
    return found


class Observation(NamedTuple):
    """Points that a sensor saw at one time, in metres in the frame of the costmap.

    `origin` is where the sensor was. Points within the distances of `marks` are obstacles, and up to the distance of
    `clears` there is nothing before a point; None for a sensor that does not mark, or not clear.
    """

    origin: tuple[float, float]
    x: Floats
    y: Floats
    marks: Span | None
    clears: Span | None


class ObstacleLayer:
    """Layer of what sensors see: points are obstacles, and the way to them is free.

    Args:
        default: Cost of cells that nothing was seen of: `UNKNOWN` or `FREE`.
        combination: `MAXIMUM`, `OVERWRITE` or `KNOWN_MAXIMUM`.
    """

    def __init__(self, default: int = FREE, combination: int = MAXIMUM) -> None:
        self.default, self.combination = default, combination
        self.enabled = True
        self.observations: list[Observation] = []
        """Observations that each update looks at, until they are replaced."""
        self.footprint: Floats | None = None
        """Polygon about the robot's origin that is free, in metres; None for none."""
        self.is_outside = False
        """True if a sensor was off the costmap, which cannot use what it saw."""
        self.cells: Costs = np.zeros((0, 0), np.uint8)

    def match(self, grid: Grid) -> None:
        """See `Layer`."""
        self.cells = np.full(grid.cells.shape, self.default, np.uint8)

    def roll(self, rows: int, columns: int) -> None:
        """See `Layer`."""
        self.cells = rolled(self.cells, rows, columns, self.default)

    def look(self, grid: Grid, robot: Pose, window: Window | None) -> Window | None:
        """See `Layer`."""
        self.is_outside = False
        if not self.enabled:
            return window
        for observation in self.observations:
            window = self._free(grid, observation, window)
        for observation in self.observations:
            self._mark(grid, observation)
        return window if self.footprint is None else self._free_footprint(grid, robot, self.footprint, window)

    def _free(self, grid: Grid, observation: Observation, window: Window | None) -> Window | None:
        """Free the cells on the lines to the points; return the window of all that the observation may change."""
        row, column = map(int, grid.world_to_cell(*observation.origin))
        if not grid.contains(row, column):
            self.is_outside = True
            return window
        spans = [each.most for each in (observation.marks, observation.clears) if each is not None]
        farthest = math.ceil(min(max(spans, default=0.0) / grid.resolution, sum(self.cells.shape))) + 1
        if observation.clears is not None:
            least, most = (each / grid.resolution for each in observation.clears)
            rows, columns = grid.world_to_cell(observation.x, observation.y)
            seen = trace(self.cells.shape, (row, column), rows, columns, Span(math.ceil(least), math.ceil(most)))
            self.cells.reshape(-1)[seen] = FREE
        return Window(row, row + 1, column, column + 1).grown(farthest, self.cells.shape).joined(window)

    def _mark(self, grid: Grid, observation: Observation) -> None:
        """Mark the cells of points as obstacles."""
        if observation.marks is None or not grid.contains(*grid.world_to_cell(*observation.origin)):
            return
        dx, dy = observation.x - observation.origin[0], observation.y - observation.origin[1]
        squares = dx * dx + dy * dy
        rows, columns = grid.world_to_cell(observation.x, observation.y)
        least, most = observation.marks
        found = grid.contains(rows, columns) & (squares <= most * most) & (squares >= least * least)
        self.cells[rows[found], columns[found]] = LETHAL

    def _free_footprint(self, grid: Grid, robot: Pose, footprint: Floats, window: Window | None) -> Window | None:
        """Free the cells under the robot; return the window that holds them, too."""
        cos, sin = math.cos(robot.theta), math.sin(robot.theta)
        x = robot.x + cos * footprint[:, 0] - sin * footprint[:, 1]
        y = robot.y + sin * footprint[:, 0] + cos * footprint[:, 1]
        rows, columns = grid.world_to_cell(x, y)
        height, width = self.cells.shape
        low, high = (int(rows.min()), int(columns.min())), (int(rows.max()) + 1, int(columns.max()) + 1)
        under = Window(max(low[0], 0), min(high[0], height), max(low[1], 0), min(high[1], width))
        if under.bottom >= under.top or under.left >= under.right:
            return window
        if not self.cells[under.cells].any():  # all is free already
            return under.joined(window)
        across, up = grid.cell_to_world(*np.mgrid[under.cells])
        inside = contains(np.column_stack((x, y)), np.column_stack((across.ravel(), up.ravel())))
        self.cells[under.cells][inside.reshape(across.shape)] = FREE
        return under.joined(window)

    def write(self, costs: Costs, window: Window) -> None:
        """See `Layer`."""
        if not self.enabled:
            return
        own, below = self.cells[window.cells], costs[window.cells]
        if self.combination == OVERWRITE:
            costs[window.cells] = np.where(own == UNKNOWN, below, own)
        elif self.combination == KNOWN_MAXIMUM:
            costs[window.cells] = np.where(below == UNKNOWN, below, larger(below, own))
        else:
            costs[window.cells] = larger(below, own)

    def clear(self, retained: npt.NDArray[np.bool_]) -> None:
        """See `Layer`."""
        self.cells[~retained] = self.default


class InflationLayer:
    """Layer that gives cells near obstacles a cost, which falls with the distance.

    Within the inscribed radius of the robot it is 253, beyond 252 exp(-`scaling` (d - inscribed)), where d is the
    distance in metres, up to `radius`: Nav2's formula.

    Args:
        radius: Distance from an obstacle up to which cells have a cost, in metres.
        scaling: How fast the cost falls, in 1/m.
        inscribed: Inscribed radius of the robot in metres.
        inflate_unknown: True gives unknown cells a cost, too; else only those within the inscribed radius.
        around_unknown: True takes unknown cells for obstacles.
    """

    def __init__(
        self,
        radius: float = 0.55,
        scaling: float = 10.0,
        inscribed: float = 0.1,
        *,
        inflate_unknown: bool = False,
        around_unknown: bool = False,
    ) -> None:
        self.radius, self.scaling, self.inscribed = radius, scaling, inscribed
        self.inflate_unknown, self.around_unknown = inflate_unknown, around_unknown
        self.enabled = True
        self._cells, self._table = 0, np.zeros(1, np.uint8)

    def match(self, grid: Grid) -> None:
        """See `Layer`. It is to be called after the radii have changed."""
        self._cells = min(math.ceil(self.radius / grid.resolution), sum(grid.cells.shape))
        self._table = self._costs_by_square(grid.resolution)

    def _costs_by_square(self, resolution: float) -> Costs:
        """Return the cost by the squared distance in cells; the last one is of all that is farther."""
        distances = np.sqrt(np.arange(self._cells * self._cells + 1)) * resolution
        beyond = np.maximum(distances - self.inscribed, 0.0).tolist()
        found = np.array([int((INSCRIBED - 1) * math.exp(-self.scaling * each)) for each in beyond], np.uint8)
        found[distances <= self.inscribed] = INSCRIBED
        found[0] = LETHAL
        # Nav2 gives a cost at exactly the radius, too; here it is one with all that is beyond.
        found[-1] = FREE
        return found

    def roll(self, rows: int, columns: int) -> None:
        """See `Layer`."""

    def look(self, grid: Grid, robot: Pose, window: Window | None) -> Window | None:
        """See `Layer`."""
        return window if window is None else window.grown(self._cells, grid.cells.shape)

    def write(self, costs: Costs, window: Window) -> None:
        """See `Layer`."""
        if not self.enabled or not self._cells:
            return
        around = window.grown(self._cells, costs.shape)
        near = costs[around.cells]
        occupied = (near == LETHAL) | (near == UNKNOWN) if self.around_unknown else near == LETHAL
        inside = tuple(
            slice(each.start - low, each.stop - low)
            for each, low in zip(window.cells, (around.bottom, around.left), strict=True)
        )
        inflated = self._table[squared_distances(occupied, self._cells)[inside]]
        below = costs[window.cells]
        known = np.maximum(below, inflated)
        least = 1 if self.inflate_unknown else INSCRIBED
        costs[window.cells] = np.where((below == UNKNOWN) & (inflated >= least), inflated, known)

    def clear(self, retained: npt.NDArray[np.bool_]) -> None:
        """See `Layer`."""
