"""Homogeneous transformation matrices, with the names of tf_transformations: 4x4, and acting on columns.

Vectors and matrices may be given as any sequences.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from robolink.geometry.rotations import (
    EPS,
    Angles,
    Matrix,
    Vector,
    euler_from_matrix,
    euler_matrix,
    quaternion_about_axis,
    quaternion_from_matrix,
    quaternion_matrix,
    split_matrix,
    unit_vector,
)


def identity_matrix() -> Matrix:
    """Return the identity matrix."""
    return np.identity(4)


def translation_matrix(direction: ArrayLike) -> Matrix:
    """Return the matrix that moves by `direction`, of which the first three numbers count."""
    matrix = np.identity(4)
    matrix[:3, 3] = np.asarray(direction)[:3]
    return matrix


def translation_from_matrix(matrix: ArrayLike) -> Vector:
    """Return the vector by which `matrix` moves."""
    return np.array(np.asarray(matrix, np.float64)[:3, 3])


def rotation_matrix(angle: float, direction: ArrayLike, point: ArrayLike | None = None) -> Matrix:
    """Return the matrix that rotates about an axis.

    Args:
        angle: Angle in radians.
        direction: Direction of the axis, of any length but 0.
        point: A point on the axis; None: the origin.
    """
    return _around(quaternion_matrix(quaternion_about_axis(angle, np.asarray(direction)[:3])), point)


def rotation_from_matrix(matrix: ArrayLike) -> tuple[float, Vector, Vector]:
    """Return angle, direction and a point of the axis about which `matrix` rotates."""
    given = np.asarray(matrix, np.float64)
    x, y, z, w = quaternion_from_matrix(given)
    sine = math.sqrt(x * x + y * y + z * z)
    direction = np.array([x, y, z]) / sine if sine > EPS else np.array([1.0, 0.0, 0.0])
    point, *_ = np.linalg.lstsq(np.identity(3) - given[:3, :3], given[:3, 3], rcond=1e-9)
    return 2.0 * math.atan2(sine, w), direction, point


def reflection_matrix(point: ArrayLike, normal: ArrayLike) -> Matrix:
    """Return the matrix that mirrors at the plane through `point` with the normal vector `normal`."""
    return scale_matrix(-1.0, point, normal)


def reflection_from_matrix(matrix: ArrayLike) -> tuple[Vector, Vector]:
    """Return a point and the normal of the plane at which `matrix` mirrors. Raises ValueError if it does not mirror."""
    factor, origin, normal = scale_from_matrix(matrix)
    if normal is None or abs(factor + 1.0) > 1e-6:
        raise ValueError(f"this matrix is not a reflection: {np.asarray(matrix).tolist()}")
    return origin, normal


def scale_matrix(factor: float, origin: ArrayLike | None = None, direction: ArrayLike | None = None) -> Matrix:
    """Return the matrix that scales.

    Args:
        factor: Factor of all lengths.
        origin: The point that stays where it is; None: the origin.
        direction: The one direction that is scaled; None: all.
    """
    matrix = np.identity(4)
    if direction is None:
        matrix[:3, :3] *= factor
    else:
        along = unit_vector(np.asarray(direction)[:3])
        matrix[:3, :3] -= (1.0 - factor) * np.outer(along, along)
    return _around(matrix, origin)


def scale_from_matrix(matrix: ArrayLike) -> tuple[float, Vector, Vector | None]:
    """Return factor, origin and direction (None: all) with which `matrix` scales."""
    given = np.asarray(matrix, np.float64)
    part = given[:3, :3]
    if np.allclose(part, part[0, 0] * np.identity(3), rtol=0.0, atol=1e-9):
        factor, direction = float(part[0, 0]), None
    else:
        factor = float(np.trace(part)) - 2.0
        values, vectors = np.linalg.eigh((part + part.T) / 2.0)
        direction = vectors[:, int(np.argmin(abs(values - factor)))]
    origin, *_ = np.linalg.lstsq(np.identity(3) - part, given[:3, 3], rcond=1e-9)
    return factor, origin, direction


def _around(matrix: Matrix, point: ArrayLike | None) -> Matrix:
    """Return the matrix changed so that it leaves this point where it is, instead of the origin."""
    if point is not None:
        place = np.asarray(point, np.float64)[:3]
        matrix[:3, 3] = place - matrix[:3, :3] @ place
    return matrix


def concatenate_matrices(*matrices: ArrayLike) -> Matrix:
    """Return the product of `matrices`: the last one is the first to act."""
    product = np.identity(4)
    for each in matrices:
        product = product @ np.asarray(each, np.float64)
    return product


def inverse_matrix(matrix: ArrayLike) -> Matrix:
    """Return the inverse of `matrix`. Raises numpy.linalg.LinAlgError if there is none."""
    return np.linalg.inv(np.asarray(matrix, np.float64))


def is_same_transform(matrix0: ArrayLike, matrix1: ArrayLike) -> bool:
    """True if `matrix0` and `matrix1` do the same to every point."""
    one, other = np.asarray(matrix0, np.float64), np.asarray(matrix1, np.float64)
    return bool(np.allclose(one / one[3, 3], other / other[3, 3]))


def compose_matrix(
    scale: ArrayLike | None = None,
    shear: ArrayLike | None = None,
    angles: Angles | None = None,
    translate: ArrayLike | None = None,
    perspective: ArrayLike | None = None,
) -> Matrix:
    """Return the matrix that shears, scales, rotates, moves and projects, in this order; None leaves a part out.

    Args:
        scale: Factors along x, y and z.
        shear: Factors of shear xy, xz and yz.
        angles: Roll, pitch and yaw in radians.
        translate: The vector to move by.
        perspective: Last row of the matrix of the projection, four numbers.
    """
    matrix = np.identity(4)
    if shear is not None:
        matrix[(0, 0, 1), (1, 2, 2)] = np.asarray(shear)
    if scale is not None:
        matrix[:3, :3] = np.diag(np.asarray(scale, np.float64)) @ matrix[:3, :3]
    if angles is not None:
        matrix = euler_matrix(*angles) @ matrix
    if translate is not None:
        matrix = translation_matrix(translate) @ matrix
    if perspective is not None:
        outer = np.identity(4)
        outer[3] = np.asarray(perspective)
        matrix = outer @ matrix
    return matrix


def decompose_matrix(matrix: ArrayLike) -> tuple[Vector, Vector, Angles, Vector, Vector | None]:
    """Return the arguments of `compose_matrix` that make `matrix`, with None for a perspective that changes nothing.

    Raises ValueError for a matrix that flattens space.
    """
    given = np.asarray(matrix, np.float64)
    inner = np.vstack([given[:3], [0.0, 0.0, 0.0, 1.0]])
    rotation, scale, shear = split_matrix(inner[:3, :3])
    perspective = given[3] @ np.linalg.inv(inner)
    flat = np.allclose(perspective, [0.0, 0.0, 0.0, 1.0])
    return scale, shear, euler_from_matrix(rotation), inner[:3, 3], None if flat else perspective


def superimposition_matrix(v0: ArrayLike, v1: ArrayLike, scaling: bool = False, usesvd: bool = True) -> Matrix:
    """Return the rigid motion that brings points closest to others (least squares, by Kabsch's algorithm).

    Args:
        v0: The points to move; each column is a point.
        v1: The points to meet, as many.
        scaling: True: a uniform scale is found too.
        usesvd: Ignored; there for tf_transformations' signature.

    Raises:
        ValueError: if there are fewer than three points.
    """
    before, after = np.asarray(v0, np.float64)[:3], np.asarray(v1, np.float64)[:3]
    if before.shape != after.shape or before.ndim != 2 or before.shape[1] < 3:
        raise ValueError(f"expected two sets of three or more points, got shapes {before.shape} and {after.shape}")
    middle, goal = before.mean(axis=1), after.mean(axis=1)
    before, after = before - middle[:, None], after - goal[:, None]
    left, _, right = np.linalg.svd(after @ before.T)
    turn = left @ np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))]) @ right
    if scaling:
        turn *= math.sqrt(np.square(after).sum() / np.square(before).sum())
    matrix = np.identity(4)
    matrix[:3, :3], matrix[:3, 3] = turn, goal - turn @ middle
    return matrix
