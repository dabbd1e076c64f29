"""Scan matching: the best pose of all, below a cell, and a true word about how certain it is."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from robolink.geometry.plane import Pose
from robolink.navigation.scan_matching import Field, Match, Window, blended, refined, scan_of
from tests.support.scanned_rooms import CORRIDOR, ROOM, Walls, placed, points

STANDS = (Pose(2.0, 2.0, 0.3), Pose(4.5, 5.0, -2.0), Pose(1.2, 4.4, 1.2))
ODOMETRY = np.diag([0.03**2, 0.03**2, 0.02**2])


def field_of(walls: Walls, near: Pose, **options: float) -> Field:
    """Draw four scans that were made around a pose."""
    around = [
        Pose(near.x + dx, near.y + dy, near.theta + 0.3 * dx)
        for dx, dy in ((0.2, 0), (0, 0.1), (-0.4, 0), (-0.8, -0.1))
    ]
    known = np.concatenate([placed(pose, points(walls, pose, seed=seed)) for seed, pose in enumerate(around, 10)])
    return Field(known, (near.x, near.y), 12.0, **options)


@pytest.mark.parametrize("stand", STANDS)
def test_a_scan_is_placed_to_millimetres(stand: Pose) -> None:
    scan = points(ROOM, stand, seed=1)
    guess = Pose(stand.x + 0.17, stand.y - 0.12, stand.theta + 0.2)
    field = field_of(ROOM, stand)
    found = field.search(scan, guess, Window())
    assert found is not None
    match = refined(field, scan_of(scan), found[0])
    assert math.dist(match.pose[:2], stand[:2]) < 0.006
    assert match.pose.theta == pytest.approx(stand.theta, abs=0.002)
    assert match.response > max(found[1] - 0.02, 0.9)
    assert (np.sqrt(np.diag(match.covariance)) < (0.02, 0.02, 0.01)).all()


@pytest.mark.parametrize("blocks", [(1,), (4, 1), (16, 4, 1), (6, 2, 1)])
def test_the_search_finds_what_trying_every_pose_finds(blocks: tuple[int, ...]) -> None:
    stand = STANDS[0]
    scan, field = points(ROOM, stand, beams=60, seed=2), field_of(ROOM, stand, resolution=0.05)
    window = Window(reach=0.3, turn=0.06, angle_step=0.02, blocks=blocks)
    guess = Pose(stand.x + 0.13, stand.y - 0.16, stand.theta + 0.05)
    found = field.search(scan, guess, window)
    shifts, turns = range(-6, 7), range(-3, 4)
    best = 0.0
    for right, up, turn in itertools.product(shifts, shifts, turns):
        pose = Pose(guess.x + right * 0.05, guess.y + up * 0.05, guess.theta + turn * 0.02)
        best = max(best, field.scores.ravel()[field.cells(scan, np.array([pose]))].mean() / 255)
    assert found is not None
    assert found[1] == pytest.approx(best, abs=0.002)


def test_maxima_are_those_of_the_cells_right_and_above() -> None:
    field = field_of(ROOM, STANDS[0])
    for block in (3, 4, 16):
        row, column = 300, 333
        area = field.scores[row : row + block, column : column + block]
        assert field.maxima(block)[row, column] == area.max()


def test_scores_fall_off_like_a_gaussian() -> None:
    field = Field(np.array([[0.015, 0.015]]), (0.0, 0.0), 1.0, resolution=0.03, smear=0.06)
    at = np.array([[0.015, 0.015, 0.0], [0.075, 0.015, 0.0], [0.075, 0.075, 0.0], [0.3, 0.015, 0.0]])
    assert field.responses(np.zeros((1, 2)), at) == pytest.approx([1.0, math.exp(-0.5), math.exp(-1.0), 0.0], abs=0.02)


def test_nothing_is_found_below_the_least_response() -> None:
    scan, field = points(ROOM, STANDS[0], seed=1), field_of(ROOM, Pose(8.0, 5.0))
    assert field.search(scan, Pose(8.0, 5.0), Window(), least=0.8) is None
    assert field.search(np.empty((0, 2)), Pose(8.0, 5.0), Window()) is None


def test_a_field_of_nothing_scores_nothing() -> None:
    field = Field(np.empty((0, 2)), (0.0, 0.0), 3.0)
    found = field.search(points(ROOM, STANDS[0]), Pose(), Window())
    assert found is not None
    assert found[1] == 0.0
    match = refined(field, scan_of(points(ROOM, STANDS[0])), Pose())
    assert match.pose == Pose()
    assert np.diag(match.covariance)[:2].min() > 50.0


def test_along_a_corridor_the_match_is_uncertain_and_odometry_says_where() -> None:
    stand = Pose(0.0, 0.1, 0.05)
    scan, field = points(CORRIDOR, stand, seed=3), field_of(CORRIDOR, stand)
    match = refined(field, scan_of(scan), Pose(0.1, 0.1, 0.05))
    along, across = np.sqrt(np.diag(match.covariance))[:2]
    assert along > 1.0
    assert across < 0.02
    expected = Pose(0.02, 0.14, 0.06)
    found = blended(match, expected, ODOMETRY)
    assert found.pose.x == pytest.approx(expected.x, abs=0.02)
    assert found.pose.y == pytest.approx(stand.y, abs=0.01)
    assert found.pose.theta == pytest.approx(stand.theta, abs=0.003)
    assert math.sqrt(found.covariance[0, 0]) < 0.035


def test_walls_are_filled_between_their_points_and_nothing_else_is() -> None:
    scan = scan_of(points(ROOM, Pose(2.0, 2.0), noise=0.0))
    more = placed(Pose(2.0, 2.0), scan.surface[len(scan.points) :])
    assert len(more) > 100
    x, y = more.T
    near = np.minimum.reduce([np.abs(x), np.abs(y), np.abs(y - 8), np.abs(x - 6), np.abs(x - 10)])
    inside = (x > 2.9) & (x < 3.5) & (y > 2.9) & (y < 3.7) | (x > 0.9) & (x < 2.1) & (y > 6.5)
    assert near[~inside].max() < 0.03
    assert len(scan_of(np.empty((0, 2))).surface) == 0
    assert len(scan_of(np.ones((1, 2))).surface) == 1
    walls = np.abs(scan.normals).max(axis=1) > 0.95
    assert np.mean(walls) > 0.85


def test_where_the_scans_are_certain_odometry_has_no_say() -> None:
    match = Match(Pose(1.0, 2.0, 3.0), 0.9, np.diag([1e-5, 1e-5, 1e-6]))
    found = blended(match, Pose(1.1, 1.9, 3.1), ODOMETRY)
    assert found.pose == match.pose
    assert (np.diag(found.covariance) < np.diag(match.covariance)).all()


def test_far_from_the_origin_it_is_the_same() -> None:
    far = Pose(1e7, -1e7)
    stand = STANDS[0]
    there = Pose(stand.x + far.x, stand.y + far.y, stand.theta)
    known, scan = placed(there, points(ROOM, stand)), points(ROOM, stand, seed=1)
    match = refined(Field(known, (there.x, there.y), 12.0), scan_of(scan), there._replace(x=there.x + 0.02))
    assert math.dist(match.pose[:2], there[:2]) < 0.005
