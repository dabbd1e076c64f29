"""nav2_amcl with scans, maps, poses, transforms and parameters that are wrong: it says so, and goes on."""

from __future__ import annotations

import math
from collections.abc import Callable
from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from robolink.counterparts.nav2_amcl.beams import Limits, beams_of
from robolink.exceptions import InvalidParameterValueException
from robolink.geometry.plane import pose_of
from robolink.geometry.rotations import quaternion_from_euler
from robolink.interfaces.geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_srvs.srv import Empty, Trigger
from robolink.testing import System
from tests.support.localization_lives import LATCHED, Files, Judge, initial, start, written

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Files:
    return written("lab", tmp_path_factory.mktemp("lab"))


def changed(system: System, transition: int) -> bool:
    request = ChangeState.Request(transition=Transition(id=transition))
    return bool(system.call(ChangeState, "/amcl/change_state", request).success)


def expect_pose(system: System, lab: Files, within: float = 2.0) -> None:
    """Expect the right pose, after an update that is requested."""
    heard = system.messages("amcl_pose", PoseWithCovarianceStamped)
    before = len(heard)
    system.call(Empty, "request_nomotion_update")
    system.wait_until(lambda: len(heard) > before, within)
    assert pose_of(heard[-1].pose.pose) == pytest.approx(lab.start, abs=0.3)


def scan_like(scan: LaserScan, **values: Any) -> LaserScan:
    odd = deepcopy(scan)
    for name, value in values.items():
        setattr(odd.header if name in ("frame_id", "stamp") else odd, name, value)
    return odd


SCANS: dict[str, Callable[[LaserScan], LaserScan]] = {
    "NaN": lambda scan: scan_like(scan, ranges=[math.nan] * 360),
    "inf": lambda scan: scan_like(scan, ranges=[math.inf] * 180 + [-math.inf] * 180),
    "negative": lambda scan: scan_like(scan, ranges=[-1.0] * 360, range_min=-5.0),
    "huge": lambda scan: scan_like(scan, ranges=[3e38] * 360, range_max=math.inf),
    "empty": lambda scan: scan_like(scan, ranges=[]),
    "one beam": lambda scan: scan_like(scan, ranges=scan.ranges[:1]),
    "no increment": lambda scan: scan_like(scan, angle_increment=0.0),
    "no limits": lambda scan: scan_like(scan, range_min=math.nan, range_max=math.nan),
    "angle NaN": lambda scan: scan_like(scan, angle_min=math.nan),
    "angle huge": lambda scan: scan_like(scan, angle_increment=1e30),
    "no frame": lambda scan: scan_like(scan, frame_id=""),
    "unknown frame": lambda scan: scan_like(scan, frame_id="tail"),
    "future": lambda scan: scan_like(scan, stamp=type(scan.header.stamp)(sec=2_000_000_000)),
    "past": lambda scan: scan_like(scan, stamp=type(scan.header.stamp)()),
}


@pytest.mark.parametrize("kind", SCANS)
def test_a_scan_that_is_odd_is_survived(system: System, lab: Files, kind: str) -> None:
    start(system, lab, wander=False, **initial(lab.start))
    scan: LaserScan = system.expect("scan")
    system.run(0.3)
    for _ in range(12):
        system.publish("scan", SCANS[kind](scan))
        system.call(Empty, "request_nomotion_update")
        system.run(0.02)
    system.run(0.5)
    expect_pose(system, lab)


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("angle NaN", "refused a scan: expected angles within 100 rad, got nan"),
        ("no frame", "its frame_id is empty"),
        ("unknown frame", "where is its frame 'tail' on the robot?"),
        ("future", "dropped a scan: no transform from base_frame_id 'base_link' to odom_frame_id 'odom' at its time"),
    ],
)
def test_a_scan_that_cannot_be_used_is_named(system: System, lab: Files, kind: str, words: str) -> None:
    start(system, lab, wander=False, **initial(lab.start))
    scan: LaserScan = system.expect("scan")
    for _ in range(12):
        system.publish("scan", SCANS[kind](scan))
    system.expect_log(words)


def grid_like(grid: OccupancyGrid, **values: Any) -> OccupancyGrid:
    odd = deepcopy(grid)
    for name, value in values.items():
        setattr(odd if name == "data" else odd.info, name, value)
    return odd


MAPS: dict[str, dict[str, Any]] = {
    "no cells": {"width": 0, "height": 0, "data": []},
    "too few cells": {"data": [0] * 10},
    "no resolution": {"resolution": 0.0},
    "resolution NaN": {"resolution": math.nan},
}


@pytest.mark.parametrize("kind", MAPS)
def test_a_map_that_is_malformed_is_refused(system: System, lab: Files, kind: str) -> None:
    start(system, lab, wander=False, **initial(lab.start))
    grid: OccupancyGrid = system.expect("map")
    system.run(0.3)
    system.publish("map", grid_like(grid, **MAPS[kind]), LATCHED)
    system.expect_log("Received map message is malformed. Rejecting.")
    expect_pose(system, lab)


def test_another_map_takes_the_place_of_the_first(system: System, lab: Files) -> None:
    start(system, lab, wander=False, **initial(lab.start))
    grid: OccupancyGrid = system.expect("map")
    expect_pose(system, lab)
    cells = np.array(grid.data, np.int8).reshape(grid.info.height, grid.info.width)
    fine = np.repeat(np.repeat(cells, 2, axis=0), 2, axis=1)
    height, width = fine.shape
    half = grid_like(grid, width=width, height=height, resolution=0.025, data=fine.ravel().tolist())
    system.publish("map", half, LATCHED)
    system.run(0.2)
    expect_pose(system, lab)
    system.expect_log(f"Received a {width} X {height} map @ 0.025 m/pix")


def test_a_map_without_free_cells_has_no_place_to_begin(system: System, lab: Files) -> None:
    start(system, lab, wander=False)
    grid: OccupancyGrid = system.expect("map")
    system.publish("map", grid_like(grid, data=[-1] * len(grid.data)), LATCHED)
    system.run(0.2)
    system.call(Empty, "reinitialize_global_localization")
    system.expect_log("Global localization is refused: no cell of the map is free")
    system.expect_none("amcl_pose", during=1.0)


def test_the_map_may_come_late_and_its_server_may_go(system: System, lab: Files) -> None:
    values = {"base_frame_id": "base_link", **initial(lab.start)}
    system.start("world", parameters={"world": str(lab.world), "publish_map": False})
    system.start("nav2_amcl amcl", parameters=values)
    assert changed(system, Transition.TRANSITION_CONFIGURE)
    assert changed(system, Transition.TRANSITION_ACTIVATE)
    system.call(Empty, "reinitialize_global_localization")
    system.expect_log("Global localization is refused: no map has come yet")
    system.expect_log("Waiting for map on /map")
    system.start("nav2_map_server map_server", parameters={"yaml_filename": str(lab.chart)})
    names = {"node_names": ["map_server"], "autostart": True}
    system.start("nav2_lifecycle_manager lifecycle_manager", parameters=names)
    system.expect("amcl_pose", within=3.0)
    system.stop("map_server")
    expect_pose(system, lab)


def test_a_frame_that_is_not_there_is_named(system: System, lab: Files) -> None:
    start(system, lab, wander=False, base_frame_id="base_footprint")
    system.expect_log("no transform from base_frame_id 'base_footprint' to odom_frame_id 'odom'", within=4.0)


def test_pauses_and_cleanups_keep_the_pose(system: System, lab: Files) -> None:
    start(system, lab, wander=False, **initial(lab.start))
    system.run(0.5)
    assert changed(system, Transition.TRANSITION_DEACTIVATE)
    heard = system.messages("amcl_pose", PoseWithCovarianceStamped)
    system.run(1.0)
    heard.clear()
    system.run(1.0)
    assert heard == []
    assert changed(system, Transition.TRANSITION_ACTIVATE)
    expect_pose(system, lab)
    for transition in (Transition.TRANSITION_DEACTIVATE, Transition.TRANSITION_CLEANUP):
        assert changed(system, transition)
    assert system.parameter("amcl", "initial_pose.x") == pytest.approx(lab.start.x, abs=0.2)
    system.set_parameter("amcl", "set_initial_pose", False)
    for transition in (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE):
        assert changed(system, transition)
    expect_pose(system, lab)  # it is where it was, though no parameter says so


def test_wild_parameters_are_replaced_and_named(system: System, lab: Files) -> None:
    odd: dict[str, Any] = {
        "max_particles": -5,
        "sigma_hit": -0.5,
        "laser_model_type": "beam",
        "alpha1": -1.0,
        "pf_err": 0.0,
    }
    start(system, lab, wander=False, **odd, **initial(lab.start))
    system.expect_log("laser_model_type: 'beam' is not there, known are likelihood_field and likelihood_field_prob")
    system.expect_log("max_particles: expected 1 to 100000, got -5: using 2000")
    system.expect_log("sigma_hit: expected 1e-06 to 1000, got -0.5: using 0.2")
    expect_pose(system, lab)


def test_an_unknown_motion_model_is_refused(system: System, lab: Files) -> None:
    system.start("nav2_amcl amcl", parameters={"robot_model_type": "hover"})
    assert not changed(system, Transition.TRANSITION_CONFIGURE)
    system.expect_log("robot_model_type: unknown model 'hover', known are nav2_amcl::DifferentialMotionModel")


def test_parameters_may_change_while_it_runs(system: System, lab: Files) -> None:
    start(system, lab, wander=False, **initial(lab.start))
    expect_pose(system, lab)
    system.set_parameter("amcl", "max_particles", 600)
    system.set_parameter("amcl", "laser_model_type", "likelihood_field_prob")
    system.set_parameter("amcl", "do_beamskip", True)
    expect_pose(system, lab)
    for name, value in (("max_particles", 100), ("z_hit", -1.0)):
        with pytest.raises(InvalidParameterValueException, match=name if name == "z_hit" else "min_particles"):
            system.set_parameter("amcl", name, value)


def scan_ahead(angle: float) -> LaserScan:
    scan = LaserScan(angle_min=angle, angle_increment=0.1, range_max=10.0, ranges=[2.0])
    scan.header.frame_id = "laser"
    return scan


@pytest.mark.parametrize(
    ("roll", "pitch", "yaw", "ahead", "aside"),
    [
        (0, 0, 0, 0.3 + 2 * math.cos(0.5), 0.1 + 2 * math.sin(0.5)),
        (math.pi, 0, 0, 0.3 + 2 * math.cos(0.5), 0.1 - 2 * math.sin(0.5)),  # upside down
        (0, 0, math.pi, 0.3 - 2 * math.cos(0.5), 0.1 - 2 * math.sin(0.5)),  # looking back
    ],
)
def test_a_scanner_may_be_mounted_anyhow(roll: float, pitch: float, yaw: float, ahead: float, aside: float) -> None:
    mount = TransformStamped()
    mount.transform.translation.x, mount.transform.translation.y = 0.3, 0.1
    turn = mount.transform.rotation
    turn.x, turn.y, turn.z, turn.w = map(float, quaternion_from_euler(roll, pitch, yaw))
    found = beams_of(scan_ahead(0.5), mount, Limits())
    assert (found.ahead.tolist(), found.aside.tolist()) == ([pytest.approx(ahead)], [pytest.approx(aside)])
    assert (found.range_max, found.scanner) == (10.0, "laser")


@pytest.mark.parametrize(
    ("limits", "count"),
    [(Limits(), 60), (Limits(max_beams=1), 1), (Limits(max_beams=1000), 360), (Limits(max_range=3.0), 0)],
)
def test_beams_are_evenly_spaced(limits: Limits, count: int) -> None:
    scan = LaserScan(angle_min=-3.0, angle_increment=0.01, range_max=12.0, ranges=[5.0] * 360)
    assert len(beams_of(scan, TransformStamped(), limits).ahead) == count


def test_a_map_that_is_wrong_in_places_does_not_mislead_it(tmp_path_factory: pytest.TempPathFactory) -> None:
    """A wall that is gone, and one that is not there."""
    folder = tmp_path_factory.mktemp("wrong")
    files = written("lab", folder, 1)
    image = folder / "map.pgm"
    head, pixels = image.read_bytes().split(b" 255\n", 1)
    width, height = map(int, head.split()[1:])
    shades = np.frombuffer(bytearray(pixels), np.uint8).reshape(height, width)
    shades[12 : height // 2, width * 11 // 20 : width * 13 // 20] = 254
    shades[height // 3 : height // 3 + 3, width // 5 : width // 3] = 0
    image.write_bytes(head + b" 255\n" + shades.tobytes())
    with System(1) as system:
        judge = Judge(system)
        start(system, files, 1, recovery_alpha_slow=0.001, recovery_alpha_fast=0.1, **initial(files.start))
        system.run(60.0)
    assert judge.rms(5.0)[0] < 0.06
    assert judge.held(5.0) > 0.9


@pytest.mark.parametrize("sim_time", [False, True])
def test_a_world_that_is_reset_is_followed(tmp_path_factory: pytest.TempPathFactory, sim_time: bool) -> None:
    """The robot is where it began, and odometry at its origin again."""
    files = written("lab", tmp_path_factory.mktemp("reset"), 1)
    with System(1) as system:
        judge = Judge(system)
        own: dict[str, Any] = {"use_sim_time": True} if sim_time else {}
        start(system, files, 1, publish_clock=sim_time, **own, **initial(files.start))
        system.run(15.0)
        assert system.call(Trigger, "/world/reset").success
        system.run(15.0)
    assert judge.moments[-1].distance < 0.1
