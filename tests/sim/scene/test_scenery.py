"""Scenery of worlds: where the surfaces of walls, obstacles and robots are."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from robolink.sim import load_world
from robolink.sim.description import Obstacle, RobotDescription, Shape, Wall, WorldDescription
from robolink.sim.looks import OBSTACLE_HEIGHT, WALL_HEIGHT
from robolink.sim.quantities import Pose
from robolink.sim.scene.scenery import robot_surfaces, scenery
from robolink.sim.scene.solids import Face

WORLDS = Path(__file__).parents[3] / "configs" / "worlds"


def area(face: Face) -> float:
    """Area of a face, in m²."""
    (ax, ay, az), (bx, by, bz) = face.a, face.b
    whole = math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
    return whole * {"parallelogram": 1.0, "ellipse": math.pi / 4, "triangle": 0.5}[face.outline]


def level(faces: tuple[Face, ...], z: float) -> list[Face]:
    """Faces that lie level at the height z."""
    return [each for each in faces if each.corner[2] == z and each.a[2] == each.b[2] == 0.0]


def world(*obstacles: Obstacle) -> WorldDescription:
    return WorldDescription(obstacles=obstacles)


def test_a_wall_stands_on_its_line() -> None:
    scene = scenery(WorldDescription(walls=(Wall(((0.0, 0.0), (4.0, 0.0), (4.0, 3.0)), closed=True),)))
    first, second, third = scene.fixed.faces
    assert (first.corner, first.a, first.b) == ((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 0.0, WALL_HEIGHT))
    assert second.corner == (4.0, 0.0, 0.0)
    assert third.a == (-4.0, -3.0, 0.0)


def test_a_box_has_four_sides_and_a_top() -> None:
    (x, y), turned = (2.0, 3.0), math.pi / 2
    scene = scenery(world(Obstacle(box=(1.0, 0.5), pose=Pose(x, y, turned))))
    faces = scene.fixed.faces
    assert len(faces) == 5
    (top,) = level(faces, OBSTACLE_HEIGHT)
    ends = [
        (top.corner[0] + i * top.a[0] + j * top.b[0], top.corner[1] + i * top.a[1] + j * top.b[1])
        for i in (0, 1)
        for j in (0, 1)
    ]
    assert sorted((round(px, 9), round(py, 9)) for px, py in ends) == [
        (1.75, 2.5),
        (1.75, 3.5),
        (2.25, 2.5),
        (2.25, 3.5),
    ]
    assert sum(area(each) for each in faces) == pytest.approx(2 * 1.5 * OBSTACLE_HEIGHT + 0.5)


def test_a_circle_is_a_cylinder_with_a_lid() -> None:
    scene = scenery(world(Obstacle(circle=0.3, pose=Pose(1.0, 2.0))))
    (side,), (lid,) = scene.fixed.cylinders, scene.fixed.faces
    assert side[:5] == (1.0, 2.0, 0.3, 0.0, OBSTACLE_HEIGHT)
    assert lid.outline == "ellipse"
    assert area(lid) == pytest.approx(math.pi * 0.09)


@pytest.mark.parametrize("clockwise", [False, True])
def test_a_concave_polygon_has_a_top_of_its_own_area(clockwise: bool) -> None:
    corners = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 0.5), (0.0, 2.0))
    shape = Obstacle(polygon=corners[::-1] if clockwise else corners, pose=Pose(0.0, 0.0))
    faces = scenery(world(shape)).fixed.faces
    assert sum(area(each) for each in level(faces, OBSTACLE_HEIGHT)) == pytest.approx(2.5)
    assert len(faces) - len(level(faces, OBSTACLE_HEIGHT)) == 5


def test_what_moves_has_surfaces_of_its_own() -> None:
    pushed = Obstacle(box=(0.2, 0.2), pose=Pose(1.0, 1.0), mass=1.0)
    moving = Obstacle(circle=0.2, path=((3.0, 0.0), (4.0, 0.0)))
    scene = scenery(world(Obstacle(circle=0.1, pose=Pose(5.0, 5.0)), pushed, moving))
    assert sorted(scene.movable) == [1, 2]
    assert scene.movable[2].cylinders[0][:2] == (0.0, 0.0)
    assert [each.x for each in scene.fixed.cylinders] == [5.0]


def test_a_robot_stands_above_the_floor_and_has_an_underside() -> None:
    surfaces = robot_surfaces(RobotDescription("ada", Pose(3.0, 3.0), shape=Shape(box=(0.4, 0.2))))
    assert sorted({each.corner[2] for each in surfaces.faces}) == [0.02, 0.2]
    assert len(surfaces.faces) == 6


def test_every_world_has_scenery() -> None:
    for path in sorted(WORLDS.glob("*.yaml")):
        description = load_world(path)
        scene = scenery(description)
        assert len(scene.robots) == len(description.robots)
        assert len(scene.fixed.faces) >= sum(len(each.segments()) for each in description.walls)


def test_an_empty_world_is_a_floor_and_a_sky() -> None:
    scene = scenery(WorldDescription())
    assert scene.fixed == ((), ())
    assert scene.floor.image is None
