"""Package image_geometry of ROS 2: from points in space to pixels and back, by the calibration in a CameraInfo.

Names are those of ROS 2, in the spelling of Humble (`projectPixelTo3dRay`) and of Rolling (`project_pixel_to_3d_ray`).
All is numpy's but `rectifyImage`, which needs OpenCV.
"""

from robolink.companions.image_geometry.pinhole import PinholeCameraModel
from robolink.companions.image_geometry.stereo import StereoCameraModel

__all__ = ["PinholeCameraModel", "StereoCameraModel"]
