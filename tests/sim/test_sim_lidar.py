"""The lidar against closed forms, at corners and at its limits, with many at once and on large maps."""

from __future__ import annotations

import hashlib
import math

import numpy as np
import pymunk
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink.geometry.trigonometry import cos_and_sin
from robolink.sim.arrays import Array, Indices
from robolink.sim.description import Shape, WorldDescription
from robolink.sim.quantities import Pose
from robolink.sim.sensing.lidar import Beams, distances, distances_batch, limited, returns_batch
from robolink.sim.sensing.scene import (
    FIXED,
    NOBODY,
    Edges,
    Scene,
    Surroundings,
    Tiles,
    circles_of,
    columns,
    edges,
    standing,
)
from robolink.sim.sensors import Lidar

NO_CIRCLES = np.zeros((0, 3))
NO_SEGMENTS = np.zeros((0, 4))
FAR = (0.0, 100.0)
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
    found = distances(beams, pose, standing(ROOM, NO_CIRCLES))
    np.testing.assert_allclose(found, in_room(beams, pose), rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    "lidar",
    [Lidar("a", range=FAR), Lidar("b", beams=97, fov=200, range=FAR), Lidar("c", start=10, beams=1080, range=FAR)],
)
def test_crossing_walls_are_exact(lidar: Lidar) -> None:
    random = np.random.default_rng(4)
    segments = random.uniform(-10, 10, (60, 4))
    beams = Beams(lidar)
    for x, y, theta in random.uniform(-5, 5, (20, 3)):
        pose = Pose(x, y, theta)
        found = distances(beams, pose, standing(segments, NO_CIRCLES))
        np.testing.assert_allclose(found, by_every_ray(beams, pose, segments), rtol=0, atol=1e-9)


def circles_exactly(beams: Beams, pose: Pose, circles: Array) -> Array:
    cos, sin = (each[:, None] for each in directions(beams, pose.theta))
    x, y = circles[:, 0] - pose.x, circles[:, 1] - pose.y
    ahead, root = cos * x + sin * y, circles[:, 2] ** 2 - (cos * y - sin * x) ** 2
    met = (root > 0) & (ahead > 0)
    nearest: Array = np.where(met, ahead - np.sqrt(np.where(met, root, 0.0)), np.inf).min(axis=1)
    return nearest


@pytest.mark.parametrize("lidar", [Lidar("a", beams=720, range=FAR), Lidar("b", beams=97, fov=300, range=FAR)])
def test_circles_are_exact(lidar: Lidar) -> None:
    random = np.random.default_rng(5)
    circles = np.column_stack((random.uniform(-10, 10, (30, 2)), random.uniform(0.05, 0.6, 30)))
    beams = Beams(lidar)
    for theta in random.uniform(-3, 3, 20):
        found = distances(beams, Pose(0.0, 0.0, theta), standing(NO_SEGMENTS, circles))
        np.testing.assert_allclose(found, circles_exactly(beams, Pose(0.0, 0.0, theta), circles), rtol=0, atol=1e-9)


@pytest.mark.parametrize("place", [(0.1, 0.0), (0.0, 0.0), (0.5, 0.0), (0.3, 0.4)])
@pytest.mark.parametrize("fov", [360.0, 300.0])
def test_a_sensor_inside_of_a_circle_sees_nothing_but_it(place: tuple[float, float], fov: float) -> None:
    around, poses = standing(ROOM, np.array([[0.0, 0.0, 0.5]])), np.array([[*place, 0.3]])
    ranges, light = returns_batch(Beams(Lidar("scan", fov=fov)), poses, around)
    assert ranges.max() < 1e-9
    assert np.isfinite(light).all()


def star(random: np.random.Generator) -> Array:
    """Give the corners of a crooked room, one in the direction of each degree from the origin."""
    angles = math.radians(1) * np.arange(360)
    corners: Array = random.uniform(1.0, 5.0, (360, 1)) * np.column_stack((np.cos(angles), np.sin(angles)))
    return corners


def closed(corners: Array) -> Array:
    return np.concatenate((corners, np.roll(corners, -1, axis=0)), axis=1)


@pytest.mark.slow
@pytest.mark.parametrize("largest", [0.0, 3.0, 1e5])
def test_no_beam_of_a_million_leaks_through_a_corner(largest: float) -> None:
    """1,008,000 beams, each aimed at its own corner of a crooked room, near the origin and far from it."""
    random, beams = np.random.default_rng(6), Beams(Lidar("scan"))
    worst = 0.0
    for turn, x, y in random.uniform(-1, 1, (934, 3)) * (math.pi, largest, largest):
        corners = star(random)
        far = np.hypot(*corners.T)
        cos, sin = math.cos(turn), math.sin(turn)
        moved = corners @ np.array([[cos, sin], [-sin, cos]]) + (x, y)
        found = distances(beams, Pose(x, y, turn), standing(closed(moved), NO_CIRCLES))
        worst = max(worst, float(abs(np.roll(found, 180) - far).max()))
    assert worst < (1e-8 if largest < 10 else 1e-6)


@given(st.integers(0, 2**32), st.integers(2, 2000), st.floats(1, 360), st.floats(-6.28, 6.28))
@settings(max_examples=60, deadline=None)
def test_a_closed_room_has_no_gap(seed: int, count: int, fov: float, theta: float) -> None:
    random = np.random.default_rng(seed)
    angles = np.sort(random.uniform(-math.pi, math.pi, 12)) + (0.0 if seed % 2 else theta)
    angles = np.concatenate((angles, angles[0] + math.tau * np.arange(1, 3) / 3))  # no side as wide as half a turn
    angles = np.sort(angles % math.tau)
    corners = random.uniform(0.5, 5.0, (14, 1)) * np.column_stack((np.cos(angles), np.sin(angles)))
    found = distances(
        Beams(Lidar("scan", beams=count, fov=fov)), Pose(0.0, 0.0, theta), standing(closed(corners), NO_CIRCLES)
    )
    assert found.max() < 5.01


def test_no_beam_leaks_between_unequal_walls() -> None:
    """The first beam is aimed at a corner of a crooked room, from everywhere in it."""
    room = np.array([[0, 0], [4, 0.3], [3.7, 3], [2, 2.2], [0.2, 3.1]], dtype=np.float64)
    segments = np.concatenate((room, np.roll(room, -1, axis=0)), axis=1)
    beams = Beams(Lidar("scan", beams=36, start=0.0))
    random = np.random.default_rng(7)
    for x, y in random.uniform((0.3, 0.4), (3.5, 2.0), (1000, 2)):
        corner = random.integers(5)
        aim = math.atan2(room[corner, 1] - y, room[corner, 0] - x)
        found = distances(beams, Pose(x, y, aim), standing(segments, NO_CIRCLES))
        assert np.isfinite(found).all()
        assert found[0] <= math.dist((x, y), room[corner]) + 1e-6


@pytest.mark.parametrize("slope", [0.0, 0.7])
@pytest.mark.parametrize("aside", [0.0, 1e-17, -1e-13, 1e-10, 1e-6])
def test_a_wall_seen_edge_on_is_as_far_as_its_end(aside: float, slope: float) -> None:
    cos, sin = math.cos(slope), math.sin(slope)
    wall = np.array([[2 * cos, 1 + 2 * sin, 5 * cos, 1 + 5 * sin]])
    pose = Pose(-sin * aside, 1.0 + cos * aside, slope)
    for flip in (wall, wall[:, [2, 3, 0, 1]]):
        found = distances(Beams(Lidar("scan", beams=4, start=0)), pose, standing(flip, NO_CIRCLES))
        assert found[1:].tolist() == [math.inf] * 3
        assert found[0] == pytest.approx(2.0, abs=1e-9) or (abs(aside) > 1e-15 and found[0] in (math.inf,))


def test_a_wall_that_a_sensor_stands_on_is_on_one_side_of_it() -> None:
    for x1, y1, x2, y2 in ((-1, -2, 2, 4), (3, 0, -1, 0), (0, -1, 0, 1)):
        found = distances(
            Beams(Lidar("scan")), Pose(0.0, 0.0), standing(np.array([[x1, y1, x2, y2]]) * 1.0, NO_CIRCLES)
        )
        assert np.count_nonzero(found < 1e-9) in (179, 180, 181)
        assert np.count_nonzero(np.isposinf(found)) >= 179


@pytest.mark.parametrize("place", [(2.0, 1.0), (4.0, 2.0)])
def test_a_sensor_at_a_walls_end_still_sees_the_rest(place: tuple[float, float]) -> None:
    segments = np.concatenate((ROOM, [[2.0, 1.0, 4.0, 2.0]]))
    found = distances(Beams(Lidar("scan")), Pose(*place, 0.3), standing(segments, NO_CIRCLES))
    assert np.isfinite(found).all()
    assert np.count_nonzero(found > 0.5) >= 180


def test_a_wall_without_length_is_a_point() -> None:
    beams = Beams(Lidar("scan", beams=8, start=0))
    for x, y, ahead in ((3.0, 0.0, 3.0), (2.0, 2.0, math.inf), (0.0, 0.0, None)):
        found = distances(beams, Pose(0.0, 0.0), standing(np.array([[x, y, x, y]]), NO_CIRCLES))
        assert not np.isnan(found).any()
        assert ahead is None or found[0] == ahead


def test_far_from_the_origin_it_is_as_exact_as_the_numbers_are() -> None:
    beams, moved = Beams(Lidar("scan")), ROOM + 98_000.0
    found = distances(beams, Pose(98_002.5, 98_001.25, 0.3), standing(moved, NO_CIRCLES))
    np.testing.assert_allclose(found, in_room(beams, Pose(2.5, 1.25, 0.3)), rtol=0, atol=1e-9)


def test_nothing_is_no_return() -> None:
    found = distances(Beams(Lidar("scan")), Pose(0.0, 0.0), standing(NO_SEGMENTS, NO_CIRCLES))
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
    seen = distances(whole, pose, standing(ROOM, NO_CIRCLES))[90:271]
    np.testing.assert_allclose(distances(half, pose, standing(ROOM, NO_CIRCLES)), seen, rtol=0, atol=1e-9)


def test_limits_are_those_of_rep_117() -> None:
    found = limited(np.array([0.0, 0.1, 0.12, 5.0, 12.0, 12.1, math.inf]), 0.12, 12.0)
    assert found.tolist() == [-math.inf, -math.inf, 0.12, 5.0, 12.0, math.inf, math.inf]


# --- Many at once, large maps, light ----------------------------------------------------------------------------------


def crowd(random: np.random.Generator, turned: float = 3.0) -> tuple[Surroundings, Array, Indices]:
    """Give a room with pillars, in which twenty round robots and twenty boxes drive, and the poses of all of them."""
    poses = np.array([[0.9 * (each % 8) + 0.5, 0.9 * (each // 8) + 0.5, 0.0] for each in range(40)])
    poses += random.uniform(-1, 1, (40, 3)) * (0.2, 0.2, turned)
    round_ones = np.column_stack((poses[:20, :2], random.uniform(0.1, 0.2, 20)))
    pillars = np.array([[7.7, 2.0, 0.3], [7.7, 4.0, 0.2]])
    owner = np.concatenate((np.arange(20), np.full(2, FIXED)))
    circles = circles_of(np.concatenate((round_ones, pillars)), random.uniform(0.1, 1, 22), owner)
    corners = [(0.15, 0.1), (-0.15, 0.1), (-0.15, -0.1), (0.15, -0.1)]
    boxes = np.concatenate([edges(corners, Pose(*pose)) for pose in poses[20:].tolist()])
    whose = np.repeat(np.arange(20, 40), 4)
    centres = poses[whose]
    moving = Edges(columns(boxes, random.uniform(0.1, 1, 80)), centres[:, 0], centres[:, 1], np.full(80, 0.19), whose)
    return Surroundings(Tiles(ROOM, np.full(4, 0.5)), circles, moving), poses, np.arange(40)


@pytest.mark.parametrize("lidar", [Lidar("a"), Lidar("b", beams=31, fov=250), Lidar("c", beams=512, range=(0.1, 2.5))])
def test_how_many_are_measured_together_changes_no_bit(lidar: Lidar, monkeypatch: pytest.MonkeyPatch) -> None:
    (around, poses, own), beams = crowd(np.random.default_rng(8)), Beams(lidar)
    alone = np.array([distances(beams, Pose(*pose), around, each) for pose, each in zip(poses, own, strict=True)])
    for at_once in (1, 5_000, 10**6):
        monkeypatch.setattr("robolink.sim.sensing.lidar._AT_ONCE", at_once)
        assert distances_batch(beams, poses, around, own).tobytes() == alone.tobytes()
        ranges, light = returns_batch(beams, poses, around, own)
        assert ranges.tobytes() == alone.tobytes()
        singly = [returns_batch(beams, poses[each : each + 1], around, own[each : each + 1])[1] for each in own]
        assert light.tobytes() == np.concatenate(singly).tobytes()


def test_each_sees_the_others_and_not_itself() -> None:
    around, poses, own = crowd(np.random.default_rng(9))
    assert around.edges is not None
    beams = Beams(Lidar("scan", range=FAR))
    found = distances_batch(beams, poses, around, own)
    for pose, number, ranges in zip(poses.tolist(), own.tolist(), found, strict=True):
        kept, edges_kept = around.circles.owner != number, around.edges.owner != number
        x1, x2, y1, y2 = around.edges.columns[:4, edges_kept]
        segments = np.concatenate((ROOM, np.column_stack((x1, y1, x2, y2))))
        circles = np.column_stack(around.circles[:3])[kept]
        everything = np.minimum(
            by_every_ray(beams, Pose(*pose), segments), circles_exactly(beams, Pose(*pose), circles)
        )
        np.testing.assert_allclose(ranges, everything, rtol=0, atol=1e-9)


def test_nobody_measures_nothing() -> None:
    assert distances_batch(Beams(Lidar("scan")), np.zeros((0, 3)), standing(ROOM, NO_CIRCLES)).shape == (0, 360)


def test_what_is_beyond_reach_is_not_seen() -> None:
    found = distances(Beams(Lidar("scan", beams=4, range=(0.1, 4.0))), Pose(2.0, 2.0), standing(ROOM, NO_CIRCLES))
    assert found.tolist() == pytest.approx([2.0, 2.0, math.inf, 3.0])


def test_noise_may_bring_back_what_is_just_beyond_range() -> None:
    lidar = Lidar("scan", beams=4, range=(0.1, 5.5), noise=0.1)
    found = distances(Beams(lidar), Pose(2.0, 2.0), standing(ROOM, NO_CIRCLES))
    assert found[2] == pytest.approx(6.0)


def city(random: np.random.Generator, count: int) -> Array:
    """Give short walls all over a square kilometre."""
    starts = random.uniform(-500, 500, (count, 2))
    return np.concatenate((starts, starts + random.uniform(-15, 15, (count, 2))), axis=1)


@pytest.mark.parametrize("kept", [10**6, 100])
def test_a_large_map_is_seen_exactly(kept: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.sim.sensing.scene._MOST_COLUMNS", kept)
    random = np.random.default_rng(10)
    segments, beams = city(random, 2000), Beams(Lidar("scan", beams=60, range=(0.1, 60.0)))
    around, poses = standing(segments, NO_CIRCLES), random.uniform(-500, 500, (20, 3))
    for _ in range(2):
        for pose, found in zip(poses.tolist(), distances_batch(beams, poses, around), strict=True):
            everything = by_every_ray(beams, Pose(*pose), segments)
            np.testing.assert_allclose(found, np.where(everything > 60.0, np.inf, everything), rtol=0, atol=1e-9)


def test_of_a_large_map_only_what_is_within_reach_is_looked_at() -> None:
    tiles = Tiles(city(np.random.default_rng(11), 20_000), np.ones(20_000))
    assert 20 < tiles.near(10.0, 20.0, 30.0).shape[1] < 200
    assert tiles.near(10.0, 20.0, 30.0) is tiles.near(11.0, 21.0, 30.0)
    assert tiles.near(1e5, 1e5, 30.0).shape[1] == 0


def test_light_is_reflectance_times_cosine_of_incidence() -> None:
    walls = Tiles(np.array([[3.0, -50, 3.0, 50]]), np.array([0.6]))
    around = Surroundings(walls, circles_of(np.array([[-5.0, 0.0, 1.0]]), np.array([0.9]), np.array([FIXED])))
    beams = Beams(Lidar("scan", beams=720, range=(0.1, 60.0)))
    ranges, light = (each[0] for each in returns_batch(beams, np.zeros((1, 3)), around))
    ahead = ranges == 3.0 / np.where(beams.cos > 0, beams.cos, np.nan)
    np.testing.assert_allclose(light[beams.cos > 0.1], 0.6 * beams.cos[beams.cos > 0.1], atol=1e-12)
    x, y = ranges * beams.cos, ranges * beams.sin
    met = (beams.cos < 0) & np.isfinite(ranges)
    outwards = np.column_stack((x[met] + 5.0, y[met]))
    straight = -(outwards[:, 0] * beams.cos[met] + outwards[:, 1] * beams.sin[met])
    np.testing.assert_allclose(light[met], 0.9 * straight, atol=1e-9)
    assert np.count_nonzero(met) > 40
    assert ahead.any()
    assert (light[np.isposinf(ranges)] == 0.0).all()


def test_light_is_that_of_the_nearest() -> None:
    walls = Tiles(np.array([[3.0, -1, 3.0, 1], [2.0, -1, 2.0, 1], [4.0, 1, 4.0, -1]]), np.array([0.6, 0.3, 0.9]))
    around = standing(NO_SEGMENTS, NO_CIRCLES)._replace(walls=walls)
    _, light = returns_batch(Beams(Lidar("scan", beams=4)), np.zeros((1, 3)), around)
    assert light[0].tolist() == pytest.approx([0.0, 0.0, 0.3, 0.0])


def test_directions_are_exact() -> None:
    angles = np.linspace(-12.6, 12.6, 20_001)
    cos, sin = cos_and_sin(angles)
    assert max(abs(each - math.cos(angle)) for each, angle in zip(cos.tolist(), angles.tolist(), strict=True)) < 3e-16
    assert max(abs(each - math.sin(angle)) for each, angle in zip(sin.tolist(), angles.tolist(), strict=True)) < 3e-16


def test_a_scan_has_the_same_bits_on_every_machine() -> None:
    """Headings are 0: cosines and sines of others come from the machine's C library."""
    (around, poses, own), beams = crowd(np.random.default_rng(12), turned=0.0), Beams(Lidar("scan", fov=270))
    found = np.concatenate(returns_batch(beams, poses, around, own))
    assert hashlib.sha256(found.tobytes()).hexdigest()[:16] == "f74ee2592691b3e2"


# --- What moves -------------------------------------------------------------------------------------------------------


def test_things_come_move_and_go() -> None:
    scene, beams = Scene(WorldDescription(), pymunk.Space()), Beams(Lidar("scan", beams=4, start=0.0))
    disc, box, plate = (pymunk.Body(1.0, 1.0) for _ in range(3))
    disc.position, box.position, plate.position = (3.0, 0.0), (0.0, 4.0), (-2.0, 0.0)
    plate.angle = math.pi / 2

    def seen(body: pymunk.Body | None = None) -> list[float]:
        own = NOBODY if body is None else scene.number(body)
        found: list[float] = distances(beams, Pose(0.0, 0.0), scene.surroundings(), own).tolist()
        return found

    assert seen() == [math.inf] * 4
    scene.add(disc, Shape(circle=0.5))
    scene.add(box, Shape(box=(1.0, 2.0)), reflectance=0.5)
    scene.add(plate, Shape(polygon=((-1, -0.1), (1, -0.1), (1, 0.2), (-1, 0.2))))
    assert seen() == pytest.approx([2.5, 3.0, 1.9, math.inf])
    assert seen(disc) == pytest.approx([math.inf, 3.0, 1.9, math.inf])
    assert seen(plate) == pytest.approx([2.5, 3.0, math.inf, math.inf])
    disc.position, box.angle = (0.0, -2.0), math.pi / 2
    assert seen() == pytest.approx([2.5, 3.0, 1.9, math.inf])  # as it was at this step
    scene.moved()
    assert seen() == pytest.approx([math.inf, 3.5, 1.9, 1.5])
    plate.position = (-3.0, 0.0)
    scene.step += 1
    assert seen(box) == pytest.approx([math.inf, math.inf, 2.9, 1.5])
    scene.remove(disc)
    assert seen() == pytest.approx([math.inf, 3.5, 2.9, math.inf])
    assert seen(box) == pytest.approx([math.inf, math.inf, 2.9, math.inf])  # numbers stay when others go
    with pytest.raises(KeyError):
        scene.remove(disc)
    with pytest.raises(KeyError):
        scene.number(disc)
