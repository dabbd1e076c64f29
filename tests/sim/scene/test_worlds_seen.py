"""The worlds for cameras: what there is to see is seen, and the files of their signs are what the tool draws."""

from __future__ import annotations

import math
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from robolink.sim import Pose, World, load_world
from robolink.sim.scene.pictures import read_picture
from robolink.sim.scene.scenery import scenery

ROOT = Path(__file__).parents[3]
WORLDS = ROOT / "configs" / "worlds"
TOOL = runpy.run_path(str(ROOT / "tools" / "draw_signs.py"))


def image(world: str, pose: Pose | None = None) -> npt.NDArray[np.int16]:
    """What the camera of a world's robot sees, there or at its start."""
    made = World(load_world(WORLDS / f"{world}.yaml"))
    (robot,) = made.robots.values()
    if pose is not None:
        robot.teleport(pose)
    found: Any = next(each.value for each in made.readings() if each.sensor.kind == "camera")
    seen: npt.NDArray[np.int16] = found.image("rgb8").astype(np.int16)
    return seen


def share(pixels: npt.NDArray[np.int16], colour: tuple[int, int, int]) -> float:
    """Share of an image's pixels that have a colour's hue, brighter or darker."""
    length = np.sqrt((pixels.astype(np.float64) ** 2).sum(axis=2)) * math.hypot(*colour)
    return float(((pixels * colour).sum(axis=2) > 0.985 * length).mean())


def test_the_robot_of_track_sees_the_line_in_the_middle_below() -> None:
    seen = image("track")
    columns = np.flatnonzero((seen[-1, :, 0] - seen[-1, :, 2]) > 80)
    assert columns.mean() == pytest.approx(79.5, abs=2.0)
    assert 0.05 < share(seen, (230, 200, 40)) < 0.3


def test_the_line_of_track_has_bends_to_both_sides_and_is_closed() -> None:
    floor = scenery(load_world(WORLDS / "track.yaml")).floor
    assert floor.image is not None
    line = (floor.image == (0xE6, 0xC8, 0x28)).all(axis=2)
    straight = 2.8 + 2 * 1.8 + 4 * 0.2  # sides without their arcs of 0.6 m
    arcs = 8 * math.pi / 2 * 0.6
    assert line.sum() * floor.resolution**2 == pytest.approx(0.05 * (straight + arcs), rel=0.12)  # less its edges


@pytest.mark.parametrize(
    ("number", "pose"), [(0, Pose(7.0, 3.6, 0.0)), (1, Pose(4.0, 4.0, math.pi / 2)), (2, Pose(4.0, 3.2, 0.0))]
)
def test_opencv_finds_the_tags_of_signs_where_they_are(number: int, pose: Pose) -> None:
    aruco = pytest.importorskip("cv2").aruco
    seen = image("signs", pose)
    dictionary = aruco.getPredefinedDictionary(aruco.DICT_APRILTAG_36h11)
    corners, numbers, _ = aruco.ArucoDetector(dictionary, aruco.DetectorParameters()).detectMarkers(
        seen.astype(np.uint8)
    )
    assert numbers.ravel().tolist() == [number]
    middle = corners[0][0].mean(axis=0)
    assert middle[0] == pytest.approx(319.5, abs=1.5)


def test_the_robot_of_signs_sees_red_and_blue_signs_from_its_start() -> None:
    seen = image("signs")
    assert share(seen, (200, 30, 30)) > 0.003
    assert share(seen, (30, 80, 180)) > 0.01


@pytest.mark.parametrize(
    ("x", "y", "colour"),
    [(1.2, 4.8, (210, 30, 30)), (4.8, 4.6, (30, 150, 50)), (4.9, 1.2, (30, 70, 210)), (1.0, 1.4, (230, 200, 40))],
)
def test_each_thing_of_blobs_is_seen_from_the_middle_and_no_other_has_its_colour(
    x: float, y: float, colour: tuple[int, int, int]
) -> None:
    towards = math.atan2(y - 3.0, x - 3.0)
    assert share(image("blobs", Pose(3.0, 3.0, towards)), colour) > 0.003
    assert share(image("blobs", Pose(3.0, 3.0, math.remainder(towards + math.pi, math.tau))), colour) < 1e-4


@pytest.mark.parametrize("name", TOOL["SIGNS"])
def test_the_files_of_the_signs_are_what_the_tool_draws(name: str, tmp_path: Path) -> None:
    (tmp_path / "drawn.png").write_bytes(TOOL["drawn"](name))
    drawn = read_picture(str(tmp_path / "drawn.png")).astype(int)
    file = read_picture(str(WORLDS / "signs" / f"{name}.png")).astype(int)
    assert np.abs(drawn - file).max() <= 1  # cosines may differ in their last bit
    assert sorted(path.stem for path in (WORLDS / "signs").iterdir()) == sorted(TOOL["SIGNS"])
