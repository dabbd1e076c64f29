"""Counterparts of image_tools: a camera, or a picture that is drawn, as messages, and their window."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from robolink.counterparts.program import UsageError, spin_program
from robolink.exceptions import RobolinkError, nearest
from robolink.image import to_array, to_message
from robolink.image.opencv import opencv
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import Bool
from robolink.node import Node
from robolink.parameters.descriptors import described
from robolink.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data

T = TypeVar("T")

RELIABILITIES = {"reliable": ReliabilityPolicy.RELIABLE, "best_effort": ReliabilityPolicy.BEST_EFFORT}
HISTORIES = {"keep_last": HistoryPolicy.KEEP_LAST, "keep_all": HistoryPolicy.KEEP_ALL}


def declared_qos(node: Node) -> QoSProfile:
    """Declare the parameters depth, reliability and history; return the profile. Raises UsageError."""
    depth = node.declare_parameter("depth", 10, described("messages that are kept", 1, 100_000)).value
    return QoSProfile(
        depth=depth,
        reliability=_chosen(node, "reliability", "reliable", RELIABILITIES),
        history=_chosen(node, "history", "keep_last", HISTORIES),
    )


def _chosen(node: Node, name: str, default: str, known: dict[str, T]) -> T:
    value = node.declare_parameter(name, default, described(" or ".join(known))).value
    if value not in known:
        raise UsageError(f"{name}: expected {' or '.join(known)}, got '{value}'{nearest(value, known)}")
    return known[value]


Picture = npt.NDArray[np.uint8]

LAYERS = (
    ("upper", -0.55, 0.45, (60, 140, 215)),
    ("block", -0.10, 0.12, (60, 190, 90)),
    ("block", 0.02, 0.18, (40, 60, 95)),
    ("block", 0.20, 0.08, (70, 210, 250)),
    ("lower", 0.28, 0.27, (70, 150, 220)),
)
"""Parts of a burger from above: shape, upper edge and height as shares of its size, colour as blue, green, red."""
BACKGROUND = (40, 30, 30)


class Flight(NamedTuple):
    """Path of one burger: size as a share of the picture's height, and speed in shares of the picture per frame."""

    size: float
    x: float
    y: float
    dx: float
    dy: float


FLIGHTS = (
    Flight(0.22, 0.1, 0.3, 0.011, 0.007),
    Flight(0.16, 0.7, 0.6, 0.008, 0.013),
    Flight(0.12, 0.4, 0.1, 0.017, 0.01),
)


def render(width: int, height: int, number: int) -> Picture:
    """Return the picture of a frame, as (rows, columns, 3) in the order blue, green, red.

    Args:
        width: Width in pixels.
        height: Height in pixels.
        number: Number of the frame.
    """
    picture = np.empty((height, width, 3), np.uint8)
    picture[:] = BACKGROUND
    for each in FLIGHTS:
        radius = max(each.size * height, 2.0)
        x = radius + bounced(each.x + each.dx * number) * max(width - 2 * radius, 0.0)
        y = radius + bounced(each.y + each.dy * number) * max(height - 2 * radius, 0.0)
        draw(picture, x, y, radius)
    return picture


def bounced(way: float) -> float:
    """Return a place from 0 to 1 after a way that turns at both ends.

    >>> [round(bounced(each), 2) for each in (0.25, 1.25, 2.25)]
    [0.25, 0.75, 0.25]
    """
    rest = way % 2.0
    return rest if rest <= 1.0 else 2.0 - rest


def draw(picture: Picture, x: float, y: float, radius: float) -> None:
    """Draw a burger at a place in pixels."""
    height, width = picture.shape[:2]
    rows, columns = np.ogrid[:height, :width]
    across, down = (columns - x) / radius, (rows - y) / radius
    for shape, top, tall, colour in LAYERS:
        inside = (down >= top) & (down < top + tall) & (np.abs(across) <= 0.95)
        if shape == "upper":
            inside = inside & (across**2 + ((down - top - tall) / tall) ** 2 <= 0.9)
        elif shape == "lower":
            inside = inside & (np.abs(across) <= 0.95 - 0.6 * np.clip(down - top, 0.0, 1.0))
        picture[inside] = colour


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


def run_cam2image(args: list[str] | None = None) -> None:
    """Publish pictures until Ctrl-C."""
    spin_program(lambda words: Cam2Image(), args)


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


def run_showimage(args: list[str] | None = None) -> None:
    """Show pictures until Ctrl-C."""
    spin_program(lambda words: ShowImage(), args)
