"""Follow a line on the floor by a camera that looks ahead and down: colour, mask, centre, error, PID, command.

1. The image arrives, and cv_bridge makes a numpy array of it, with the colours in OpenCV's order.
2. Only a band of rows counts, from `top` to `bottom`: the floor at one distance ahead of the robot.
3. In HSV a colour is one number, its hue, however bright the light is. The mask is white where it is the line's.
4. The mask's moments have the centre of what is white. The error e says where it is: -1 left, 0 middle, 1 right.
5. A PID controller turns the robot by kp e + ki (sum of e) + kd (change of e), against the error.

Begin with `kp` alone. If it is too small the robot leaves the line on the outside of bends; if it is too great the
robot cuts bends, since the camera looks ahead, and weaves in the end: `kd` is against that, and `ki` against an error
that stays. All of it works while the robot drives:

robolink param set /line_follower kp 2.5
"""

import math
from typing import Any, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from robolink import Parameter
from robolink.companions.cv_bridge import CvBridge
from robolink.control.image_controller import ImageController
from robolink.control.pid import Pid
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.parameters.descriptors import described

PERIOD = 0.1
"""Seconds from image to image where their stamps do not tell."""

LEAST_SHARE = 0.002
"""Least share of the band that must have the line's colour; less is noise."""

SLOWEST = 0.3
"""Share of the speed that is left where the line is at the image's edge."""


class Settings(NamedTuple):
    """Settings of the follower; the parameters of the node have the same names."""

    kp: float = 1.5
    ki: float = 0.0
    kd: float = 0.1
    speed: float = 0.3
    turn_speed: float = 1.5
    hue: int = 30
    hue_tolerance: int = 12
    min_saturation: int = 80
    min_value: int = 50
    top: float = 0.7
    bottom: float = 1.0
    search_time: float = 10.0


PARAMETERS = {
    "kp": described("rad/s of turning for a line at the edge of the image", 0.0, 20.0),
    "ki": described("rad/s more for each second that it was there; against an error that stays", 0.0, 20.0),
    "kd": described("rad/s for an error that changes by 1 in a second; against weaving", 0.0, 20.0),
    "speed": described("m/s on a straight line", 0.0, 2.0),
    "turn_speed": described("rad/s at most, and to find a lost line", 0.05, 10.0),
    "hue": described("hue of the line as OpenCV has it: 0 red, 30 yellow, 60 green, 90 cyan, 120 blue", 0, 179),
    "hue_tolerance": described("by which a hue may differ from it", 1, 90),
    "min_saturation": described("least saturation, from 0 for grey to 255 for a pure colour", 0, 255),
    "min_value": described("least brightness, from 0 for black to 255", 0, 255),
    "top": described("where the band of rows begins, from 0 for the image's first row to 1 for its last", 0.0, 0.99),
    "bottom": described("where the band of rows ends; it has one row at least", 0.01, 1.0),
    "search_time": described("seconds for which it turns to find a lost line", 0.0, 600.0),
}


class LineFollower(ImageController):
    """Line follower: turns each image into a velocity command; stops without images, and at its own end.

    What it sees is on the topic ~/image, while somebody looks: robolink image show /line_follower/image
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("line_follower", **options)
        for name, value in Settings()._asdict().items():
            self.declare_parameter(name, value, PARAMETERS[name])
        self.bridge = CvBridge()
        self.seen = self.create_publisher(Image, "~/image", 1)
        self.read_settings()
        self.forget()
        self.add_post_set_parameters_callback(self.read_settings)

    def read_settings(self, _: list[Parameter[Any]] | None = None) -> None:
        """Take over the parameters; the sum of errors begins anew."""
        settings = self.settings = Settings(*(self.get_parameter(name).value for name in Settings._fields))
        limits = -settings.turn_speed, settings.turn_speed
        self.pid = Pid(settings.kp, settings.ki, settings.kd, limits=limits, filter_time=PERIOD)

    def forget(self) -> None:
        """Forget the line: the robot may be elsewhere."""
        super().forget()
        self.pid.reset()
        self.error = self.lost_for = 0.0

    def decide(self, message: Image, seconds: float) -> tuple[Twist, str]:
        """Steer by where the line is in an image; turn to where it was last if it is in none."""
        settings, dt = self.settings, seconds or PERIOD
        image = self.bridge.imgmsg_to_cv2(message, "bgr8")
        error = find_line(image, settings)
        if self.seen.get_subscription_count():
            self.seen.publish(self.bridge.cv2_to_imgmsg(drawn(image, error, settings), "bgr8", message.header))
        twist = Twist()
        if error is not None:
            self.error, self.lost_for = error, 0.0
            twist.angular.z = self.pid.update(0.0, error, dt)  # a line on the right is an error above 0: turn right
            twist.linear.x = settings.speed * max(SLOWEST, 1.0 - abs(error))
            return twist, f"following the line, {abs(error):.0%} to the {'left' if error < 0 else 'right'}"
        self.lost_for += dt
        if self.lost_for > settings.search_time:
            return twist, f"no line for {settings.search_time:g} s: standing still"
        twist.angular.z = -math.copysign(settings.turn_speed, self.error)
        return twist, f"no line in view: turning {'left' if self.error < 0 else 'right'}"


def find_line(image: npt.NDArray[np.uint8], settings: Settings) -> float | None:
    """Return where the line is in an image, from -1 at its left edge to 1 at its right one; None for no line."""
    first, last = band(image, settings)
    moments = cv2.moments(mask(image[first:last], settings), binaryImage=True)
    rows, columns = last - first, image.shape[1]
    if moments["m00"] <= LEAST_SHARE * rows * columns:  # the number of white pixels
        return None
    centre = moments["m10"] / moments["m00"]  # the mean of their columns, counted from 0
    return float((2 * centre + 1) / columns - 1)


def band(image: npt.NDArray[np.uint8], settings: Settings) -> tuple[int, int]:
    """Return the first row of the band that counts, and the one behind its last."""
    height = image.shape[0]
    first = int(settings.top * height)
    return first, max(first + 1, round(settings.bottom * height))


def mask(image: npt.NDArray[np.uint8], settings: Settings) -> npt.NDArray[np.uint8]:
    """Return an image that is 255 where the colour is the line's, and else 0."""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    found = np.zeros(image.shape[:2], np.uint8)
    for turn in (-180, 0, 180):  # hues are on a circle: red lies at 179 and at 0
        low = (settings.hue - settings.hue_tolerance + turn, settings.min_saturation, settings.min_value)
        found |= cv2.inRange(hsv, low, (settings.hue + settings.hue_tolerance + turn, 255, 255))
    return found


def drawn(image: npt.NDArray[np.uint8], error: float | None, settings: Settings) -> npt.NDArray[np.uint8]:
    """Return an image with the band and the line's centre drawn on it."""
    first, last = band(image, settings)
    columns = image.shape[1]
    cv2.rectangle(image, (0, first), (columns - 1, last - 1), (255, 255, 255), 1)
    if error is not None:
        centre = round(((error + 1) * columns - 1) / 2)
        cv2.circle(image, (centre, (first + last) // 2), 4, (0, 0, 255), -1)
    return image
