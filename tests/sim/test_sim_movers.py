"""Obstacles that move by themselves, crates that are pushed, outlines of any form, and many walls."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink.sim import Robot, World, load_world
from robolink.sim.description import MapWalls, Obstacle, RobotDescription, WorldDescription, signed_area
from robolink.sim.physics.bodies import centroid
from robolink.sim.physics.convex import convex_parts
from robolink.sim.physics.mover import Mover
from robolink.sim.quantities import Point, Pose

ROOM = "walls: [{polyline: [[0, 0], [8, 0], [8, 5], [0, 5]], closed: true}]\n"


def world(obstacles: str, robot: str = "pose: [1, 1, 0]") -> World:
    return World(load_world("movers.yaml", text=f"{ROOM}obstacles: [{obstacles}]\nrobots: [{{name: r, {robot}}}]"))


def run(world: World, seconds: float) -> Robot:
    for _ in range(round(seconds / 0.01)):
        world.step()
    return world.robots["r"]


@pytest.mark.parametrize(
    ("seconds", "closed", "place"),
    [
        (0.0, False, (0.0, 0.0)),
        (6.0, False, (3.0, 0.0)),
        (10.0, False, (3.0, 2.0)),
        (11.0, False, (3.0, 1.5)),
        (20.0, False, (0.0, 0.0)),
        (47.0, False, (3.0, 0.5)),
        (10.0, True, (3.0, 2.0)),
        (10.0 + math.sqrt(13), True, (1.5, 1.0)),
        (20.0 + 4 * math.sqrt(13), True, (0.0, 0.0)),
    ],
)
def test_an_obstacle_is_where_its_path_says(seconds: float, closed: bool, place: Point) -> None:
    mover = Mover(Obstacle(circle=0.1, path=((0.0, 0.0), (3.0, 0.0), (3.0, 2.0)), speed=0.5, closed=closed), 0.001)
    assert mover.place(round(seconds * 1000)) == pytest.approx(place, abs=1e-3)


def test_what_moves_by_itself_is_seen_there_whatever_it_has_met() -> None:
    crate = "{box: [0.4, 0.4], path: [[2, 2.5], [6, 2.5]], speed: 1.0}, {circle: 0.2, pose: [4, 2.5], mass: 5}"
    made = world(crate, "pose: [4, 1, 1.5707963267948966], sensors: [{lidar: scan, beams: 4, fov: 360}]")
    run(made, 10.0)  # there, back, and half of the way again
    assert made.robots["r"].scan().ranges[2] == pytest.approx(1.3, abs=1e-9)
    run(made, 71.0)
    assert run(made, 1.0).scan().ranges[2] == pytest.approx(1.3, abs=1e-9)


@pytest.mark.parametrize("speed", [0.5, 2.0, 5.0, 10.0])
def test_a_robot_is_pushed_along_and_never_passed_through(speed: float) -> None:
    made = world(f"{{box: [0.6, 0.6], path: [[1, 2.5], [6, 2.5]], speed: {speed}}}", "pose: [3, 2.5, 0]")
    robot = run(made, 5.0 / speed)
    assert robot.pose.x == pytest.approx(6.0 + 0.3 + 0.17, abs=0.02)
    assert math.hypot(robot.twist.v, robot.twist.sideways) < 1.2 * speed


@pytest.mark.slow
@pytest.mark.parametrize("speed", [0.2, 0.5, 1.0, 2.0, 5.0, 10.0])
@pytest.mark.parametrize("robot", ["shape: {circle: 0.17}", "shape: {box: [0.5, 0.34]}"])
@pytest.mark.parametrize("mover", ["circle: 0.3", "box: [0.6, 0.6]"])
def test_a_robot_squeezed_against_a_wall_is_passed_over_and_stays_calm(speed: float, robot: str, mover: str) -> None:
    path = "path: [[4, 2.5], [7.9, 2.5]]"
    made = world(f"{{{mover}, {path}, speed: {speed}}}", f"pose: [7, 2.52, 0], {robot}")
    fastest, squeezed = 0.0, made.robots["r"]
    for _ in range(round(max(10.0, 8.0 / speed) / 0.01)):
        made.step()
        fastest = max(fastest, math.hypot(squeezed.twist.v, squeezed.twist.sideways))
        assert 0.0 < squeezed.pose.x < 8.0
        assert 0.0 < squeezed.pose.y < 5.0
    assert squeezed.contacts >= 2
    assert fastest < 1.2 * speed


def test_robots_and_crates_in_a_row_are_not_pushed_through_a_wall() -> None:
    row = "{box: [0.5, 0.5], path: [[3, 2.5], [7.9, 2.5]], speed: 0.5}, {box: [0.3, 0.3], pose: [7.3, 2.5], mass: 1}"
    made = world(row, "pose: [6, 2.5, 0]")
    for _ in range(2000):
        made.step()
        for body in made._space.bodies:
            assert 0.0 < body.position.x < 8.0
            assert body.velocity.length < 1.0


def test_what_is_squeezed_can_drive_away_and_is_pushed_again() -> None:
    made = world("{box: [0.6, 0.6], path: [[6, 2.5], [7.5, 2.5]], speed: 0.5}", "pose: [7.5, 2.5, 1.5707963267948966]")
    robot = run(made, 3.0)
    for _ in range(400):
        robot.command(0.5, 0.0)
        made.step()
    assert robot.pose.y > 4.0
    assert robot.touching == 1  # the wall that it has driven to


STAR = st.lists(st.floats(0.15, 1.0), min_size=3, max_size=14).map(
    lambda radii: [
        (r * math.cos(math.tau * k / len(radii)), r * math.sin(math.tau * k / len(radii))) for k, r in enumerate(radii)
    ]
)


@pytest.mark.slow
@given(STAR, st.floats(0.05, 20.0))
@settings(max_examples=100, deadline=None)
def test_any_outline_is_cut_into_convex_parts_without_a_rest(star: list[Point], scale: float) -> None:
    corners = [(scale * x, scale * y) for x, y in star]
    parts = convex_parts(corners)
    areas = [signed_area(part) for part in parts]
    assert min(areas) > 0.0
    assert sum(areas) == pytest.approx(signed_area(corners))
    for part in parts:
        for (x1, y1), (x2, y2), (x3, y3) in zip(part, part[1:] + part[:1], part[2:] + part[:2], strict=True):
            assert (x2 - x1) * (y3 - y2) - (y2 - y1) * (x3 - x2) > -1e-9 * scale * scale


def test_a_robot_fits_into_the_notch_of_a_concave_obstacle() -> None:
    u = "{polygon: [[4, 1], [6, 1], [6, 4], [4, 4], [4, 3.5], [5.5, 3.5], [5.5, 1.5], [4, 1.5]], pose: [0, 0]}"
    made = world(u, "pose: [2, 2.5, 0], sensors: [{lidar: scan, beams: 4}]")
    robot = made.robots["r"]
    assert robot.scan().ranges[2] == pytest.approx(3.5)
    for _ in range(1000):
        robot.command(0.5, 0.0)
        made.step()
    assert robot.pose.x == pytest.approx(5.5 - 0.17, abs=0.005)


def test_a_robot_may_be_concave_itself() -> None:
    prongs = "[0.4, -0.3], [0.4, -0.2], [0.1, -0.2], [0.1, 0.2], [0.4, 0.2], [0.4, 0.3]"
    fork = f"shape: {{polygon: [[-0.2, -0.3], {prongs}, [-0.2, 0.3]]}}"
    made = world("{circle: 0.15, pose: [3, 1]}, {circle: 0.15, pose: [6, 1.25]}", f"pose: [1, 1, 0], {fork}")
    robot = made.robots["r"]
    for _ in range(600):
        robot.command(0.5, 0.0)
        made.step()
    assert robot.pose.x == pytest.approx(3 - 0.15 - 0.1, abs=0.005)  # the post stands between its prongs


def test_a_crate_turns_about_its_middle_and_not_its_origin() -> None:
    corners = [(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)]
    assert centroid(corners) == pytest.approx((1.5, 1.5))
    outline = ", ".join(f"[{x}, {y}]" for x, y in corners)
    off = world(f"{{polygon: [{outline}], pose: [2, 1], mass: 2}}", "pose: [2, 2.3, 0], drive: {v_max: 1}")
    own = world("{box: [1, 1], pose: [3.5, 2.5], mass: 2}", "pose: [2, 2.3, 0], drive: {v_max: 1}")
    for made in (off, own):
        for _ in range(400):
            made.robots["r"].command(0.6, 0.0)
            made.step()
    assert off.robots["r"].pose.x == pytest.approx(own.robots["r"].pose.x, abs=1e-6)
    assert off.robots["r"].pose.x > 3.0


@pytest.mark.slow
def test_ten_thousand_pieces_of_wall_hold_a_robot() -> None:
    rim = [(0.1 * math.cos(a), 0.1 * math.sin(a)) for a in (math.tau * k / 10_000 for k in range(10_001))]
    pieces = [(30 * x, 30 * y) for k in range(10_000) for x, y in (rim[k], rim[k + 1])]
    made = World(
        WorldDescription(walls=(MapWalls(tuple(pieces)),), robots=(RobotDescription("r", Pose(0.0, 0.0, 1.0)),))
    )
    robot = made.robots["r"]
    for _ in range(1000):
        robot.command(0.5, 0.05)
        made.step()
    assert math.hypot(robot.pose.x, robot.pose.y) == pytest.approx(3.0 - 0.17, abs=0.005)
