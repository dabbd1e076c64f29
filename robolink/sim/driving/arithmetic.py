"""Elementary functions for formulas, once for floats and once for arrays.

A formula written with these serves one robot or a hundred at once, and gives the same bits either way: Python and
numpy both ask the C library for sines and cosines (not so for tangents, powers and hypotenuses), and a root is exact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from robolink.sim.arrays import Array

Number = TypeVar("Number", float, Array)

_SMALL = 1e-3
"""Square of x below which four terms of the series of sin(x) / x are exact."""


@dataclass(frozen=True)
class Arithmetic(Generic[Number]):
    """A set of functions of floats, or the same functions of arrays."""

    cos: Callable[[Number], Number]
    sin: Callable[[Number], Number]
    sinc: Callable[[Number], Number]
    clipped: Callable[[Number, Number], Number]
    where: Callable[[Any, Number, Number], Number]
    root: Callable[[Number], Number]


def sinc(x: float) -> float:
    """Return sin(x) / x: the chord of an arc that turns by 2x, as a share of the arc."""
    square = x * x
    if square < _SMALL:
        return 1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0 - square / 5040.0))
    return math.sin(x) / x


def clipped(value: float, limit: float) -> float:
    """Return a value clipped to [-limit, limit]."""
    return limit if value > limit else -limit if value < -limit else value


def _where(condition: bool, yes: float, no: float) -> float:
    return yes if condition else no


def _sincs(x: Array) -> Array:
    square = x * x
    series: Array = 1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0 - square / 5040.0))
    if square.max() < _SMALL:
        return series
    large = square >= _SMALL
    divisor = np.where(large, x, 1.0)
    return np.where(large, np.sin(divisor) / divisor, series)


def _all_clipped(values: Array, limits: Array) -> Array:
    clipped: Array = np.maximum(np.minimum(values, limits), -limits)
    return clipped


FLOATS = Arithmetic[float](math.cos, math.sin, sinc, clipped, _where, math.sqrt)
ARRAYS = Arithmetic[Array](np.cos, np.sin, _sincs, _all_clipped, np.where, np.sqrt)
