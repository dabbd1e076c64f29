"""Cosine and sine by plain arithmetic: the same bits on every machine, whatever its numpy and processor.

For what a run must repeat to the last bit; libraries' own functions are quicker, and differ there from each other.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]

_QUARTER = math.pi / 2
_QUARTER_REST = 6.123233995736766e-17  # what pi/2 has beyond a float
_QUARTER_HEAD = float(np.float32(_QUARTER))
_QUARTER_TAIL = _QUARTER - _QUARTER_HEAD  # both parts times a small integer are exact
_SINE = [(-1.0) ** n / math.factorial(2 * n + 1) for n in range(9, -1, -1)]
_COSINE = [(-1.0) ** n / math.factorial(2 * n) for n in range(9, -1, -1)]


def cos_and_sin(angles: Array) -> tuple[Array, Array]:
    """Return cosines and sines of `angles` (radians) of a few turns, within a unit or two in the last place."""
    quarters = np.rint(angles / _QUARTER)
    rest = (angles - quarters * _QUARTER_HEAD - quarters * _QUARTER_TAIL) - quarters * _QUARTER_REST
    square = rest * rest
    cos, sin = _polynomial(_COSINE, square), rest * _polynomial(_SINE, square)
    turned = quarters.astype(np.intp) % 4
    return np.choose(turned, (cos, -sin, -cos, sin)), np.choose(turned, (sin, cos, -sin, -cos))


def cos_and_sin_of(angle: float) -> tuple[float, float]:
    """Return the cosine and sine of one `angle`: the same bits as `cos_and_sin`, and a tenth of the time."""
    quarters = round(angle / _QUARTER)
    rest = (angle - quarters * _QUARTER_HEAD - quarters * _QUARTER_TAIL) - quarters * _QUARTER_REST
    square, cos, sin = rest * rest, _COSINE[0], _SINE[0]
    for of_cosine, of_sine in zip(_COSINE[1:], _SINE[1:], strict=True):
        cos, sin = cos * square + of_cosine, sin * square + of_sine
    sin *= rest
    return ((cos, sin), (-sin, cos), (-cos, -sin), (sin, -cos))[quarters % 4]


def _polynomial(coefficients: list[float], x: Array) -> Array:
    value = np.full(len(x), coefficients[0])
    for coefficient in coefficients[1:]:
        value = value * x + coefficient
    return value
