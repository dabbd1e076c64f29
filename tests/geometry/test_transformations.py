"""robolink.geometry.transformations against scipy's rotations, and what goes there and back."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from robolink.geometry import transformations as tft
from robolink.geometry.rotations import Numbers

ANGLE = st.floats(-math.pi, math.pi)
NUMBER = st.floats(-100.0, 100.0)
VECTOR = st.tuples(NUMBER, NUMBER, NUMBER)
DIRECTION = VECTOR.filter(lambda v: math.hypot(*v) > 1e-3)
QUATERNION = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: math.hypot(*q) > 1e-2)
AXES = sorted(tft._AXES2TUPLE)


def scipys(axes: str) -> str:
    """The same axes as scipy spells them: small letters are static, capital ones turn along."""
    return axes[1:] if axes[0] == "s" else axes[1:].upper()


def same_rotation(one: Numbers, other: Numbers) -> bool:
    return bool(abs(np.dot(tft.unit_vector(one), tft.unit_vector(other))) > 1 - 1e-9)


def test_there_are_24_conventions() -> None:
    assert len(AXES) == 24
    assert {"sxyz", "rzyx", "szxz", "rxyx"} <= set(AXES)


@given(st.sampled_from(AXES), ANGLE, ANGLE, ANGLE)
def test_euler_angles_mean_what_scipy_means(axes: str, a: float, b: float, c: float) -> None:
    wanted = Rotation.from_euler(scipys(axes), [a, b, c])
    assert np.allclose(tft.euler_matrix(a, b, c, axes)[:3, :3], wanted.as_matrix())
    assert same_rotation(tft.quaternion_from_euler(a, b, c, axes), wanted.as_quat())


@given(st.sampled_from(AXES), QUATERNION)
def test_euler_angles_of_a_quaternion(axes: str, quaternion: tuple[float, ...]) -> None:
    rotation = Rotation.from_quat(quaternion)
    angles = tft.euler_from_quaternion(quaternion, axes)
    assert np.allclose(Rotation.from_euler(scipys(axes), angles).as_matrix(), rotation.as_matrix(), atol=1e-6)
    assert tft.euler_from_matrix(tft.quaternion_matrix(quaternion), axes) == angles
    assert tft.euler_from_quaternion(quaternion, tft._AXES2TUPLE[axes]) == angles


@pytest.mark.parametrize("axes", AXES)
def test_gimbal_lock_keeps_the_rotation_and_leaves_one_angle_out(axes: str) -> None:
    repeated = axes[1] == axes[3]
    for a, c, up in itertools.product([0.3, -2.0], [1.1, -0.7], [1.0, -1.0]):
        middle = (0.0 if up > 0 else math.pi) if repeated else up * math.pi / 2
        matrix = tft.euler_matrix(a, middle, c, axes)
        found = tft.euler_from_matrix(matrix, axes)
        assert found[2 if axes[0] == "s" else 0] == 0.0
        assert np.allclose(tft.euler_matrix(*found, axes), matrix, atol=1e-6)


def test_roll_pitch_and_yaw_are_what_everybody_thinks() -> None:
    assert tft.quaternion_from_euler(0, 0, math.pi / 2) == pytest.approx((0, 0, math.sqrt(0.5), math.sqrt(0.5)))
    assert tft.euler_from_quaternion([0.0, 0.0, 0.0, 1.0]) == (0.0, 0.0, 0.0)
    assert tft.euler_from_quaternion(tft.quaternion_from_euler(0.1, 0.2, 0.3)) == pytest.approx((0.1, 0.2, 0.3))


@pytest.mark.parametrize("axes", ["xyz", "sxxy", "", "sxy", (0, 0, 0, 2), "qxyz"])
def test_unknown_axes_are_an_error_that_lists_the_known(axes: Any) -> None:
    with pytest.raises(ValueError, match=r"expected one of rxyx, .*, szyz, got"):
        tft.euler_matrix(1, 2, 3, axes)


@given(QUATERNION, QUATERNION)
def test_quaternions_multiply_as_rotations_do(one: tuple[float, ...], other: tuple[float, ...]) -> None:
    wanted = Rotation.from_quat(one) * Rotation.from_quat(other)
    assert same_rotation(tft.quaternion_multiply(one, other), wanted.as_quat())
    assert np.allclose(tft.quaternion_matrix(one)[:3, :3], Rotation.from_quat(one).as_matrix())
    assert np.allclose(tft.quaternion_multiply(one, tft.quaternion_inverse(one)), [0, 0, 0, 1])
    assert same_rotation(tft.quaternion_conjugate(one), Rotation.from_quat(one).inv().as_quat())


@given(QUATERNION)
def test_a_matrix_gives_its_quaternion_back(quaternion: tuple[float, ...]) -> None:
    found = tft.quaternion_from_matrix(tft.quaternion_matrix(quaternion))
    assert same_rotation(found, quaternion)
    assert found[3] >= 0.0
    assert all(type(each) is float for each in found)


def test_a_quaternion_of_nothing_turns_nothing() -> None:
    assert np.array_equal(tft.quaternion_matrix([0, 0, 0, 0]), np.identity(4))


@given(ANGLE, DIRECTION, VECTOR)
def test_rotation_about_an_axis(angle: float, direction: tuple[float, ...], point: tuple[float, ...]) -> None:
    wanted = Rotation.from_rotvec(tft.unit_vector(direction) * angle)
    assert same_rotation(tft.quaternion_about_axis(angle, direction), wanted.as_quat())
    matrix = tft.rotation_matrix(angle, direction, point)
    assert np.allclose(matrix[:3, :3], wanted.as_matrix())
    assert np.allclose(matrix @ (*point, 1.0), (*point, 1.0))
    if abs(angle) > 1e-3:
        assert np.allclose(tft.rotation_matrix(*tft.rotation_from_matrix(matrix)), matrix, atol=1e-6)


@given(QUATERNION, QUATERNION, st.floats(0.0, 1.0))
def test_slerp_is_scipys(one: tuple[float, ...], other: tuple[float, ...], fraction: float) -> None:
    a, b = Rotation.from_quat(one), Rotation.from_quat(other)
    wanted = a * Rotation.from_rotvec((a.inv() * b).as_rotvec() * fraction)
    found = Rotation.from_quat(tft.quaternion_slerp(one, other, fraction))
    if abs(np.dot(a.as_quat(), b.as_quat())) > 1e-6:  # else both ways round are as short
        assert (found.inv() * wanted).magnitude() < 1e-6


def test_slerp_may_go_the_long_way() -> None:
    here, there = [0, 0, 0, 1], tft.quaternion_from_euler(0, 0, 1.5 * math.pi)
    assert tft.euler_from_quaternion(tft.quaternion_slerp(here, there, 0.5))[2] == pytest.approx(-math.pi / 4)
    long = tft.quaternion_slerp(here, there, 0.5, shortestpath=False)
    assert tft.euler_from_quaternion(long)[2] == pytest.approx(0.75 * math.pi)


@given(
    st.tuples(*[st.floats(0.1, 10.0)] * 3),
    st.tuples(*[st.floats(-2.0, 2.0)] * 3),
    st.tuples(ANGLE, st.floats(-1.5, 1.5), ANGLE),
    VECTOR,
)
def test_matrices_are_composed_and_decomposed(scale: Any, shear: Any, angles: Any, translate: Any) -> None:
    matrix = tft.compose_matrix(scale, shear, angles, translate)
    found = tft.decompose_matrix(matrix)
    assert found[4] is None
    assert tft.is_same_transform(tft.compose_matrix(*found), matrix)
    assert np.allclose(found[0], scale)
    assert np.allclose(found[1], shear, atol=1e-6)
    assert np.allclose(tft.euler_matrix(*found[2]), tft.euler_matrix(*angles), atol=1e-6)
    assert np.allclose(tft.translation_from_matrix(matrix), translate)
    assert np.allclose(tft.concatenate_matrices(matrix, tft.inverse_matrix(matrix)), np.identity(4), atol=1e-6)


def test_what_a_composed_matrix_does_first_and_last() -> None:
    matrix = tft.compose_matrix([2, 1, 1], [1, 0, 0], (0.0, 0.0, math.pi / 2), [0, 0, 5])
    assert np.allclose(matrix @ [0, 1, 0, 1], [-1, 2, 5, 1])  # sheared to (1, 1), scaled to (2, 1), turned, lifted


def test_perspective_is_composed_and_decomposed() -> None:
    matrix = tft.compose_matrix([1, 2, 3], angles=(1.0, 0.5, 0.2), translate=[1, 2, 3], perspective=[0.1, 0.2, 0.3, 2])
    perspective = tft.decompose_matrix(matrix)[4]
    assert perspective is not None
    assert np.allclose(perspective, [0.1, 0.2, 0.3, 2])
    assert np.allclose(tft.compose_matrix(*tft.decompose_matrix(matrix)), matrix)


def test_a_flat_matrix_is_an_error() -> None:
    with pytest.raises(ValueError, match="flattens space"):
        tft.decompose_matrix(np.diag([1, 1, 0, 1]))


@given(DIRECTION, VECTOR, st.floats(0.1, 5.0))
@example(normal=(0.0, 1.0, 0.0), point=(0.0, 2.0, 0.0), factor=0.99999)  # nearly, but not, the same in all directions
def test_scaling_and_mirroring_there_and_back(normal: Any, point: Any, factor: float) -> None:
    for matrix in (tft.scale_matrix(factor, point), tft.scale_matrix(factor, point, normal)):
        assert np.allclose(matrix @ (*point, 1.0), (*point, 1.0))
        assert np.allclose(tft.scale_matrix(*tft.scale_from_matrix(matrix)), matrix, atol=1e-5)
    mirror = tft.reflection_matrix(point, normal)
    assert np.allclose(mirror @ mirror, np.identity(4), atol=1e-6)
    assert np.allclose(tft.reflection_matrix(*tft.reflection_from_matrix(mirror)), mirror, atol=1e-6)
    with pytest.raises(ValueError, match="not a reflection"):
        tft.reflection_from_matrix(np.identity(4))


@given(QUATERNION, VECTOR, st.integers(0, 1000))
def test_superimposition_finds_the_motion(quaternion: Any, place: Any, seed: int) -> None:
    points = np.random.default_rng(seed).uniform(-5, 5, (3, 8))
    motion = tft.concatenate_matrices(tft.translation_matrix(place), tft.quaternion_matrix(quaternion))
    moved = motion[:3, :3] @ points + motion[:3, 3:]
    assert np.allclose(tft.superimposition_matrix(points, moved), motion, atol=1e-6)
    scaled = tft.superimposition_matrix(points, 3 * moved, scaling=True)
    assert np.allclose(scaled, tft.scale_matrix(3) @ motion, atol=1e-5)


def test_superimposition_of_too_few_points() -> None:
    with pytest.raises(ValueError, match="three or more points"):
        tft.superimposition_matrix([[1, 2]] * 3, [[1, 2]] * 3)


def test_lengths() -> None:
    rows = np.array([[3.0, 4.0], [6.0, 8.0]])
    assert tft.vector_norm([3, 4]) == 5.0
    assert tft.vector_norm(rows, axis=1).tolist() == [5, 10]
    out = np.zeros(2)
    assert tft.vector_norm(rows, axis=1, out=out) is None
    assert out.tolist() == [5, 10]
    assert tft.unit_vector([3, 4]).tolist() == [0.6, 0.8]
    assert tft.unit_vector(rows, axis=1).tolist() == [[0.6, 0.8]] * 2
    assert tft.unit_vector(rows, out=rows) is None
    assert np.square(rows).sum() == pytest.approx(1.0)


def test_chance() -> None:
    quaternions = np.array([tft.random_quaternion() for _ in range(2000)])
    assert np.allclose(np.square(quaternions).sum(axis=1), 1.0)
    assert abs(quaternions.mean(axis=0)).max() < 0.1
    assert same_rotation(tft.random_quaternion([0.1, 0.2, 0.3]), tft.random_quaternion([0.1, 0.2, 0.3]))
    assert np.linalg.det(tft.random_rotation_matrix()) == pytest.approx(1.0)
    assert tft.random_vector(5).shape == (5,)
    assert tft.is_same_transform(tft.identity_matrix(), 2 * np.identity(4))
