"""Distortion of a lens: where a ray meets the image, and which ray a place in the image is of."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from robolink.image import ImageError
from robolink.system.terminal import shown

Points = NDArray[np.float64]
"""Places in the plane one focal length away, as an array of (2, number)."""

FISHEYE = ("equidistant", "fisheye")
"""Models in which the distance from the centre grows with the angle, with four coefficients."""
KNOWN = (4, 5, 8, 12)
"""Numbers of coefficients that OpenCV's model has; 14 are known if the last two, a tilted sensor, are 0."""

_STAGES, _STEPS = 10, 5
_STEP = 1e-6
"""Distance to the neighbours from which a slope is taken, in focal lengths."""
_NEAR, _TINY = 1e-9, 1e-12
"""Distance, in focal lengths, at which a place is found; and a step that is no step."""


class Lens(NamedTuple):
    """Distortion of a lens.

    Args:
        is_fisheye: True for the fisheye's model, False for OpenCV's common one.
        coefficients: Four for a fisheye, else twelve: k1, k2, p1, p2, k3 to k6, s1 to s4.
    """

    is_fisheye: bool = False
    coefficients: tuple[float, ...] = (0.0,) * 12

    def distorted(self, points: Points) -> Points:
        """Return where the lens puts rays.

        Args:
            points: Rays without distortion: x / z and y / z.
        """
        return _fisheye(points, self.coefficients) if self.is_fisheye else _radial(points, self.coefficients)

    def undistorted(self, points: Points) -> Points:
        """Return the rays that the lens puts there; NaN for places that no ray reaches.

        Newton's method, from the centre outwards: a strong distortion has other rays, far outside, for the same place.

        Args:
            points: Places with distortion.
        """
        if not any(self.coefficients) and not self.is_fisheye:
            return points
        found: Points = np.zeros_like(points)
        with np.errstate(all="ignore"):
            for share in np.linspace(0, 1, _STAGES + 1)[1:]:
                for _ in range(_STEPS):
                    step = self._solved(found, self.distorted(found) - share * points)
                    found -= step
                    if not np.abs(step).max() > _TINY:
                        break
            missed = np.abs(self.distorted(found) - points).max(axis=0)
            a, b, c, d = self._slopes(found)
            reached = (missed < _NEAR) & (a * d > b * c) & ((found * points).sum(axis=0) >= 0)
        found[:, ~reached] = np.nan
        return found

    def _solved(self, points: Points, missed: Points) -> Points:
        """Return the step that would take away what is missed, if the lens were linear around the points."""
        a, b, c, d = self._slopes(points)
        step: Points = np.array([d * missed[0] - b * missed[1], a * missed[1] - c * missed[0]]) / (a * d - b * c)
        return step

    def _slopes(self, points: Points) -> Points:
        """Return the Jacobian matrix around each point, row by row."""
        across, down = np.array([[_STEP], [0.0]]), np.array([[0.0], [_STEP]])
        by_x = (self.distorted(points + across) - self.distorted(points - across)) / (2 * _STEP)
        by_y = (self.distorted(points + down) - self.distorted(points - down)) / (2 * _STEP)
        return np.array([by_x[0], by_y[0], by_x[1], by_y[1]])


def lens_of(model: str, coefficients: Any) -> Lens:
    """Return the lens of a CameraInfo.

    Args:
        model: Its distortion_model; all but a fisheye's are told apart by the number of coefficients, as OpenCV does.
        coefficients: Its d.

    Raises:
        ImageError: for a number of coefficients that no model has, or a tilted sensor.
    """
    values = tuple(float(each) for each in coefficients)
    if model in FISHEYE:
        if len(values) not in (0, 4):
            raise ImageError(f"a camera that is {model} has 4 coefficients of distortion, not {len(values)}")
        return Lens(True, values or (0.0,) * 4)
    if len(values) == 14 and not any(values[12:]):
        values = values[:12]
    if values and len(values) not in KNOWN:
        counts = ", ".join(str(each) for each in KNOWN)
        raise ImageError(f"distortion {shown(model, 40)} has {len(values)} coefficients; {counts} are understood")
    return Lens(False, values + (0.0,) * (12 - len(values)))


def _radial(points: Points, coefficients: tuple[float, ...]) -> Points:
    k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4 = coefficients
    x, y = points
    square = x * x + y * y
    away = (1 + square * (k1 + square * (k2 + square * k3))) / (1 + square * (k4 + square * (k5 + square * k6)))
    aside = 2 * x * y
    return np.array(
        [
            x * away + p1 * aside + p2 * (square + 2 * x * x) + square * (s1 + square * s2),
            y * away + p1 * (square + 2 * y * y) + p2 * aside + square * (s3 + square * s4),
        ]
    )


def _fisheye(points: Points, coefficients: tuple[float, ...]) -> Points:
    k1, k2, k3, k4 = coefficients
    distance = np.hypot(*points)
    angle = np.arctan(distance)
    square = angle * angle
    bent = angle * (1 + square * (k1 + square * (k2 + square * (k3 + square * k4))))
    far = distance > _NEAR
    scale = np.where(far, bent / np.where(far, distance, 1.0), 1.0)
    return np.asarray(points * scale)
