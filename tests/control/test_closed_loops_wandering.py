"""Robots that wander among obstacles for minutes, from anywhere: they get around, and touch nothing."""

from __future__ import annotations

from typing import Any

import pytest

from tests.support.closed_loops import LIDARS, wander


@pytest.mark.slow
def test_from_10_random_starts_among_obstacles_it_drives_on_and_touches_nothing() -> None:
    runs = [wander(seed, 300.0) for seed in range(10)]
    assert [run.robot.contacts for run in runs] == [0] * 10
    assert min(run.in_motion() for run in runs) >= 0.6
    assert min(run.driven() for run in runs) >= 100.0, "of 120 m at full speed"
    assert min(run.cells() for run in runs) >= 20, "it gets around, and not in a circle"


@pytest.mark.slow
@pytest.mark.parametrize("lidar", LIDARS.values(), ids=LIDARS.keys())
def test_any_lidar_wanders(lidar: dict[str, Any]) -> None:
    run = wander(3, 60.0, **lidar)
    assert run.robot.contacts == 0
    assert run.in_motion() >= 0.6
