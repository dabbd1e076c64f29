"""Images for tests of nodes that see, and a camera that shows them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from robolink import Node
from robolink.image import to_message
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import Header

Pixels = npt.NDArray[np.uint8]

GREY, RED, PINK, GREEN, BLUE, YELLOW = (
    (115, 110, 110),
    (30, 30, 210),
    (90, 30, 210),
    (50, 150, 30),
    (210, 70, 30),
    (40, 200, 230),
)
"""Colours in the order blue, green, red; the hue of PINK is 170."""


def floor(*bars: tuple[tuple[int, int, int], slice], height: int = 120, width: int = 160) -> Pixels:
    """A grey image with bars of colours from its upper to its lower edge, each in some columns."""
    image = np.full((height, width, 3), GREY, np.uint8)
    for colour, columns in bars:
        image[:, columns] = colour
    return image


def thing(colour: tuple[int, int, int], rows: slice, columns: slice, image: Pixels | None = None) -> Pixels:
    """A grey image, or `image`, with a rectangle of a colour."""
    image = floor() if image is None else image.copy()
    image[rows, columns] = colour
    return image


class Camera(Node):
    """Publishes the image that it is told to, ten times a second, and hears what comes of it."""

    def __init__(self, **options: Any) -> None:
        super().__init__("camera", **options)
        self.shown: Image | None = to_message(floor(), "bgr8")
        self.is_stamped = True
        self.heard = list[Twist]()
        self.images = self.create_publisher(Image, "camera/image_raw", 10)
        self.create_subscription(Twist, "cmd_vel", self.heard.append, 100)
        self.create_timer(0.1, self.on_timer)

    def show(self, image: Pixels | Image | None, encoding: str = "bgr8") -> None:
        """Show an array, a message as it is, or nothing from now on."""
        self.shown = to_message(image, encoding) if isinstance(image, np.ndarray) else image

    def on_timer(self) -> None:
        if self.shown is not None:
            stamp = self.get_clock().now().to_msg()
            if self.is_stamped:
                self.shown.header = Header(stamp=stamp, frame_id="camera_optical_frame")
            self.images.publish(self.shown)


BAD: dict[str, tuple[Image, str]] = {
    "no pixels": (Image(encoding="bgr8"), "an image of 0 x 0 pixels shows nothing"),
    "no columns": (Image(encoding="bgr8", height=4), "an image of 0 x 4 pixels shows nothing"),
    "no encoding": (Image(height=2, width=2, step=6, data=bytes(12)), "encoding"),
    "unknown encoding": (Image(height=2, width=2, step=6, encoding="hsv8", data=bytes(12)), "hsv8"),
    "distances": (Image(height=2, width=2, step=8, encoding="32FC1", data=bytes(16)), "is not a color format"),
    "too few bytes": (Image(height=9, width=9, step=27, encoding="bgr8", data=bytes(5)), "wrongly formed"),
    "too short a step": (Image(height=2, width=9, step=3, encoding="bgr8", data=bytes(54)), "wrongly formed"),
}
"""Images that are no use, each with words of the reason."""
