"""Adapters of other simulators' lidars and worlds, for `benchmarks/simulator.py`; each only if installed.

A scanner is made of a world's segments and tells what it sees from a place; a peer's world makes one step. None of
their packages has types that mypy would follow, so what they hand out is Any.
"""

from __future__ import annotations

import importlib
import math
import os
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt
import pymunk

Array: TypeAlias = npt.NDArray[np.float64]
Place: TypeAlias = "tuple[float, float, float]"
Scan: TypeAlias = "Callable[[Place], Array]"
"""Gives the range in metres of each beam, inf or the range's end where nothing is; the first beam points backwards."""

THIN = 1e-4
"""Half the thickness in metres of a wall where a peer knows no lines."""


class Peer(NamedTuple):
    """A lidar of others: its name, the module that must be there, and what makes its scan."""

    name: str
    module: str
    make: Callable[[Array, int, float], Scan]


def installed(module: str) -> bool:
    """Return whether a module can be imported here."""
    try:
        importlib.import_module(module)
    except ImportError:
        return False
    return True


def pymunk_scanner(segments: Array, beams: int, reach: float) -> Scan:
    """A query for each beam, as most programs that use pymunk do it."""
    space = pymunk.Space()
    space.add(*(pymunk.Segment(space.static_body, (a, b), (c, d), 0.0) for a, b, c, d in segments.tolist()))
    nobody = pymunk.ShapeFilter()
    angles = [math.tau * index / beams - math.pi for index in range(beams)]

    def scan(place: Place) -> Array:
        x, y, theta = place
        ranges = []
        for angle in angles:
            end = (x + reach * math.cos(theta + angle), y + reach * math.sin(theta + angle))
            hit = space.segment_query_first((x, y), end, 0.0, nobody)
            ranges.append(math.inf if hit is None else hit.alpha * reach)
        return np.array(ranges)

    return scan


def mujoco_scanner(segments: Array, beams: int, reach: float) -> Scan:
    """All rays in one call of MuJoCo's C library; walls are thin boxes."""
    mujoco: Any = importlib.import_module("mujoco")
    boxes = []
    for x1, y1, x2, y2 in segments.tolist():
        half, angle = math.hypot(x2 - x1, y2 - y1) / 2, math.degrees(math.atan2(y2 - y1, x2 - x1))
        boxes.append(
            f'<geom type="box" pos="{(x1 + x2) / 2} {(y1 + y2) / 2} 0" size="{half} {THIN} 1" euler="0 0 {angle}"/>'
        )
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{''.join(boxes)}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    angles = np.arange(beams) * (math.tau / beams) - math.pi
    hits, ranges, rays = np.zeros(beams, np.int32), np.zeros(beams), np.zeros((beams, 3))

    def scan(place: Place) -> Array:
        x, y, theta = place
        np.cos(angles + theta, out=rays[:, 0])
        np.sin(angles + theta, out=rays[:, 1])
        eye = np.array((x, y, 0.0))
        mujoco.mj_multiRay(model, data, eye, rays.ravel(), None, 1, -1, hits, ranges, None, beams, reach)
        return np.where(ranges < 0.0, np.inf, ranges)

    return scan


def irsim_scanner(segments: Array, beams: int, reach: float) -> Scan:
    """ir-sim's own lidar; a wall is a linestring."""
    env = irsim_world(segments, [(0.0, 0.0, 0.0)], beams, reach)
    lidar, half = env.robot.lidar, math.pi / beams

    def scan(place: Place) -> Array:
        x, y, theta = place
        lidar.step(np.array((x, y, theta - half)).reshape(3, 1))  # its fan is symmetric about the heading
        ranges: Array = lidar.range_data
        return ranges

    return scan


def irsim_world(segments: Array, robots: Sequence[Place], beams: int, reach: float) -> Any:
    """Make an ir-sim environment with robots that have a lidar; a step of it is 0.1 s."""
    irsim: Any = importlib.import_module("irsim")
    fan = math.tau * (beams - 1) / beams
    lidar = {"name": "lidar2d", "range_min": 0.0, "range_max": reach, "angle_range": fan, "number": beams}
    walls = [
        {"shape": {"name": "linestring", "vertices": [[a, b], [c, d]]}, "state": [0, 0, 0]}
        for a, b, c, d in segments.tolist()
    ]
    shape = {"name": "circle", "radius": 0.17}
    bodies = [
        {"kinematics": {"name": "diff"}, "shape": shape, "state": list(place), "sensors": [lidar]} for place in robots
    ]
    highest = segments.max(axis=0)
    world = {
        "width": float(max(highest[0], highest[2])) + 2,
        "height": float(max(highest[1], highest[3])) + 2,
        "offset": [-1, -1],
        "step_time": 0.1,
        "sample_time": 0.1,
    }
    import yaml

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "world.yaml"
        file.write_text(yaml.safe_dump({"world": world, "robot": bodies, "obstacle": walls}), encoding="utf-8")
        return irsim.make(str(file), headless=True, log_level="ERROR")


def pyrobosim_scanner(segments: Array, beams: int, reach: float) -> Scan:
    """The lidar of pyrobosim itself; walls are cut out of its free space as strips."""
    lidar_module: Any = importlib.import_module("pyrobosim.sensors.lidar")
    pose_module: Any = importlib.import_module("pyrobosim.utils.pose")
    shapely: Any = importlib.import_module("shapely")
    low, high = segments.min(axis=0), segments.max(axis=0)
    hall = shapely.box(min(low[0], low[2]), min(low[1], low[3]), max(high[0], high[2]), max(high[1], high[3]))
    strips = [shapely.LineString([(a, b), (c, d)]).buffer(THIN, cap_style="flat") for a, b, c, d in segments.tolist()]
    step = math.tau / beams
    lidar = lidar_module.Lidar2D(
        update_rate_s=0.1,
        angle_units="radians",
        min_angle=-math.pi,
        max_angle=math.pi - 1.5 * step,
        angular_resolution=step,
        max_range_m=reach,
    )
    world = SimpleNamespace(total_external_polygon=hall.difference(shapely.union_all(strips)), robots=[])
    robot = SimpleNamespace(world=world, polygon=None, get_pose=lambda: None)
    lidar.robot = robot

    def scan(place: Place) -> Array:
        x, y, theta = place
        robot.polygon = shapely.Point(x, y).buffer(0.01)
        robot.get_pose = lambda: pose_module.Pose(x=x, y=y, yaw=theta)
        lidar.update()
        ranges: Array = lidar.get_measurement()
        return ranges

    return scan


PEERS = (
    Peer("pymunk", "pymunk", pymunk_scanner),
    Peer("MuJoCo", "mujoco", mujoco_scanner),
    Peer("ir-sim", "irsim", irsim_scanner),
    Peer("pyrobosim", "pyrobosim", pyrobosim_scanner),
)

os.environ.setdefault("MPLBACKEND", "Agg")  # ir-sim draws, unless it is kept from it
