"""Dock at a tag: find it by the camera, come before it, drive straight in, and stand at a distance that is exact.

1. OpenCV finds the tag's corners in the image, and `solvePnP` where such a square is that has them there.
2. /tf brings that into the frame of odometry, where it stays while the robot turns away. Near sightings count more.
3. The robot drives to a place `run_up` metres before the dock, on the line that leaves the tag at a right angle.
4. From there it drives in on that line. A wrong end is no end: it backs off, and tries again.

robolink run tag_docker -p tag:=1 -p distance:=0.5
robolink param set /tag_docker tag 2
"""

import math
from enum import Enum
from typing import Any, NamedTuple, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from robolink import Parameter, Time
from robolink.companions.cv_bridge import CvBridge
from robolink.control.approach import Limits, decide, left_to
from robolink.control.image_controller import ImageController
from robolink.geometry.plane import Pose, Speeds, clipped, is_finite, pose_of, seen_from, wrapped
from robolink.image import ImageError
from robolink.interfaces.geometry_msgs.msg import PointStamped, Twist, Vector3Stamped
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.sensor_msgs.msg import CameraInfo, Image
from robolink.interfaces.std_msgs.msg import Bool
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.tf2 import Buffer, TransformException, TransformListener
from robolink.tf2.geometry import do_transform_point, do_transform_vector3
from robolink.time import sent_time

FAMILIES = {
    "16h5": cv2.aruco.DICT_APRILTAG_16h5,
    "25h9": cv2.aruco.DICT_APRILTAG_25h9,
    "36h11": cv2.aruco.DICT_APRILTAG_36h11,
    "4X4_50": cv2.aruco.DICT_4X4_50,
    "5X5_100": cv2.aruco.DICT_5X5_100,
    "6X6_250": cv2.aruco.DICT_6X6_250,
}
"""OpenCV's dictionaries of markers by name."""

Pixels: TypeAlias = npt.NDArray[np.uint8]
Vector: TypeAlias = npt.NDArray[np.float64]

PERIOD = 0.1
"""Seconds from image to image where their stamps do not tell."""

FADE = 0.95
"""Share that earlier sightings keep at each new one: the frame of odometry drifts."""

LINE_GAIN, HEADING_GAIN = 100.0, 20.0
"""Gains of steering onto the line, in 1/m² and 1/m: off the line by y, the robot is by (1 + 10 s) exp(-10 s) y after
s metres, without swinging over."""

SLOWING = 1.5
"""Gain of the speed on the remaining way, in 1/s."""

AT_START = 0.04
"""Distance in metres from the place before the dock within which driving in begins."""

STOPPED = 0.002
"""Way that may be left where the robot stands, in metres."""

CALM_IMAGES = 5
"""Images that must show the robot in its dock, one after another."""


class Settings(NamedTuple):
    """Settings of the docker; the parameters of the node have the same names."""

    family: str = "36h11"
    tag: int = 0
    size: float = 0.16
    distance: float = 0.4
    run_up: float = 0.5
    speed: float = 0.25
    turn_speed: float = 0.8
    position_tolerance: float = 0.006
    heading_tolerance: float = 0.015
    memory: float = 15.0


PARAMETERS = {
    "family": described("family of the tag"),
    "tag": described("number of the tag", 0, 1000),
    "size": described("side of the tag's black square, in metres", 0.01, 10.0),
    "distance": described("metres from the tag to the robot's base where it docks", 0.05, 10.0),
    "run_up": described("metres before the dock from which it drives straight in", 0.1, 10.0),
    "speed": described("m/s at most", 0.01, 2.0),
    "turn_speed": described("rad/s at most, and to search", 0.05, 10.0),
    "position_tolerance": described("metres off the dock that are near enough", 0.002, 1.0),
    "heading_tolerance": described("radians off the heading that are near enough", 0.005, 1.0),
    "memory": described("seconds for which it drives on without seeing the tag", 0.5, 600.0),
}
PARAMETERS["family"].additional_constraints = ", ".join(FAMILIES)


class Phase(Enum):
    """Phases of docking."""

    SEARCHING = "searching"
    COMING = "coming before the tag"
    DOCKING = "driving in"
    BACKING = "backing off"
    DOCKED = "docked"


class Sighting(NamedTuple):
    """A tag in the camera's optical frame: x to the right, y down, z ahead.

    Args:
        place: The tag's middle, in metres.
        normal: Unit vector that leaves the tag's face at a right angle.
    """

    place: Vector
    normal: Vector

    @property
    def distance(self) -> float:
        """Metres from the camera."""
        return math.sqrt(float(self.place @ self.place))


class TagPlace:
    """Place of a tag in the plane, the mean of its sightings: one at half the distance counts sixteen times as much.

    An error of a pixel moves a tag the more, the farther away it is: its distance by the square of that.
    """

    def __init__(self) -> None:
        self.weight = 0.0
        self.mean = np.zeros(4)

    def add(self, place: tuple[float, float], normal: tuple[float, float], distance: float) -> None:
        """Add a sighting: its place and normal, and its distance from the camera, in metres."""
        weight = 1.0 / max(distance, 0.1) ** 4
        self.weight = FADE * self.weight + weight
        self.mean += (np.array((*place, *normal)) - self.mean) * (weight / self.weight)

    def before(self, distance: float) -> Pose:
        """Return the pose that looks at the tag, `distance` metres before it."""
        x, y, across, along = self.mean.tolist()
        length = math.hypot(across, along) or 1.0
        return Pose(x + distance * across / length, y + distance * along / length, math.atan2(-along, -across))


class TagDocker(ImageController):
    """Node that docks at a tag by camera and odometry, and publishes True on `docked` while the robot stands there.

    The robot must be able to turn on the spot. It looks at nothing but the tag: the way there must be free.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("tag_docker", **options)
        self.add_on_set_parameters_callback(on_set)
        for name, value in Settings()._asdict().items():
            self.declare_parameter(name, value, PARAMETERS[name])
        self.bridge, self.camera = CvBridge(), CameraInfo()
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.odometry: Odometry | None = None
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.docked = self.create_publisher(Bool, "docked", latched)
        self.create_subscription(CameraInfo, "camera/camera_info", self.on_camera_info, 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10)
        self.add_post_set_parameters_callback(self.read_settings)
        self.read_settings()

    def read_settings(self, _: list[Parameter[Any]] | None = None) -> None:
        """Take over the parameters, and begin again."""
        self.settings = Settings(*(self.get_parameter(name).value for name in Settings._fields))
        self.detector = detector(self.settings.family)
        self.forget()

    def on_camera_info(self, info: CameraInfo) -> None:
        """Take over the camera's calibration, unless it is not finite."""
        if all(map(math.isfinite, (*info.k, *info.d))):
            self.camera = info

    def on_odom(self, odometry: Odometry) -> None:
        """Take over where the robot is, unless that is not finite."""
        if is_finite(pose_of(odometry.pose.pose)):
            self.odometry = odometry

    def forget(self) -> None:
        """Forget the tag: the robot may be elsewhere."""
        super().forget()
        self.place, self.unseen, self.calm = TagPlace(), 0.0, 0
        self.speeds = Speeds()
        self.enter(Phase.SEARCHING)

    def enter(self, phase: Phase) -> None:
        """Enter a phase, and say so."""
        self.phase = phase
        self.docked.publish(Bool(data=phase is Phase.DOCKED))

    def decide(self, message: Image, seconds: float) -> tuple[Twist, str]:
        """Look for the tag in an image, and drive by where it is."""
        if self.odometry is None:
            return Twist(), f"no odometry on {self.resolve_topic_name('odom')} yet"
        if not self.camera.k[0]:
            return Twist(), f"no calibration on {self.resolve_topic_name('camera/camera_info')} yet"
        self.look(message, seconds or PERIOD)
        self.speeds = self.next_speeds(pose_of(self.odometry.pose.pose), seconds or PERIOD)
        twist = Twist()
        twist.linear.x, twist.angular.z = self.speeds
        return twist, f"tag {self.settings.family}/{self.settings.tag}: {self.phase.value}"

    def look(self, message: Image, seconds: float) -> None:
        """Note where the tag is, if it is in an image; forget it if it was in none for too long."""
        sighting = find_tag(self.bridge.imgmsg_to_cv2(message, "mono8"), self.detector, self.camera, self.settings)
        if sighting is None or not self.note(message, sighting):
            self.unseen += seconds
            if self.phase is not Phase.SEARCHING and self.unseen > self.settings.memory:
                self.forget()
            return
        self.unseen = 0.0
        if self.phase is Phase.SEARCHING:
            self.enter(Phase.COMING)

    def note(self, message: Image, sighting: Sighting) -> bool:
        """Bring a sighting into the frame of odometry, and add it; False if /tf does not connect the two yet."""
        assert self.odometry is not None
        fixed, camera = self.odometry.header.frame_id, message.header.frame_id
        try:
            when = stamp_of(message)
            if not self.buffer.can_transform(fixed, camera, when):
                when = Time()  # the last that is known
            way = self.buffer.lookup_transform(fixed, camera, when)
        except TransformException as error:
            self.get_logger().warning(f"{fixed} and {camera} are not connected: {error}", throttle_duration_sec=5.0)
            return False
        point, arrow = PointStamped(), Vector3Stamped()
        point.point.x, point.point.y, point.point.z = sighting.place.tolist()
        arrow.vector.x, arrow.vector.y, arrow.vector.z = sighting.normal.tolist()
        place, normal = do_transform_point(point, way).point, do_transform_vector3(arrow, way).vector
        self.place.add((place.x, place.y), (normal.x, normal.y), sighting.distance)
        return True

    def next_speeds(self, pose: Pose, dt: float) -> Speeds:
        """Return the speeds for the present phase, and enter the next one where this one ends."""
        settings = self.settings
        if self.phase is Phase.SEARCHING:
            return Speeds(0.0, settings.turn_speed)
        dock = self.place.before(settings.distance)
        start = self.place.before(settings.distance + settings.run_up)
        here = seen_from(dock, pose)  # x grows towards the tag: -run_up at the start
        if self.phase is Phase.COMING:
            left = left_to(start, pose)
            if left.distance > AT_START:
                limits = Limits(speed=settings.speed, turn_speed=settings.turn_speed)
                return decide(left, self.speeds, limits, math.inf, arrived=False, dt=dt)
            self.enter(Phase.DOCKING)
        if self.phase is Phase.BACKING:
            if here.x > -settings.run_up:
                return Speeds(-settings.speed / 2, clipped(-2.0 * here.theta, settings.turn_speed))
            self.enter(Phase.DOCKING)
        return self.drive_in(here)

    def drive_in(self, here: Pose) -> Speeds:
        """Return the speeds on the line into the dock, for a pose as the dock sees it."""
        settings = self.settings
        speeds = steered(here, settings)
        is_there = -here.x <= max(STOPPED, settings.position_tolerance / 2)
        off = math.hypot(here.x, here.y) > settings.position_tolerance
        turned = abs(wrapped(here.theta)) > settings.heading_tolerance
        if is_there and not turned and off and self.unseen == 0.0:
            self.calm = 0
            self.enter(Phase.BACKING)
        elif is_there and not turned and not off:
            self.calm += 1
            if self.calm >= CALM_IMAGES and self.phase is not Phase.DOCKED:
                self.enter(Phase.DOCKED)
            return Speeds()
        else:
            self.calm = 0
            if self.phase is Phase.DOCKED:
                self.enter(Phase.DOCKING)
        return speeds


def stamp_of(message: Image) -> Time:
    """Return the time of an image. Raises ImageError for one that no message has."""
    try:
        return sent_time(message.header.stamp)
    except ValueError as error:
        raise ImageError(f"an image is of no time that there is: {error}") from None


def on_set(parameters: list[Parameter[Any]]) -> SetParametersResult:
    """Refuse a family of tags that OpenCV does not know by this name."""
    for each in parameters:
        if each.name == "family" and each.value not in FAMILIES:
            reason = f"no family '{each.value}' of tags: expected {', '.join(FAMILIES)}"
            return SetParametersResult(successful=False, reason=reason)
    return SetParametersResult(successful=True)


def steered(here: Pose, settings: Settings) -> Speeds:
    """Return the speeds that bring a robot onto the x axis and to its origin, and turn it along the axis there.

    Args:
        here: The robot's pose as the dock sees it: x negative before the dock, y off the line, and its heading.
        settings: Speeds at most.
    """
    left = -here.x
    if left <= STOPPED:
        return Speeds(0.0, clipped(-2.0 * here.theta, settings.turn_speed))
    slow = max(0.0, math.cos(2.0 * clipped(here.theta, math.pi / 4)))  # turn before you drive
    v = min(settings.speed, SLOWING * left) * slow
    turn = -v * (LINE_GAIN * here.y + HEADING_GAIN * here.theta) if slow > 0.1 else -2.0 * here.theta
    return Speeds(v, clipped(turn, settings.turn_speed))


def detector(family: str) -> cv2.aruco.ArucoDetector:
    """Return a detector of a family's tags, whose corners are found to a fraction of a pixel."""
    options = cv2.aruco.DetectorParameters()
    options.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    return cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(FAMILIES[family]), options)


def find_tag(
    image: Pixels, detector: cv2.aruco.ArucoDetector, camera: CameraInfo, settings: Settings
) -> Sighting | None:
    """Return where a tag is that an image shows; None if it does not show it.

    Args:
        image: Gray image.
        detector: Detector of its family.
        camera: Calibration of the camera.
        settings: The tag's number and size.

    Raises:
        ImageError: if the calibration is for images of another size.
    """
    rows, columns = image.shape[:2]
    if (camera.width, camera.height) != (columns, rows):
        expected = f"{camera.width} x {camera.height}"
        raise ImageError(f"an image of {columns} x {rows} pixels, and the calibration is for {expected}")
    all_corners, numbers, _ = detector.detectMarkers(image)
    for corners, number in zip(all_corners, () if numbers is None else numbers.ravel().tolist(), strict=True):
        if number == settings.tag:
            return seen_square(corners.reshape(4, 2), camera, settings.size)
    return None


def seen_square(corners: npt.NDArray[np.float32], camera: CameraInfo, size: float) -> Sighting | None:
    """Return where a square is that has these corners in an image, an array (4, 2); `size` is its side in metres."""
    half = size / 2
    # As the camera has it, x to the right, y down: with y up, the turn of a square seen squarely is half of a full one,
    # for which OpenCV 5.0 may return no turn at all.
    square = np.array([(-half, -half, 0.0), (half, -half, 0.0), (half, half, 0.0), (-half, half, 0.0)])
    matrix, distortion = np.array(camera.k).reshape(3, 3), np.array(camera.d)
    found, turn, place = cv2.solvePnP(square, corners, matrix, distortion, flags=cv2.SOLVEPNP_IPPE)
    if not found or not np.isfinite(turn).all() or not np.isfinite(place).all():
        return None
    normal = -cv2.Rodrigues(turn)[0][:, 2]  # the square's z axis goes into it
    return Sighting(place.ravel(), normal)
