"""Rotations: quaternions and Euler angles, with the names of tf_transformations.

Quaternions are x, y, z, w. Angles are radians. `axes` says how three Euler angles are meant: "s" (about static axes,
one after another) or "r" (about axes that turn along), then the three axes: "sxyz" is roll, pitch, yaw.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Quaternion: TypeAlias = tuple[float, float, float, float]
Angles: TypeAlias = tuple[float, float, float]
Numbers: TypeAlias = "Sequence[float] | NDArray[Any]"
Axes: TypeAlias = "str | tuple[int, int, int, int]"

_TINY = 1e-7
"""Gimbal lock: the sine below which two of three Euler angles turn about the same axis."""

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


# Euler angles


def euler_matrix(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Matrix:
    """Return the matrix of three Euler angles.

    Args:
        ai: First angle in radians.
        aj: Second angle in radians.
        ak: Third angle in radians.
        axes: The axes of the angles, as in the module's docstring.

    Raises:
        ValueError: if `axes` is unknown.
    """
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Quaternion:
    """Return the quaternion of three Euler angles.

    Args:
        ai: First angle in radians.
        aj: Second angle in radians.
        ak: Third angle in radians.
        axes: The axes of the angles, as in the module's docstring.

    Raises:
        ValueError: if `axes` is unknown.
    """
    i, j, k, _, _, is_static = _turning(axes)
    first, third = (ak, ai) if is_static else (ai, ak)
    return quaternion_multiply(quaternion_multiply(_elementary(i, first), _elementary(j, aj)), _elementary(k, third))


def _elementary(axis: int, angle: float) -> Quaternion:
    sine = math.sin(angle / 2.0)
    return sine * (axis == 0), sine * (axis == 1), sine * (axis == 2), math.cos(angle / 2.0)


def euler_from_quaternion(quaternion: Numbers, axes: Axes = "sxyz") -> Angles:
    """Return the three Euler angles of `quaternion` about `axes`. Raises ValueError for unknown axes."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def euler_from_matrix(matrix: ArrayLike, axes: Axes = "sxyz") -> Angles:
    """Return the three Euler angles of `matrix` about `axes`.

    In gimbal lock the last static, or first turning, angle is zero. Raises ValueError for unknown axes.
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
    """Return the quaternion that rotates by `angle` radians about `axis`, of any length but 0."""
    x, y, z = (unit_vector(axis) * math.sin(angle / 2.0)).tolist()
    return x, y, z, math.cos(angle / 2.0)


def quaternion_matrix(quaternion: Numbers) -> Matrix:
    """Return the rotation matrix of `quaternion`, of any length; of one that is all zero, the identity."""
    x, y, z, w = map(float, quaternion)
    square = x * x + y * y + z * z + w * w
    matrix = np.identity(4)
    if square > EPS:
        s = 2.0 / square
        matrix[:3, :3] = (
            (1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)),
            (s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)),
            (s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)),
        )
    return matrix


def quaternion_from_matrix(matrix: ArrayLike) -> Quaternion:
    """Return the unit quaternion of the rotation of `matrix`; its w is not negative."""
    rotation, _, _ = split_matrix(np.asarray(matrix, np.float64)[:3, :3])
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
    """Return the product of two quaternions: `quaternion0` rotates first, then `quaternion1`."""
    x1, y1, z1, w1 = map(float, quaternion1)
    x0, y0, z0, w0 = map(float, quaternion0)
    return (
        w1 * x0 + x1 * w0 + y1 * z0 - z1 * y0,
        w1 * y0 - x1 * z0 + y1 * w0 + z1 * x0,
        w1 * z0 + x1 * y0 - y1 * x0 + z1 * w0,
        w1 * w0 - x1 * x0 - y1 * y0 - z1 * z0,
    )


def quaternion_conjugate(quaternion: Numbers) -> Vector:
    """Return the conjugate of `quaternion`: x, y and z negated; of a unit quaternion this is the inverse."""
    return np.asarray(quaternion, np.float64) * (-1.0, -1.0, -1.0, 1.0)


def quaternion_inverse(quaternion: Numbers) -> Vector:
    """Return the inverse of `quaternion`: their product is 0, 0, 0, 1."""
    return np.asarray(quaternion_conjugate(quaternion) / np.dot(quaternion, quaternion))


def quaternion_slerp(
    quat0: Numbers, quat1: Numbers, fraction: float, spin: int = 0, shortestpath: bool = True
) -> Vector:
    """Return the spherical linear interpolation between two rotations.

    Args:
        quat0: The rotation at fraction 0.
        quat1: The rotation at fraction 1.
        fraction: Place on the arc from one to the other, 0 to 1.
        spin: Number of half turns that the arc makes more.
        shortestpath: True: the shorter of the two arcs.
    """
    one, other = unit_vector(quat0), unit_vector(quat1)
    cosine = float(np.dot(one, other))
    if cosine < 0.0 and shortestpath:
        cosine, other = -cosine, -other
    if fraction in (0.0, 1.0):
        return np.asarray(one if fraction == 0.0 else unit_vector(quat1))
    angle = math.acos(max(-1.0, min(1.0, cosine))) + spin * math.pi
    sine = math.sin(angle)
    if abs(abs(cosine) - 1.0) < EPS or sine == 0.0:
        return np.asarray(one)
    return np.asarray((math.sin((1.0 - fraction) * angle) * one + math.sin(fraction * angle) * other) / sine)


def random_quaternion(rand: Numbers | None = None) -> Vector:
    """Return a uniformly distributed random rotation, made from `rand`, three numbers in [0, 1); None draws them."""
    u, v, w = np.random.random(3) if rand is None else rand
    a, b = math.sqrt(1.0 - u), math.sqrt(u)
    s, t = 2.0 * math.pi * v, 2.0 * math.pi * w
    return np.array([a * math.sin(s), a * math.cos(s), b * math.sin(t), b * math.cos(t)])


def random_rotation_matrix(rand: Numbers | None = None) -> Matrix:
    """Return the matrix of a random rotation, made from `rand` as in `random_quaternion`."""
    return quaternion_matrix(random_quaternion(rand))


Matrix: TypeAlias = NDArray[Any]
Vector: TypeAlias = NDArray[Any]

EPS = np.finfo(float).eps * 4.0
"""Largest size of a number that counts as 0."""


def vector_norm(data: ArrayLike, axis: int | None = None, out: Vector | None = None) -> Any:
    """Return the Euclidean norm of a vector as a float, or of an array as an array.

    Args:
        data: A vector, or an array of vectors.
        axis: Axis along which an array's norms are taken; None: of all its numbers.
        out: Array that takes the result; then None is returned.
    """
    squares = np.square(np.asarray(data, np.float64))
    if out is not None:
        np.sqrt(squares.sum(axis=axis), out)
        return None
    return math.sqrt(squares.sum()) if squares.ndim == 1 else np.atleast_1d(np.sqrt(squares.sum(axis=axis)))


def unit_vector(data: ArrayLike, axis: int | None = None, out: Vector | None = None) -> Any:
    """Return a vector of length 1 in the same direction.

    Args:
        data: A vector, or an array of vectors.
        axis: Axis along which an array's vectors lie; None: all its numbers are one vector.
        out: Array that takes the result; then None is returned.
    """
    given = np.array(data, np.float64)
    scaled = given / np.sqrt(np.square(given).sum(axis=axis, keepdims=given.ndim > 1))
    if out is None:
        return scaled
    out[...] = scaled
    return None


def random_vector(size: Any) -> Vector:
    """Return an array of shape `size` of random numbers, uniform in [0, 1)."""
    return np.asarray(np.random.random(size))


def split_matrix(matrix: Matrix) -> tuple[Matrix, Vector, Vector]:
    """Return the rotation, scales and shears that make a 3x3 `matrix`. Raises ValueError if it flattens space."""
    rotation, upper = np.linalg.qr(matrix)
    signs = np.where(np.diag(upper) < 0.0, -1.0, 1.0)
    rotation, upper = rotation * signs, upper * signs[:, None]
    if np.linalg.det(rotation) < 0.0:  # it mirrors: x takes the minus
        rotation[:, 0], upper[0] = -rotation[:, 0], -upper[0]
    scale = np.diag(upper).copy()
    if np.any(abs(scale) < EPS):
        raise ValueError(f"a matrix that flattens space cannot be decomposed: {matrix.tolist()}")
    shear = upper / scale[:, None]
    return rotation, scale, shear[(0, 0, 1), (1, 2, 2)]
