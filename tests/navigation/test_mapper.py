"""Mapper: walls where they are, loops that close, and a word when the scans and the map do not fit."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robolink.geometry.plane import Pose, placed_on, seen_from
from robolink.navigation.mapper import Fit, Mapper, Options
from robolink.navigation.occupancy import Beams, Lidar, beams_of
from robolink.navigation.scan_matching import Field
from tests.support import mapping_drives
from tests.support.mapping_drives import Drive, driven, wall_distances
from tests.support.scanned_rooms import CORRIDOR, ROOM, Walls, points

ROUND = [
    (2.0, 1.5),
    (5.0, 1.5),
    (5.2, 3.6),
    (8.0, 3.6),
    (8.0, 1.5),
    (8.0, 6.0),
    (8.0, 3.6),
    (5.2, 3.6),
    (4.5, 6.5),
    (2.0, 5.5),
]


def way(places: list[tuple[float, float]], step: float = 0.25) -> list[Pose]:
    """Return poses along a way, a step apart, each towards the next place."""
    found = []
    for (x0, y0), (x1, y1) in itertools.pairwise(places):
        turn, count = math.atan2(y1 - y0, x1 - x0), max(1, round(math.dist((x0, y0), (x1, y1)) / step))
        found += [Pose(x0 + (x1 - x0) * n / count, y0 + (y1 - y0) * n / count, turn) for n in range(count)]
    return found


def scan_of(walls: Walls, pose: Pose, seed: int = 0) -> Beams:
    scan = points(walls, pose, seed=seed)
    return Beams(scan, len(scan))


def mapped(
    mapper: Mapper, walls: Walls, poses: Iterable[Pose], odometry: Pose | None = None, scale: float = 1.03
) -> tuple[list[Fit], Pose]:
    """Map a way with odometry that is wrong by a factor; return the fits, and where odometry is at the end."""
    fits, last = [], None
    for seed, pose in enumerate(poses):
        if odometry is None:
            odometry = pose
        elif last is not None:
            step = seen_from(last, pose)
            odometry = placed_on(odometry, Pose(step.x * scale, step.y * scale, step.theta * (2.0 - scale)))
        last = pose
        fit = mapper.process(scan_of(walls, pose, seed), odometry)
        if fit is not None:
            fits.append(fit)
    assert odometry is not None
    return fits, odometry


def map_drive(mapper: Mapper, drive: Drive) -> np.ndarray:
    """Map a drive; return the true poses of the keyframes."""
    truth = []
    for true, odometry, ranges in zip(drive.truth, drive.odometry, drive.ranges, strict=True):
        before = len(mapper.keyframes)
        mapper.process(beams_of(ranges, drive.angles, (0.12, 12.0), 12.0, Lidar()), Pose(*odometry.tolist()))
        if len(mapper.keyframes) > before:
            truth.append(true)
    return np.array(truth)


def occupied(mapper: Mapper) -> np.ndarray:
    """Return the places of occupied cells, as rows."""
    grid = mapper.grid()
    return np.column_stack(grid.cell_to_world(*np.nonzero(grid.cells == 100)))


def rms(numbers: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(numbers))))


@pytest.mark.slow
@pytest.mark.parametrize("world", mapping_drives.TOURS)
def test_walls_are_within_five_centimetres_of_the_true_ones(tmp_path: Path, world: str) -> None:
    drive, mapper = driven(tmp_path, world, 150.0, seed=1, movers=False), Mapper()
    truth = map_drive(mapper, drive)
    odometry = np.hypot(*(drive.odometry - drive.truth)[:, :2].T)
    errors = np.hypot(*(mapper.graph.poses - truth)[:, :2].T)
    assert rms(odometry) > 0.2
    assert rms(errors) < 0.03
    assert rms(wall_distances(drive, occupied(mapper))) < 0.05
    assert any(each.weight > 0.5 for each in mapper.graph.loops)


@pytest.mark.slow
def test_things_that_move_do_not_harm_the_way(tmp_path: Path) -> None:
    drive, mapper = driven(tmp_path, "lab", 90.0, seed=2), Mapper()
    truth = map_drive(mapper, drive)
    assert rms(np.hypot(*(mapper.graph.poses - truth)[:, :2].T)) < 0.03


def test_a_robot_that_stands_adds_nothing() -> None:
    mapper = Mapper()
    stand = Pose(2.0, 2.0, 0.3)
    assert mapper.process(scan_of(ROOM, stand), stand) is not None
    assert mapper.process(scan_of(ROOM, stand), stand) is None
    assert mapper.process(scan_of(ROOM, stand), Pose(2.4, 2.0, 0.3)) is None
    assert mapper.process(scan_of(ROOM, Pose(2.0, 2.0, 0.9)), Pose(2.0, 2.0, 0.9)) is not None
    assert len(mapper.keyframes) == len(mapper.graph) == 2
    assert mapper.expected(Pose(2.1, 2.0, 0.9)).x == pytest.approx(2.1, abs=0.01)


def test_the_first_scan_is_where_odometry_says() -> None:
    mapper = Mapper()
    fits, _ = mapped(mapper, ROOM, [Pose(2.0, 2.0)], odometry=Pose(7.0, -3.0, 1.0))
    assert fits[0].pose == Pose(7.0, -3.0, 1.0)


@pytest.mark.slow
def test_a_round_ends_where_it_began() -> None:
    places = [*ROUND, *ROUND[:4]]
    mapper = Mapper(Options(do_loop_closing=True))
    fits, odometry = mapped(mapper, ROOM, way(places))
    assert math.dist(odometry[:2], way(places)[-1][:2]) > 0.5
    assert math.dist(fits[-1].pose[:2], way(places)[-1][:2]) < 0.3
    assert any(fit.closed is not None for fit in fits)
    plain = Mapper(Options(do_loop_closing=False))
    mapped(plain, ROOM, way(places))
    assert plain.graph.loops == []


def test_without_matching_odometry_is_all() -> None:
    mapper = Mapper(Options(use_scan_matching=False))
    fits, odometry = mapped(mapper, ROOM, way(ROUND[:4], 0.5))
    assert math.dist(fits[-1].pose[:2], odometry[:2]) < 0.6
    assert fits[-1].pose.theta == pytest.approx(odometry.theta)
    assert fits[-1].response == 0.0


@pytest.mark.slow
def test_in_a_corridor_the_map_does_not_slide() -> None:
    mapper = Mapper()
    fits, odometry = mapped(mapper, CORRIDOR, way([(0.0, 0.2), (20.0, 0.2)]))
    assert odometry.x == pytest.approx(20.3, abs=0.4)
    assert fits[-1].pose.x == pytest.approx(odometry.x, abs=0.5)  # what odometry says, and no scan denies
    assert fits[-1].pose.y == pytest.approx(0.2, abs=0.1)
    assert abs(fits[-1].pose.theta) < 0.01
    step = mapper.graph.steps[1][-1]
    assert step[0, 0] > 50 * step[1, 1]


def test_where_nothing_is_seen_odometry_is_believed() -> None:
    mapper, nothing = Mapper(), Beams(np.empty((0, 2)), 0)
    for number in range(10):
        fit = mapper.process(nothing, Pose(0.6 * number))
        assert fit is not None
        assert not fit.is_lost
    assert mapper.pose.x == pytest.approx(5.4)
    assert mapper.grid().cells.size == 0


@pytest.mark.slow
def test_a_robot_that_is_carried_away_is_found_again() -> None:
    mapper = Mapper()
    _, odometry = mapped(mapper, ROOM, way(ROUND))
    count = len(mapper.keyframes)
    away = way([(8.0, 2.0), (8.0, 5.5), (8.0, 3.0), (8.0, 5.5)])
    fits, _ = mapped(mapper, ROOM, away, odometry)
    assert [fit.is_lost for fit in fits[:2]] == [True, True]
    assert sum(fit.is_found for fit in fits) == 1
    assert not fits[-1].is_lost
    assert math.dist(fits[-1].pose[:2], away[-1][:2]) < 0.4
    assert len(mapper.keyframes) > count
    x, y = occupied(mapper).T
    near = np.minimum.reduce([np.abs(x), np.abs(y), np.abs(y - 8), np.abs(x - 6), np.abs(x - 10)])
    assert np.mean(near < 0.1) > 0.9


@pytest.mark.slow
def test_wheels_that_slip_farther_than_a_match_looks_lose_nothing() -> None:
    mapper = Mapper()
    poses = way(ROUND)
    _, odometry = mapped(mapper, ROOM, poses)
    count, there = len(mapper.keyframes), placed_on(poses[-1], Pose(0.6))
    fit = mapper.process(scan_of(ROOM, there, 99), placed_on(odometry, Pose(0.6, 0.42)))
    assert fit is not None
    assert not fit.is_lost
    assert len(mapper.keyframes) == count + 1
    assert math.dist(fit.pose[:2], there[:2]) < 0.05


@pytest.mark.slow
def test_odometry_that_jumps_does_not_lose_the_robot() -> None:
    mapper = Mapper()
    mapped(mapper, ROOM, way(ROUND))
    poses = way(ROUND[:3], 0.5)
    fits, _ = mapped(mapper, ROOM, poses, odometry=Pose(-30.0, 12.0, 2.0))  # the world was reset
    assert not fits[0].is_lost
    assert math.dist(fits[0].pose[:2], ROUND[0]) < 0.05
    assert math.dist(fits[-1].pose[:2], poses[-1][:2]) < 0.05


@pytest.mark.slow
def test_a_lost_robot_that_finds_nothing_maps_on() -> None:
    mapper = Mapper()
    _, odometry = mapped(mapper, ROOM, way(ROUND[:4]))
    other = tuple((y * 0.7 + 100.0, x * 1.3, v * 0.7 + 100.0, u * 1.3) for x, y, u, v in ROOM[:5])
    fits, _ = mapped(mapper, other, way([(101.0, 2.0), (103.0, 6.0), (101.5, 11.0), (103.0, 4.0)]), odometry)
    assert any(fit.is_lost for fit in fits)
    assert not fits[-1].is_lost


@pytest.mark.slow
@pytest.mark.parametrize("start", [Pose(2.0, 1.5), Pose(2.3, 1.2, 0.2)])
def test_a_map_goes_on_near_a_pose(start: Pose) -> None:
    mapper = Mapper()
    mapped(mapper, ROOM, way(ROUND))
    mapper.begin_at(start)
    fits, _ = mapped(mapper, ROOM, way(ROUND[:3]), odometry=Pose(-50.0, 20.0, 2.0))
    assert math.dist(fits[0].pose[:2], ROUND[0]) < 0.05
    assert math.dist(fits[-1].pose[:2], way(ROUND[:3])[-1][:2]) < 0.4


@pytest.mark.slow
def test_a_robot_localizes_itself_in_a_map_that_stays_as_it_is() -> None:
    mapper = Mapper()
    mapped(mapper, ROOM, way(ROUND))
    before, odometry = len(mapper.keyframes), Pose(3.0, 1.0, -1.0)
    mapper.begin_at(Pose(2.3, 1.3))
    poses, fits = way(ROUND[:5], 0.5), []
    for seed, (last, pose) in enumerate(itertools.pairwise([poses[0], *poses])):
        odometry = placed_on(odometry, seen_from(last, pose))
        fit = mapper.localize(scan_of(ROOM, pose, seed), odometry)
        assert fit is None or math.dist(fit.pose[:2], pose[:2]) < 0.05
        fits.append(fit)
    assert sum(fit is not None for fit in fits) > 10
    for seed in range(6):  # carried away
        odometry = placed_on(odometry, Pose(0.6))
        fit = mapper.localize(scan_of(ROOM, Pose(8.0, 2.0 + 0.6 * seed, math.pi / 2), seed), odometry)
    assert fit is not None
    assert math.dist(fit.pose[:2], (8.0, 5.0)) < 0.05
    fit = mapper.localize(scan_of(ROOM, Pose(2.0, 2.0), 9), Pose(500.0, 40.0))  # odometry began anew
    assert fit is not None
    assert math.dist(fit.pose[:2], (2.0, 2.0)) < 0.05
    assert len(mapper.keyframes) == before
    assert Mapper().localize(scan_of(ROOM, poses[0]), odometry) is None


def test_keyframes_that_moved_are_drawn_anew() -> None:
    mapper = Mapper()
    mapped(mapper, ROOM, way(ROUND[:4]))
    before = mapper.grid()
    assert mapper.draw() == 0
    mapper.graph.poses = mapper.graph.poses + np.array([10.0, 0.0, 0.0])
    assert mapper.draw(5) == len(mapper.keyframes) - 5
    after = mapper.grid()
    assert after.origin[0] == pytest.approx(before.origin[0] + 10.0, abs=0.051)
    assert (after.cells == 100).sum() == pytest.approx((before.cells == 100).sum(), rel=0.1)


def test_a_lidar_that_sees_far_costs_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    sides = []

    class Watched(Field):
        def __init__(self, *args: Any, **options: Any) -> None:
            super().__init__(*args, **options)
            sides.append(self.scores.shape[0])

    monkeypatch.setattr("robolink.navigation.mapper.Field", Watched)
    mapper = Mapper()
    hall = tuple((x * 15, y * 15, u * 15, v * 15) for x, y, u, v in ROOM[:4])
    for number in range(4):
        pose = Pose(70.0 + 0.6 * number, 60.0)
        scan = points(hall, pose, seed=number, most=200.0)
        mapper.process(Beams(scan, len(scan)), Pose(70.0 + 0.63 * number, 60.0))
    assert max(sides) < 2300
    assert mapper.pose.x == pytest.approx(71.8, abs=0.1)


def test_scans_too_far_for_one_map_are_counted() -> None:
    mapper = Mapper(Options(use_scan_matching=False))
    for x in (0.0, 1e6, 1e6 + 1.0):
        mapper.process(scan_of(ROOM, Pose(2.0, 2.0)), Pose(x, x))
    assert max(mapper.grid().cells.shape) < 300
    assert mapper.too_far == 2


def test_far_from_the_origin_it_is_the_same() -> None:
    mapper = Mapper()
    far = way([(x + 1e6, y - 1e6) for x, y in ROUND[:4]])
    walls = tuple((x + 1e6, y - 1e6, u + 1e6, v - 1e6) for x, y, u, v in ROOM)
    fits, _ = mapped(mapper, walls, far)
    assert math.dist(fits[-1].pose[:2], far[-1][:2]) < 0.4
    assert max(mapper.grid().cells.shape) < 400


ODD = [
    Beams(np.empty((0, 2)), 0),
    Beams(np.ones((100, 2)), 100),
    Beams(np.zeros((50, 2)), 50),
    Beams(np.column_stack((np.linspace(-5.0, 5.0, 200), np.ones(200))), 200),
    Beams(np.random.default_rng(1).normal(0.0, 5.0, (300, 2)), 300),
    Beams(np.random.default_rng(2).normal(0.0, 5.0, (50, 2)), 0),
]
"""Scans that say little: nothing, one place, a line, noise, and beams that met nothing."""


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 45, 54, 57])
def test_whatever_comes_the_mapper_goes_on(seed: int) -> None:
    random, mapper, odometry = np.random.default_rng(seed), Mapper(), Pose(2.0, 2.0)
    for number in range(20):
        step = float(random.choice([0.6, 0.6, 0.6, 0.6, 3.0, 50.0, 1e6, 1e8]))
        odometry = placed_on(odometry, Pose(step, 0.0, float(random.uniform(-0.5, 0.5))))
        if random.random() < 0.1:
            mapper.begin_at(Pose(*random.normal(0.0, 5.0, 3).tolist()))
        place = Pose(*random.uniform((0.5, 0.5, -3.0), (9.5, 7.5, 3.0)).tolist())
        odd = ODD[int(random.integers(len(ODD)))]
        fit = mapper.process(odd if random.random() < 0.4 else scan_of(ROOM, place, number), odometry)
        assert fit is None or (np.isfinite(fit.pose).all() and np.isfinite(fit.covariance).all())
    assert mapper.keyframes
