"""The robot systems as users start them: what the robots do is measured from /odom and the world files."""

from __future__ import annotations

import itertools
import math
import re
import sys
from pathlib import Path

import pytest

from robolink.sim import load_world
from robolink.sim.sensing.scene import fixed_circles, fixed_segments, nearest_wall_distance
from robolink.workspace import find_world
from tests.support.commands import TERMINAL, Command
from tests.support.domains import free_domain
from tests.support.long_runs import LongRun, Sample
from tests.support.witness import watched

pytestmark = pytest.mark.processes

MIDDLE = (3.0, 2.5)
"""A point of the cornered room that the path along its walls leads around; it is far from all of them."""


# --- what is measured -----------------------------------------------------------------------------------------


def clearances(samples: list[Sample], world: str) -> list[float]:
    """The distance from the robot's centre to the nearest wall or fixed obstacle, in metres."""
    description = load_world(find_world(world))
    segments, circles = fixed_segments(description), fixed_circles(description)
    return [nearest_wall_distance(segments, circles, each.x, each.y) for each in samples]


def radius_of_robot(world: str) -> float:
    return load_world(find_world(world)).robots[0].shape.outer_radius()


def length(samples: list[Sample]) -> float:
    return sum(math.dist(one[1:3], other[1:3]) for one, other in itertools.pairwise(samples))


def laps(samples: list[Sample], middle: tuple[float, float]) -> float:
    """How often the path leads around a point, counter-clockwise."""
    bearings = [math.atan2(each.y - middle[1], each.x - middle[0]) for each in samples]
    turns = (other - one for one, other in itertools.pairwise(bearings))
    return sum((turn + math.pi) % math.tau - math.pi for turn in turns) / math.tau


def rms(values: list[float]) -> float:
    return math.sqrt(sum(value * value for value in values) / len(values))


def test_the_measures_are_right() -> None:
    ring = [Sample(0.0, math.cos(angle / 50), math.sin(angle / 50), 0.0) for angle in range(630)]
    assert length(ring) == pytest.approx(12.58, abs=0.01)
    assert laps(ring, (0.0, 0.5)) == pytest.approx(2.0, abs=0.05)
    assert laps(ring, (2.0, 0.0)) == pytest.approx(0.0, abs=0.1)
    assert rms([3.0, -4.0]) == pytest.approx(3.5355, abs=1e-4)
    assert clearances([Sample(0.0, 3.0, 0.9, 0.0)], "corners") == pytest.approx([0.9])


# --- launch wander and launch follow --------------------------------------------------------------------------


def ran_well(run: LongRun) -> list[Sample]:
    """Wait for its orderly end, and see that it said what it does and left nothing behind; what /odom said."""
    code = run.end()
    report = [line.text for line in run.launch.lines]
    assert (code, run.launch.errors) == (0, []), report
    assert run.launch.left() == []
    with watched(run.domain) as witness:
        witness.wait_until_alone()
    for said in (r"robot at \(\S+, \S+\) heading", r"driving|turning|following"):
        assert [line for line in report if re.search(said, line)]
    assert not [line for line in report if "ran into" in line or "in contact" in line]
    samples = run.samples()
    assert samples[-1].time - samples[0].time > run.seconds - 15.0  # what is left over is starting and ending
    assert len(samples) > 0.5 * 50 * (run.seconds - 15.0)
    return samples


@pytest.mark.long_run("wander", 60)
def test_wander_drives_far_and_touches_nothing(long_run: LongRun) -> None:
    samples = ran_well(long_run)
    assert length(samples) >= 8.0
    assert min(clearances(samples, "obstacles")) > radius_of_robot("obstacles")


@pytest.mark.long_run("follow", 120)
@pytest.mark.timeout(240)
def test_follow_goes_around_along_the_wall(long_run: LongRun) -> None:
    samples = ran_well(long_run)
    distances = clearances(samples, "corners")
    settled = samples[0].time + 30.0
    errors = [distance - 0.5 for each, distance in zip(samples, distances, strict=True) if each.time > settled]
    assert laps(samples, MIDDLE) >= 1.0
    assert rms(errors) < 0.1
    assert min(distances) > radius_of_robot("corners")


# --- launch teleop --------------------------------------------------------------------------------------------


def test_pub_drives_the_robot_of_launch_teleop_until_it_is_killed() -> None:
    with free_domain() as domain, watched(domain) as witness, Command(domain, "launch", "teleop") as teleop:
        there = witness.wait(lambda each: True)
        assert there.speed == pytest.approx(0.0)
        pub = "pub", "/cmd_vel", "Twist", "{linear: {x: 0.3}}", "-r", "10"
        with Command(domain, *pub) as driver:
            witness.wait(lambda each: math.dist(each[1:3], there[1:3]) > 0.3)
            assert max(each.speed for each in witness.samples) == pytest.approx(0.3, abs=0.01)
            driver.kill()
        witness.wait(lambda each: abs(each.speed) < 1e-3)
        assert len(teleop.left()) >= 3 or not Path("/proc/self/environ").exists()
        teleop.interrupt()
        assert teleop.end() == 0
    assert any("drive with: robolink pub /cmd_vel Twist" in line.text for line in teleop.lines)
    assert (teleop.left(), driver.errors, teleop.errors) == ([], [], [])


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudo-terminals for a test to type on")
def test_keys_drive_the_robot_of_launch_teleop() -> None:
    shell = 'trap : INT; "$@"; echo code $?; stty -a'
    terminal = (sys.executable, "-c", TERMINAL, "/bin/sh", "-c", shell, "sh", sys.executable, "-m", "robolink")
    with (
        free_domain() as domain,
        watched(domain) as witness,
        Command(domain, "launch", "teleop", program=terminal, has_input=True) as teleop,
    ):
        teleop.wait_for("drive with w a s d")
        there = witness.wait(lambda each: True)
        while math.dist(witness.samples[-1][1:3], there[1:3]) <= 0.3:  # or else pytest gives up
            teleop.press("w")
            witness.go_on(0.1)
        assert max(each.speed for each in witness.samples) == pytest.approx(0.3, abs=0.01)
        witness.wait(lambda each: abs(each.speed) < 1e-3)
        teleop.press("\x03")
        teleop.wait_for("code 0")
        teleop.wait_for(" icanon")
        assert teleop.end() == 0
    assert teleop.left() == []
