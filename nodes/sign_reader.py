"""Drive along a road and obey its traffic signs, which a camera reads: colours, contours, comparison with pictures.

1. Signs are red or blue. In HSV such a colour is a range of hues, and the mask is white where it is found.
2. Each white patch that is about as wide as it is high may be a sign. Its part of the image is brought to 32 x 32.
3. It is compared with each picture in the folder `pictures` by normalised correlation; the best one names the sign,
   if it is alike enough and no other is nearly as much.
4. How wide the sign looks says how far it is. From `react_distance` on the robot does what `RULES` say.

The name of each sign that it passes is published on `sign`. What it sees is on the topic ~/image, while somebody looks:
robolink image show /sign_reader/image
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from robolink import Parameter
from robolink.companions.cv_bridge import CvBridge
from robolink.control.image_controller import ImageController
from robolink.geometry.plane import Speeds, clipped, is_finite, pose_of, wrapped
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.sensor_msgs.msg import CameraInfo, Image
from robolink.interfaces.std_msgs.msg import String
from robolink.parameters.descriptors import described

Pixels: TypeAlias = npt.NDArray[np.uint8]

PICTURES = Path(__file__).resolve().parent.parent / "configs" / "worlds" / "signs"
"""Folder of the signs of the world `signs`."""

PERIOD = 0.1
"""Seconds from image to image where their stamps do not tell."""

SIDE = 32
"""Side of the square in which pictures are compared, in pixels."""

SMALLEST = 16
"""Least width of a sign, in pixels: below that nobody can read it."""

LEAST_LIKENESS, LEAST_LEAD = 0.7, 0.05
"""Least correlation with a picture, from -1 to 1, and its least lead over that with any other."""

HUES = ((0, 8), (172, 179), (105, 125))
"""Ranges of hues as OpenCV has them: red at both ends of the circle of colours, and blue."""

FORGOTTEN = 1.5
"""Seconds out of sight after which a sign of the same name is another one."""

HEADING_GAIN = 1.5
"""Gain of turning back to the road's direction, in 1/s."""


class Rule(NamedTuple):
    """Behaviour at a sign: a `speed` from then on, as a share of the parameter's, after `pause` seconds of standing."""

    speed: float
    pause: float = 0.0


RULES = {
    "ahead": Rule(1.0),
    "speed_30": Rule(0.5),
    "yield": Rule(0.5, pause=1.0),
    "stop": Rule(0.5, pause=3.0),
    "no_entry": Rule(0.0),
}
"""Rules by the sign's name, which is its picture's; signs without one are read and passed."""


class Settings(NamedTuple):
    """Settings of the reader; the parameters of the node have the same names."""

    speed: float = 0.4
    turn_speed: float = 1.0
    size: float = 0.3
    react_distance: float = 1.2
    pictures: str = str(PICTURES)


PARAMETERS = {
    "speed": described("m/s where no sign says less", 0.0, 2.0),
    "turn_speed": described("rad/s at most", 0.05, 10.0),
    "size": described("width of a sign, in metres", 0.01, 10.0),
    "react_distance": described("metres from a sign, along the road, at which it is obeyed", 0.1, 100.0),
    "pictures": described("folder of the signs' pictures; a picture's name is the sign's"),
}


class Sign(NamedTuple):
    """A sign in an image.

    Args:
        name: Its name.
        left: Its leftmost column.
        top: Its first row.
        width: Its width in pixels.
        height: Its height in pixels.
        likeness: Correlation with its picture, at most 1.
    """

    name: str
    left: int
    top: int
    width: int
    height: int
    likeness: float


class SignReader(ImageController):
    """Sign reader: drives straight on at the speed that the last sign allows; stops without images, and at its own end.

    It keeps the heading that odometry had at its start. It looks at nothing but signs: the road must be free.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("sign_reader", **options)
        self.add_on_set_parameters_callback(on_set)
        for name, value in Settings()._asdict().items():
            self.declare_parameter(name, value, PARAMETERS[name])
        self.bridge = CvBridge()
        self.focal = 0.0
        """Focal length in pixels; 0 until the camera's calibration has come."""
        self.road: float | None = None
        """Heading of the road in the frame of odometry, in radians."""
        self.heading = 0.0
        self.allowed, self.pause_left = 1.0, 0.0
        self.last, self.unseen = "", 0.0
        self.names = self.create_publisher(String, "sign", 10)
        self.seen = self.create_publisher(Image, "~/image", 1)
        self.create_subscription(CameraInfo, "camera/camera_info", self.on_camera_info, 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10)
        self.add_post_set_parameters_callback(self.read_settings)
        self.read_settings()

    def read_settings(self, _: list[Parameter[Any]] | None = None) -> None:
        """Take over the parameters."""
        self.settings = Settings(*(self.get_parameter(name).value for name in Settings._fields))
        self.pictures = pictures_in(self.settings.pictures)

    def on_camera_info(self, info: CameraInfo) -> None:
        """Take over the camera's focal length."""
        self.focal = float(info.k[0])

    def on_odom(self, odometry: Odometry) -> None:
        """Take over the heading, unless it is not finite; the first one is that of the road."""
        pose = pose_of(odometry.pose.pose)
        if not is_finite(pose):
            return
        self.heading = pose.theta
        if self.road is None:
            self.road = self.heading

    def decide(self, message: Image, seconds: float) -> tuple[Twist, str]:
        """Read the signs in an image; obey the nearest."""
        if not self.focal:
            return Twist(), f"no calibration on {self.resolve_topic_name('camera/camera_info')} yet"
        image = self.bridge.imgmsg_to_cv2(message, "bgr8")
        signs = find_signs(image, self.pictures)
        if self.seen.get_subscription_count():
            self.seen.publish(self.bridge.cv2_to_imgmsg(drawn(image, signs), "bgr8", message.header))
        nearest = max(signs, key=lambda sign: sign.width, default=None)
        self.pause_left = max(0.0, self.pause_left - (seconds or PERIOD))
        self.unseen += seconds or PERIOD
        if nearest is not None and self.distance(nearest) <= self.settings.react_distance:
            self.obey(nearest.name)
        twist, speeds = Twist(), self.speeds()
        twist.linear.x, twist.angular.z = speeds
        return twist, f"{self.last or 'no sign yet'}: {speeds.v:.2f} m/s"

    def distance(self, sign: Sign) -> float:
        """Return how far a sign is along the camera's axis, in metres."""
        return self.focal * self.settings.size / sign.width

    def obey(self, name: str) -> None:
        """Take over what a sign says, once, until it has been out of sight."""
        known, self.last, self.unseen = name == self.last and self.unseen < FORGOTTEN, name, 0.0
        if known:
            return
        self.names.publish(String(data=name))
        rule = RULES.get(name)
        if rule is not None:
            self.allowed, self.pause_left = rule.speed, rule.pause
        self.get_logger().info(f"sign: {name}")

    def speeds(self) -> Speeds:
        """Return the present speeds: straight on along the road."""
        if self.pause_left > 0.0 or self.allowed == 0.0:
            return Speeds()
        off = 0.0 if self.road is None else wrapped(self.road - self.heading)
        return Speeds(self.allowed * self.settings.speed, clipped(HEADING_GAIN * off, self.settings.turn_speed))


def on_set(parameters: list[Parameter[Any]]) -> SetParametersResult:
    """Refuse a folder without pictures of signs."""
    for each in parameters:
        if each.name == "pictures" and not pictures_in(each.value):
            reason = f"pictures: no .png of a red or blue sign in the folder '{each.value}'"
            return SetParametersResult(successful=False, reason=reason)
    return SetParametersResult(successful=True)


def pictures_in(folder: str) -> dict[str, Pixels]:
    """Return the signs in a folder's pictures by name, each brought to the size in which they are compared."""
    read = {path.stem: cv2.imread(str(path), cv2.IMREAD_COLOR) for path in sorted(Path(folder).glob("*.png"))}
    found = {name: list(cut_out(image)) for name, image in read.items() if image is not None}
    return {name: signs[0][1] for name, signs in found.items() if signs}


def find_signs(image: Pixels, pictures: dict[str, Pixels]) -> list[Sign]:
    """Return the signs in an image whose channels are blue, green, red."""
    named = ((box, *most_like(part, pictures)) for box, part in cut_out(image))
    return [Sign(name, *box, likeness) for box, name, likeness in named if name]


def cut_out(image: Pixels) -> Iterator[tuple[tuple[int, int, int, int], Pixels]]:
    """Yield the candidates for a sign: the box (left, top, width, height), and what is in it, brought to one size."""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    mask = np.zeros(image.shape[:2], np.uint8)
    for low, high in HUES:
        mask |= cv2.inRange(hsv, (low, 120, 60), (high, 255, 255))
    contours = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)[0]
    for left, top, width, height in map(cv2.boundingRect, contours):
        is_cut = left == 0 or left + width == image.shape[1]
        if width >= SMALLEST and 0.7 <= width / height <= 1.5 and not is_cut:
            part = image[top : top + height, left : left + width]
            yield (left, top, width, height), cv2.resize(part, (SIDE, SIDE), interpolation=cv2.INTER_AREA)


def most_like(part: Pixels, pictures: dict[str, Pixels]) -> tuple[str, float]:
    """Return the name of the picture that a part of an image is most like, and its likeness; '' for none of them."""
    likeness = {
        name: float(cv2.matchTemplate(part, each, cv2.TM_CCOEFF_NORMED)[0, 0]) for name, each in pictures.items()
    }
    best, *others = sorted(likeness, key=lambda name: likeness[name], reverse=True) or [""]
    second = likeness[others[0]] if others else -1.0
    if not best or not likeness[best] >= max(LEAST_LIKENESS, second + LEAST_LEAD):  # a part without contrast has NaN
        return "", 0.0
    return best, likeness[best]


def drawn(image: Pixels, signs: list[Sign]) -> Pixels:
    """Return an image with a box round each sign, and its name."""
    for sign in signs:
        corner, other = (sign.left, sign.top), (sign.left + sign.width, sign.top + sign.height)
        cv2.rectangle(image, corner, other, (0, 255, 0), 2)
        cv2.putText(image, sign.name, (sign.left, sign.top - 5), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 255, 0))
    return image
