"""Pose graph: loops are closed exactly, wrong ones are found, and covariances are true."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import least_squares

from robolink.geometry.plane import Pose, placed_on, seen_from
from robolink.navigation.pose_graph import PoseGraph

STEP = np.diag([0.02**2, 0.01**2, 0.01**2])
TIGHT = np.diag([0.01**2, 0.01**2, 0.005**2])


def around(rounds: int = 1, sides: int = 40, radius: float = 5.0) -> list[Pose]:
    """Return poses on a circle, each ahead of the one before."""
    angles = [math.tau * number / sides for number in range(sides * rounds + 1)]
    return [Pose(radius * math.sin(a), radius - radius * math.cos(a), math.remainder(a, math.tau)) for a in angles]


def driven(truth: list[Pose], way: float = 1.03, turn: float = 0.97, seed: int | None = None) -> PoseGraph:
    """Return the graph of a robot whose odometry is wrong by these factors, or by the noise of a seed."""
    graph, pose, random = PoseGraph(), truth[0], np.random.default_rng(seed)
    graph.add(pose, STEP)
    for before, after in itertools.pairwise(truth):
        step = seen_from(before, after)
        x, y, theta = random.normal(0.0, np.sqrt(np.diag(STEP))) if seed is not None else (0.0, 0.0, 0.0)
        pose = placed_on(pose, Pose(step.x * way + x, step.y * way + y, step.theta * turn + theta))
        graph.add(pose, STEP)
    return graph


def worst(graph: PoseGraph, truth: list[Pose]) -> float:
    return float(np.hypot(*(graph.poses - np.array(truth))[:, :2].T).max())


def close(graph: PoseGraph, truth: list[Pose], source: int, target: int, wrong: Pose | None = None) -> None:
    relative = seen_from(truth[source], truth[target])
    graph.link(source, target, placed_on(relative, wrong) if wrong else relative, TIGHT)


def test_a_loop_brings_the_end_back_to_the_beginning() -> None:
    truth = around()
    graph = driven(truth)
    before = worst(graph, truth)
    assert before > 0.5
    close(graph, truth, 0, 40)
    assert graph.optimize() > 0.3
    assert math.dist(graph.pose(40)[:2], graph.pose(0)[:2]) < 0.01
    assert worst(graph, truth) < before / 2
    assert graph.pose(0) == truth[0]
    assert graph.loops[0].weight == 1.0


def test_without_loops_nothing_moves() -> None:
    graph = driven(around())
    before = graph.poses.copy()
    assert graph.optimize() == 0.0
    assert np.array_equal(graph.poses, before)
    assert PoseGraph().optimize() == 0.0


@pytest.mark.parametrize("seed", range(3))
def test_the_best_poses_are_those_of_scipy(seed: int) -> None:
    truth = around(sides=12)
    graph = driven(truth, seed=seed)
    close(graph, truth, 0, 12)
    close(graph, truth, 3, 9)
    start, roots = graph.poses.copy(), np.sqrt(np.diag(STEP))

    def errors(numbers: np.ndarray) -> np.ndarray:
        poses = [Pose(*start[0]), *(Pose(*each) for each in numbers.reshape(-1, 3))]
        found = []
        for number, (step, _) in enumerate(zip(*graph.steps, strict=True)):
            found.append((np.array(seen_from(poses[number], poses[number + 1])) - step) / roots)
        for loop in graph.loops:
            gap = seen_from(loop.relative, seen_from(poses[loop.source], poses[loop.target]))
            x, y = np.array(seen_from(poses[loop.source], poses[loop.target])[:2]) - loop.relative[:2]
            found.append(np.array([x, y, gap.theta]) / np.sqrt(np.diag(TIGHT)))
        return np.concatenate(found)

    best = least_squares(errors, start[1:].ravel(), xtol=1e-12, ftol=1e-12, gtol=1e-12).x.reshape(-1, 3)
    graph.optimize(believed=1e9)
    assert np.abs(graph.poses[1:] - best)[:, :2].max() < 1e-4


def test_a_wrong_loop_is_not_believed_beside_true_ones() -> None:
    truth = around(rounds=2)
    graph = driven(truth, seed=4)
    for source in range(0, 40, 6):
        close(graph, truth, source, source + 40)
    graph.optimize()
    expected = graph.poses.copy()
    close(graph, truth, 10, 30, wrong=Pose(1.0, -0.5, 0.3))
    close(graph, truth, 20, 55, wrong=Pose(-0.6, 0.4, -0.2))
    graph.optimize()
    weights = [each.weight for each in graph.loops]
    assert min(weights[:-2]) > 0.4
    assert max(weights[-2:]) < 0.05
    assert np.abs(graph.poses - expected).max() < 0.02


def test_a_loop_that_the_way_cannot_explain_is_a_surprise() -> None:
    truth = around()
    graph = driven(truth, 1.0, 1.0, seed=4)
    relative = seen_from(truth[0], truth[20])
    assert graph.surprise(0, 20, relative, TIGHT) < 11.3
    assert graph.surprise(0, 20, placed_on(relative, Pose(4.0)), TIGHT) > 50.0
    surprises = [driven(truth, 1.0, 1.0, seed).surprise(0, 20, relative, TIGHT * 1e-6) for seed in range(100)]
    assert np.mean(surprises) == pytest.approx(3.0, abs=0.5)  # chi² with three degrees of freedom


def test_uncertainty_grows_along_the_way_and_a_loop_ends_it() -> None:
    truth = around()
    graph = driven(truth)
    spreads = [math.sqrt(np.trace(graph.relative_covariance(0, number)[:2, :2])) for number in (1, 10, 40)]
    assert spreads[0] == pytest.approx(math.sqrt(np.trace(STEP[:2, :2])), rel=0.05)
    assert spreads[0] < spreads[1] < spreads[2]
    close(graph, truth, 0, 40)
    graph.optimize()
    assert math.sqrt(np.trace(graph.relative_covariance(0, 40)[:2, :2])) < 0.015
    assert np.allclose(graph.relative_covariance(5, 5), 0.0, atol=1e-9)


@given(st.integers(0, 1000))
def test_a_covariance_is_that_of_drives_that_differ_by_noise(seed: int) -> None:
    graph = driven(around(sides=8), seed=seed)
    covariance = graph.relative_covariance(0, 8)
    assert np.allclose(covariance, covariance.T, rtol=1e-6, atol=1e-12)
    assert np.linalg.eigvalsh(covariance)[0] > 0


def test_the_covariance_of_a_way_is_what_many_drives_show() -> None:
    truth = [Pose(0.5 * number) for number in range(11)]
    ends = np.array([driven(truth, 1.0, 1.0, seed).pose(10) for seed in range(300)])
    found = np.cov(ends.T)
    assert np.diag(found) == pytest.approx(np.diag(driven(truth, 1.0, 1.0).relative_covariance(0, 10)), rel=0.35)


def test_far_from_the_origin_it_is_the_same() -> None:
    near, far = around(), [Pose(each.x + 1e7, each.y - 1e7, each.theta) for each in around()]
    graphs = [driven(near), driven(far)]
    for graph, truth in zip(graphs, (near, far), strict=True):
        close(graph, truth, 0, 40)
        graph.optimize()
    assert np.allclose(graphs[0].poses, graphs[1].poses - (1e7, -1e7, 0.0), atol=1e-5)
