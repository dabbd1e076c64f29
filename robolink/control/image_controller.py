"""Base class of nodes that drive a robot by its camera, image by image."""

from __future__ import annotations

from typing import Any

from robolink.control.sensor_controller import SensorController
from robolink.image import ImageError
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Image

LONGEST_GAP = 2.0
"""Longest time between two successive images, in seconds."""


class ImageController(SensorController):
    """Node that turns each image into a velocity command; stops the robot when images fail to come, and at its own end.

    A subclass implements `decide`. The topics are `camera/image_raw` and `cmd_vel`. The parameter `timeout` is the time
    without an image, in seconds, after which the robot stops until the next one. If none has come at all, a warning
    says so after five seconds. An image without pixels, or one for which `decide` raises ImageError (CvBridgeError is
    the same), stops the robot until a good one comes; a warning says why, once.

    Args:
        node_name: Name of the node.
        **options: Further arguments of `Node`.
    """

    def __init__(self, node_name: str, **options: Any) -> None:
        super().__init__(node_name, noun="image", topic="camera/image_raw", timeout=1.0, **options)
        self.last_stamp: float | None = None
        self.fault = ""
        """The fault of the last image; '' for none."""
        self.create_subscription(Image, "camera/image_raw", self.on_image, 10)

    def decide(self, message: Image, seconds: float) -> tuple[Twist, str]:
        """Return the next command for an image, and the reason in words.

        Args:
            message: The image.
            seconds: Seconds since the last one by their stamps, at most two; 0 if unknown.

        Raises:
            ImageError: if the image is not fit for a decision.
        """
        raise NotImplementedError

    def forget(self) -> None:
        """Forget earlier images, since no good one has come; a subclass that remembers more overrides this."""
        self.last_stamp = None

    def on_image(self, message: Image) -> None:
        """Call `decide` for an image, and publish its command.

        Args:
            message: The image.
        """
        stamp = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
        seconds = 0.0 if self.last_stamp is None else stamp - self.last_stamp
        self.last_stamp = stamp
        try:
            if not (message.width and message.height):
                raise ImageError(f"an image of {message.width} x {message.height} pixels shows nothing")
            twist, words = self.decide(message, seconds if 0.0 < seconds <= LONGEST_GAP else 0.0)
        except ImageError as error:
            self.refuse(str(error))
            return
        self.fault = ""
        self.command(twist, words)

    def refuse(self, fault: str) -> None:
        """Stop for an image that is of no use, and warn unless the one before was none either.

        Args:
            fault: The reason, as the middle of a line.
        """
        self.wind_up()
        self.forget()
        self.stop()
        if not self.fault:
            words = f"{self.topic}: {fault}: the robot stands until a good image comes"
            self.get_logger().warning(words, throttle_duration_sec=5.0)
        self.fault = fault
