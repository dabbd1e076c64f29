"""Robots that follow walls for minutes, from anywhere: how well they keep to the wall, and no contact.

The figures are SIMULATOR.md's: the root mean square of (distance to the nearest wall - 0.5 m), once settled.
"""

from __future__ import annotations

import statistics
from typing import Any

import pytest

from tests.support.closed_loops import LIDARS, SETTLED, follow


@pytest.mark.slow
def test_from_20_random_starts_the_wall_is_kept_within_5_cm_and_nothing_is_touched() -> None:
    runs = [follow(seed, 120.0) for seed in range(20)]
    assert [run.robot.contacts for run in runs] == [0] * 20
    errors = [run.rms(0.5, SETTLED) for run in runs]
    assert statistics.median(errors) <= 0.05
    assert max(errors) <= 0.05


@pytest.mark.slow
@pytest.mark.parametrize("lidar", LIDARS.values(), ids=LIDARS.keys())
def test_any_lidar_follows_a_wall_on_either_side(lidar: dict[str, Any]) -> None:
    for seed, side in enumerate(("left", "right")):
        run = follow(seed, 80.0, {"side": side}, **lidar)
        assert run.robot.contacts == 0
        assert run.rms(0.5, SETTLED) <= 0.06
