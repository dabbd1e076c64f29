"""The line follower: what it makes of an image, and that it keeps to the line of the world `track`."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from robolink import Parameter
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.sim import Pose, load_world
from robolink.sim.scene.strokes import strokes
from robolink.testing import System
from tests.support.cameras import GREEN, PINK, RED, YELLOW, Camera, floor, thing
from tests.support.nodefiles import ROOT, load_node_file
from tests.support.systems import said

follower = load_node_file("line_follower")
WORLD = ROOT / "configs" / "worlds" / "track.yaml"


def found(image: Any, **settings: Any) -> Any:
    return follower.find_line(image, follower.Settings(**settings))


@pytest.mark.parametrize(
    ("columns", "error"), [(slice(0, 1), 1 / 160 - 1), (slice(75, 85), 0.0), (slice(150, 160), 15 / 16)]
)
def test_the_error_is_where_the_line_is(columns: slice, error: float) -> None:
    assert found(floor((YELLOW, columns))) == pytest.approx(error)


def test_only_the_band_of_rows_and_the_colour_count() -> None:
    assert found(thing(YELLOW, slice(0, 84), slice(0, 160))) is None
    assert found(thing(YELLOW, slice(0, 84), slice(0, 160)), top=0.5, bottom=0.55) == pytest.approx(0.0)
    assert found(floor((RED, slice(0, 160)))) is None
    assert found(floor((RED, slice(0, 80)), (YELLOW, slice(150, 160)))) == pytest.approx(15 / 16)
    assert found(thing(YELLOW, slice(110, 112), slice(80, 82))) is None, "four pixels are noise"


def test_a_band_has_a_row_at_least() -> None:
    assert found(floor((YELLOW, slice(0, 80))), top=0.9, bottom=0.2) == pytest.approx(-0.5)
    assert found(floor((YELLOW, slice(0, 1)), height=1, width=1)) == pytest.approx(0.0)


@pytest.mark.parametrize("hue", [170, 0, 5])
def test_red_is_at_both_ends_of_the_scale(hue: int) -> None:
    assert found(floor((RED, slice(0, 80))), hue=hue) == pytest.approx(-0.5)
    assert found(floor((PINK, slice(0, 80))), hue=hue) == (pytest.approx(-0.5) if hue != 5 else None)
    assert found(floor((GREEN, slice(0, 80))), hue=hue) is None


@given(st.integers(1, 40), st.integers(1, 40), st.integers(0, 2**32 - 1), st.integers(0, 179), st.integers(1, 90))
def test_no_image_brings_the_error_out_of_its_limits(height: int, width: int, seed: int, hue: int, near: int) -> None:
    image = np.random.default_rng(seed).integers(0, 256, (height, width, 3), dtype=np.uint8)
    error = found(image, hue=hue, hue_tolerance=near)
    assert error is None or -1.0 < error < 1.0


def seen(system: System, columns: slice, **parameters: Any) -> tuple[Camera, Any]:
    camera, node = system.start(Camera), system.start("line_follower", parameters=parameters)
    camera.show(floor((YELLOW, columns)))
    system.run(1.05)
    return camera, node


def test_it_turns_to_the_line_and_is_slower_where_the_line_is_aside(system: System) -> None:
    camera, _ = seen(system, slice(110, 130), kd=0.0, kp=1.5, speed=0.3)  # half way to the right
    assert camera.heard[-1].angular.z == pytest.approx(-0.75)
    assert camera.heard[-1].linear.x == pytest.approx(0.15)
    camera.show(floor((YELLOW, slice(30, 50))))
    system.run(0.2)
    assert camera.heard[-1].angular.z == pytest.approx(0.75)


def test_it_is_tuned_while_it_runs(system: System) -> None:
    camera, node = seen(system, slice(110, 130), kd=0.0)
    node.set_parameters([Parameter("kp", value=2.5)])
    system.run(0.1)
    assert camera.heard[-1].angular.z == pytest.approx(-1.25)
    node.set_parameters([Parameter("kp", value=0.0), Parameter("ki", value=1.0)])
    system.run(1.0)
    assert camera.heard[-1].angular.z == pytest.approx(-0.5), "half a radian in a second"
    camera.show(floor((YELLOW, slice(75, 85))))
    node.set_parameters([Parameter("ki", value=0.0), Parameter("speed", value=0.1)])
    system.run(0.2)
    assert camera.heard[-1].linear.x == pytest.approx(0.1)
    assert camera.heard[-1].angular.z == 0.0, "nothing is left of the sum"
    node.set_parameters([Parameter("hue", value=60)])
    system.run(0.2)
    assert camera.heard[-1].linear.x == 0.0, "the yellow line is none any more"


def test_it_turns_to_where_the_line_was_and_stands_when_it_does_not_come_back(system: System) -> None:
    camera, _ = seen(system, slice(0, 20), search_time=3.0, turn_speed=0.8)
    camera.show(floor())
    system.run(2.0)
    assert camera.heard[-1].angular.z == pytest.approx(0.8), "to the left"
    assert said(system, "no line in view: turning left") == 1
    system.run(3.0)
    assert camera.heard[-1] == Twist()
    assert said(system, "no line for 3 s: standing still") >= 1
    camera.show(floor((YELLOW, slice(75, 85))))
    system.run(0.2)
    assert camera.heard[-1].linear.x > 0.2


# On the track


def line() -> npt.NDArray[np.float64]:
    """The corners of the painted line, with its rounded bends."""
    (stroke,) = strokes(load_world(WORLD).paint[0], 1e-4)
    points = np.array(stroke.points)
    corners: npt.NDArray[np.float64] = points[np.append(True, np.hypot(*np.diff(points, axis=0).T) > 1e-9)]
    return corners


LINE = line()


def off(x: float, y: float) -> float:
    """Metres from a point to the middle of the line."""
    starts, sides = LINE[:-1], np.diff(LINE, axis=0)
    share = np.clip((((x, y) - starts) * sides).sum(1) / (sides**2).sum(1), 0.0, 1.0)
    return float(np.hypot(*(starts + share[:, None] * sides - (x, y)).T).min())


def start(seed: int) -> Pose:
    """A pose near the line: anywhere along it, in either direction, up to 8 cm beside it and 25 degrees askew."""
    random = np.random.default_rng(seed)
    lengths = np.hypot(*np.diff(LINE, axis=0).T)
    which = random.choice(len(lengths), p=lengths / lengths.sum())
    x, y = LINE[which] + random.uniform() * (LINE[which + 1] - LINE[which])
    heading = math.atan2(*(LINE[which + 1] - LINE[which])[::-1])
    aside = random.uniform(-0.08, 0.08)
    x, y = x - aside * math.sin(heading), y + aside * math.cos(heading)
    return Pose(float(x), float(y), heading + random.uniform(-0.44, 0.44) + math.pi * int(random.integers(2)))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_it_keeps_to_the_line_for_two_minutes(seed: int, tmp_path: Path) -> None:
    description = yaml.safe_load(WORLD.read_text(encoding="utf-8"))
    robot, pose = description["robots"][0], start(seed)
    robot["pose"] = [pose.x, pose.y, pose.theta]
    robot["sensors"] = [each for each in robot["sensors"] if "camera" in each]
    description["world"]["dt"] = 0.02
    (tmp_path / "track.yaml").write_text(yaml.safe_dump(description), encoding="utf-8")
    way = list[tuple[float, float]]()
    with System(seed=seed) as system:
        system.start("world", parameters={"world": str(tmp_path / "track.yaml")})
        system.start("line_follower")
        system.run(5.0)
        for _ in range(575):
            system.run(0.2)
            pose = system.robot().pose
            way.append((pose.x, pose.y))
    assert max(off(*each) for each in way) < 0.03
    assert sum(itertools.starmap(math.dist, itertools.pairwise(way))) > 20.0


@pytest.mark.slow
def test_the_launch_file_of_the_track_follows_its_line(system: System) -> None:
    system.launch("track")
    system.run(20.0)
    pose = system.robot().pose
    assert off(pose.x, pose.y) < 0.03
    assert math.dist((pose.x, pose.y), (2.0, 1.0)) > 3.0
