"""Show the pictures of /image in a window; without a window system they are on a topic, for `robolink view`.

robolink run image_tools showimage
"""

from __future__ import annotations

from typing import Any

from robolink.counterparts.image_tools.settings import declared_qos
from robolink.counterparts.program import spin_program
from robolink.exceptions import RobolinkError
from robolink.image import to_array
from robolink.image.opencv import opencv
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.node import Node
from robolink.parameters.descriptors import described


class ShowImage(Node):
    """A node that shows pictures. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("showimage", **options)
        try:
            qos = declared_qos(self)
        except RobolinkError:
            self.destroy_node()
            raise
        self._shows = self.declare_parameter("show_image", True, described("show them, not just count")).value
        title = self.declare_parameter("window_name", "", described("title of the window; '' for the topic")).value
        self._cv2 = self._opencv() if self._shows else None
        subscription = self.create_subscription(Image, "image", self.on_image, qos)
        self._title = title or subscription.topic_name

    def _opencv(self) -> Any:
        """Return OpenCV; None, with a warning, where it is not installed."""
        try:
            return opencv("a window")
        except RobolinkError as error:
            self.get_logger().warning(f"{error}; 'robolink image show' draws in the terminal")
            return None

    def on_image(self, message: Image) -> None:
        """Show a picture."""
        self.get_logger().info(f"Received image #{message.header.frame_id}")
        if self._cv2 is None:
            return
        try:
            picture = to_array(message, "bgr8")
        except RobolinkError as error:
            self.get_logger().error(f"it cannot be shown: {error}")
            return
        if not picture.size:
            self.get_logger().error(f"it cannot be shown: it has {message.width} x {message.height} pixels")
            return
        self._cv2.imshow(self._title, picture)
        self._cv2.waitKey(1)


def main(args: list[str] | None = None) -> None:
    """Show pictures until Ctrl-C."""
    spin_program(lambda words: ShowImage(), args)


if __name__ == "__main__":
    main()
