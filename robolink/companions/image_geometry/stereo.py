"""Model of a stereo camera: two pinhole cameras side by side, and how far away is what both see."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from robolink.companions.image_geometry.pinhole import Matrix, PinholeCameraModel, mkmat
from robolink.image import ImageError
from robolink.interfaces.sensor_msgs.msg import CameraInfo


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
