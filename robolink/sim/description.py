"""Structs of a world file: its keys, with their units, limits and defaults.

Metres, radians (degrees where a field of view is meant), seconds, kilograms. Poses are ``[x, y, theta]``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Literal, TypeAlias

from msgspec import Meta, Struct

from robolink.sim.quantities import FARTHEST, Factor, Height, Length, Limit, Mass, Point, Pose, Rate, Share
from robolink.sim.sensors import Sensor

GRAVITY = 9.81
"""Acceleration of gravity, in m/s²."""


class FloorSettings(Struct, frozen=True, forbid_unknown_fields=True):
    """Look of the floor: a colour, and on it the picture `image`, whose lower left corner lies at `origin`.

    `resolution` is the side of a pixel in metres, of the picture and of all that is painted.
    """

    colour: str | None = None
    image: str | None = None
    resolution: Annotated[float, Meta(ge=0.0001, le=10.0)] | None = None
    origin: Point = (0.0, 0.0)


class Settings(Struct, frozen=True, forbid_unknown_fields=True):
    """The world as a whole.

    It has the step `dt`, the real-time factor `rtf` (0 is as fast as it goes), the `size` that holds all, and `floor`.
    """

    name: str = ""
    size: tuple[Length, Length] | None = None
    dt: Annotated[float, Meta(ge=0.0001, le=0.1)] = 0.01
    rtf: Annotated[float, Meta(ge=0.0, le=1000.0)] = 1.0
    seed: Annotated[int, Meta(ge=0, le=2**63 - 1)] = 0
    floor: FloorSettings = FloorSettings()


class Wall(Struct, frozen=True, forbid_unknown_fields=True):
    """A line of walls from point to point, without thickness; `closed` joins the last to the first.

    A camera sees its `height` in metres and its `colour`.
    """

    polyline: Annotated[tuple[Point, ...], Meta(min_length=2)]
    closed: bool = False
    reflectance: Share = 1.0
    height: Height | None = None
    colour: str | None = None

    def segments(self) -> list[tuple[Point, Point]]:
        """Return the wall as pairs of end points."""
        ends = [*self.polyline[1:], self.polyline[0]] if self.closed else self.polyline[1:]
        return list(zip(self.polyline, ends, strict=False))


class MapWalls(Wall, frozen=True):
    """The walls that a map's occupied cells have towards free ones: each two points of `polyline` are one of them."""

    def segments(self) -> list[tuple[Point, Point]]:
        """Return the walls as pairs of end points."""
        return list(zip(self.polyline[::2], self.polyline[1::2], strict=True))

    def enclose(self, x: float, y: float) -> bool:
        """True if a point is among occupied cells: a ray from there crosses an odd number of walls."""
        met = 0
        for (x1, y1), (x2, y2) in self.segments():
            met += (y1 > y) != (y2 > y) and x1 + (y - y1) * (x2 - x1) / (y2 - y1) > x
        return met % 2 == 1


class Shape(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """An outline about its own origin: a box (length along x, width along y), a circle (radius) or a polygon.

    A polygon's corners go round in either direction, and it may be concave; it must not cross itself.
    """

    box: tuple[Length, Length] | None = None
    circle: Length | None = None
    polygon: Annotated[tuple[Point, ...], Meta(min_length=3, max_length=1000)] | None = None

    def corners(self) -> list[Point]:
        """Return the corners of a box or polygon, counter-clockwise; a circle has none."""
        if self.polygon is not None:
            return list(self.polygon if signed_area(self.polygon) > 0.0 else reversed(self.polygon))
        x, y = (side / 2 for side in self.box or (0.0, 0.0))
        return [(x, y), (-x, y), (-x, -y), (x, -y)] if self.box else []

    def inner_radius(self) -> float:
        """Return the distance of the nearest point of the outline from the origin, in metres; 0 if that is outside."""
        if self.polygon is not None:
            return _inner_radius(self.corners())
        return self.circle or min(self.box or (0.0, 0.0)) / 2

    def outer_radius(self) -> float:
        """Return the distance of the farthest point from the origin, in metres."""
        return self.circle or max((math.hypot(*corner) for corner in self.corners()), default=0.0)

    def inertia(self, mass: float) -> float:
        """Return the moment of inertia about the origin of a solid of this shape, in kg m²."""
        if self.circle is not None:
            return mass * self.circle**2 / 2
        corners = self.corners()
        crosses = [x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in _pairs(corners)]
        squares = [x1 * x1 + x1 * x2 + x2 * x2 + y1 * y1 + y1 * y2 + y2 * y2 for (x1, y1), (x2, y2) in _pairs(corners)]
        weighted = math.fsum(c * s for c, s in zip(crosses, squares, strict=True))  # `sum` differs between Pythons
        return mass / 6 * weighted / math.fsum(crosses)


def signed_area(polygon: Sequence[Point]) -> float:
    """Return the area of a polygon in m², negative if it goes round clockwise."""
    return math.fsum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in _pairs(polygon)) / 2


def turn(a: Point, b: Point, c: Point) -> float:
    """Return twice the signed area of a triangle in m²: positive if c lies to the left of the way from a to b."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _pairs(polygon: Sequence[Point]) -> Iterator[tuple[Point, Point]]:
    return zip(polygon, [*polygon[1:], polygon[0]], strict=True)


def _inner_radius(corners: Sequence[Point]) -> float:
    """Return the distance from the origin to a polygon's nearest edge; 0 unless the origin lies inside."""
    inside, nearest = False, math.inf
    for (x1, y1), (x2, y2) in _pairs(corners):
        if (y1 > 0.0) != (y2 > 0.0) and x1 - y1 * (x2 - x1) / (y2 - y1) > 0.0:
            inside = not inside
        dx, dy = x2 - x1, y2 - y1
        share = min(1.0, max(0.0, -(x1 * dx + y1 * dy) / max(dx * dx + dy * dy, 1e-18)))
        nearest = min(nearest, math.hypot(x1 + share * dx, y1 + share * dy))
    return nearest if inside else 0.0


class Paint(Shape, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Paint on the floor, which only cameras see: a line, or what lies within an outline at `pose`.

    A `line` joins its points, the last and the first too if it is `closed`. It is `width` metres wide, and its
    corners are arcs of `radius` metres. `dashes` are the lengths of a dash and of the gap behind it.
    """

    colour: str = "white"
    line: Annotated[tuple[Point, ...], Meta(min_length=2, max_length=10_000)] | None = None
    width: Length = 0.05
    closed: bool = False
    radius: Annotated[float, Meta(ge=0.0, le=FARTHEST)] = 0.0
    dashes: tuple[Length, Length] | None = None
    pose: Pose = Pose(0.0, 0.0)


class Sign(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """An upright sign, which only cameras see: a fiducial marker (`tag`, such as 36h11/3) or a picture (`image`).

    It looks to where its `pose` heads, its middle is `z` metres above the floor. `size` is the side of a tag's black
    square, without the white margin around it, or the width of a picture. On a robot or an obstacle its pose is in the
    frame of that. A sign of the world that hangs on no wall has a pole.
    """

    pose: Pose
    tag: str | None = None
    image: str | None = None
    z: Annotated[float, Meta(ge=0.0, le=1000.0)] = 0.3
    size: Length = 0.2


Signs: TypeAlias = Annotated[tuple[Sign, ...], Meta(max_length=1000)]


class Obstacle(Shape, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """An obstacle: fixed, or with a `mass` one that can be pushed, or one that moves along a `path` by itself.

    It goes along its path at `speed` m/s whatever is in its way, to the end and back, or round and round if the
    path is `closed`. `reflectance` is the share of light that it sends back. A camera sees its `height` in metres, its
    `colour` and its `signs`.
    """

    pose: Pose | None = None
    mass: Mass | None = None
    path: Annotated[tuple[Point, ...], Meta(min_length=2)] | None = None
    speed: Limit = 0.5
    closed: bool = False
    reflectance: Share = 1.0
    height: Height | None = None
    colour: str | None = None
    signs: Signs = ()

    @property
    def start(self) -> Pose:
        """The pose at the start: `pose`, or the first point of `path`."""
        return self.pose or Pose(*(self.path or ((0.0, 0.0),))[0])


class Map(Struct, frozen=True, forbid_unknown_fields=True):
    """A map of ROS's map_server: the path of its YAML file, from the world file's folder.

    A camera sees its walls' `height` in metres and their `colour`.
    """

    yaml: str
    height: Height | None = None
    colour: str | None = None


class Drive(Struct, frozen=True, forbid_unknown_fields=True):
    """The drive of a robot: limits in m/s, rad/s, m/s², rad/s²; it stops `timeout` seconds after its last command.

    `diff` goes ahead and turns; `omni` goes sideways too; `ackermann` steers like a car, its reference point in the
    middle of the rear axle, `wheelbase` metres behind the front axle, and turns its wheels by `steer_max` radians at
    most, `steer_rate` radians a second. With `stamped` its commands are of the type TwistStamped.
    """

    type: Literal["diff", "omni", "ackermann"] = "diff"
    v_max: Limit = 0.5
    w_max: Limit = 2.0
    a_max: Limit = 1.5
    alpha_max: Limit = 10.0
    timeout: Limit = 0.5
    wheelbase: Length = 0.3
    steer_max: Annotated[float, Meta(ge=0.01, le=1.5)] = 0.5
    steer_rate: Limit = 2.0
    stamped: bool = False


class Wheel(Struct, frozen=True, forbid_unknown_fields=True):
    """A wheel that a motor turns: `at` is where it stands on the robot and which way it rolls, `radius` in metres.

    `speed_max` is the most that the motor called `motor` turns it by, in rad/s.
    """

    motor: str
    at: Pose
    radius: Length = 0.05
    speed_max: Limit = 100.0


class OdomNoise(Struct, frozen=True, forbid_unknown_fields=True):
    """Noise of the speeds of odometry: standard deviations as a share of `v` and of `w`, drawn at each step."""

    v: Share = 0.0
    w: Share = 0.0


class OdomScale(Struct, frozen=True, forbid_unknown_fields=True):
    """Systematic error of the speeds of odometry: what it measures as a share of the true `v` and of the true `w`.

    `v` errs by the radius of the wheels (1.02: they are 2 % smaller than odometry takes them for), `w` also by the
    distance between them.
    """

    v: Factor = 1.0
    w: Factor = 1.0


class Odom(Struct, frozen=True, forbid_unknown_fields=True):
    """Odometry, published `rate` times a second, with its errors.

    `drift` is the turn in rad, counter-clockwise, that it sees in each metre ahead: one wheel is larger than the other.
    Going back undoes it.
    """

    rate: Rate = 50.0
    noise: OdomNoise = OdomNoise()
    scale: OdomScale = OdomScale()
    drift: Annotated[float, Meta(ge=-1.0, le=1.0)] = 0.0

    @property
    def errs(self) -> bool:
        """True if it has an error of any kind."""
        return bool(self.noise != OdomNoise() or self.scale != OdomScale() or self.drift)


class GroundTruth(Struct, frozen=True, forbid_unknown_fields=True):
    """The true pose and speeds, published `rate` times a second."""

    rate: Rate = 10.0


MOST_WALLS, MOST_OBSTACLES, MOST_ROBOTS, MOST_SENSORS = 10_000, 5_000, 1_000, 100
"""Most walls, obstacles and robots of a world file, and most sensors of a robot; the walls of a map do not count."""


class RobotDescription(Struct, frozen=True, forbid_unknown_fields=True):
    """Robot of a world file.

    Args:
        name: Name, which is that of its namespace.
        pose: Pose at the start, in metres and radians.
        shape: Outline.
        mass: Mass in kg.
        drive: Drive, with its limits.
        wheels: Wheels, whose motors can be driven one by one, with encoders.
        odom: Odometry, with its noise.
        ground_truth: True pose, as it is published.
        sensors: Sensors.
        height: Height in metres, for cameras.
        colour: Colour, for cameras.
        signs: Signs on it, in its own frame.
    """

    name: str
    pose: Pose
    shape: Shape = Shape(circle=0.17)
    mass: Mass = 3.0
    drive: Drive = Drive()
    wheels: Annotated[tuple[Wheel, ...], Meta(max_length=64)] = ()
    odom: Odom = Odom()
    ground_truth: GroundTruth = GroundTruth()
    sensors: Annotated[tuple[Sensor, ...], Meta(max_length=MOST_SENSORS)] = ()
    height: Height | None = None
    colour: str | None = None
    signs: Signs = ()


class WorldDescription(Struct, frozen=True, forbid_unknown_fields=True):
    """Whole world file: settings of the `world`, its `map`, `walls`, `obstacles` and `robots`, `paint` and `signs`."""

    world: Settings = Settings()
    map: Map | None = None
    walls: Annotated[tuple[Wall, ...], Meta(max_length=MOST_WALLS)] = ()
    obstacles: Annotated[tuple[Obstacle, ...], Meta(max_length=MOST_OBSTACLES)] = ()
    robots: Annotated[tuple[RobotDescription, ...], Meta(max_length=MOST_ROBOTS)] = ()
    paint: Annotated[tuple[Paint, ...], Meta(max_length=1000)] = ()
    signs: Signs = ()


def steps_between(rate: float, dt: float) -> int:
    """Return the whole number of steps of `dt` seconds between two readings at `rate` Hz; 0 if it is not whole."""
    steps = 1.0 / (rate * dt)
    whole = round(steps)
    return whole if whole >= 1 and abs(steps - whole) < 1e-6 * steps else 0
