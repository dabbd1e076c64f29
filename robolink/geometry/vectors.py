"""Vectors: lengths and directions; and the types of vectors and matrices."""

from __future__ import annotations

import math
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

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
