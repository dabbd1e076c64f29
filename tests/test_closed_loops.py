"""Robots that drive by the controllers for minutes, from anywhere: how well they keep to the wall, and no contact.

The figures are SIMULATOR.md's: the root mean square of (distance to the nearest wall - 0.5 m). It counts from 30 s on,
in which a robot at 0.3 m/s comes to a wall from anywhere in the room and has settled there. The worlds run with steps
of 20 ms, twice as long as usual, which saves time and changes nothing that shows here.
"""

from __future__ import annotations

import statistics
from typing import Any

import pytest

from tests.drives import Drive, Follower, Reactive, random_start, world

SETTLED, DT = 30.0, 0.02


def follow(seed: int, seconds: float, goal: dict[str, Any] | None = None, **lidar: Any) -> Drive:
    pose = random_start("corners", seed)
    return Drive(world("corners", pose, seed, DT, **lidar), Follower(**(goal or {})), seconds)


def wander(seed: int, seconds: float, settings: dict[str, Any] | None = None, **lidar: Any) -> Drive:
    pose = random_start("obstacles", seed)
    return Drive(world("obstacles", pose, seed, DT, **lidar), Reactive(**(settings or {})), seconds)


def test_from_20_random_starts_the_wall_is_kept_within_5_cm_and_nothing_is_touched() -> None:
    drives = [follow(seed, 120.0) for seed in range(20)]
    assert [drive.robot.contacts for drive in drives] == [0] * 20
    errors = [drive.rms(0.5, SETTLED) for drive in drives]
    assert statistics.median(errors) <= 0.05
    assert max(errors) <= 0.05


def test_from_10_random_starts_among_obstacles_it_drives_on_and_touches_nothing() -> None:
    drives = [wander(seed, 300.0) for seed in range(10)]
    assert [drive.robot.contacts for drive in drives] == [0] * 10
    assert min(drive.in_motion() for drive in drives) >= 0.6
    assert min(drive.driven() for drive in drives) >= 0.6 * 300.0 * 0.05


LIDARS: dict[str, dict[str, Any]] = {
    "90 degrees": {"fov": 90.0, "beams": 91},
    "180 degrees": {"fov": 180.0, "beams": 181},
    "270 degrees, turned": {"fov": 270.0, "beams": 271, "start": -90.0},
    "from the left, few beams": {"start": 90.0, "beams": 36},
    "noise and dropout": {"noise": 0.02, "dropout": 0.2},
    "seldom": {"rate": 2.0},
}


@pytest.mark.parametrize("lidar", LIDARS.values(), ids=LIDARS.keys())
def test_any_lidar_follows_a_wall_on_either_side(lidar: dict[str, Any]) -> None:
    for seed, side in enumerate(("left", "right")):
        drive = follow(seed, 80.0, {"side": side}, **lidar)
        assert drive.robot.contacts == 0
        assert drive.rms(0.5, SETTLED) <= 0.06


@pytest.mark.parametrize("lidar", LIDARS.values(), ids=LIDARS.keys())
def test_any_lidar_wanders(lidar: dict[str, Any]) -> None:
    drive = wander(3, 60.0, **lidar)
    assert drive.robot.contacts == 0
    assert drive.in_motion() >= 0.6
