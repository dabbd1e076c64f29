"""Particle filters: how particles are drawn, weighed and counted, and what they say of the pose."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest

from robolink.geometry.plane import Pose
from robolink.navigation.clusters import best_cluster, count_bins
from robolink.navigation.grid import Grid
from robolink.navigation.likelihood_field import UNITS, LikelihoodField, SensorModel
from robolink.navigation.motion_models import Alphas, move_differential
from robolink.navigation.particle_filter import (
    FilterOptions,
    ParticleFilter,
    cholesky,
    covariance_about,
    enough_particles,
    tempered,
)

OPTIONS = FilterOptions(500, 1000)


def filter_of(options: FilterOptions = OPTIONS, seed: int = 1) -> ParticleFilter:
    return ParticleFilter(options, np.random.default_rng(seed))


def test_particles_are_scattered_by_a_covariance() -> None:
    covariance = np.array([[0.04, 0.03, 0.0], [0.03, 0.09, 0.01], [0.0, 0.01, 0.02]])
    particles = filter_of(FilterOptions(500, 20_000))
    particles.scatter_about(Pose(1, 2, 3.1), covariance)
    estimate = particles.estimate()
    assert estimate.pose[:2] == pytest.approx((1, 2), abs=0.01)
    assert math.remainder(estimate.pose.theta - 3.1, math.tau) == pytest.approx(0, abs=0.01)
    assert estimate.covariance == pytest.approx(covariance, abs=0.003)
    assert np.abs(particles.poses[2]).max() <= math.pi


@pytest.mark.parametrize("covariance", [np.zeros((3, 3)), np.diag([0.0, -1.0, 0.0]), np.ones((3, 3))])
def test_any_covariance_has_a_root(covariance: np.ndarray) -> None:
    root = np.array(cholesky(covariance))
    assert root @ root.T == pytest.approx(np.maximum(covariance, 0.0))


def test_particles_are_scattered_over_free_squares() -> None:
    particles = filter_of()
    places = np.array([[0.5, 2.5], [0.5, 0.5]])
    particles.scatter_over(places, 1.0)
    x, y, theta = particles.poses
    assert ((x < 1) | (x > 2)).all()
    assert (0.4 < (x < 1).mean() < 0.6, y.min() >= 0, y.max() <= 1) == (True, True, True)
    assert (theta.min() < -3, theta.max() > 3) == (True, True)


def test_particles_are_drawn_as_often_as_they_weigh() -> None:
    particles = filter_of(FilterOptions(1000, 1000))
    particles.poses[0] = np.arange(1000) * 0.0001
    particles.weights = np.where(np.arange(1000) == 7, 0.5, 0.5 / 999)
    particles.resample()
    assert (particles.poses[0] == 0.0007).sum() in (500, 501)
    assert np.unique(particles.poses[0], return_counts=True)[1].tolist().count(1) > 400
    assert particles.weights.sum() == pytest.approx(1.0)


def test_the_number_of_particles_follows_their_spread() -> None:
    particles = filter_of(FilterOptions(100, 2000))
    particles.scatter_about(Pose(), np.diag([9.0, 9.0, 1.0]))
    particles.resample()
    assert particles.poses.shape == (3, 2000)
    particles.scatter_about(Pose(), np.diag([0.01, 0.01, 0.01]))
    particles.resample()
    assert 100 <= particles.poses.shape[1] < 400


@pytest.mark.parametrize(("bins", "count"), [(0, 2000), (1, 2000), (2, 100), (30, 365), (10_000, 2000)])
def test_enough_particles(bins: int, count: int) -> None:
    assert enough_particles(bins, FilterOptions(100, 2000)) == count


def test_weights_of_spread_particles_are_tempered() -> None:
    logs = -np.arange(1000.0)
    sharp, soft = tempered(logs, 0.0), tempered(logs, 0.5)
    assert sharp == pytest.approx(np.exp(0.5 * logs))
    assert soft.sum() ** 2 / (soft**2).sum() == pytest.approx(500, rel=0.05)
    assert (np.diff(soft) < 0).all()
    assert tempered(np.zeros(10), 0.5).tolist() == [1.0] * 10


def test_a_scan_without_beams_changes_nothing() -> None:
    particles = filter_of()
    particles.weigh(np.zeros(1000), 0)
    assert particles.weights.tolist() == [0.001] * 1000


def test_scans_between_resamplings_add_up() -> None:
    particles = filter_of()
    logs = np.where(np.arange(1000) < 500, 0.0, -1.0)
    for _ in range(2):
        particles.weigh(logs, 60)
    assert particles.weights[0] / particles.weights[-1] == pytest.approx(math.e)


def test_the_estimate_is_that_of_the_best_cluster_and_its_covariance_of_all() -> None:
    particles = filter_of()
    particles.poses[:, :600] += np.array([[5.0], [1.0], [math.pi]])
    particles.poses[2, :300] *= -1.0  # half a turn to the left is one to the right
    estimate = particles.estimate()
    assert (estimate.pose.x, estimate.pose.y, abs(estimate.pose.theta)) == pytest.approx((5, 1, math.pi))
    assert estimate.weight == pytest.approx(0.6)
    assert np.diag(estimate.covariance) == pytest.approx([0.4 * 25, 0.4, 0.4 * math.pi**2])


def test_clusters_touch_at_corners_and_go_round() -> None:
    poses = np.array([[0.1, 0.6, 9.0, 0.1], [0.1, 0.6, 9.0, 0.1], [3.14, -3.14, 0.0, 0.0]])
    assert best_cluster(poses, np.array([0.2, 0.2, 0.3, 0.3])).tolist() == [0, 1]
    assert count_bins(poses) == 4


def test_covariances_wrap_headings() -> None:
    poses = np.array([[0.0, 0.0], [0.0, 0.0], [3.1, -3.1]])
    gap = math.pi - 3.1
    assert covariance_about(Pose(0, 0, math.pi), poses, np.array([0.5, 0.5]))[2, 2] == pytest.approx(gap**2)


def test_some_particles_may_be_drawn_from_everywhere() -> None:
    particles = filter_of()
    particles.scatter_some(0.3, np.array([[50.0], [50.0]]), 1.0)
    assert 250 < (particles.poses[0] > 40).sum() < 350
    assert particles.is_spread()
    particles.scatter_about(Pose(), np.diag([0.25, 0.25, 0.1]))
    assert not particles.is_spread()


def room() -> Grid:
    """Return the map of an angular room of 6 x 4 m, in cells of 5 cm."""
    cells = np.zeros((84, 124), np.int8)
    cells[:2] = cells[-2:] = cells[:, :2] = cells[:, -2:] = 100
    cells[2:30, 90:122] = cells[60:62, 2:30] = 100
    return Grid(cells, 0.05, (-0.1, -0.1, 0.0))


def scan(grid: Grid, pose: Pose, count: int = 60) -> tuple[np.ndarray, np.ndarray]:
    """Return the ends of beams all round, ahead and aside of a robot."""
    angles = np.linspace(-math.pi, math.pi, count, endpoint=False)
    steps = np.arange(0.0, 8.0, 0.005)
    x, y = (np.outer(each(angles + pose.theta), steps) for each in (np.cos, np.sin))
    row, column = grid.world_to_cell(pose.x + x, pose.y + y)
    ranges = steps[(grid.cells[row.clip(0, 83), column.clip(0, 123)] > 0).argmax(axis=1)]
    return ranges * np.cos(angles), ranges * np.sin(angles)


def way(before: Pose, after: Pose, poses: np.ndarray, random: np.random.Generator) -> None:
    move_differential(poses, before, after, Alphas(), random)


def driven(particles: ParticleFilter, ways: int) -> Pose:
    """Drive round in a room; return the error of the last estimate."""
    grid, field = room(), LikelihoodField(room(), SensorModel(), 8.0)
    before = Pose(1.5, 1.5, 0.0)
    for step in range(ways):
        angle = 0.2 * (step + 1)
        after = Pose(1.5 + math.sin(angle), 2.5 - math.cos(angle), angle)
        particles.move(partial(way, before, after))
        ratings = field.ratings(particles.poses, *scan(grid, after))
        particles.weigh(ratings.sum(axis=1, dtype=np.int32) / UNITS, ratings.shape[1])
        estimate = particles.estimate()
        particles.resample()
        before = after
    x, y, theta = estimate.pose
    return Pose(x - after.x, y - after.y, math.remainder(theta - after.theta, math.tau))


def test_a_filter_finds_the_robot_from_near_and_from_anywhere() -> None:
    particles = filter_of()
    particles.scatter_about(Pose(1.7, 1.4, 0.1), np.diag([0.06, 0.06, 0.07]))
    assert np.abs(driven(particles, 12)).max() < 0.04
    particles = filter_of(FilterOptions(500, 3000))
    row, column = (room().cells == 0).nonzero()
    particles.scatter_over(np.array(room().cell_to_world(row, column)), 0.05)
    assert np.abs(driven(particles, 25)).max() < 0.06


def test_the_same_seed_gives_the_same_bits() -> None:
    poses = []
    for _ in range(2):
        particles = filter_of(seed=5)
        particles.scatter_about(Pose(1.7, 1.4, 0.1), np.diag([0.06, 0.06, 0.07]))
        driven(particles, 3)
        poses.append(particles.poses)
    assert (poses[0] == poses[1]).all()
