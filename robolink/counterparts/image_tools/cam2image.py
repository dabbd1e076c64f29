"""Publish the pictures of a camera on /image; where there is none, drawn ones.

robolink run image_tools cam2image --ros-args -p burger_mode:=true
"""

from __future__ import annotations

from typing import Any

import numpy as np

from robolink.counterparts.image_tools.burger import Picture, render
from robolink.counterparts.image_tools.settings import declared_qos
from robolink.counterparts.program import spin_program
from robolink.exceptions import RobolinkError
from robolink.image import to_message
from robolink.image.opencv import opencv
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import Bool
from robolink.node import Node
from robolink.parameters.descriptors import described
from robolink.qos import QoSProfile, qos_profile_sensor_data


class Cam2Image(Node):
    """A node that publishes pictures. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("cam2image", **options)
        self._camera: Any = None
        try:
            self._set_up()
        except RobolinkError:
            self.destroy_node()
            raise

    def _set_up(self) -> None:
        qos: QoSProfile = declared_qos(self)
        frequency = self._declare("frequency", 30.0, "pictures a second, in Hz", 0.01, 1000.0)
        self._width = self._declare("width", 320, "width in pixels", 1, 8192)
        self._height = self._declare("height", 240, "height in pixels", 1, 8192)
        is_drawn = self._declare("burger_mode", False, "draw pictures, and use no camera")
        device = self._declare("device_id", 0, "number of the camera")
        self._frame = self._declare("frame_id", "camera_frame", "frame of the pictures")
        self._shows = self._declare("show_camera", False, "show the pictures in a window, too")
        if not is_drawn:
            self._camera = self._open(device)
        self._is_flipped, self._number = False, 0
        self._images = self.create_publisher(Image, "image", qos)
        self.create_subscription(Bool, "flip_image", self.on_flip, qos_profile_sensor_data)
        self.create_timer(1.0 / frequency, self.on_timer)

    def _declare(self, name: str, default: Any, words: str, low: Any = None, high: Any = None) -> Any:
        return self.declare_parameter(name, default, described(words, low, high)).value

    def _open(self, device: int) -> Any:
        """Return the camera; None, with a warning, where there is none."""
        try:
            cv2 = opencv("a camera")
        except RobolinkError as error:
            self.get_logger().warning(f"{error}; drawn pictures are published")
            return None
        camera = cv2.VideoCapture(device)
        if not camera.isOpened():
            self.get_logger().warning(f"Could not open video stream {device}: drawn pictures are published")
            return None
        camera.set(cv2.CAP_PROP_FRAME_WIDTH, float(self._width))
        camera.set(cv2.CAP_PROP_FRAME_HEIGHT, float(self._height))
        return camera

    def on_flip(self, message: Bool) -> None:
        """Mirror the pictures from now on, or no longer."""
        self._is_flipped = message.data
        self.get_logger().info(f"Set flip mode to: {'on' if message.data else 'off'}")

    def _picture(self) -> Picture | None:
        if self._camera is None:
            return render(self._width, self._height, self._number)
        is_there, picture = self._camera.read()
        return picture if is_there else None

    def on_timer(self) -> None:
        """Publish a picture, if the camera has one."""
        picture = self._picture()
        if picture is None:
            return
        if self._is_flipped:
            picture = np.ascontiguousarray(picture[:, ::-1])
        message = to_message(picture, "bgr8")
        message.header.stamp, message.header.frame_id = self.get_clock().now().to_msg(), self._frame
        self._number += 1
        self.get_logger().info(f"Publishing image #{self._number}")
        self._images.publish(message)
        if self._shows:
            cv2 = opencv("a window")
            cv2.imshow("cam2image", picture)
            cv2.waitKey(1)

    def destroy_node(self) -> None:
        """Release the camera, too."""
        if self._camera is not None:
            self._camera.release()
            self._camera = None
        super().destroy_node()


def main(args: list[str] | None = None) -> None:
    """Publish pictures until Ctrl-C."""
    spin_program(lambda words: Cam2Image(), args)


if __name__ == "__main__":
    main()
