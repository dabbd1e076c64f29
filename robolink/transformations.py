"""Rotations and homogeneous matrices: what programs call from tf_transformations.

Quaternions are x, y, z, w. Angles are radians. Matrices are 4x4 and act on columns. Vectors, matrices and quaternions
may be given as any sequences. `axes` says how three Euler angles are meant: "s" (about static axes, one after another)
or "r" (about axes that turn along), then the three axes: "sxyz" is roll, pitch, yaw.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Matrix: TypeAlias = NDArray[Any]
Vector: TypeAlias = NDArray[Any]
Quaternion: TypeAlias = tuple[float, float, float, float]
Angles: TypeAlias = tuple[float, float, float]
Numbers: TypeAlias = "Sequence[float] | NDArray[Any]"
Axes: TypeAlias = "str | tuple[int, int, int, int]"

_EPS = np.finfo(float).eps * 4.0
_TINY = 1e-7
"""A sine below this is gimbal lock: two of three angles turn about the same axis."""

_NEXT = (1, 2, 0, 1)


def _letters(code: tuple[int, int, int, int]) -> str:
    """Spell axes that are coded as first axis, parity, repetition and frame."""
    first, parity, repetition, frame = code
    second, third = _NEXT[first + parity], _NEXT[first - parity + 1]
    order = "".join("xyz"[each] for each in (first, second, first if repetition else third))
    return f"r{order[::-1]}" if frame else f"s{order}"


_AXES2TUPLE = {_letters(code): code for code in itertools.product(range(3), (0, 1), (0, 1), (0, 1))}
_TUPLE2AXES = {code: name for name, code in _AXES2TUPLE.items()}


def _turning(axes: Axes) -> tuple[int, int, int, int, float, bool]:
    """Read axes as turning ones: first, second, third, the axis left over, the sign of their order, and if reversed."""
    name = axes.lower() if isinstance(axes, str) else _TUPLE2AXES.get(tuple(axes))  # type: ignore[arg-type]
    if name not in _AXES2TUPLE:
        raise ValueError(f"axes: expected one of {', '.join(sorted(_AXES2TUPLE))}, got {axes!r}")
    is_static = name[0] == "s"
    i, j, k = ("xyz".index(each) for each in (name[:0:-1] if is_static else name[1:]))
    other = 3 - i - j
    return i, j, k, other, 1.0 if (j - i) % 3 == 1 else -1.0, is_static


# Vectors


def vector_norm(data: ArrayLike, axis: int | None = None, out: Vector | None = None) -> Any:
    """Give the length: of a vector a float, of an array along `axis`; into `out`, if that is given."""
    squares = np.square(np.asarray(data, np.float64))
    if out is not None:
        np.sqrt(squares.sum(axis=axis), out)
        return None
    return math.sqrt(squares.sum()) if squares.ndim == 1 else np.atleast_1d(np.sqrt(squares.sum(axis=axis)))


def unit_vector(data: ArrayLike, axis: int | None = None, out: Vector | None = None) -> Any:
    """Give a vector of length 1 in the same direction; of an array along `axis`; into `out`, if that is given."""
    given = np.array(data, np.float64)
    scaled = given / np.sqrt(np.square(given).sum(axis=axis, keepdims=given.ndim > 1))
    if out is None:
        return scaled
    out[...] = scaled
    return None


def random_vector(size: Any) -> Vector:
    """Give random numbers from 0 to below 1."""
    return np.asarray(np.random.random(size))


# Matrices


def identity_matrix() -> Matrix:
    """Give the matrix that changes nothing."""
    return np.identity(4)


def translation_matrix(direction: ArrayLike) -> Matrix:
    """Give the matrix that moves by a vector."""
    matrix = np.identity(4)
    matrix[:3, 3] = np.asarray(direction)[:3]
    return matrix


def translation_from_matrix(matrix: ArrayLike) -> Vector:
    """Give the vector by which a matrix moves."""
    return np.array(np.asarray(matrix, np.float64)[:3, 3])


def rotation_matrix(angle: float, direction: ArrayLike, point: ArrayLike | None = None) -> Matrix:
    """Give the matrix that rotates about an axis of this direction, through a point or the origin."""
    return _around(quaternion_matrix(quaternion_about_axis(angle, np.asarray(direction)[:3])), point)


def rotation_from_matrix(matrix: ArrayLike) -> tuple[float, Vector, Vector]:
    """Give angle, direction and a point of the axis about which a matrix rotates."""
    given = np.asarray(matrix, np.float64)
    x, y, z, w = quaternion_from_matrix(given)
    sine = math.sqrt(x * x + y * y + z * z)
    direction = np.array([x, y, z]) / sine if sine > _EPS else np.array([1.0, 0.0, 0.0])
    point, *_ = np.linalg.lstsq(np.identity(3) - given[:3, :3], given[:3, 3], rcond=1e-9)
    return 2.0 * math.atan2(sine, w), direction, point


def reflection_matrix(point: ArrayLike, normal: ArrayLike) -> Matrix:
    """Give the matrix that mirrors at the plane through a point, with this normal."""
    return scale_matrix(-1.0, point, normal)


def reflection_from_matrix(matrix: ArrayLike) -> tuple[Vector, Vector]:
    """Give a point and the normal of the plane at which a matrix mirrors. Raises ValueError if it does not."""
    factor, origin, normal = scale_from_matrix(matrix)
    if normal is None or abs(factor + 1.0) > 1e-6:
        raise ValueError(f"this matrix is no reflection: {np.asarray(matrix).tolist()}")
    return origin, normal


def scale_matrix(factor: float, origin: ArrayLike | None = None, direction: ArrayLike | None = None) -> Matrix:
    """Give the matrix that scales around an origin, in all directions or in one."""
    matrix = np.identity(4)
    if direction is None:
        matrix[:3, :3] *= factor
    else:
        along = unit_vector(np.asarray(direction)[:3])
        matrix[:3, :3] -= (1.0 - factor) * np.outer(along, along)
    return _around(matrix, origin)


def scale_from_matrix(matrix: ArrayLike) -> tuple[float, Vector, Vector | None]:
    """Give factor, origin and direction (None: all) with which a matrix scales."""
    given = np.asarray(matrix, np.float64)
    part = given[:3, :3]
    if np.allclose(part, part[0, 0] * np.identity(3)):
        factor, direction = float(part[0, 0]), None
    else:
        factor = float(np.trace(part)) - 2.0
        values, vectors = np.linalg.eigh((part + part.T) / 2.0)
        direction = vectors[:, int(np.argmin(abs(values - factor)))]
    origin, *_ = np.linalg.lstsq(np.identity(3) - part, given[:3, 3], rcond=1e-9)
    return factor, origin, direction


def _around(matrix: Matrix, point: ArrayLike | None) -> Matrix:
    """Have a matrix leave this point where it is, instead of the origin."""
    if point is not None:
        place = np.asarray(point, np.float64)[:3]
        matrix[:3, 3] = place - matrix[:3, :3] @ place
    return matrix


def concatenate_matrices(*matrices: ArrayLike) -> Matrix:
    """Give the product: the last matrix is the first to act."""
    product = np.identity(4)
    for each in matrices:
        product = product @ np.asarray(each, np.float64)
    return product


def inverse_matrix(matrix: ArrayLike) -> Matrix:
    """Give the matrix that undoes this one. Raises numpy.linalg.LinAlgError where there is none."""
    return np.linalg.inv(np.asarray(matrix, np.float64))


def is_same_transform(matrix0: ArrayLike, matrix1: ArrayLike) -> bool:
    """Say whether two matrices do the same to every point."""
    one, other = np.asarray(matrix0, np.float64), np.asarray(matrix1, np.float64)
    return bool(np.allclose(one / one[3, 3], other / other[3, 3]))


def compose_matrix(
    scale: ArrayLike | None = None,
    shear: ArrayLike | None = None,
    angles: Angles | None = None,
    translate: ArrayLike | None = None,
    perspective: ArrayLike | None = None,
) -> Matrix:
    """Give the matrix that shears (xy, xz, yz), scales, rotates (roll, pitch, yaw) and moves, in this order."""
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
    """Give what `compose_matrix` makes a matrix of; None for a perspective where there is none.

    Raises ValueError for a matrix that flattens space.
    """
    given = np.asarray(matrix, np.float64)
    inner = np.vstack([given[:3], [0.0, 0.0, 0.0, 1.0]])
    rotation, scale, shear = _parts(inner[:3, :3])
    perspective = given[3] @ np.linalg.inv(inner)
    flat = np.allclose(perspective, [0.0, 0.0, 0.0, 1.0])
    return scale, shear, euler_from_matrix(rotation), inner[:3, 3], None if flat else perspective


def _parts(matrix: Matrix) -> tuple[Matrix, Vector, Vector]:
    """Part a 3x3 matrix into a rotation, scales and shears."""
    rotation, upper = np.linalg.qr(matrix)
    signs = np.where(np.diag(upper) < 0.0, -1.0, 1.0)
    rotation, upper = rotation * signs, upper * signs[:, None]
    if np.linalg.det(rotation) < 0.0:  # it mirrors: x takes the minus
        rotation[:, 0], upper[0] = -rotation[:, 0], -upper[0]
    scale = np.diag(upper).copy()
    if np.any(abs(scale) < _EPS):
        raise ValueError(f"a matrix that flattens space cannot be decomposed: {matrix.tolist()}")
    shear = upper / scale[:, None]
    return rotation, scale, shear[(0, 0, 1), (1, 2, 2)]


def superimposition_matrix(v0: ArrayLike, v1: ArrayLike, scaling: bool = False, usesvd: bool = True) -> Matrix:
    """Give the rigid motion, on request with a scale, that brings points v0 closest to v1; points are columns.

    Kabsch's algorithm, whatever `usesvd` says. Raises ValueError for fewer than three points.
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


# Euler angles


def euler_matrix(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Matrix:
    """Give the matrix of three Euler angles. Raises ValueError for unknown axes."""
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Quaternion:
    """Give the quaternion of three Euler angles. Raises ValueError for unknown axes."""
    i, j, k, _, _, is_static = _turning(axes)
    first, third = (ak, ai) if is_static else (ai, ak)
    return quaternion_multiply(quaternion_multiply(_elementary(i, first), _elementary(j, aj)), _elementary(k, third))


def _elementary(axis: int, angle: float) -> Quaternion:
    sine = math.sin(angle / 2.0)
    return sine * (axis == 0), sine * (axis == 1), sine * (axis == 2), math.cos(angle / 2.0)


def euler_from_quaternion(quaternion: Numbers, axes: Axes = "sxyz") -> Angles:
    """Give the three Euler angles of a quaternion. Raises ValueError for unknown axes."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def euler_from_matrix(matrix: ArrayLike, axes: Axes = "sxyz") -> Angles:
    """Give the three Euler angles of a matrix; in gimbal lock the last static, or first turning, angle is zero.

    Raises ValueError for unknown axes.
    """
    i, j, k, other, sign, is_static = _turning(axes)
    m = np.asarray(matrix, np.float64).tolist()
    if i == k:
        sine = math.hypot(m[i][j], m[i][other])
        second, locked = math.atan2(sine, m[i][i]), sine < _TINY
        first, third = math.atan2(m[j][i], -sign * m[other][i]), math.atan2(m[i][j], sign * m[i][other])
        if locked:
            first, third = 0.0, math.atan2(-sign * m[j][other], m[j][j])
    else:
        cosine = math.hypot(m[i][i], m[i][j])
        second, locked = math.atan2(sign * m[i][k], cosine), cosine < _TINY
        first, third = math.atan2(-sign * m[j][k], m[k][k]), math.atan2(-sign * m[i][j], m[i][i])
        if locked:
            first, third = 0.0, math.atan2(sign * m[j][i], m[j][j])
    return (third, second, first) if is_static else (first, second, third)


# Quaternions


def quaternion_about_axis(angle: float, axis: ArrayLike) -> Quaternion:
    """Give the quaternion that rotates by an angle about an axis."""
    x, y, z = (unit_vector(axis) * math.sin(angle / 2.0)).tolist()
    return x, y, z, math.cos(angle / 2.0)


def quaternion_matrix(quaternion: Numbers) -> Matrix:
    """Give the matrix of a quaternion of any length; of one that is all zero, the identity."""
    x, y, z, w = map(float, quaternion)
    square = x * x + y * y + z * z + w * w
    matrix = np.identity(4)
    if square > _EPS:
        s = 2.0 / square
        matrix[:3, :3] = (
            (1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)),
            (s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)),
            (s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)),
        )
    return matrix


def quaternion_from_matrix(matrix: ArrayLike) -> Quaternion:
    """Give the unit quaternion of a matrix's rotation; its w is not negative."""
    rotation, _, _ = _parts(np.asarray(matrix, np.float64)[:3, :3])
    (a, b, c), (d, e, f), (g, h, i) = rotation.tolist()
    # Four times the products of each two components: the row of the largest is the quaternion, up to its length.
    rows = (
        (1.0 + a - e - i, b + d, c + g, h - f),
        (b + d, 1.0 - a + e - i, f + h, c - g),
        (c + g, f + h, 1.0 - a - e + i, d - b),
        (h - f, c - g, d - b, 1.0 + a + e + i),
    )
    largest = max(range(4), key=lambda at: rows[at][at])
    length = math.copysign(math.sqrt(sum(each * each for each in rows[largest])), rows[largest][3])
    x, y, z, w = (each / length for each in rows[largest])
    return x, y, z, w


def quaternion_multiply(quaternion1: Numbers, quaternion0: Numbers) -> Quaternion:
    """Give the product: `quaternion0` rotates first, `quaternion1` then."""
    x1, y1, z1, w1 = map(float, quaternion1)
    x0, y0, z0, w0 = map(float, quaternion0)
    return (
        w1 * x0 + x1 * w0 + y1 * z0 - z1 * y0,
        w1 * y0 - x1 * z0 + y1 * w0 + z1 * x0,
        w1 * z0 + x1 * y0 - y1 * x0 + z1 * w0,
        w1 * w0 - x1 * x0 - y1 * y0 - z1 * z0,
    )


def quaternion_conjugate(quaternion: Numbers) -> Vector:
    """Give the quaternion with x, y and z negated: for a unit quaternion, what undoes it."""
    return np.asarray(quaternion, np.float64) * (-1.0, -1.0, -1.0, 1.0)


def quaternion_inverse(quaternion: Numbers) -> Vector:
    """Give the quaternion whose product with this one is 0, 0, 0, 1."""
    return np.asarray(quaternion_conjugate(quaternion) / np.dot(quaternion, quaternion))


def quaternion_slerp(
    quat0: Numbers, quat1: Numbers, fraction: float, spin: int = 0, shortestpath: bool = True
) -> Vector:
    """Give what lies at `fraction` on the arc from one rotation (0) to the other (1).

    The arc makes `spin` half turns more, and is the shorter of two unless `shortestpath` is False.
    """
    one, other = unit_vector(quat0), unit_vector(quat1)
    cosine = float(np.dot(one, other))
    if cosine < 0.0 and shortestpath:
        cosine, other = -cosine, -other
    if fraction in (0.0, 1.0):
        return np.asarray(one if fraction == 0.0 else unit_vector(quat1))
    angle = math.acos(max(-1.0, min(1.0, cosine))) + spin * math.pi
    sine = math.sin(angle)
    if abs(abs(cosine) - 1.0) < _EPS or sine == 0.0:
        return np.asarray(one)
    return np.asarray((math.sin((1.0 - fraction) * angle) * one + math.sin(fraction * angle) * other) / sine)


def random_quaternion(rand: Numbers | None = None) -> Vector:
    """Give a random rotation, every one as likely as any other; `rand` may be three numbers from 0 to 1."""
    u, v, w = np.random.random(3) if rand is None else rand
    a, b = math.sqrt(1.0 - u), math.sqrt(u)
    s, t = 2.0 * math.pi * v, 2.0 * math.pi * w
    return np.array([a * math.sin(s), a * math.cos(s), b * math.sin(t), b * math.cos(t)])


def random_rotation_matrix(rand: Numbers | None = None) -> Matrix:
    """Give the matrix of a random rotation; see `random_quaternion`."""
    return quaternion_matrix(random_quaternion(rand))
