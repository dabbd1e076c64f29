"""Localization: which scans are used, and what jumps of odometry, several scanners and people do."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robolink.geometry.plane import Pose, placed_on, seen_from
from robolink.navigation.grid import Floats, Grid
from robolink.navigation.localization import Beams, BeamSkip, Localization, LocalizationOptions
from robolink.navigation.particle_filter import FilterOptions

TRUTH = Pose(2.0, 1.5, 0.3)
DOUBT = np.diag([0.04, 0.04, 0.02])


def room() -> Grid:
    """Return the map of an angular room of 6 x 4 m, in cells of 5 cm."""
    cells = np.zeros((84, 124), np.int8)
    cells[:2] = cells[-2:] = cells[:, :2] = cells[:, -2:] = 100
    cells[2:30, 90:122] = cells[60:62, 2:30] = 100
    return Grid(cells, 0.05, (-0.1, -0.1, 0.0))


def beams(pose: Pose, scanner: str = "") -> Beams:
    """Return the scan of a robot in the room."""
    grid, angles, steps = room(), np.linspace(-math.pi, math.pi, 60, endpoint=False), np.arange(0.0, 8.0, 0.005)
    x, y = (np.outer(each(angles + pose.theta), steps) for each in (np.cos, np.sin))
    row, column = grid.world_to_cell(pose.x + x, pose.y + y)
    ranges = steps[(grid.cells[row.clip(0, 83), column.clip(0, 123)] > 0).argmax(axis=1)]
    return Beams(ranges * np.cos(angles), ranges * np.sin(angles), 8.0, scanner)


def localized(**options: object) -> Localization:
    """Return a localization that knows about where it is, and has used a scan at odometry's origin."""
    made = Localization(LocalizationOptions(**options), np.random.default_rng(1))  # type: ignore[arg-type]
    made.set_map(room())
    made.start_at(Pose(2.1, 1.4, 0.25), DOUBT)
    assert made.update(Pose(), beams(TRUTH))
    return made


def pose(made: Localization) -> Pose:
    assert made.estimate is not None
    return made.estimate.pose


def test_scans_are_used_when_the_robot_has_moved() -> None:
    made = localized()
    assert pose(made) == pytest.approx(TRUTH, abs=0.1)
    assert not made.update(Pose(0.2, 0.0, 0.1), beams(TRUTH))
    way = Pose(0.3, 0.0, 0.0)
    assert made.update(way, beams(placed_on(TRUTH, way)))
    assert pose(made) == pytest.approx(placed_on(TRUTH, way), abs=0.1)
    assert made.update(Pose(0.3, 0.0, 0.3), beams(placed_on(TRUTH, Pose(0.3, 0.0, 0.3))))
    made.is_forced = True
    assert made.update(Pose(0.3, 0.0, 0.3), beams(placed_on(TRUTH, Pose(0.3, 0.0, 0.3))))
    assert not made.update(Pose(0.3, 0.0, 0.3), beams(TRUTH))


def test_without_a_map_nothing_is_used_and_nothing_is_free() -> None:
    made = Localization(LocalizationOptions(), np.random.default_rng(1))
    assert not made.has_map
    assert not made.start_anywhere()
    made.start_at(TRUTH, DOUBT)
    assert not made.update(Pose(), beams(TRUTH))
    assert made.origin_of_odometry() is None


def test_each_scanner_has_its_turn() -> None:
    made = localized()
    assert made.update(Pose(), beams(TRUTH, "rear"))
    assert not made.update(Pose(), beams(TRUTH, "rear"))
    way = Pose(0.3, 0.0, 0.0)
    there = placed_on(TRUTH, way)
    assert [made.update(way, beams(there, name)) for name in ("", "rear", "", "rear")] == [True, True, False, False]


def test_the_transform_leads_from_the_map_to_odometry() -> None:
    made = localized()
    way = Pose(0.3, 0.1, 0.2)
    made.update(way, beams(placed_on(TRUTH, way)))
    origin = made.origin_of_odometry()
    assert origin is not None
    assert placed_on(origin, way) == pytest.approx(pose(made))


def drive(made: Localization, odometry: Pose, truth: Pose) -> Pose:
    """Drive round a circle of 30 cm radius from poses of odometry and of the robot; return where it is then."""
    for step in range(16):
        turned = 0.25 * step
        way = Pose(0.3 * math.sin(turned), 0.3 * (1.0 - math.cos(turned)), turned)
        made.update(placed_on(odometry, way), beams(placed_on(truth, way)), 0.1)
    there = placed_on(truth, way)
    return there._replace(theta=math.remainder(there.theta, math.tau))


@pytest.mark.parametrize("jump", [Pose(100.0, -50.0, 2.0), Pose(0.0, 0.0, 3.0)])
def test_odometry_that_is_set_elsewhere_does_not_move_the_robot(jump: Pose) -> None:
    made = localized()
    made.update(Pose(0.1, 0.0, 0.0), beams(placed_on(TRUTH, Pose(0.1, 0.0, 0.0))), 0.1)
    there = drive(made, jump, placed_on(TRUTH, Pose(0.1, 0.0, 0.0)))
    assert pose(made) == pytest.approx(there, abs=0.15)
    assert made.estimate is not None
    assert made.estimate.weight > 0.9


def test_a_robot_that_jumps_with_its_odometry_is_followed() -> None:
    """As when a simulator is reset."""
    made = localized()
    jump = Pose(1.5, 1.0, 2.0)
    there = drive(made, jump, placed_on(TRUTH, jump))
    assert pose(made) == pytest.approx(there, abs=0.15)


def test_odometry_may_begin_anew_with_time() -> None:
    made = localized()
    made.restart_odometry()
    there = drive(made, Pose(0.4, 0.2, 0.1), TRUTH)
    assert pose(made) == pytest.approx(there, abs=0.15)


def test_a_long_way_between_two_scans_is_not_a_jump() -> None:
    made = localized()
    way = Pose(1.5, 0.0, 0.0)
    assert made.update(way, beams(placed_on(TRUTH, way)), 5.0)
    assert pose(made) == pytest.approx(placed_on(TRUTH, way), abs=0.4)


def test_a_robot_at_rest_stays_in_doubt() -> None:
    made = localized()
    for _ in range(50):
        made.is_forced = True
        made.update(Pose(), beams(TRUTH))
    assert made.estimate is not None
    assert np.linalg.eigvalsh(made.estimate.covariance).min() > 1e-5
    gap = np.array(seen_from(TRUTH, pose(made)))
    assert gap @ np.linalg.solve(made.estimate.covariance, gap) < 7.8


def crowded(scan: Beams, share: float) -> Beams:
    """Return a scan of which a share of the beams, one after the other, meets people."""
    many = int(share * 60)
    shorter = np.where(np.arange(60) < many, 0.3, 1.0)
    return scan._replace(ahead=scan.ahead * shorter, aside=scan.aside * shorter)


@pytest.mark.parametrize("skip", [None, BeamSkip()])
def test_people_do_not_mislead_it(skip: BeamSkip | None) -> None:
    made = localized(skip=skip)
    for step in range(1, 8):
        way = Pose(0.2 * step, 0.0, 0.25 * step)
        made.update(way, crowded(beams(placed_on(TRUTH, way)), 0.25))
    assert pose(made) == pytest.approx(placed_on(TRUTH, way), abs=0.25)
    assert made.fit < 0.85
    assert not made.seems_lost


def test_options_may_change() -> None:
    made = localized()
    made.options = made.options._replace(particles=FilterOptions(50, 60), resample_interval=3)
    counts = []
    for _ in range(3):
        made.is_forced = True
        made.update(Pose(), beams(TRUTH))
        counts.append(made.particles.poses.shape[1])
    assert counts[0] >= 500
    assert 50 <= counts[-1] <= 60


def test_a_scan_without_beams_moves_the_particles_alone() -> None:
    made = localized()
    nothing: Floats = np.empty(0)
    assert made.update(Pose(0.5, 0.0, 0.0), Beams(nothing, nothing, 8.0))
    assert pose(made) == pytest.approx(placed_on(TRUTH, Pose(0.5, 0.0, 0.0)), abs=0.2)
