"""Signs: where their faces are, which way up, and whether they hang on a wall or stand on a pole."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from robolink.sim.description import Obstacle, RobotDescription, Sign, Wall, WorldDescription
from robolink.sim.quantities import Pose
from robolink.sim.scene.scenery import robot_surfaces, scenery
from robolink.sim.scene.solids import Face, Surfaces

WALLS = (Wall(((4.0, 0.0), (4.0, 4.0)), height=0.6),)


def seen(*signs: Sign, **world: Any) -> Surfaces:
    """Surfaces of a world with these signs, without those that it has without them."""
    with_them, without = (scenery(WorldDescription(signs=each, **world)).fixed for each in (signs, ()))
    return Surfaces(with_them.faces[len(without.faces) :], with_them.cylinders[len(without.cylinders) :])


def corners(face: Face) -> list[tuple[float, ...]]:
    """Upper left, upper right and lower left corner of a face, as who looks at it sees them."""
    corner, a, b = (np.array(each) for each in face[:3])
    return [tuple(np.round(each, 6).tolist()) for each in (corner, corner + a, corner + b)]


def test_a_tag_on_a_wall_is_one_face_that_looks_away_from_it() -> None:
    found = seen(Sign(tag="36h11/3", pose=Pose(4.0, 2.0, math.pi), z=0.5, size=0.16), walls=WALLS)
    (face,) = found.faces
    assert found.cylinders == ()
    assert face.texture is not None
    assert face.texture.shape == (10, 10, 3)
    # Who looks along +x has larger y at the left: 16 cm and a cell of 2 cm around.
    assert corners(face) == [(4.0, 2.1, 0.6), (4.0, 1.9, 0.6), (4.0, 2.1, 0.4)]


@pytest.mark.parametrize("theta", [0.0, 1.0, -2.5])
def test_the_cross_product_of_its_sides_points_away_from_who_sees_it(theta: float) -> None:
    face = seen(Sign(tag="16h5/0", pose=Pose(1.0, 1.0, theta))).faces[0]
    away = np.cross(face.a, face.b)
    assert away @ (math.cos(theta), math.sin(theta), 0.0) == pytest.approx(-math.hypot(*away))


def test_a_sign_in_the_open_has_a_back_and_a_pole_up_to_its_plate() -> None:
    found = seen(Sign(tag="4x4_50/7", pose=Pose(1.0, 2.0), z=0.5, size=0.18), walls=WALLS)
    face, back = found.faces
    assert back == face._replace(texture=None)
    (pole,) = found.cylinders
    assert (pole.x, pole.y, pole.z0) == (1.0, 2.0, 0.0)
    assert pole.z1 == pytest.approx(0.5 - 0.12)


@pytest.mark.parametrize(
    ("pose", "z", "count"),
    [
        (Pose(3.96, 2.0, math.pi), 0.5, 0),
        (Pose(3.9, 2.0, math.pi), 0.5, 1),
        (Pose(4.0, 2.0, math.pi), 0.9, 1),  # above the wall
        (Pose(1.5, 1.0), 0.4, 0),  # the side of the box
        (Pose(2.0, 3.0), 0.3, 0),  # the side of the cylinder
        (Pose(2.2, 3.0), 0.3, 1),
    ],
)
def test_it_hangs_on_what_is_near_and_high_enough(pose: Pose, z: float, count: int) -> None:
    box = Obstacle(box=(1.0, 1.0), pose=Pose(1.0, 1.0))
    post = Obstacle(circle=0.5, pose=Pose(1.5, 3.0), height=0.35)
    sign = Sign(tag="36h11/0", pose=pose, z=z)
    assert len(seen(sign, walls=WALLS, obstacles=(box, post)).cylinders) == count


def test_a_sign_on_a_fixed_obstacle_turns_with_it() -> None:
    sign = Sign(tag="36h11/1", pose=Pose(0.5, 0.0), z=0.2)
    bare = Obstacle(box=(1.0, 1.0), pose=Pose(2.0, 3.0, math.pi / 2))
    signed = Obstacle(box=(1.0, 1.0), pose=Pose(2.0, 3.0, math.pi / 2), signs=(sign,))
    faces = scenery(WorldDescription(obstacles=(signed,))).fixed.faces
    assert len(faces) == len(scenery(WorldDescription(obstacles=(bare,))).fixed.faces) + 2
    left, right, _ = corners(next(each for each in faces if each.texture is not None))
    assert left[1] == right[1] == pytest.approx(3.5)
    assert left[0] > right[0]  # who sees it looks along -y


def test_signs_go_with_what_moves_and_with_robots() -> None:
    sign = Sign(tag="36h11/1", pose=Pose(-0.17, 0.0, math.pi), z=0.15, size=0.1)
    moving = Obstacle(circle=0.2, path=((0.0, 0.0), (1.0, 0.0)), signs=(sign,))
    found = scenery(
        WorldDescription(obstacles=(moving,), robots=(RobotDescription("r", Pose(5.0, 5.0), signs=(sign,)),))
    )
    for surfaces in (
        found.movable[0],
        found.robots["r"],
        robot_surfaces(RobotDescription("x", Pose(0.0, 0.0), signs=(sign,))),
    ):
        face = next(each for each in surfaces.faces if each.texture is not None)
        assert face.corner[0] == pytest.approx(-0.17)
    assert found.fixed == ((), ())


def test_the_same_tag_is_one_picture() -> None:
    found = seen(*(Sign(tag="36h11/3", pose=Pose(x, 1.0)) for x in (1.0, 2.0)))
    first, second = (each.texture for each in found.faces if each.texture is not None)
    assert first is second
