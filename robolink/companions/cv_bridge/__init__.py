"""Package cv_bridge of ROS 2: images of messages as numpy arrays, as OpenCV has them, and back.

Names and conversions are those of ROS 2's. Most need numpy alone; OpenCV is imported for JPEG and PNG, Bayer patterns,
YUV, colour maps, and for the numbers of OpenCV's types, which differ between its versions. What upstream stumbles over
works: images that cannot be written to, rows with padding, and big endian with numpy 2.
"""

from robolink.companions.cv_bridge.core import CvBridge, CvBridgeError
from robolink.companions.cv_bridge.functions import cvtColorForDisplay, getCvType

__all__ = ["CvBridge", "CvBridgeError", "cvtColorForDisplay", "getCvType"]
