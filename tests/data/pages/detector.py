"""Node that shows an image in a window."""

import cv2
import numpy as np
import rclpy
from rclpy.node import Node


class Detector(Node):
    def __init__(self):
        super().__init__("detector")
        self.create_timer(0.1, self.show)

    def show(self):
        cv2.imshow("WINDOW", np.zeros((48, 64, 3), np.uint8))
        cv2.waitKey(1)


def main():
    rclpy.init()
    rclpy.spin(Detector())


if __name__ == "__main__":
    main()
