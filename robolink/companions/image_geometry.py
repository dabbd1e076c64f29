"""Package image_geometry of ROS 2: from points in space to pixels and back, by the calibration in a CameraInfo.

Names are those of ROS 2, in the spelling of Humble (`projectPixelTo3dRay`) and of Rolling (`project_pixel_to_3d_ray`).
All is numpy's but `rectifyImage`, which needs OpenCV.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from robolink.image import ImageError
from robolink.image.opencv import call, opencv
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.sensor_msgs.msg import CameraInfo, RegionOfInterest
from robolink.system.terminal import shown

__all__ = [
    "PinholeCameraModel",
    "StereoCameraModel",
]


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
"""Distance, in focal lengths, at which a place is found; and a step too small to be one."""


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
        model: Its distortion_model; all but a fisheye's are known by the number of coefficients, as OpenCV does.
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


Matrix = Any
"""A numpy.matrix, whose `*` is the product of matrices, as programs for image_geometry expect."""


def mkmat(rows: int, cols: int, L: Sequence[float]) -> Matrix:
    """Return numbers as a matrix.

    Args:
        rows: Number of rows.
        cols: Number of columns.
        L: The numbers, row by row.
    """
    return np.array(L, np.float64).reshape(rows, cols).view(np.matrix)


class PinholeCameraModel:
    """Camera without distortion, and the lens that comes before it. `fromCameraInfo` must be called first.

    `K` is the camera matrix of the raw image, `D` its distortion (None: none), `R` the rotation to the rectified image
    and `P` the projection to it. K and P are those of the image as it comes: of a region, and binned. `mapx` and `mapy`
    are where in the raw image each pixel of the rectified one is, once an image has been rectified.
    """

    def __init__(self) -> None:
        self.K: Matrix = None
        self.D: Matrix | None = None
        self.R: Matrix = None
        self.P: Matrix = None
        self.full_K: Matrix = None
        self.full_P: Matrix = None
        self.width = self.height = 0
        self.binning_x = self.binning_y = 1
        self.resolution = (0, 0)
        self.raw_roi = RegionOfInterest()
        self.tf_frame = ""
        self.stamp = Time()
        self.mapx = self.mapy = np.empty((0, 0), np.float32)
        self._lens = Lens()

    def from_camera_info(self, msg: CameraInfo) -> None:
        """Take the calibration from a message.

        Args:
            msg: The message of the topic camera_info.

        Raises:
            ImageError: if it is another message, or its distortion is unknown.
        """
        if not isinstance(msg, CameraInfo):
            raise ImageError(f"expected a sensor_msgs.msg.CameraInfo, got {type(msg).__name__}")
        self.mapx = self.mapy = np.empty((0, 0), np.float32)
        self._lens = lens_of(msg.distortion_model, msg.d)
        self.D = mkmat(len(msg.d), 1, msg.d) if len(msg.d) else None
        self.R = mkmat(3, 3, msg.r)
        self.K, self.full_K = mkmat(3, 3, msg.k), mkmat(3, 3, msg.k)
        self.P, self.full_P = mkmat(3, 4, msg.p), mkmat(3, 4, msg.p)
        self.width, self.height = self.resolution = (msg.width, msg.height)
        self.binning_x, self.binning_y = max(1, msg.binning_x), max(1, msg.binning_y)
        self.raw_roi = roi = copy.copy(msg.roi)
        if not (roi.x_offset or roi.y_offset or roi.width or roi.height):
            roi.width, roi.height = msg.width, msg.height
        self.tf_frame, self.stamp = msg.header.frame_id, msg.header.stamp
        for matrix in (self.K, self.P):
            matrix[0, 2] -= roi.x_offset
            matrix[1, 2] -= roi.y_offset
            matrix[0] /= self.binning_x
            matrix[1] /= self.binning_y

    def rectify_image(self, raw: NDArray[Any], rectified: NDArray[Any] | None = None) -> NDArray[Any]:
        """Return an image as a camera without distortion would have taken it; OpenCV does it.

        Args:
            raw: The image as it came.
            rectified: Array of the same shape and type that is filled; None: a new one.

        Raises:
            ImageError: without OpenCV, without a calibration, or if `rectified` is of another shape or type.
        """
        if rectified is not None and (rectified.shape, rectified.dtype) != (raw.shape, raw.dtype):
            raise ImageError(
                f"the rectified image must be like the raw one, {raw.shape} of {raw.dtype};"
                f" it is {rectified.shape} of {rectified.dtype}"
            )
        height, width = raw.shape[:2]
        if self.mapx.shape != (height, width):
            places = np.indices((height, width), np.float64)[::-1].reshape(2, -1)
            self.mapx, self.mapy = self._raw_places(places).astype(np.float32).reshape(2, height, width)
        cv2 = opencv("rectifying an image")
        made: NDArray[Any] = call(
            f"rectify {width} x {height} pixels", cv2.remap, raw, self.mapx, self.mapy, cv2.INTER_CUBIC, rectified
        )
        return made

    def rectify_point(self, uv_raw: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
        """Return where a pixel of the raw image is in the rectified one; NaN where no ray comes through the lens.

        Args:
            uv_raw: Column and row, in pixels.

        Raises:
            ImageError: without a calibration.
        """
        u, v = uv_raw
        camera = self._calibrated()
        places = np.linalg.solve(camera, np.array([[u], [v], [1.0]]))
        rays = self._lens.undistorted(places[:2] / places[2])
        seen = self._turned() @ np.vstack([rays, np.ones(1)])
        return np.asarray(seen[:2, 0] / seen[2, 0])

    def unrectify_point(self, uv_rect: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
        """Return where a pixel of the rectified image is in the raw one.

        Args:
            uv_rect: Column and row, in pixels.

        Raises:
            ImageError: without a calibration.
        """
        u, v = uv_rect
        return self._raw_places(np.array([[u], [v]], np.float64))[:, 0]

    def project_3d_to_pixel(self, point: Sequence[float]) -> tuple[float, float]:
        """Return the pixel of the rectified image that shows a point; (nan, nan) for one in the camera's plane.

        Args:
            point: x to the right, y down and z ahead, in m, in the optical frame.

        Raises:
            ImageError: before `fromCameraInfo`.
        """
        x, y, w = (float(each) for each in np.asarray(self.projection()) @ (point[0], point[1], point[2], 1.0))
        return (x / w, y / w) if w else (math.nan, math.nan)

    def project_pixel_to_3d_ray(self, uv: Sequence[float]) -> tuple[float, float, float]:
        """Return the direction, of length 1, in which a pixel of the rectified image looks.

        Args:
            uv: Column and row, in pixels.

        Raises:
            ImageError: without a calibration.
        """
        x = (uv[0] - self.cx()) / self.focal(0)
        y = (uv[1] - self.cy()) / self.focal(1)
        norm = math.sqrt(x * x + y * y + 1)
        return (x / norm, y / norm, 1.0 / norm)

    def get_delta_u(self, delta_x: float, z: float) -> float:
        """Return how many pixels a step to the right is; inf at a distance of 0.

        Args:
            delta_x: The step in m.
            z: Distance of the plane in m.
        """
        return self.fx() * delta_x / z if z else math.inf

    def get_delta_v(self, delta_y: float, z: float) -> float:
        """Return how many pixels a step down is; inf at a distance of 0.

        Args:
            delta_y: The step in m.
            z: Distance of the plane in m.
        """
        return self.fy() * delta_y / z if z else math.inf

    def get_delta_x(self, delta_u: float, z: float) -> float:
        """Return how long a step of pixels to the right is, in m.

        Args:
            delta_u: The step in pixels.
            z: Distance of the plane in m.
        """
        return z * delta_u / self.focal(0)

    def get_delta_y(self, delta_v: float, z: float) -> float:
        """Return how long a step of pixels down is, in m.

        Args:
            delta_v: The step in pixels.
            z: Distance of the plane in m.
        """
        return z * delta_v / self.focal(1)

    def full_resolution(self) -> tuple[int, int]:
        """Return width and height of the whole image, in pixels."""
        return self.resolution

    def intrinsic_matrix(self) -> Matrix:
        """Return K, the camera matrix of the raw image."""
        return self.K

    def distortion_coeffs(self) -> Matrix | None:
        """Return D, a column of coefficients; None without distortion."""
        return self.D

    def rotation_matrix(self) -> Matrix:
        """Return R, the rotation from the raw to the rectified image."""
        return self.R

    def projection_matrix(self) -> Matrix:
        """Return P, the projection to the rectified image."""
        return self.P

    def full_intrinsic_matrix(self) -> Matrix:
        """Return K of the whole image, without region and binning."""
        return self.full_K

    def full_projection_matrix(self) -> Matrix:
        """Return P of the whole image, without region and binning."""
        return self.full_P

    def cx(self) -> float:
        """Return the column of the optical axis, in pixels."""
        return float(self.projection()[0, 2])

    def cy(self) -> float:
        """Return the row of the optical axis, in pixels."""
        return float(self.projection()[1, 2])

    def fx(self) -> float:
        """Return the focal length in columns."""
        return float(self.projection()[0, 0])

    def fy(self) -> float:
        """Return the focal length in rows."""
        return float(self.projection()[1, 1])

    def tx(self) -> float:
        """Return the last number of P's first row: minus the baseline times the focal length, for a right camera."""
        return float(self.projection()[0, 3])

    def ty(self) -> float:
        """Return the last number of P's second row."""
        return float(self.projection()[1, 3])

    def fov_x(self) -> float:
        """Return the horizontal field of view, in radians."""
        return 2 * math.atan(self.width / (2 * self.focal(0)))

    def fov_y(self) -> float:
        """Return the vertical field of view, in radians."""
        return 2 * math.atan(self.height / (2 * self.focal(1)))

    def get_tf_frame(self) -> str:
        """Return the optical frame's name."""
        return self.tf_frame

    def projection(self) -> Matrix:
        """Return P. Raises ImageError before `fromCameraInfo`."""
        if self.P is None:
            raise ImageError("the camera model knows no camera yet: call fromCameraInfo(msg) with a CameraInfo first")
        return self.P

    def focal(self, axis: int) -> float:
        """Return a focal length of P, in pixels.

        Args:
            axis: 0 for columns, 1 for rows.

        Raises:
            ImageError: without a calibration.
        """
        length = float(self.projection()[axis, axis])
        if not length:
            raise ImageError("the camera is not calibrated: P of its CameraInfo has a focal length of 0")
        return length

    def _calibrated(self) -> NDArray[np.float64]:
        self.projection()
        if not (self.K[0, 0] and self.K[1, 1] and self.K[2, 2]):
            raise ImageError("the camera is not calibrated: K of its CameraInfo has a focal length of 0")
        return np.asarray(self.K)

    def _turned(self) -> NDArray[np.float64]:
        """Return the matrix from rays of the raw camera to the rectified image; no R at all is not a rotation."""
        self.focal(0), self.focal(1)
        rotation = np.asarray(self.R) if self.R.any() else np.eye(3)
        return np.asarray(np.asarray(self.projection())[:, :3] @ rotation)

    def _raw_places(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        camera = self._calibrated()
        rays = np.linalg.inv(self._turned()) @ np.vstack([places, np.ones(places.shape[1])])
        seen = np.vstack([self._lens.distorted(rays[:2] / rays[2]), np.ones(places.shape[1])])
        return np.asarray((camera @ seen)[:2])

    fromCameraInfo = from_camera_info
    rectifyImage = rectify_image
    rectifyPoint = rectify_point
    unrectifyPoint = unrectify_point
    project3dToPixel = project_3d_to_pixel
    projectPixelTo3dRay = project_pixel_to_3d_ray
    getDeltaU = get_delta_u
    getDeltaV = get_delta_v
    getDeltaX = get_delta_x
    getDeltaY = get_delta_y
    fullResolution = full_resolution
    intrinsicMatrix = intrinsic_matrix
    distortionCoeffs = distortion_coeffs
    rotationMatrix = rotation_matrix
    projectionMatrix = projection_matrix
    fullIntrinsicMatrix = full_intrinsic_matrix
    fullProjectionMatrix = full_projection_matrix
    Tx = tx
    Ty = ty
    fovX = fov_x
    fovY = fov_y
    tfFrame = get_tf_frame


class StereoCameraModel:
    """Two cameras side by side, whose rectified images have the same rows. `fromCameraInfo` must be called first.

    `left` and `right` are their models; `Q` maps (column, row, disparity, 1) of the left image to space.
    """

    def __init__(self) -> None:
        self.left = PinholeCameraModel()
        self.right = PinholeCameraModel()
        self.Q: Matrix = None

    def from_camera_info(self, left_msg: CameraInfo, right_msg: CameraInfo) -> None:
        """Take the calibration from the messages of both.

        Args:
            left_msg: The left camera's.
            right_msg: The right one's, whose P has the baseline.

        Raises:
            ImageError: if P has no baseline, and as with one camera.
        """
        self.left.from_camera_info(left_msg)
        self.right.from_camera_info(right_msg)
        baseline = -self.right.tx() / self.right.focal(0)
        if not baseline:
            raise ImageError("the right camera's CameraInfo has no baseline: p[3] is -baseline * p[0], and it is 0")
        self.Q = mkmat(4, 4, [0.0] * 16)
        self.Q[0, 0] = self.Q[1, 1] = 1.0
        self.Q[0, 3], self.Q[1, 3], self.Q[2, 3] = -self.left.cx(), -self.left.cy(), self.right.fx()
        self.Q[3, 2], self.Q[3, 3] = 1 / baseline, (self.right.cx() - self.left.cx()) / baseline

    def get_tf_frame(self) -> str:
        """Return the optical frame's name, the left camera's."""
        return self.left.get_tf_frame()

    def project_3d_to_pixel(self, point: Sequence[float]) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the pixels of the left and of the right image that show a point.

        Args:
            point: x to the right, y down and z ahead, in m, in the left camera's optical frame.
        """
        return (self.left.project_3d_to_pixel(point), self.right.project_3d_to_pixel(point))

    def project_pixel_to_3d(self, left_uv: Sequence[float], disparity: float) -> tuple[float, float, float]:
        """Return the point that a pixel of the left image shows, in m; (0, 0, 0) for one infinitely far away.

        Args:
            left_uv: Column and row, in pixels.
            disparity: How many columns further left the right image has it.

        Raises:
            ImageError: before `fromCameraInfo`.
        """
        self.left.projection()
        x, y, z, w = (float(each) for each in np.asarray(self.Q) @ (left_uv[0], left_uv[1], disparity, 1.0))
        return (x / w, y / w, z / w) if w else (0.0, 0.0, 0.0)

    def get_z(self, disparity: float) -> float:
        """Return the distance at which a point has a disparity, in m; inf for one infinitely far away.

        Args:
            disparity: How many columns further left the right image has it.
        """
        shift = disparity - (self.left.cx() - self.right.cx())
        return -self.right.tx() / shift if shift else math.inf

    def get_disparity(self, z: float) -> float:
        """Return how many columns further left the right image has a point; inf at a distance of 0.

        Args:
            z: Distance in m.
        """
        return -self.right.tx() / z + (self.left.cx() - self.right.cx()) if z else math.inf

    def get_left_camera(self) -> PinholeCameraModel:
        """Return the left camera's model."""
        return self.left

    def get_right_camera(self) -> PinholeCameraModel:
        """Return the right camera's model."""
        return self.right

    fromCameraInfo = from_camera_info
    tfFrame = get_tf_frame
    project3dToPixel = project_3d_to_pixel
    projectPixelTo3d = project_pixel_to_3d
    getZ = get_z
    getDisparity = get_disparity
