"""The lidar against closed forms, at corners, at its limits, and its noise."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink.sim import World, load_world
from robolink.sim.description import Lidar, Pose
from robolink.sim.geometry import Array
from robolink.sim.lidar import Beams, distances, limited

NO_CIRCLES = np.zeros((0, 3))
NO_SEGMENTS = np.zeros((0, 4))
ROOM = np.array([[0, 0, 8, 0], [8, 0, 8, 5], [8, 5, 0, 5], [0, 5, 0, 0]], dtype=np.float64)


def directions(beams: Beams, theta: float) -> tuple[Array, Array]:
    angles = theta + beams.start + beams.increment * np.arange(beams.count)
    return np.cos(angles), np.sin(angles)


def in_room(beams: Beams, pose: Pose) -> Array:
    """What a beam meets in the 8 x 5 m room: the nearer of the walls that it faces."""
    cos, sin = directions(beams, pose.theta)
    with np.errstate(divide="ignore"):
        across = np.where(cos > 0, 8 - pose.x, pose.x) / abs(cos)
        along = np.where(sin > 0, 5 - pose.y, pose.y) / abs(sin)
    nearest: Array = np.minimum(across, along)
    return nearest


def by_every_ray(beams: Beams, pose: Pose, segments: Array) -> Array:
    """Intersect all beams with all segments."""
    cos, sin = (each[:, None] for each in directions(beams, pose.theta))
    ax, ay = segments[:, 0] - pose.x, segments[:, 1] - pose.y
    dx, dy = segments[:, 2] - segments[:, 0], segments[:, 3] - segments[:, 1]
    across = cos * dy - sin * dx
    ranges, shares = (ax * dy - ay * dx) / across, (ax * sin - ay * cos) / across
    met = (ranges > 0) & (shares >= 0) & (shares <= 1)
    nearest: Array = np.where(met, ranges, np.inf).min(axis=1)
    return nearest


@given(st.floats(0.01, 7.99), st.floats(0.01, 4.99), st.floats(-6.28, 6.28), st.integers(2, 400), st.floats(1, 360))
@settings(max_examples=60, deadline=None)
def test_a_room_is_exact_from_everywhere(x: float, y: float, theta: float, count: int, fov: float) -> None:
    beams, pose = Beams(Lidar("scan", beams=count, fov=fov)), Pose(x, y, theta)
    found = distances(beams, pose, ROOM, NO_CIRCLES)
    np.testing.assert_allclose(found, in_room(beams, pose), rtol=0, atol=1e-9)


@pytest.mark.parametrize("lidar", [Lidar("a"), Lidar("b", beams=97, fov=200), Lidar("c", start=10, beams=1080)])
def test_crossing_walls_are_exact(lidar: Lidar) -> None:
    random = np.random.default_rng(4)
    segments = random.uniform(-10, 10, (60, 4))
    beams = Beams(lidar)
    for x, y, theta in random.uniform(-5, 5, (20, 3)):
        pose = Pose(x, y, theta)
        found = distances(beams, pose, segments, NO_CIRCLES)
        np.testing.assert_allclose(found, by_every_ray(beams, pose, segments), rtol=0, atol=1e-9)


def test_circles_are_exact() -> None:
    random = np.random.default_rng(5)
    circles = np.column_stack((random.uniform(-10, 10, (30, 2)), random.uniform(0.05, 0.6, 30)))
    beams = Beams(Lidar("scan", beams=720))
    for theta in random.uniform(-3, 3, 20):
        cos, sin = (each[:, None] for each in directions(beams, theta))
        ahead = cos * circles[:, 0] + sin * circles[:, 1]
        root = circles[:, 2] ** 2 - (cos * circles[:, 1] - sin * circles[:, 0]) ** 2
        met = (root > 0) & (ahead > 0)
        expected = np.where(met, ahead - np.sqrt(np.where(met, root, 0.0)), np.inf).min(axis=1)
        found = distances(beams, Pose(0.0, 0.0, theta), NO_SEGMENTS, circles)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9)


def test_a_sensor_inside_of_a_circle_sees_nothing_but_it() -> None:
    found = distances(Beams(Lidar("scan")), Pose(0.1, 0.0), ROOM, np.array([[0.0, 0.0, 0.5]]))
    assert found.max() < 1e-9


def test_no_beam_leaks_through_a_corner() -> None:
    """108,000 beams, each aimed at a corner of a round wall of 360 segments."""
    angles = math.radians(1) * np.arange(360)
    corners = 3.0 * np.column_stack((np.cos(angles), np.sin(angles)))
    segments = np.concatenate((corners, np.roll(corners, -1, axis=0)), axis=1)
    beams = Beams(Lidar("scan"))
    random = np.random.default_rng(6)
    for turn, x, y in random.uniform(-3, 3, (300, 3)):
        cos, sin = math.cos(turn), math.sin(turn)
        turned = segments.reshape(-1, 2, 2) @ np.array([[cos, sin], [-sin, cos]])
        moved = (turned + np.array([x, y])).reshape(-1, 4)
        found = distances(beams, Pose(x, y, turn), moved, NO_CIRCLES)
        np.testing.assert_allclose(found, 3.0, rtol=0, atol=1e-6)


def test_no_beam_leaks_between_unequal_walls() -> None:
    """The first beam is aimed at a corner of a crooked room, from everywhere in it."""
    room = np.array([[0, 0], [4, 0.3], [3.7, 3], [2, 2.2], [0.2, 3.1]], dtype=np.float64)
    segments = np.concatenate((room, np.roll(room, -1, axis=0)), axis=1)
    beams = Beams(Lidar("scan", beams=36, start=0.0))
    random = np.random.default_rng(7)
    for x, y in random.uniform((0.3, 0.4), (3.5, 2.0), (1000, 2)):
        corner = random.integers(5)
        aim = math.atan2(room[corner, 1] - y, room[corner, 0] - x)
        found = distances(beams, Pose(x, y, aim), segments, NO_CIRCLES)
        assert np.isfinite(found).all()
        assert found[0] <= math.dist((x, y), room[corner]) + 1e-6


def test_a_wall_seen_edge_on_is_as_far_as_its_end() -> None:
    wall = np.array([[2.0, 1.0, 5.0, 1.0]])
    for flip in (wall, wall[:, [2, 3, 0, 1]]):
        found = distances(Beams(Lidar("scan", beams=4, start=0)), Pose(0.0, 1.0), flip, NO_CIRCLES)
        assert found.tolist() == [2.0, math.inf, math.inf, math.inf]


def test_nothing_is_no_return() -> None:
    found = distances(Beams(Lidar("scan")), Pose(0.0, 0.0), NO_SEGMENTS, NO_CIRCLES)
    assert np.isposinf(found).all()


def test_a_full_circle_has_no_doubled_beam_and_ahead_in_the_middle() -> None:
    beams = Beams(Lidar("scan", beams=360))
    assert beams.start == -math.pi
    assert beams.increment == math.tau / 360
    assert beams.cos[180] == pytest.approx(1.0)


def test_a_part_of_a_circle_has_a_beam_at_both_ends_and_is_the_same() -> None:
    whole, half = Beams(Lidar("scan", beams=360)), Beams(Lidar("scan", beams=181, fov=180))
    assert half.start + 180 * half.increment == pytest.approx(math.pi / 2)
    pose = Pose(2.3, 1.7, 0.4)
    seen = distances(whole, pose, ROOM, NO_CIRCLES)[90:271]
    np.testing.assert_allclose(distances(half, pose, ROOM, NO_CIRCLES), seen, rtol=0, atol=1e-9)


def test_limits_are_those_of_rep_117() -> None:
    found = limited(np.array([0.0, 0.1, 0.12, 5.0, 12.0, 12.1, math.inf]), 0.12, 12.0)
    assert found.tolist() == [-math.inf, -math.inf, 0.12, 5.0, 12.0, math.inf, math.inf]


WORLD = """
world: {{seed: {seed}}}
walls: [{{polyline: [[0, 0], [8, 0], [8, 5], [0, 5]], closed: true}}]
robots:
  - name: first
    pose: [2, 2, 0]
    sensors: [{{lidar: scan, noise: 0.02, dropout: 0.1}}, {{lidar: rear, noise: 0.02}}]
  {others}
"""
SECOND = "- {name: second, pose: [6, 3, 1], sensors: [{lidar: scan, noise: 0.02}]}"


def noisy(seed: int = 1, others: str = "") -> World:
    return World(load_world("noisy.yaml", text=WORLD.format(seed=seed, others=others)))


def test_noise_has_its_size_and_dropout_its_share() -> None:
    robot = noisy().robots["first"]
    exact = distances(Beams(Lidar("scan")), robot.pose, ROOM, NO_CIRCLES)
    ranges = np.array([robot.scan().ranges for _ in range(50)])
    lost = np.isposinf(ranges)
    assert lost.mean() == pytest.approx(0.1, abs=0.01)
    assert (ranges - exact)[~lost].std() == pytest.approx(0.02, rel=0.03)
    assert (ranges - exact)[~lost].mean() == pytest.approx(0.0, abs=0.001)


def test_the_same_seed_gives_the_same_noise_and_another_seed_another() -> None:
    scans = [noisy(seed).robots["first"].scan().ranges.tobytes() for seed in (1, 1, 2)]
    assert scans[0] == scans[1] != scans[2]


def test_sensors_and_robots_have_streams_of_their_own() -> None:
    alone, together = noisy(), noisy(others=SECOND)
    distances_to_second = together.robots["second"].scan().ranges
    assert np.isfinite(distances_to_second).all()
    rear = [world.robots["first"].scan("rear").ranges for world in (alone, together)]
    unhidden = rear[0] == rear[1]
    assert unhidden.mean() > 0.95  # only the beams that meet the other robot differ
    assert not np.isclose(rear[0], alone.robots["first"].scan().ranges).all()


def test_a_lidar_sees_from_where_it_is_mounted() -> None:
    text = """
    walls: [{polyline: [[5, -9], [5, 9]]}]
    robots:
      - name: r
        pose: [0, 0, 1.5707963267948966]
        sensors: [{lidar: s, beams: 4, offset: [0.1, -0.2, -1.5707963267948966]}]
    """
    scan = World(load_world("mount.yaml", text=text)).robots["r"].scan()
    assert scan.ranges[2] == pytest.approx(4.8)  # 0.2 m to the right of a robot that faces up is nearer to x = 5


def test_robots_see_each_other_and_not_themselves() -> None:
    text = """
    robots:
      - {name: a, pose: [0, 0], sensors: [{lidar: scan, beams: 4}]}
      - {name: b, pose: [2, 0], shape: {box: [0.4, 0.4]}, sensors: [{lidar: scan, beams: 4}]}
      - {name: c, pose: [0, 3], shape: {circle: 0.5}}
    """
    robots = World(load_world("three.yaml", text=text)).robots
    assert robots["a"].scan().ranges.tolist() == pytest.approx([math.inf, math.inf, 1.8, 2.5])
    assert robots["b"].scan().ranges.tolist() == pytest.approx([1.83, math.inf, math.inf, math.inf])
