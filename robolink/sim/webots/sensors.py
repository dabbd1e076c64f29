"""Converter of the sensors of a Webots robot."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Literal, NamedTuple

import numpy as np

from robolink.sim.checks.robots import TAKEN
from robolink.sim.sensors import Bumper, Camera, Encoders, Imu, Lidar, RangeFinder, Sensor
from robolink.sim.webots.geometry import Placement, rounded
from robolink.sim.webots.vrml_node import Node
from robolink.text.names import spelled, unlike

SCAN = "scan"
"""Topic of a robot's only lidar."""

NARROW = 1.0
"""Field of view of a distance sensor with a single ray, in degrees."""

FULL_TURN = math.radians(359.5)
"""Field of view, in radians, from which on a lidar is taken to see all round, such as 6.28."""

TABLE = [0.0, 0.0, 0.0, 0.1, 1000.0, 0.0]
"""Webots' default `lookupTable`: rows of a distance, the sensor's value there, and its noise."""

SEEING = frozenset({"Camera", "RangeFinder"})
"""Sensors of Webots that make images, of colours or of depths."""

INERTIAL = frozenset({"Accelerometer", "Gyro", "InertialUnit"})
LACKING = frozenset({"Compass", "GPS", "LightSensor", "Radar", "Receiver"})
"""Sensors of Webots that are not supported."""


class Model(NamedTuple):
    """A lidar on the market: name, beams, field of view in degrees, range in metres, noise as a share of its end."""

    name: str
    beams: int
    fov: float
    range: tuple[float, float]
    noise: float = 0.0
    is_set: bool = True
    """True if a world may set the number of beams."""


LIDARS = {
    "HokuyoUrg04lx": Model("Hokuyo URG-04LX", 667, 240.0, (0.06, 4.096)),
    "HokuyoUrg04lxug01": Model("Hokuyo URG-04LX-UG01", 667, 240.0, (0.2, 5.6)),
    "HokuyoUtm30lx": Model("Hokuyo UTM-30LX", 1080, 270.0, (0.1, 30.0)),
    "RobotisLds01": Model("LDS-01", 360, 360.0, (0.12, 3.5), 0.0043, is_set=False),
    "SickLms291": Model("Sick LMS 291", 180, 180.0, (0.01, 80.0)),
}
"""Lidars of Webots' library that scan in a plane, as their PROTOs define them."""


def rate_near(requested: float, dt: float) -> float:
    """Return the rate in Hz nearest to the requested one whose period is a whole number of steps of `dt` seconds."""
    return 1.0 / (max(1, round(1.0 / (requested * dt))) * dt)


def sensors(
    devices: Sequence[tuple[Node, Placement]], resolutions: Sequence[float], dt: float, raised: float = 0.0
) -> tuple[Sensor, ...]:
    """Make the sensors of a robot from its devices; `resolutions` are those of its position sensors, in radians.

    Exact ones need no encoders: the angles of all wheels are published anyway. `raised` is the height in metres of the
    robot's origin above the floor.
    """
    names = _Names(devices)
    found: list[Sensor] = [made for each in devices if (made := _sensor(*each, names, dt, raised))]
    if any(node.type in INERTIAL for node, _ in devices):
        found.append(Imu(names.free("imu"), rate=rate_near(50.0, dt)))
    finest = min((each for each in resolutions if each > 0.0), default=0.0)
    if finest:
        ticks = min(max(round(math.tau / finest), 1), 10_000_000)
        found.append(Encoders(names.free("encoders"), rate=rate_near(50.0, dt), ticks=ticks))
    return tuple(found)


def lacking(nodes: Iterable[Node]) -> list[str]:
    """Return the names of the devices that are not supported."""
    return [node.called for node in nodes if node.type in LACKING]


class _Names:
    """Allocator of topic names: each sensor has its own; that of a robot's only lidar is `scan`."""

    def __init__(self, devices: Sequence[tuple[Node, Placement]]) -> None:
        self._taken = set(TAKEN)
        self._only_lidar = sum(_is_lidar(node) for node, _ in devices) == 1

    def free(self, name: str) -> str:
        name = unlike(name, self._taken)
        self._taken.add(name)
        return name

    def of(self, node: Node, default: str) -> str:
        if self._only_lidar and _is_lidar(node):
            return self.free(SCAN)
        return self.free(spelled(node.text("name", default), default.replace(" ", "_")))


def _is_lidar(node: Node) -> bool:
    return node.type == "Lidar" or node.type in LIDARS


def _sensor(node: Node, placement: Placement, names: _Names, dt: float, raised: float) -> Sensor | None:
    if node.type in LIDARS:
        return _bought_lidar(node, LIDARS[node.type], placement, names, dt)
    if node.type == "Lidar":
        return _lidar(node, placement, names, dt)
    if node.type == "DistanceSensor":
        return _range_finder(node, placement, names, dt)
    if node.type == "TouchSensor":
        return _bumper(node, placement, names, dt)
    if node.type in SEEING:
        return _camera(node, placement, names, dt, raised)
    return None


def _camera(node: Node, placement: Placement, names: _Names, dt: float, raised: float) -> Camera:
    """A camera, or a range finder, which is one of depths; it looks along its x axis, and roll is left out."""
    depth = node.type == "RangeFinder"
    width, height = (int(min(max(node.number(each, 64.0), 1.0), 4096.0)) for each in ("width", "height"))
    ahead = placement.matrix[:, 0] / np.linalg.norm(placement.matrix[:, 0])
    limits = _depths(node) if depth else Camera("").range
    return Camera(
        names.of(node, "range-finder" if depth else "camera"),
        rate=rate_near(10.0, dt),
        width=width,
        height=height,
        fov=min(max(math.degrees(node.length("fieldOfView", math.pi / 4)), 1.0), 170.0),
        offset=placement.pose,
        z=min(max(rounded(placement.offset[2]) + raised, 0.005), 1000.0),
        pitch=rounded(math.degrees(math.asin(min(max(-float(ahead[2]), -1.0), 1.0)))),
        noise=0.0 if depth else min(max(255.0 * node.number("noise", 0.0), 0.0), 255.0),
        depth=depth,
        range=limits,
    )


def _depths(node: Node) -> tuple[float, float]:
    """Return the least and the greatest depth, in metres, that a range finder sees."""
    near, far = node.length("minRange", 0.01), node.length("maxRange", 1.0)
    if near >= far:
        raise node.error(f"expected more than 0 to less than maxRange, {far:g}, got {near:g}", "minRange")
    return min(max(near, 0.001), 9_999.0), min(max(far, 0.002), 10_000.0)


def _lidar(node: Node, placement: Placement, names: _Names, dt: float) -> Lidar:
    nearest, farthest = node.number("minRange", 0.01), node.length("maxRange", 1.0)
    if not 0.0 <= nearest < farthest:
        raise node.error(f"expected 0 to less than maxRange, {farthest:g}, got {nearest:g}", "minRange")
    beams = node.number("horizontalResolution", 512)
    if not 2 <= beams <= 100_000:
        raise node.error(f"expected 2 to 100000 beams, got {beams:g}", "horizontalResolution")
    angle = node.length("fieldOfView", math.pi / 2)
    turns = node.text("type", "fixed") == "rotating" or angle >= FULL_TURN
    return Lidar(
        names.of(node, "lidar"),
        rate=rate_near(10.0, dt),
        beams=int(beams),
        fov=360.0 if turns else max(math.degrees(angle), 0.01),
        range=(nearest, max(farthest, 0.001)),
        noise=_noise(node.number("noise", 0.0), farthest),
        offset=placement.pose,
    )


def _bought_lidar(node: Node, model: Model, placement: Placement, names: _Names, dt: float) -> Lidar:
    return Lidar(
        names.of(node, model.name),
        rate=rate_near(10.0, dt),
        beams=min(max(int(node.number("resolution", model.beams)), 2), 100_000) if model.is_set else model.beams,
        fov=model.fov,
        range=model.range,
        noise=_noise(node.number("noise", model.noise), model.range[1]),
        offset=placement.pose,
    )


def _noise(share: float, farthest: float) -> float:
    """Return the standard deviation in metres of what Webots gives as a share of the range's end."""
    return min(max(share, 0.0) * farthest, 100.0)


def _range_finder(node: Node, placement: Placement, names: _Names, dt: float) -> RangeFinder:
    """A distance sensor; it measures metres, from the least to the greatest distance of its `lookupTable`."""
    table = node.all_numbers("lookupTable") or TABLE
    if len(table) % 3 or not max(table[0], table[-3]) > 0.0:
        raise node.error("expected rows of distance, value and noise, the last distance more than 0", "lookupTable")
    farthest = max(table[0], table[-3], 0.001)
    nearest = max(min(table[0], table[-3]), 0.0)
    kind = node.text("type", "generic")
    radiation: Literal["ultrasound", "infrared"] = "ultrasound" if kind == "sonar" else "infrared"
    wide = node.number("numberOfRays", 1.0) > 1.0 and kind != "laser"
    aperture = min(max(math.degrees(node.number("aperture", math.pi / 2)), 0.01), 180.0)
    angle = aperture if wide else NARROW
    return RangeFinder(
        names.of(node, "distance sensor"),
        rate=rate_near(10.0, dt),
        fov=angle,
        range=(nearest if nearest < farthest else 0.0, farthest),
        offset=placement.pose,
        radiation=radiation,
        aperture=0.0 if wide else aperture,
    )


def _bumper(node: Node, placement: Placement, names: _Names, dt: float) -> Bumper:
    """A touch sensor: one at the robot's side feels that half of it, one in its middle everything."""
    pose = placement.pose
    topic, rate = names.of(node, "touch sensor"), rate_near(10.0, dt)
    if math.hypot(pose.x, pose.y) < 0.001:
        return Bumper(topic, rate=rate)
    middle = math.degrees(math.atan2(pose.y, pose.x))
    return Bumper(topic, rate=rate, fov=180.0, start=middle - 90.0)


def by_lookup_table(nodes: Iterable[Node]) -> list[str]:
    """Return the names of distance sensors whose `lookupTable` has other values than metres."""
    found = []
    for node in nodes:
        table = (node.all_numbers("lookupTable") or TABLE) if node.type == "DistanceSensor" else []
        if any(distance != value for distance, value in zip(table[::3], table[1::3], strict=False)):
            found.append(node.text("name", "distance sensor"))
    return found
