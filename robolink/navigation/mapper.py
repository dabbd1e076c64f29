"""Mapper: makes a map of a lidar's scans, and finds where the robot is in it (graph-based SLAM).

Whenever the robot has gone a bit, its scan becomes a keyframe: it is matched onto the last ones, which gives a step of
the pose graph. Where the robot comes by a place again, the scan is matched onto those from there, and the graph closes
the loop if that agrees with all that is known of the way between.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.geometry.plane import Pose, placed_on, seen_from
from robolink.navigation.grid import Floats, Grid
from robolink.navigation.occupancy import Beams, Occupancy
from robolink.navigation.pose_graph import PoseGraph
from robolink.navigation.scan_matching import Field, Match, Scan, Window, blended, refined, scan_of

FEWEST = 10
"""Points with which a scan is matched; with fewer odometry is believed."""
MOST = 360
"""Points of a scan that are matched: of more, each second or third is taken."""
_FINEST, _COARSEST = 0.02, 0.1
"""Range of the side of a matcher's cells, in metres: it refines below a cell, and time grows with the square."""
_SURE = (0.02, 0.006)
"""Deviations (metres, radians) of what lies between two keyframes up to which matching them would bring nothing."""
_CELLS = 800
"""Cells from the middle of a matcher's field to its border: where a lidar sees farther, they become larger."""
_AROUND = 40.0
"""Metres in x and in y around the last keyframe in which a lost robot is looked for."""
_BREAK = np.diag([1e4, 1e4, 1e2])
"""Covariance of a step that nothing was measured of: from the last pose of a map to the first one of a new start."""
_STRANGE = (0.55, 0.3)
"""Response below which a scan may not fit where the robot should be, and the share of its beams that the map denies
above which it does not."""
_LOST_AFTER = 3
"""Scans in a row that do not fit, after which the robot counts as lost."""
_JUMP = 3.0
"""Metres between two scans that odometry only has when it jumps."""
_GIVE_UP = 8.0
"""Metres of odometry after which a lost robot maps on from where odometry says that it is."""


class Options(NamedTuple):
    """Parameters of mapping by slam_toolbox's names, with its defaults; in metres and radians.

    See docs/reference/counterparts.md for those that differ in meaning.
    """

    minimum_travel_distance: float = 0.5
    minimum_travel_heading: float = 0.5
    use_scan_matching: bool = True
    scan_buffer_size: int = 10
    scan_buffer_maximum_scan_distance: float = 10.0
    link_match_minimum_response_fine: float = 0.1
    do_loop_closing: bool = True
    loop_search_maximum_distance: float = 3.0
    loop_match_minimum_chain_size: int = 10
    loop_match_maximum_variance_coarse: float = 3.0
    loop_match_minimum_response_coarse: float = 0.35
    loop_match_minimum_response_fine: float = 0.45
    correlation_search_space_dimension: float = 0.5
    correlation_search_space_resolution: float = 0.01
    correlation_search_space_smear_deviation: float = 0.1
    loop_search_space_dimension: float = 8.0
    loop_search_space_resolution: float = 0.05
    loop_search_space_smear_deviation: float = 0.03
    coarse_search_angle_offset: float = 0.349
    coarse_angle_resolution: float = 0.0349
    use_response_expansion: bool = True
    resolution: float = 0.05
    min_pass_through: int = 2
    occupancy_threshold: float = 0.1


class Keyframe(NamedTuple):
    """A scan of the map: its `beams` in the frame of the robot, and the points of them that are matched."""

    beams: Beams
    scan: Scan

    @property
    def points(self) -> Floats:
        """The points that are matched, in the frame of the robot."""
        return self.scan.points

    @property
    def radius(self) -> float:
        """Distance of the farthest of them from the robot, in metres."""
        return float(np.sqrt(np.square(self.points).sum(axis=1).max()))


class Fit(NamedTuple):
    """A scan in the map.

    `pose` is that of the robot, `covariance` its x, y (metres) and heading (radians), `response` the mean score of the
    match, from 0 to 1 (0 where nothing was matched). `is_lost` is True while scans do not fit the map: they are left
    out, and the pose is odometry's. `is_found` is True where that ended, and `closed` the metres by which a loop moved
    the map, None if there was none.
    """

    pose: Pose
    covariance: Floats
    response: float
    is_lost: bool = False
    is_found: bool = False
    closed: float | None = None


class Mapper:
    """Makes a map of scans, one after the other. `graph` has the poses of the `keyframes`.

    Args:
        options: How the map is made.
    """

    def __init__(self, options: Options | None = None) -> None:
        self.options = options or Options()
        self.graph = PoseGraph()
        self.keyframes: list[Keyframe] = []
        self.pose = Pose()
        self._odometry: Pose | None = None
        self._begin: Pose | None = None
        self._strange, self._odd_way = 0, 0.0
        self._last_loop = -10
        self._first = 0
        self._occupancy = self._empty()
        self._drawn: list[Pose] = []
        self.too_far = 0
        """Scans that were left out of the map, since it would have become too large."""

    def _empty(self) -> Occupancy:
        given = self.options
        return Occupancy(
            given.resolution,
            min_pass_through=given.min_pass_through,
            occupancy_threshold=given.occupancy_threshold,
        )

    def begin_at(self, pose: Pose) -> None:
        """Go on with this map from the next scan on, which was made near a pose."""
        self._begin, self._odometry = pose, None
        self._strange, self._odd_way = 0, 0.0

    def expected(self, odometry: Pose) -> Pose:
        """Return where the robot is in the map, by the last scan and the odometry since."""
        return self.pose if self._odometry is None else placed_on(self.pose, seen_from(self._odometry, odometry))

    def process(self, beams: Beams, odometry: Pose) -> Fit | None:
        """Take a scan into the map; return where it was made, None if the robot has not moved enough.

        Args:
            beams: The scan, in the frame of the robot.
            odometry: Pose of the robot by its odometry when it was made.
        """
        if self._odometry is not None and not self._has_moved(seen_from(self._odometry, odometry)):
            return None
        keyframe = keyframe_of(beams)
        if self._odometry is None:
            return self._started(keyframe, odometry)
        moved = seen_from(self._odometry, odometry)
        guess, spread = placed_on(self.pose, moved), _odometry_spread(moved, self.pose.theta)
        match = self._matched(keyframe, guess, spread, self._buffer())
        self._odometry = odometry
        if self._is_strange(match, keyframe, math.hypot(moved.x, moved.y)):
            alone = Match(guess, match.response, spread)
            return self._rejoined(keyframe, alone) or self._sought(keyframe, alone)
        return self._added(keyframe, match)

    def _has_moved(self, moved: Pose) -> bool:
        far = math.hypot(moved.x, moved.y) >= self.options.minimum_travel_distance
        return far or abs(moved.theta) >= self.options.minimum_travel_heading

    def _started(self, keyframe: Keyframe, odometry: Pose) -> Fit:
        """Begin a map where odometry says, or go on with one near the pose that was given."""
        self._odometry = odometry
        begin, self._begin = self._begin, None
        if begin is None or not self.keyframes:
            nothing = Match(begin or odometry, 0.0, np.zeros((3, 3)))
            return self._added(keyframe, nothing)
        found = self._placed_near(keyframe, begin, reach=1.0, turn=0.6) or self._placed_anywhere(keyframe)
        return self._anchored(keyframe, found or Match(begin, 0.0, np.diag([0.25, 0.25, 0.1])))

    def localize(self, beams: Beams, odometry: Pose) -> Fit | None:
        """Find where a scan was made, and leave the map as it is; None if the robot has not moved enough.

        Args:
            beams: The scan, in the frame of the robot.
            odometry: Pose of the robot by its odometry when it was made.
        """
        if not self.keyframes or (
            self._odometry is not None and not self._has_moved(seen_from(self._odometry, odometry))
        ):
            return None
        keyframe, guess = keyframe_of(beams), self.expected(odometry)
        spread, way = np.diag([0.25, 0.25, 0.1]), 0.0
        if self._odometry is None:
            guess, self._begin = self._begin or guess, None
            match = self._placed_near(keyframe, guess, reach=1.0, turn=0.6) or Match(guess, 0.0, spread)
        else:
            moved = seen_from(self._odometry, odometry)
            spread, way = _odometry_spread(moved, self.pose.theta), math.hypot(moved.x, moved.y)
            match = self._matched(keyframe, guess, spread, self._nearest(guess))
        self._odometry = odometry
        if not self._is_strange(match, keyframe, way):
            self.pose = match.pose
            return Fit(match.pose, match.covariance, match.response)
        found = self._placed_anywhere(keyframe) if self._strange >= _LOST_AFTER else None
        self.pose = found.pose if found else guess
        if found is None:
            return Fit(guess, spread, match.response, is_lost=True)
        self._strange = 0
        return Fit(found.pose, found.covariance, found.response, is_found=True)

    def _nearest(self, pose: Pose) -> list[int]:
        """Return the keyframes nearest to a pose, as many as a scan is matched onto."""
        far = np.hypot(*(self.graph.poses[:, :2] - pose[:2]).T)
        found: list[int] = np.argsort(far, kind="stable")[: self.options.scan_buffer_size].tolist()
        return found

    def _anchored(self, keyframe: Keyframe, match: Match) -> Fit:
        """Add a keyframe that does not follow the last one, tied to those around it."""
        nearest = self._nearest(match.pose)[0]
        self._strange, self._odd_way, self._first = 0, 0.0, len(self.keyframes)
        fit = self._added(keyframe, match, step=_BREAK)
        self._link(nearest, match)
        return fit

    def _link(self, source: int, match: Match) -> None:
        """Tie the last keyframe to an earlier one, by a match of it."""
        base = self.graph.pose(source)
        self.graph.link(source, len(self.keyframes) - 1, seen_from(base, match.pose), _turned(match, base))

    def _added(self, keyframe: Keyframe, match: Match, step: Floats | None = None) -> Fit:
        """Add a keyframe to the map, and close a loop if there is one."""
        before = self.graph.pose(-1) if self.keyframes else match.pose
        spread = _turned(match, before) if step is None else step
        number = self.graph.add(match.pose, spread)
        self.keyframes.append(keyframe)
        self.pose = match.pose
        closed = self._closed(number) if self.options.do_loop_closing and self.options.use_scan_matching else None
        self.pose = self.graph.pose(number)
        return Fit(self.pose, match.covariance, match.response, closed=closed)

    def _buffer(self) -> list[int]:
        """Return the last keyframes, as many as there may be, not too far off, and not of an earlier start."""
        first = max(self._first, len(self.keyframes) - self.options.scan_buffer_size)
        numbers = np.arange(first, len(self.keyframes))
        far = np.hypot(*(self.graph.poses[numbers, :2] - self.pose[:2]).T)
        near: list[int] = numbers[far <= self.options.scan_buffer_maximum_scan_distance].tolist()
        return near or [len(self.keyframes) - 1]

    def points_of(self, numbers: list[int]) -> Floats:
        """Return the points of keyframes in the map, and those between them on walls, as rows."""
        return np.concatenate([_placed(self.keyframes[each].scan.surface, self.graph.pose(each)) for each in numbers])

    def _matched(self, keyframe: Keyframe, guess: Pose, spread: Floats, numbers: list[int]) -> Match:
        """Match a scan onto keyframes around a guess, whose own covariance is given."""
        given = self.options
        alone = Match(guess, 0.0, spread)
        if not given.use_scan_matching or len(keyframe.points) < FEWEST:
            return alone
        reach = given.correlation_search_space_dimension / 2
        found = self._searched(keyframe, guess, numbers, reach)
        at_border = max(abs(found.pose.x - guess.x), abs(found.pose.y - guess.y)) > 0.9 * reach
        if given.use_response_expansion and (at_border or found.response < _STRANGE[0]):
            wider = self._searched(keyframe, guess, numbers, 3.0 * reach)
            found = wider if wider.response > found.response + 0.05 else found
        if found.response < given.link_match_minimum_response_fine:
            return alone._replace(response=found.response)
        return blended(found, guess, spread)

    def _searched(self, keyframe: Keyframe, guess: Pose, numbers: list[int], reach: float) -> Match:
        """Return the best match of a scan onto keyframes, up to `reach` metres from a guess in x and y."""
        given = self.options
        field = self._field(numbers, guess, keyframe, reach)
        window = Window(reach, given.coarse_search_angle_offset, given.coarse_angle_resolution / 4, (16, 4, 1))
        found = field.search(keyframe.points, guess, window)
        return refined(field, keyframe.scan, found[0] if found else guess)

    def _field(self, numbers: list[int], guess: Pose, keyframe: Keyframe, reach: float, *, loop: bool = False) -> Field:
        given = self.options
        finest = given.loop_search_space_resolution if loop else max(given.correlation_search_space_resolution, 0.03)
        cell = max(min(max(finest, _FINEST), _COARSEST), keyframe.radius / _CELLS)
        smear = given.loop_search_space_smear_deviation if loop else given.correlation_search_space_smear_deviation
        return Field(
            self.points_of(numbers),
            (guess.x, guess.y),
            keyframe.radius,
            resolution=cell,
            smear=max(smear, 1.2 * cell),
            reach=reach,
        )

    # Robots that were carried away, and maps that go on.

    def _is_strange(self, match: Match, keyframe: Keyframe, way: float) -> bool:
        """Return True if a scan does not fit where the robot should be, and is not to become part of the map."""
        # So far a robot does not drive between two scans: odometry began anew, or the world was reset.
        jumped = way > max(_JUMP, 3.0 * self.options.minimum_travel_distance)
        matched = self.options.use_scan_matching and len(keyframe.points) >= FEWEST
        fits = not matched or match.response >= _STRANGE[0]
        if fits or (not jumped and self._denied(keyframe, match.pose) < _STRANGE[1]):
            self._strange, self._odd_way = 0, 0.0
            return False
        self._strange = max(self._strange + 1, _LOST_AFTER if jumped else 0)
        self._odd_way += 0.0 if jumped else way
        return True

    def _denied(self, keyframe: Keyframe, pose: Pose) -> float:
        """Return the share of a scan's beams that the map denies: they end in free space, or go through a wall."""
        grid = self.grid()
        padded = grid._replace(cells=np.pad(grid.cells, 3, constant_values=-1))
        far = np.sqrt(np.square(keyframe.points).sum(axis=1))
        ends = _values(padded, _placed(keyframe.points, pose))
        lone = (ends == 0) & ~self._near_wall(padded, _placed(keyframe.points, pose))
        steps = np.arange(grid.resolution, max(float(far.max()), grid.resolution), grid.resolution)
        ways = keyframe.points[:, None, :] * (steps[:, None] / np.maximum(far, 1e-9)[:, None, None])
        walls = (_values(padded, _placed(ways.reshape(-1, 2), pose)) == 100).reshape(len(far), -1)
        through = (walls & (steps < far[:, None] - 4 * grid.resolution)).any(axis=1)
        return float((lone | through).mean())

    def _near_wall(self, padded: Grid, points: Floats) -> npt.NDArray[np.bool_]:
        """Return which points lie in an occupied cell or at most two from one."""
        found = np.zeros(len(points), np.bool_)
        for up in range(-2, 3):
            for right in range(-2, 3):
                found |= _values(padded, points + np.array([right, up]) * padded.resolution) == 100
        return found

    def _rejoined(self, keyframe: Keyframe, guess: Match) -> Fit | None:
        """Add a keyframe that old ones explain where the last ones do not; None if they do not, either.

        The wheels slipped farther than a match looks; or a lidar that looks ahead only turns to walls that the last
        keyframes have not seen, and the map has drifted since the old ones have.
        """
        found = self._placed_near(keyframe, guess.pose, reach=0.5, turn=0.35)
        if found is None or found.response < _STRANGE[0]:
            return None
        nearest = self._nearest(found.pose)[0]
        self._strange, self._odd_way = 0, 0.0
        self._added(keyframe, guess)
        self._link(nearest, found)
        self.graph.optimize()
        self.pose = self.graph.pose(len(self.keyframes) - 1)
        return Fit(self.pose, found.covariance, found.response)

    def _sought(self, keyframe: Keyframe, guess: Match) -> Fit:
        """Look for the robot in the whole map once it is lost; map on where odometry says if that fails for long."""
        self.pose = guess.pose
        found = self._placed_anywhere(keyframe) if self._strange >= _LOST_AFTER else None
        if found is not None:
            return self._anchored(keyframe, found)._replace(is_found=True)
        if self._odd_way > _GIVE_UP:
            self._strange, self._odd_way, self._first = 0, 0.0, len(self.keyframes)
            return self._added(keyframe, guess, step=_BREAK)._replace(is_found=True)
        return Fit(guess.pose, guess.covariance, guess.response, is_lost=True)

    def _placed_near(self, keyframe: Keyframe, guess: Pose, reach: float, turn: float) -> Match | None:
        """Match a scan onto the keyframes around a guess, however old they are; None if it does not fit."""
        found = self._coarse_to_fine(keyframe, guess, self._nearest(guess), Window(reach, turn, 0.0175, (16, 4, 1)))
        return found if found is not None and found.response >= self.options.loop_match_minimum_response_fine else None

    def _placed_anywhere(self, keyframe: Keyframe) -> Match | None:
        """Match a scan onto the whole map, in any heading; None if it does not fit well anywhere."""
        if len(keyframe.points) < FEWEST:
            return None
        poses = self.graph.poses[:, :2]
        within = np.flatnonzero(np.abs(poses - poses[-1]).max(axis=1) < _AROUND)
        low, high = poses[within].min(axis=0), poses[within].max(axis=0)
        middle, reach = Pose(*((low + high) / 2).tolist()), float((high - low).max()) / 2 + 1.0
        numbers = within[np.unique(np.linspace(0, len(within) - 1, 150).astype(int))].tolist()
        field = Field(
            self.points_of(numbers),
            (middle.x, middle.y),
            keyframe.radius,
            resolution=0.1,
            smear=0.12,
            reach=reach,
        )
        few = keyframe.points[:: max(1, len(keyframe.points) // 120)]
        found = field.search(few, middle, Window(reach, math.pi, 0.035, (32, 8, 2, 1)), least=0.7)
        return self._placed_near(keyframe, found[0], 0.2, 0.05) if found else None

    # Loops.

    def _coarse_to_fine(self, keyframe: Keyframe, guess: Pose, numbers: list[int], window: Window) -> Match | None:
        """Match a scan in a wide window, and then precisely; None if one of both does not fit well enough."""
        given = self.options
        if len(keyframe.points) < FEWEST:
            return None
        coarse = self._field(numbers, guess, keyframe, window.reach, loop=True)
        few = keyframe.points[:: max(1, len(keyframe.points) // 120)]
        found = coarse.search(few, guess, window, least=given.loop_match_minimum_response_coarse)
        if found is None:
            return None
        fine = self._field(numbers, found[0], keyframe, 0.15)
        near = fine.search(keyframe.points, found[0], Window(0.12, window.angle_step * 1.5, window.angle_step / 3))
        return refined(fine, keyframe.scan, near[0]) if near else None

    def _closed(self, number: int) -> float | None:
        """Close a loop at a keyframe if there is one; return the metres by which that moved the map."""
        chain = self._chain_near(number)
        if not chain or number - self._last_loop < 3:
            return None
        nearest = self._nearest_of(chain, number)
        spread = self.graph.relative_covariance(nearest, number)
        way, turn = math.sqrt(max(spread[0, 0], spread[1, 1])), math.sqrt(spread[2, 2])
        if way < _SURE[0] and turn < _SURE[1]:
            return None
        self._last_loop = number
        match = self._loop_match(number, nearest, chain, way, turn)
        if match is None:
            return None
        source = self.graph.pose(nearest)
        relative, spread = seen_from(source, match.pose), _turned(match, source)
        if self.graph.surprise(nearest, number, relative, spread) > 30.0:
            return None
        self.graph.link(nearest, number, relative, spread)
        moved = self.graph.optimize()
        return moved if self.graph.loops[-1].weight > 0.5 else None

    def _nearest_of(self, chain: list[int], number: int) -> int:
        """Return the keyframe of a chain that is nearest to another one, or nearly so and at the end of a loop already.

        The time to solve the graph grows with the number of keyframes at which loops end.
        """
        far = np.hypot(*(self.graph.poses[chain, :2] - self.graph.poses[number, :2]).T)
        ends = {each.source for each in self.graph.loops} | {each.target for each in self.graph.loops}
        used = np.isin(chain, list(ends)) & (far < far.min() + 0.7)
        return chain[int(np.where(used, far - 1.0, far).argmin())]

    def _chain_near(self, number: int) -> list[int]:
        """Return the longest run of earlier keyframes near a keyframe that is not a part of the way just driven."""
        given = self.options
        far = np.hypot(*(self.graph.poses[: number + 1, :2] - self.graph.poses[number, :2]).T)
        outside = np.flatnonzero(far > given.loop_search_maximum_distance)
        if not len(outside):
            return []
        last = min(int(outside[-1]), number - given.scan_buffer_size)
        inside = np.flatnonzero(far[: max(last, 0)] <= given.loop_search_maximum_distance)
        runs = np.split(inside, np.flatnonzero(np.diff(inside) > 1) + 1)
        longest = max(runs, key=lambda run: (len(run), -float(far[run].min()) if len(run) else 0.0))
        return longest.tolist() if len(longest) >= given.loop_match_minimum_chain_size else []

    def _loop_match(self, number: int, nearest: int, chain: list[int], way: float, turn: float) -> Match | None:
        """Match a keyframe onto a chain, as far around as the way between leaves open; None if it does not fit."""
        given, keyframe, pose = self.options, self.keyframes[number], self.graph.pose(number)
        reach = min(given.loop_search_space_dimension / 2, 0.3 + 3.0 * way)
        turn = min(given.coarse_search_angle_offset, 0.07 + 3.0 * turn)
        middle = chain.index(nearest)
        part = chain[max(0, middle - 6) : middle + 7]
        match = self._coarse_to_fine(keyframe, pose, part, Window(reach, turn, 0.0175, (16, 4, 1)))
        if match is None or match.response < given.loop_match_minimum_response_fine:
            return None
        if max(match.covariance[0, 0], match.covariance[1, 1]) > given.loop_match_maximum_variance_coarse:
            return None
        return match

    # The map.

    def grid(self) -> Grid:
        """Return the map: cells of 0 (free), 100 (occupied) and -1 (unknown)."""
        self.draw()
        return self._occupancy.grid()

    def draw(self, most: int | None = None) -> int:
        """Draw keyframes that are new or have moved, at most so many; return how many are left to draw."""
        stale = [each for each in range(len(self.keyframes)) if self._is_stale(each)]
        for number in stale[:most]:
            pose, beams = self.graph.pose(number), self.keyframes[number].beams
            if number < len(self._drawn):
                self._occupancy.remove(self._drawn[number], beams)
                self._drawn[number] = pose
            else:
                self._drawn.append(pose)
            fits = self._occupancy.add(pose, beams)
            self.too_far += not fits
        return len(stale) - len(stale[:most])

    def _is_stale(self, number: int) -> bool:
        """Return True if a keyframe is not drawn where it is, to a fifth of a cell at five metres."""
        if number >= len(self._drawn):
            return True
        gap, near = seen_from(self._drawn[number], self.graph.pose(number)), self.options.resolution / 5
        return max(abs(gap.x), abs(gap.y), abs(gap.theta) * 5.0) > near


def keyframe_of(beams: Beams) -> Keyframe:
    """Return the keyframe of a scan."""
    points = beams.points
    return Keyframe(beams, scan_of(points[:: max(1, math.ceil(len(points) / MOST))]))


def _placed(points: Floats, pose: Pose) -> Floats:
    cos, sin = math.cos(pose.theta), math.sin(pose.theta)
    x, y = points[:, 0], points[:, 1]
    return np.column_stack((cos * x - sin * y + pose.x, sin * x + cos * y + pose.y))


def _values(padded: Grid, points: Floats) -> npt.NDArray[np.int8]:
    """Return the values of the cells that points lie in, by a grid that three unknown cells were added around."""
    row, column = padded.world_to_cell(points[:, 0], points[:, 1])
    height, width = padded.cells.shape
    found: npt.NDArray[np.int8] = padded.cells[np.clip(row + 3, 0, height - 1), np.clip(column + 3, 0, width - 1)]
    return found


def _odometry_spread(moved: Pose, heading: float) -> Floats:
    """Return the covariance of a step by odometry: a tenth of the way and the turn, and a drift of 0.02 rad a metre."""
    way = math.hypot(moved.x, moved.y)
    along, turn = 0.01 + 0.1 * way, 0.01 + 0.1 * abs(moved.theta) + 0.02 * way
    return np.diag([along**2, along**2, turn**2])


def _turned(match: Match, base: Pose) -> Floats:
    """Return the covariance of a match in the frame of a pose."""
    cos, sin = math.cos(base.theta), math.sin(base.theta)
    turn = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(turn @ match.covariance @ turn.T)
