"""The node tag_docker: what it makes of a tag's corners, its way in, and docking in the world of signs."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.geometry.plane import Pose
from robolink.interfaces.sensor_msgs.msg import CameraInfo, Image
from robolink.testing import System
from tests.support.docking import MOST_DEGREES, MOST_METRES, dock
from tests.support.nodefiles import load_node_file

docker = load_node_file("tag_docker")
SETTINGS = docker.Settings()
FOCAL = 457.0
HALF = SETTINGS.size / 2
CORNERS = np.array([(-HALF, -HALF, 0.0), (HALF, -HALF, 0.0), (HALF, HALF, 0.0), (-HALF, HALF, 0.0)])
"""The tag's corners as the camera sees them: x to the right, y down."""
UNEVEN = np.array([(0.003, -0.001), (-0.002, 0.004), (0.001, 0.002), (0.002, -0.003)])
"""Pixels by which corners are off: `solvePnP` returns no numbers for some that are quite even, unlike any image's."""


def calibration(width: int = 640, height: int = 480) -> CameraInfo:
    k = [FOCAL, 0.0, (width - 1) / 2, 0.0, FOCAL, (height - 1) / 2, 0.0, 0.0, 1.0]
    return CameraInfo(width=width, height=height, k=k, d=[0.0] * 5, distortion_model="plumb_bob")


@given(st.floats(-0.3, 0.3), st.floats(-0.1, 0.1), st.floats(0.35, 2.0), st.floats(-0.9, 0.9))
def test_corners_tell_where_a_tag_is_and_where_it_looks(x: float, y: float, z: float, turn: float) -> None:
    """Facing the camera squarely, it could be tilted a little to either side: that is tried with a turn."""
    turn = math.copysign(max(abs(turn), 0.2), turn)
    turned = CORNERS @ cv2.Rodrigues(np.array([0.0, turn, 0.0]))[0].T + (x, y, z)
    matrix = np.array(calibration().k).reshape(3, 3)
    corners = cv2.projectPoints(turned, np.zeros(3), np.zeros(3), matrix, np.zeros(5))[0]
    seen = docker.seen_square((corners.reshape(4, 2) + UNEVEN).astype(np.float32), calibration(), SETTINGS.size)
    assert seen.place == pytest.approx([x, y, z], abs=2e-3)
    assert seen.normal == pytest.approx([-math.sin(turn), 0.0, -math.cos(turn)], abs=2e-2)
    assert seen.distance == pytest.approx(math.sqrt(x * x + y * y + z * z), abs=2e-3)


def test_the_tag_is_found_by_its_number() -> None:
    image = np.full((480, 640), 128, np.uint8)
    for left, number in ((60, 5), (380, SETTINGS.tag)):
        image[140:340, left : left + 200] = 255
        family = cv2.aruco.getPredefinedDictionary(docker.FAMILIES[SETTINGS.family])
        image[160:320, left + 20 : left + 180] = cv2.aruco.generateImageMarker(family, number, 160)
    detector = docker.detector(SETTINGS.family)
    seen = docker.find_tag(image, detector, calibration(), SETTINGS)
    assert seen.place == pytest.approx([0.16, 0.0, FOCAL * SETTINGS.size / 160], abs=2e-2)
    assert docker.find_tag(image, detector, calibration(), SETTINGS._replace(tag=7)) is None
    with pytest.raises(docker.ImageError, match="640 x 480 pixels, and the calibration is for 320 x 240"):
        docker.find_tag(image, detector, calibration(320, 240), SETTINGS)


def test_corners_of_no_square_are_no_sighting() -> None:
    seen = docker.seen_square(np.zeros((4, 2), np.float32), calibration(), SETTINGS.size)
    assert seen is None or np.isfinite([*seen.place, *seen.normal]).all()


def test_near_sightings_count_more() -> None:
    place = docker.TagPlace()
    for far, x in ((2.0, 1.0), (2.0, 1.0), (0.5, 0.0)):
        place.add((x, 0.0), (-1.0, 0.0), far)
    here = place.before(0.4)
    assert here == pytest.approx((-0.4, 0.0, 0.0), abs=0.01)


@given(st.floats(-0.04, 0.04), st.floats(-0.3, 0.3))
def test_the_way_in_ends_in_the_dock(y: float, theta: float) -> None:
    x, v, w = -SETTINGS.run_up, 0.0, 0.0
    for _ in range(300):
        v, w = docker.steered(Pose(x, y, theta), SETTINGS)
        theta += 0.1 * w
        x, y = x + 0.1 * v * math.cos(theta), y + 0.1 * v * math.sin(theta)
    assert (v, w) == pytest.approx((0.0, 0.0), abs=1e-3)
    assert (x, y, theta) == pytest.approx((0.0, 0.0, 0.0), abs=0.006)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(4))
def test_it_docks_within_a_centimetre_and_two_degrees(tmp_path: Path, number: int) -> None:
    """Twenty starts: python -m tests.support.docking."""
    run = dock(tmp_path, number)
    assert run.metres <= MOST_METRES
    assert run.degrees <= MOST_DEGREES


def test_bad_families_are_refused(system: System) -> None:
    node: Any = system.start("tag_docker")
    with pytest.raises(Exception, match="no family '36h12' of tags: expected 16h5, 25h9, 36h11"):
        system.set_parameter(node, "family", "36h12")
    system.set_parameter(node, "family", "25h9")
    system.wait_until(lambda: node.settings.family == "25h9")


def test_it_says_what_it_waits_for(system: System) -> None:
    system.start("tag_docker")
    system.publish("camera/image_raw", Image(width=1, height=1, step=1, encoding="mono8", data=b"\0"))
    system.expect_log("no odometry on /odom yet")
