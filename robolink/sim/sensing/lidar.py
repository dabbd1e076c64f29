"""Distances along beams: laser scanners and range finders."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np

from robolink.geometry.trigonometry import cos_and_sin
from robolink.sim.arrays import Array, Indices, Place
from robolink.sim.quantities import Pose
from robolink.sim.sensing.scene import NOBODY, NORMAL, REFLECTANCE, Circles, Surroundings, X, Y
from robolink.sim.sensors import Lidar

# Planar laser scanners, exact and without ray casting: each shape covers one interval of beams.
#
# Seen from the sensor a segment spans an interval of beam indices. All intervals are expanded once into (beam,
# shape) pairs; the inverse range of a beam with direction u to a line is ``u . g``, linear in u, where ``g`` is the
# line's unit normal over its distance. The nearest shape is then the largest inverse range of each beam.


Numbers: TypeAlias = "float | Array"
"""One number for all sensors, or one for each."""

_EDGE = 1e-9
"""Margin of an interval beyond its ends, in beams, so that rounding leaves no gap at a corner."""

_GRAZING = 0.01
"""Distance in metres below which a line may be seen so edge-on that its range beside its ends would mean nothing."""

_EDGE_ON = 1e-9
"""Distance in metres below which a line has no range of its own: the nearest point of the segment counts."""

_TOUCHING = 1e-12
"""Range in metres of a shape that touches the sensor."""

_AT_ONCE = 20_000
"""Number of beams that are computed together, so that arrays stay in the processor's cache."""

_MANY = 64
"""Number of circles from which on it pays to leave out hidden ones."""

_BLOCK = 8
"""Number of beams that are asked together if they end before a circle."""

_NEAR = 1e-6
"""Share of a range, and distance in metres, within which a circle is not taken to be hidden."""

_FREED = 4 << 20
"""Size of the block that `_keep_memory` frees, in bytes."""


class Beams:
    """The fixed directions of a scanner's beams, in its own frame, and its reach in metres."""

    def __init__(self, lidar: Lidar) -> None:
        self.full = lidar.fov == 360.0
        fov = math.tau if self.full else math.radians(lidar.fov)
        self.count = lidar.beams
        self.increment = fov / (lidar.beams if self.full else lidar.beams - 1)
        self.start = math.radians(lidar.right)
        self.period = float(lidar.beams) if self.full else math.tau / self.increment
        self.reach = lidar.range[1] + 8 * lidar.noise
        self.stride = 2 * lidar.beams if self.full else lidar.beams  # twice round, so that no interval is split
        self.cos, self.sin = cos_and_sin(self.start + self.increment * np.arange(lidar.beams, dtype=np.float64))
        self._directions = np.resize(np.column_stack((self.cos, self.sin)), (self.stride, 2))

    def directions(self, sensors: int) -> Array:
        """Return the directions of all beams of a number of sensors, `stride` of each, as rows of cosine and sine."""
        if len(self._directions) < sensors * self.stride:
            _keep_memory()
            self._directions = np.resize(self._directions, (sensors * self.stride, 2))
        return self._directions


def _keep_memory() -> None:
    """Make glibc's malloc keep the memory of a batch's arrays for the next batch.

    It gives back to the system what is free beyond twice the largest block that was ever freed; else the pages of
    each batch would be requested again, which takes as long as a third of its arithmetic.
    """
    np.empty(_FREED, dtype=np.uint8)


def distances(beams: Beams, sensor: Pose, surroundings: Surroundings, own: int = NOBODY) -> Array:
    """Return the range of each beam of a sensor at a pose (in the world): metres, inf for nothing within reach.

    `own` is the number of the moving shape that the sensor is mounted on, which it does not see.
    """
    found: Array = measured(beams, [(sensor.x, sensor.y, sensor.theta)], [own], surroundings)[0][0]
    return found


def distances_batch(beams: Beams, poses: Array, surroundings: Surroundings, own: Indices | None = None) -> Array:
    """Return the ranges of many sensors of one kind as an array (sensors, beams), each row as from `distances`.

    `poses` are rows x, y, theta in the world; `own` is for each the number of the moving shape that it is mounted
    on (`Scene.number`). How many are measured together changes no bit of a result.
    """
    return measured(beams, *_listed(poses, own), surroundings)[0]


def returns_batch(
    beams: Beams, poses: Array, surroundings: Surroundings, own: Indices | None = None
) -> tuple[Array, Array]:
    """Return the ranges as `distances_batch`, and as an array of the same shape the light that comes back.

    That is a share: the reflectance of the shape that a beam hits times the cosine of the angle at which it does;
    0 where there is nothing.
    """
    return measured(beams, *_listed(poses, own), surroundings, lit=True)


def measured(
    beams: Beams, places: Sequence[Place], own: Sequence[int], surroundings: Surroundings, lit: bool = False
) -> tuple[Array, Array]:
    """Return ranges and light of sensors (of light no columns unless `lit`), computed for some of them at a time.

    `places` and `own` are those of `distances_batch`, as lists.
    """
    if len(places) == 1:
        return _nearest(beams, 1, *_look(beams, places, own, surroundings, lit), lit)
    ranges, light = np.empty((len(places), beams.count)), np.empty((len(places), beams.count if lit else 0))
    order = _by_neighbourhood(places, beams.reach)
    places, own = [places[row] for row in order], [own[row] for row in order]
    first = 0
    while first < len(places):
        segments = surroundings.segments_near(*places[first][:2], beams.reach, own[first]).shape[1]
        last = min(first + max(1, _AT_ONCE // max(beams.stride, 3 * segments)), len(places))
        looked = _look(beams, places[first:last], own[first:last], surroundings, lit)
        ranges[order[first:last]], light[order[first:last]] = _nearest(beams, last - first, *looked, lit)
        first = last
    return ranges, light


def _by_neighbourhood(places: Sequence[Place], reach: float) -> Indices:
    """Return an order in which neighbours follow each other, along strips: so they have few circles near them."""
    x, y, _ = np.array(places).reshape(-1, 3).T
    order: Indices = np.lexsort((y, np.floor(x / reach)))
    return order


def limited(ranges: Array, range_min: float, range_max: float) -> Array:
    """Apply a scanner's limits to ranges, in place, as in REP 117: too far is +inf, too near -inf."""
    np.putmask(ranges, ranges > range_max, np.inf)
    np.putmask(ranges, ranges < range_min, -np.inf)
    return ranges


class _Eyes(NamedTuple):
    """Sensors as arrays: for each the index of its first beam among all, its position, heading and first direction.

    Each is an array, with an entry for each sensor or for each shape that one looks at. Of one sensor it is a plain
    number, which is quicker and gives the same. The direction of the first beam is in turns, from the x axis.
    """

    number: int
    first: int | Indices
    x: Numbers
    y: Numbers
    cos: Numbers
    sin: Numbers
    turn: Numbers

    def of(self, rows: Indices) -> _Eyes:
        """Return for each shape the sensor that sees it."""
        if self.number == 1:
            return self
        facts: list[Array] = [np.take(each, rows) for each in self[2:]]
        return _Eyes(self.number, np.take(self.first, rows), *facts)


class _Spans(NamedTuple):
    """Intervals of beams: the shape of each (None: one per shape, in order), its number of beams, and which."""

    who: Indices | None
    counts: Indices
    beams: Indices

    def spread(self, values: Array) -> Array:
        """Repeat the value of each shape for each of its beams."""
        return (values if self.who is None else values.take(self.who)).repeat(self.counts)

    def along(self, directions: Array, vectors: Array) -> Array:
        """Return the scalar product of each beam's direction and its shape's vector; x and y are rows of `vectors`."""
        if self.who is not None:
            vectors = vectors.take(self.who, axis=1)
        products = vectors.T.repeat(self.counts, axis=0)
        products *= directions.take(self.beams, axis=0)
        found: Array = products[:, 0] + products[:, 1]
        return found


class _Hits(NamedTuple):
    """Hits of beams, nearest or not: the beam, its inverse range, the share of light that comes back if wanted."""

    beams: Indices
    inverse: Array
    light: Array


def _listed(poses: Array, own: Indices | None) -> tuple[list[Place], list[int]]:
    return poses.tolist(), [NOBODY] * len(poses) if own is None else np.asarray(own).tolist()


def _look(
    beams: Beams, places: Sequence[Place], own: Sequence[int], surroundings: Surroundings, lit: bool
) -> tuple[Array, list[_Hits]]:
    """Return the inverse range of each beam of some sensors, and all hits that it may come from."""
    found, eyes, inverse = [], _eyes(beams, places), np.zeros(len(places) * beams.stride)
    near = [
        surroundings.segments_near(x, y, beams.reach, number) for (x, y, _), number in zip(places, own, strict=True)
    ]
    columns = near[0] if len(near) == 1 else np.concatenate(near, axis=1)
    if columns.size:
        seeing = eyes if len(near) == 1 else eyes.of(np.arange(len(near)).repeat([each.shape[1] for each in near]))
        found.append(_see_segments(beams, seeing, columns, lit))
        np.maximum.at(inverse, found[0].beams, found[0].inverse)
    if surroundings.has_circles_but(own):
        sensors, which = surroundings.circles_near(places, beams.reach, own)
        if len(which) >= _MANY:
            seen = _unhidden(beams, eyes, sensors, surroundings.circles.taken(which), inverse)
            sensors, which = sensors.take(seen), which.take(seen)
        if len(which):
            found.append(_see_circles(beams, eyes.of(sensors), surroundings.circles.taken(which), lit))
            np.maximum.at(inverse, found[-1].beams, found[-1].inverse)
    return inverse, found


def _nearest(beams: Beams, sensors: int, inverse: Array, found: list[_Hits], lit: bool) -> tuple[Array, Array]:
    """Return for each beam the range of its nearest hit, and the light of that (an empty array unless `lit`)."""
    light: Array = _light(inverse, found) if lit else inverse[:0]
    inverse, light = inverse.reshape(sensors, -1), light.reshape(sensors, -1)
    if beams.full:  # lay the two turns on each other
        once, again = inverse[:, : beams.count], inverse[:, beams.count :]
        light = np.where(once >= again, light[:, : beams.count], light[:, beams.count :]) if lit else light
        inverse = np.maximum(once, again)
    within, ranges = inverse >= 1.0 / beams.reach, np.empty(inverse.shape)
    ranges.fill(np.inf)
    np.divide(1.0, inverse, out=ranges, where=within)
    return ranges, np.minimum(light * within, 1.0) if lit else light


def _light(inverse: Array, found: list[_Hits]) -> Array:
    """Return for each beam the light of its nearest hit."""
    light = np.zeros(len(inverse))
    for hits in found:
        nearest = np.flatnonzero(hits.inverse == inverse.take(hits.beams))
        light[hits.beams.take(nearest)] = hits.light.take(nearest)
    return light


def _eyes(beams: Beams, places: Sequence[Place]) -> _Eyes:
    facts = [(x, y, math.cos(theta), math.sin(theta), (theta + beams.start) / math.tau) for x, y, theta in places]
    if len(places) == 1:
        return _Eyes(1, 0, *facts[0])
    first = beams.stride * np.arange(len(places))
    return _Eyes(len(places), first, *np.array(facts).T.copy())


def _see_segments(beams: Beams, eyes: _Eyes, columns: Array, lit: bool) -> _Hits:
    x, y, normal = columns[X] - eyes.x, columns[Y] - eyes.y, columns[NORMAL]
    ends = _in_turns(eyes, x, y)
    width = ends[1] - ends[0]
    width -= np.rint(width)
    spans = _spans(beams, eyes, ends[0] + np.minimum(width, 0.0), np.abs(width))
    distance, limit = normal[0] * x[0] + normal[1] * y[0], None
    away = np.abs(distance)
    if np.count_nonzero(away < _GRAZING):
        normal, distance, limit = _mended(normal, x, y, distance, width)
    turned = (eyes.cos * normal[:2] + eyes.sin * normal[1:]) / distance
    inverse = spans.along(beams.directions(eyes.number), turned)
    if limit is not None:
        np.minimum(inverse, spans.spread(limit), out=inverse)
    return _Hits(spans.beams, inverse, spans.spread(away * columns[REFLECTANCE]) * inverse if lit else inverse)


def _mended(normal: Array, x: Array, y: Array, distance: Array, width: Array) -> tuple[Array, Array, Array]:
    """Return normals and distances, mended for lines that a sensor is nearly on, and an upper limit of each inverse.

    No beam sees a segment nearer than it is: that bounds the beams that pass just beside an end. A segment that is
    seen edge-on counts as its nearest point; one that the sensor stands on is on the side that its beams are on.
    """
    grazing = np.flatnonzero(np.abs(distance) < _GRAZING)
    nx, ny = normal.take(grazing, axis=1)[:2]
    away, width = distance.take(grazing), width.take(grazing)
    first, last = nx * y.take(grazing, axis=1) - ny * x.take(grazing, axis=1)
    along = np.minimum(np.maximum(first, 0.0), last)
    nearest = np.maximum(np.sqrt(away * away + along * along), _TOUCHING)
    edge_on = np.abs(away) < _EDGE_ON
    beside = edge_on & (along != 0.0)
    nx, ny = (
        np.where(beside, (away * nx - along * ny) / nearest, nx),
        np.where(beside, (away * ny + along * nx) / nearest, ny),
    )
    normal, distance, limit = normal.copy(), distance.copy(), np.full(len(distance), np.inf)
    normal[:, grazing] = nx, ny, -nx
    distance[grazing] = np.where(beside, nearest, np.where(edge_on, np.copysign(_TOUCHING, width), away))
    limit[grazing] = 1.0 / nearest
    return normal, distance, limit


def _see_circles(beams: Beams, eyes: _Eyes, circles: Circles, lit: bool) -> _Hits:
    """See circles: with p the centre along a beam and w a tangent squared, 1 / range is (p + sqrt(p² - w)) / w."""
    dx, dy, radius = circles.x - eyes.x, circles.y - eyes.y, circles.radius
    square = dx * dx + dy * dy
    inside = np.flatnonzero(square <= radius * radius)
    square[inside] = np.inf
    power = square - radius * radius
    share = 1.0 / power
    centre = np.array((eyes.cos * dx + eyes.sin * dy, eyes.cos * dy - eyes.sin * dx)) * share
    half = np.arcsin(radius / np.sqrt(square)) / math.tau
    low, width = _in_turns(eyes, dx, dy) - half, 2.0 * half
    low[inside], width[inside] = 0.0, (beams.count - 1.0) / beams.period  # all beams touch
    share[inside] = -1.0 / _TOUCHING**2
    spans = _spans(beams, eyes, low, width)
    inverse = spans.along(beams.directions(eyes.number), centre)
    root = inverse * inverse
    root -= spans.spread(share)
    np.sqrt(np.maximum(root, 0.0, out=root), out=root)
    inverse += root
    light = root * spans.spread(power * circles.reflectance / radius) if lit else inverse
    return _Hits(spans.beams, inverse, light)


def _unhidden(beams: Beams, eyes: _Eyes, sensors: Indices, circles: Circles, inverse: Array) -> Indices:
    """Return which circles may be seen by their sensors, past what is at the `inverse` ranges already.

    Beams are taken in blocks. A circle that covers less than a block lies within two of them, and is hidden if every
    beam of these ends before the circle's nearest point; it would change no bit.
    """
    table = inverse.reshape(eyes.number, -1)
    if beams.full:
        table = np.maximum(table[:, : beams.count], table[:, beams.count :])
    blocks = max(1, beams.count // _BLOCK)  # the last one has the rest too
    farthest = np.minimum.reduceat(table, np.arange(blocks) * _BLOCK, axis=1)
    seeing = eyes.of(sensors)
    dx, dy = circles.x - seeing.x, circles.y - seeing.y
    distance = np.sqrt(dx * dx + dy * dy)
    gap = distance - circles.radius
    width = np.arcsin(circles.radius / np.maximum(distance, circles.radius)) / math.pi
    low = _in_turns(seeing, dx, dy) - width / 2
    low = (low - np.floor(low)) * beams.period
    begin, end = low.astype(np.intp), (low + width * beams.period + 1.0).astype(np.intp)
    narrow = (end - begin < _BLOCK) & (gap > _NEAR)
    if beams.full:
        begin, end = begin % beams.count, end % beams.count
    else:
        narrow &= end < beams.count
    first, last = (np.minimum(each // _BLOCK, blocks - 1) for each in (begin, end))
    beyond = np.minimum(farthest[sensors, first], farthest[sensors, last]) * gap > 1.0 + _NEAR
    return np.flatnonzero(~(narrow & beyond))


def _in_turns(eyes: _Eyes, x: Array, y: Array) -> Array:
    """Return the directions of points as seen by the sensors, in turns from their first beam."""
    # Its bits differ between machines: it only decides which beams look at a shape, never what they read.
    turns: Array = np.arctan2(y, x)
    turns /= math.tau
    turns -= eyes.turn
    return turns


def _spans(beams: Beams, eyes: _Eyes, low: Array, width: Array) -> _Spans:
    """Return the beams that lie in intervals (from `low`, `width` wide, in turns)."""
    low = (low - np.floor(low)) * beams.period
    high, who, first = low + width * beams.period, None, eyes.first
    if not beams.full:  # some reach round to the first beams again
        again = np.flatnonzero(high >= beams.period - _EDGE)
        who = np.concatenate((np.arange(len(low)), again))
        low = np.concatenate((low, np.zeros(len(again))))
        high = np.minimum(np.concatenate((high, high.take(again) - beams.period)), beams.count - 1.0)
        first = first if isinstance(first, int) else first.take(who)
    begin = (low + (1.0 - _EDGE)).astype(np.intp)  # the next whole number
    counts = (high + (1.0 + _EDGE)).astype(np.intp)
    counts -= begin
    if not beams.full:
        np.maximum(counts, 0, out=counts)
    begin += counts
    begin -= counts.cumsum()
    if eyes.number > 1:  # else 0
        begin += first
    found = begin.repeat(counts)
    found += np.arange(len(found))
    return _Spans(who, counts, found)


def nearest_in_cone(sensor: Pose, fov: float, segments: Array, circles: Array) -> float:
    """Return the distance in metres from a sensor to the nearest point of anything within `fov` degrees about ahead.

    `segments` are columns x1, x2, y1, y2 and `circles` columns x, y, radius, in the world. inf if there is nothing.
    """
    half = math.radians(fov) / 2
    return min(_nearest_of_segments(sensor, half, segments), _nearest_of_circles(sensor, half, circles))


def _in_frame(sensor: Pose, x: Array, y: Array) -> tuple[Array, Array]:
    cos, sin = math.cos(sensor.theta), math.sin(sensor.theta)
    dx, dy = x - sensor.x, y - sensor.y
    return cos * dx + sin * dy, cos * dy - sin * dx


def _nearest_of_segments(sensor: Pose, half: float, segments: Array) -> float:
    """Return the distance of the nearest point of the segments, clipped to the cone."""
    x1, y1 = _in_frame(sensor, segments[0], segments[2])
    x2, y2 = _in_frame(sensor, segments[1], segments[3])
    dx, dy = x2 - x1, y2 - y1
    low, high = _part_in_cone(half, x1, y1, x2, y2)
    square = np.maximum(dx * dx + dy * dy, 1e-300)
    share = np.minimum(np.maximum(-(x1 * dx + y1 * dy) / square, low), high)
    x, y = x1 + share * dx, y1 + share * dy
    distances = np.where(low <= high, np.sqrt(x * x + y * y), np.inf)
    return float(np.min(distances, initial=math.inf))


def _part_in_cone(half: float, x1: Array, y1: Array, x2: Array, y2: Array) -> tuple[Array, Array]:
    """Return the first and last share of each segment that lies in the cone, the intersection of two half-planes."""
    cos, sin = math.cos(half), math.sin(half)
    low, high = np.zeros(len(x1)), np.ones(len(x1))
    for side in (cos, -cos):
        first, second = sin * x1 + side * y1, sin * x2 + side * y2  # not negative: in this half-plane
        parallel = first == second
        crossing = first / np.where(parallel, 1.0, first - second)
        crossing = np.where(parallel, np.where(first >= 0.0, 1.0, -1.0), crossing)
        leaving = first >= second
        high = np.where(leaving, np.minimum(high, crossing), high)
        low = np.where(leaving, low, np.maximum(low, crossing))
    return low, high


def _nearest_of_circles(sensor: Pose, half: float, circles: Array) -> float:
    """Return the distance of the nearest circle: to its nearest point, or to where the cone's nearer edge meets it."""
    (x, y), radius = _in_frame(sensor, circles[0], circles[1]), circles[2]
    straight = np.sqrt(x * x + y * y) - radius
    y = np.abs(y)
    cos, sin = math.cos(half), math.sin(half)
    ahead, aside = cos * x + sin * y, cos * y - sin * x  # along that edge, and beside it: positive outside
    root = radius * radius - aside * aside
    at_edge = np.where((root >= 0.0) & (ahead > 0.0), ahead - np.sqrt(np.maximum(root, 0.0)), np.inf)
    distances = np.where((aside <= 0.0) | (straight <= 0.0), straight, at_edge)
    return max(0.0, float(np.min(distances, initial=math.inf)))
