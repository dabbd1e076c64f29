"""The blob chaser: what it makes of an image, and that it finds the things of the world `blobs`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from robolink import Parameter
from robolink.exceptions import InvalidParameterValueException
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.testing import System
from tests.support.cameras import BLUE, GREEN, PINK, RED, Camera, floor, thing
from tests.support.nodefiles import ROOT, load_node_file
from tests.support.systems import said

chaser = load_node_file("blob_chaser")
SETTINGS = chaser.Settings()
WORLD = ROOT / "configs" / "worlds" / "blobs.yaml"
THINGS = {"red": (1.2, 4.8), "green": (4.8, 4.6), "blue": (4.9, 1.2), "yellow": (1.0, 1.4)}


def test_a_blob_is_a_box_in_the_image() -> None:
    blob = chaser.find_blob(thing(RED, slice(40, 60), slice(120, 160)), "red", SETTINGS)
    assert blob == ("red", pytest.approx(0.75), 0.25, pytest.approx(40 * 20 / 160 / 120), False)
    assert chaser.find_blob(thing(RED, slice(60, 120), slice(0, 160)), "red", SETTINGS).is_cut


def test_the_largest_of_a_colour_counts_and_specks_do_not() -> None:
    image = thing(GREEN, slice(40, 50), slice(0, 10), thing(GREEN, slice(40, 60), slice(100, 120)))
    assert chaser.find_blob(image, "green", SETTINGS).offset == pytest.approx(0.375)
    assert chaser.find_blob(thing(GREEN, slice(3, 6), slice(3, 6)), "green", SETTINGS) is None
    assert chaser.find_blob(image, "blue", SETTINGS) is None


def test_red_is_at_both_ends_of_the_scale() -> None:
    image = thing(RED, slice(40, 60), slice(0, 20), thing(PINK, slice(40, 60), slice(20, 40)))
    assert chaser.find_blob(image, "red", SETTINGS).width == pytest.approx(0.25)


@given(st.integers(1, 30), st.integers(1, 30), st.integers(0, 2**32 - 1), st.sampled_from(sorted(chaser.HUES)))
def test_no_image_brings_a_command_out_of_its_limits(height: int, width: int, seed: int, colour: str) -> None:
    image = np.random.default_rng(seed).integers(0, 256, (height, width, 3), dtype=np.uint8)
    blob = chaser.find_blob(image, colour, SETTINGS)
    if blob is not None:
        twist = chaser.chase(blob, SETTINGS)
        assert 0.0 <= twist.linear.x <= SETTINGS.speed
        assert abs(twist.angular.z) <= SETTINGS.turn_speed


def test_it_turns_to_the_blob_slows_down_and_stops_before_it(system: System) -> None:
    camera, node = system.start(Camera), system.start("blob_chaser", parameters={"colours": ["red"], "pause": 1.0})
    system.run(1.05)
    assert (camera.heard[-1].linear.x, camera.heard[-1].angular.z) == (0.0, pytest.approx(0.8))
    assert said(system, "searching red, turning left") == 1
    speeds = []
    for half in (4, 20, 30):
        camera.show(thing(RED, slice(40, 60), slice(90 - half, 90 + half)))
        system.run(0.2)
        assert camera.heard[-1].angular.z == pytest.approx(-1.5 * 0.125)
        speeds.append(camera.heard[-1].linear.x)
    assert 0.25 < speeds[0] > speeds[1] > speeds[2] > 0.05
    camera.show(thing(RED, slice(40, 60), slice(80, 160)))
    system.run(0.2)
    assert camera.heard[-1].linear.x == 0.0, "near, and it turns until the blob is in the middle"
    assert camera.heard[-1].angular.z < 0.0
    camera.show(thing(RED, slice(40, 60), slice(40, 120)))
    system.run(0.2)
    assert camera.heard[-1] == Twist()
    assert node.found == ["red"]
    system.run(2.0)
    assert camera.heard[-1] == Twist()
    assert said(system, "found the red blob, 1 of 1") == 1


def test_the_colours_are_checked_and_new_ones_begin_a_new_search(system: System) -> None:
    camera, node = system.start(Camera), system.start("blob_chaser", parameters={"pause": 0.0})
    camera.show(thing(BLUE, slice(40, 60), slice(40, 120)))
    system.run(0.5)
    assert node.found == ["blue"]
    (result,) = node.set_parameters([Parameter("colours", value=["blue", "violet"])])
    assert result.reason.endswith("blue, magenta, got 'violet'")
    assert node.found == ["blue"]
    camera.show(floor())
    node.set_parameters([Parameter("colours", value=["blue"])])
    assert node.found == []
    system.run(0.5)
    assert camera.heard[-1].angular.z != 0.0
    with pytest.raises(InvalidParameterValueException, match="violet"):
        system.start("blob_chaser", name="other", parameters={"colours": ["violet"]})


def start(seed: int) -> tuple[float, float, float]:
    """A pose in the room, at least half a metre from all things and walls."""
    random = np.random.default_rng(seed)
    while True:
        x, y, theta = random.uniform((0.5, 0.5, -math.pi), (5.5, 5.5, math.pi)).tolist()
        if min(math.dist((x, y), each) for each in THINGS.values()) > 0.7:
            return x, y, theta


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_it_finds_all_three_and_stops_before_each(seed: int, tmp_path: Path) -> None:
    description: Any = yaml.safe_load(WORLD.read_text(encoding="utf-8"))
    places = [each["pose"][:2] for each in description["obstacles"]]
    assert places == [list(each) for each in THINGS.values()]
    robot = description["robots"][0]
    robot["pose"] = list(start(seed))
    robot["sensors"] = [{**each, "width": 160, "height": 120} for each in robot["sensors"] if "camera" in each]
    description["world"]["dt"] = 0.02
    (tmp_path / "blobs.yaml").write_text(yaml.safe_dump(description), encoding="utf-8")
    with System(seed=seed) as system:
        system.start("world", parameters={"world": str(tmp_path / "blobs.yaml")})
        node = system.start("blob_chaser")
        told = system.messages("/found")
        for number in range(1, 4):
            system.wait_until(lambda: len(told) == number, within=60.0)  # noqa: B023 - called in this round only
            system.run(1.0)
            robot = system.robot()
            x, y = THINGS[node.found[-1]]
            assert math.dist((x, y), (robot.pose.x, robot.pose.y)) < 1.0
            aside = math.atan2(y - robot.pose.y, x - robot.pose.x) - robot.pose.theta
            assert abs(math.remainder(aside, math.tau)) < 0.1
            assert abs(robot.twist.v) + abs(robot.twist.w) < 1e-3
        assert sorted(node.found) == ["blue", "green", "red"]
        assert [each.data for each in told] == node.found
        assert system.robot().contacts == 0


@pytest.mark.slow
def test_the_launch_file_of_the_blobs_finds_one(system: System) -> None:
    system.launch("blobs")
    system.expect("/found", within=40.0)
