"""A picture of a tag that is 0.16 m wide, straight ahead: 160 pixels at a focal length of 500 are half a metre away."""

import cv2
import numpy as np

tag = cv2.aruco.generateImageMarker(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11), 3, 160)
image = np.full((480, 640), 255, np.uint8)
image[160:320, 240:400] = tag
matrix = np.array([[500.0, 0.0, 320.0], [0.0, 500.0, 240.0], [0.0, 0.0, 1.0]])

