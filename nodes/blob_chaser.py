"""Find things of given colours by a camera, drive to each and stop before it: colour, mask, contours, size, command.

The robot turns until it sees a blob of a wanted colour, the largest if there are several. It drives there, and turns
by how far the blob is from the middle of the image. The nearer the blob, the larger it looks: at `stop_width` the
robot stands for `pause` seconds, and goes on with the colours that are left. The name of each colour that it has found
is published on `found`.

robolink run blob_chaser -p colours:='[green, blue]' -p stop_width:=0.5
"""

import math
from typing import Any, NamedTuple, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from robolink import Parameter
from robolink.companions.cv_bridge import CvBridge
from robolink.control.image_controller import ImageController
from robolink.geometry.plane import clipped
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import String
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile

HUES = {"red": 0, "orange": 12, "yellow": 30, "green": 60, "cyan": 90, "blue": 120, "magenta": 150}
"""Hues as OpenCV has them: half of the degrees on the circle of colours."""

Pixels: TypeAlias = npt.NDArray[np.uint8]

FONT = cv2.FONT_HERSHEY_SIMPLEX

PERIOD = 0.1
"""Seconds from image to image where their stamps do not tell."""

LEAST_SHARE = 0.0005
"""Least share of the image that a blob must have; less is noise."""

SLOWEST = 0.3
"""Share of the speed with which it comes to a stop."""

MIDDLE = 0.1
"""Offset up to which a blob is in the middle of the image, which is 2 wide."""


class Settings(NamedTuple):
    """Settings of the chaser; the parameters of the node have the same names."""

    colours: tuple[str, ...] = ("red", "green", "blue")
    speed: float = 0.3
    turn_speed: float = 0.8
    kp: float = 1.5
    stop_width: float = 0.45
    pause: float = 2.0
    hue_tolerance: int = 10
    min_saturation: int = 100
    min_value: int = 40


PARAMETERS = {
    "colours": described("colours to find, in any order"),
    "speed": described("m/s at most", 0.0, 2.0),
    "turn_speed": described("rad/s at most, and to search", 0.05, 10.0),
    "kp": described("rad/s of turning for a blob at the edge of the image", 0.0, 20.0),
    "stop_width": described("share of the image's width that a blob has where the robot stops", 0.05, 1.0),
    "pause": described("seconds for which it stands there", 0.0, 600.0),
    "hue_tolerance": described("by which a hue may differ from a colour's", 1, 90),
    "min_saturation": described("least saturation, from 0 for grey to 255 for a pure colour", 0, 255),
    "min_value": described("least brightness, from 0 for black to 255", 0, 255),
}
PARAMETERS["colours"].additional_constraints = ", ".join(HUES)


class Blob(NamedTuple):
    """Blob of a colour in an image.

    Args:
        colour: Its name.
        offset: Where its middle is, from -1 at the image's left edge to 1 at the right one.
        width: Share of the image's width.
        area: Share of the image.
        is_cut: True if it reaches the image's last row: its foot is too near to be seen.
    """

    colour: str
    offset: float
    width: float
    area: float
    is_cut: bool


class BlobChaser(ImageController):
    """Blob chaser: turns each image into a velocity command; stops without images, and at its own end.

    What it sees is on the topic ~/image, while somebody looks: robolink image show /blob_chaser/image
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("blob_chaser", **options)
        self.add_on_set_parameters_callback(self.check_colours)
        for name, value in Settings()._asdict().items():
            self.declare_parameter(name, value, PARAMETERS[name])
        self.bridge = CvBridge()
        self.seen = self.create_publisher(Image, "~/image", 1)
        latched = QoSProfile(depth=len(HUES), durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.found_colours = self.create_publisher(String, "found", latched)
        self.found = list[str]()
        """The colours before which it has stopped, in this order."""
        self.pause_left = 0.0
        """Seconds for which it still stands before the last of them."""
        self.side = 1.0
        """Where the last blob was seen: 1 left, -1 right."""
        self.read_settings()
        self.add_post_set_parameters_callback(self.read_settings)

    def check_colours(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        """Reject the name of a colour that is not known."""
        for each in parameters:
            unknown = [name for name in each.value if name not in HUES] if each.name == "colours" else []
            if unknown:
                reason = f"colours: expected some of {', '.join(HUES)}, got {unknown[0]!r}"
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def read_settings(self, changed: list[Parameter[Any]] | None = None) -> None:
        """Take over the parameters; new colours begin a new search."""
        self.settings = Settings(*(self.get_parameter(name).value for name in Settings._fields))
        if any(each.name == "colours" for each in changed or ()):
            self.found.clear()

    def decide(self, message: Image, seconds: float) -> tuple[Twist, str]:
        """Drive to the largest blob of a colour that is left, or search one."""
        settings, dt = self.settings, seconds or PERIOD
        image = self.bridge.imgmsg_to_cv2(message, "bgr8")
        missing = [colour for colour in settings.colours if colour not in self.found]
        blobs = [blob for colour in missing if (blob := find_blob(image, colour, settings)) is not None]
        if self.seen.get_subscription_count():
            self.seen.publish(self.bridge.cv2_to_imgmsg(drawn(image, blobs), "bgr8", message.header))
        if self.pause_left > 0.0:
            self.pause_left -= dt
            return Twist(), f"standing before the {self.found[-1]} blob"
        if not missing:
            return Twist(), f"found {', '.join(self.found) or 'nothing, as no colour is wanted'}: standing still"
        if not blobs:
            turn = Vector3(z=self.side * settings.turn_speed)
            return Twist(angular=turn), f"searching {' or '.join(missing)}, turning {'left' if turn.z > 0 else 'right'}"
        blob = max(blobs, key=lambda each: each.area)
        self.side = math.copysign(1.0, -blob.offset)
        if is_near(blob, settings) and abs(blob.offset) < MIDDLE:
            return self.arrive(blob)
        return chase(blob, settings), f"driving to the {blob.colour} blob, {blob.width:.0%} of the image wide"

    def arrive(self, blob: Blob) -> tuple[Twist, str]:
        """Stop before a blob, and begin the pause."""
        self.found.append(blob.colour)
        self.found_colours.publish(String(data=blob.colour))
        self.get_logger().info(f"found the {blob.colour} blob, {len(self.found)} of {len(self.settings.colours)}")
        self.pause_left = self.settings.pause
        return Twist(), f"standing before the {blob.colour} blob"


def find_blob(image: Pixels, colour: str, settings: Settings) -> Blob | None:
    """Return the largest blob of a colour in an image in the order blue, green, red; None for none."""
    height, width = image.shape[:2]
    contours = cv2.findContours(mask(image, HUES[colour], settings), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)[0]
    boxes = [cv2.boundingRect(each) for each in contours]  # left, top, width and height of each
    left, top, columns, rows = max(boxes, key=lambda box: box[2] * box[3], default=(0, 0, 0, 0))
    if columns * rows <= LEAST_SHARE * width * height:
        return None
    offset = (2 * left + columns) / width - 1
    return Blob(colour, offset, columns / width, columns * rows / (width * height), top + rows == height)


def mask(image: Pixels, hue: int, settings: Settings) -> Pixels:
    """Return an image that is 255 where the hue is the wanted one, and else 0."""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    found = np.zeros(image.shape[:2], np.uint8)
    for turn in (-180, 0, 180):  # hues are on a circle: red lies at 179 and at 0
        low = (hue - settings.hue_tolerance + turn, settings.min_saturation, settings.min_value)
        found |= cv2.inRange(hsv, low, (hue + settings.hue_tolerance + turn, 255, 255))
    return found


def is_near(blob: Blob, settings: Settings) -> bool:
    """True if a blob is so near that the robot stops: wide enough, or its foot is below the image."""
    return blob.width >= settings.stop_width or blob.is_cut


def chase(blob: Blob, settings: Settings) -> Twist:
    """Return the command that drives to a blob: slower where it is aside, and where it is near."""
    nearness = 1.0 if is_near(blob, settings) else blob.width / settings.stop_width
    share = max(SLOWEST, min(1.0, 2 * (1 - nearness))) if nearness < 1.0 else 0.0
    turn = clipped(-settings.kp * blob.offset, settings.turn_speed)
    return Twist(linear=Vector3(x=settings.speed * share * (1 - abs(blob.offset))), angular=Vector3(z=turn))


def drawn(image: Pixels, blobs: list[Blob]) -> Pixels:
    """Return an image with a line under the middle of each blob, as wide as the blob, and its colour's name."""
    height, width = image.shape[:2]
    for blob in blobs:
        middle, half = (blob.offset + 1) * width / 2, blob.width * width / 2
        cv2.line(image, (int(middle - half), height // 2), (int(middle + half), height // 2), (255, 255, 255), 2)
        cv2.putText(image, blob.colour, (int(middle - half), height // 2 - 5), FONT, 0.4, (255, 255, 255))
    return image
