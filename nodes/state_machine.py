"""Behaviours as a state machine: wander, see a blob of colour, approach it, back off; with a timeout in each state.

The pattern serves any robot. Its parts are:

- states: each is a method that looks at the sensors, returns a command, and the event that has happened, if any;
- `TRANSITIONS`: the table of the next state by state and event; what is not in it cannot happen;
- `TIMEOUTS`: how long each state may last. Then its event is "timeout", so that no state can trap the robot;
- one timer that calls the state's method, publishes its command, and changes the state: nowhere else does it change.

The log has each transition and its reason; the topic `state` has the present state, for who comes later too.
"""

import contextlib
import math
from typing import Any, NamedTuple, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from robolink import Parameter
from robolink.companions.cv_bridge import CvBridge, CvBridgeError
from robolink.control.laser import lane_ahead, looks_ahead, returns
from robolink.exceptions import RobolinkError
from robolink.geometry.plane import clipped
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import Image, LaserScan
from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile

TRANSITIONS = {
    ("wait", "ready"): "wander",
    ("wander", "seen"): "see",
    ("wander", "timeout"): "back_off",
    ("see", "sure"): "approach",
    ("see", "lost"): "back_off",  # not "wander": what is half hidden would be seen and lost for ever
    ("see", "timeout"): "back_off",
    ("approach", "reached"): "back_off",
    ("approach", "lost"): "see",
    ("approach", "timeout"): "back_off",
    ("back_off", "done"): "wander",
    ("back_off", "timeout"): "wander",
}
"""The next state by the present one and an event. Besides, any state becomes "wait" when a sensor falls silent."""

TIMEOUTS = {"wait": math.inf, "wander": 20.0, "see": 4.0, "approach": 30.0, "back_off": 8.0}
"""Seconds that a state may last."""

PERIOD = 0.1
"""Seconds from command to command."""

FIRST_WAIT = 5.0
"""Longest wait for the first image and scan before a warning, in seconds."""

GLANCE = 1.0
"""Seconds in which a blob that is out of view may come back before it counts as lost."""

MIDDLE = 0.15
"""Offset up to which a blob is in the middle of the image, which is 2 wide."""

LEAST_SHARE = 0.002
"""Least share of the image that must have the colour; less is noise."""

SLOW_DOWN, SLOWEST = 0.5, 0.05
"""Way before a stop on which it slows down, in metres, and the least speed of an approach, in m/s."""

BACKWARDS, ABOUT = 1.5, 2.4
"""Seconds for which it backs away, and the turn that follows, in radians."""

Pixels: TypeAlias = npt.NDArray[np.uint8]


class Settings(NamedTuple):
    """Settings of the machine; the parameters of the node have the same names."""

    speed: float = 0.3
    turn_speed: float = 1.0
    stop_distance: float = 0.5
    half_width: float = 0.25
    hue: int = 0
    hue_tolerance: int = 10
    min_saturation: int = 100
    min_value: int = 40
    timeout: float = 1.0


PARAMETERS = {
    "speed": described("m/s at most", 0.01, 2.0),
    "turn_speed": described("rad/s at most", 0.05, 10.0),
    "stop_distance": described("metres from the lidar to what it stops for; more than the robot's nose", 0.05, 10.0),
    "half_width": described("metres from the lane's middle to its edge: half the robot and some room", 0.02, 5.0),
    "hue": described("hue to look for, as OpenCV has it: 0 red, 30 yellow, 60 green, 90 cyan, 120 blue", 0, 179),
    "hue_tolerance": described("by which a hue may differ from it", 1, 90),
    "min_saturation": described("least saturation, from 0 for grey to 255 for a pure colour", 0, 255),
    "min_value": described("least brightness, from 0 for black to 255", 0, 255),
    "timeout": described("seconds without an image, or without a scan, after which it stands", 0.05, 60.0),
}


class View(NamedTuple):
    """View of the surroundings, by which a state decides.

    Args:
        offset: Where the blob is, from -1 at the image's left edge to 1 at the right one; None for no blob.
        free: Free metres ahead.
        behind: Free metres behind.
        left_is_freer: True if there is more room on the left.
        lasted: Seconds for which the state has lasted.
    """

    offset: float | None
    free: float
    behind: float
    left_is_freer: bool
    lasted: float


class StateMachine(Node):
    """Node that wanders, and visits blobs of a colour; stops without images or scans, and at its own end."""

    def __init__(self, **options: Any) -> None:
        super().__init__("state_machine", **options)
        for name, value in Settings()._asdict().items():
            self.declare_parameter(name, value, PARAMETERS[name])
        self.states = {
            "wait": self.wait,
            "wander": self.wander,
            "see": self.see,
            "approach": self.approach,
            "back_off": self.back_off,
        }
        self.settings, self.bridge = Settings(), CvBridge()
        self.state = "wait"
        self.started = self.since = self.seconds()
        self.side = 1.0
        """The side to which it turns: 1 left, -1 right."""
        self.scan = LaserScan()
        self.offset: float | None = None
        self.heard: dict[str, float] = {}
        """When the last good message of each sensor came, in seconds."""
        self.is_driving = self.has_warned = False
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.state_topic = self.create_publisher(String, "state", latched)
        images = self.create_subscription(Image, "camera/image_raw", self.on_image, 10)
        scans = self.create_subscription(LaserScan, "scan", self.on_scan, 10)
        self.topics = {"image": images.topic_name, "scan": scans.topic_name}
        self.read_settings()
        self.add_post_set_parameters_callback(self.read_settings)
        self.create_timer(PERIOD, self.on_timer)

    def read_settings(self, _: list[Parameter[Any]] | None = None) -> None:
        """Take over the parameters."""
        self.settings = Settings(*(self.get_parameter(name).value for name in Settings._fields))

    def seconds(self) -> float:
        """Return the node's time in seconds."""
        return self.get_clock().now().nanoseconds * 1e-9

    # Sensors

    def on_image(self, message: Image) -> None:
        """Look for the blob in an image."""
        try:
            image = self.bridge.imgmsg_to_cv2(message, "bgr8")
        except CvBridgeError as error:
            self.get_logger().warning(f"ignored an image: {error}", throttle_duration_sec=5.0)
            return
        if image.size:  # not one without pixels
            self.offset, self.heard["image"] = find_blob(image, self.settings), self.seconds()

    def on_scan(self, scan: LaserScan) -> None:
        """Keep a scan that looks ahead."""
        if not looks_ahead(scan):
            self.get_logger().warning("ignored a scan that does not look ahead", throttle_duration_sec=5.0)
            return
        self.scan, self.heard["scan"] = scan, self.seconds()

    # The machine

    def on_timer(self) -> None:
        """Call the method of the state, publish its command, and go to the next state if there is an event."""
        now = self.seconds()
        silent = [each for each in self.topics if now - self.heard.get(each, -math.inf) > self.settings.timeout]
        if silent:
            self.wait_for(silent[0], now)
            return
        lasted = now - self.since
        twist, event = self.states[self.state](self.view(lasted))
        self.is_driving = True
        self.cmd_vel.publish(twist)
        if not event and lasted > TIMEOUTS[self.state]:
            event = "timeout"
        if event:
            self.enter(TRANSITIONS[self.state, event], f"{event} after {lasted:.1f} s")

    def enter(self, state: str, reason: str) -> None:
        """Begin a state."""
        self.get_logger().info(f"{self.state} -> {state}: {reason}")
        self.state, self.since = state, self.seconds()
        self.state_topic.publish(String(data=state))

    def wait_for(self, sensor: str, now: float) -> None:
        """Stand while a sensor is silent, and warn once; at the start it may take a while."""
        self.stop()
        if self.state != "wait":
            self.enter("wait", f"no {sensor}")
            self.has_warned = False
        is_starting = sensor not in self.heard and now - self.started <= FIRST_WAIT
        if not (self.has_warned or is_starting):
            self.has_warned = True
            seconds = self.settings.timeout if sensor in self.heard else FIRST_WAIT
            words = f"no {sensor} on {self.topics[sensor]} for {seconds:g} s: the robot stands until one comes"
            self.get_logger().warning(words)

    def view(self, lasted: float) -> View:
        """Return the present readings of the sensors."""
        angles, ranges = returns(self.scan)
        free, behind = (lane_ahead(angles + turn, ranges, self.settings.half_width) for turn in (0.0, math.pi))
        ahead = np.cos(angles) > 0.0
        leftness = float(np.sum(np.sin(angles[ahead]) / ranges[ahead]))  # near things count most
        return View(self.offset, free, behind, leftness <= 0.0, lasted)

    # The states: each returns a command and the event that has happened, '' for none

    def wait(self, _: View) -> tuple[Twist, str]:
        """Stand; this is called once all sensors are there."""
        return Twist(), "ready"

    def wander(self, view: View) -> tuple[Twist, str]:
        """Drive ahead, and turn where something is near, until a blob is seen."""
        if view.offset is not None:
            return Twist(), "seen"
        room = view.free - self.settings.stop_distance
        if room > 0.0:
            self.side = 1.0 if view.left_is_freer else -1.0
            return drive(self.settings.speed * min(1.0, room / SLOW_DOWN), 0.0), ""
        return drive(0.0, self.side * self.settings.turn_speed), ""

    def see(self, view: View) -> tuple[Twist, str]:
        """Stand and turn to the blob, until it is in the middle of the image."""
        if view.offset is None:
            return Twist(), "lost" if view.lasted > GLANCE else ""
        if abs(view.offset) < MIDDLE and view.lasted > GLANCE:
            return Twist(), "sure"
        return drive(0.0, -self.settings.turn_speed * view.offset), ""

    def approach(self, view: View) -> tuple[Twist, str]:
        """Drive to the blob, until something is near ahead."""
        room = view.free - self.settings.stop_distance
        if room <= 0.0:
            return Twist(), "reached"
        if view.offset is None:
            return Twist(), "lost"
        speed = self.settings.speed * clipped(room / SLOW_DOWN, 1.0) * (1.0 - abs(view.offset))
        return drive(max(speed, SLOWEST), -self.settings.turn_speed * view.offset), ""

    def back_off(self, view: View) -> tuple[Twist, str]:
        """Back away as far as there is room, and turn about."""
        if view.lasted < BACKWARDS and view.behind > self.settings.stop_distance:
            return drive(-self.settings.speed / 2, 0.0), ""
        if view.lasted < BACKWARDS + ABOUT / self.settings.turn_speed:
            return drive(0.0, self.side * self.settings.turn_speed), ""
        return Twist(), "done"

    # The end

    def stop(self) -> None:
        """Stop the robot, if it was driving."""
        if self.is_driving:
            self.is_driving = False
            self.cmd_vel.publish(Twist())

    def destroy_node(self) -> None:
        """Stop the robot if the context still runs, then destroy the node."""
        with contextlib.suppress(RobolinkError):
            self.stop()
        super().destroy_node()


def drive(speed: float, turn: float) -> Twist:
    """Return a command in m/s and rad/s."""
    return Twist(linear=Vector3(x=speed), angular=Vector3(z=turn))


def find_blob(image: Pixels, settings: Settings) -> float | None:
    """Return where the colour is in an image, from -1 at its left edge to 1 at its right one; None for nowhere."""
    moments = cv2.moments(mask(image, settings), binaryImage=True)
    rows, columns = image.shape[:2]
    if moments["m00"] <= LEAST_SHARE * rows * columns:  # the number of white pixels
        return None
    return float((2 * moments["m10"] / moments["m00"] + 1) / columns - 1)


def mask(image: Pixels, settings: Settings) -> Pixels:
    """Return an image that is 255 where the colour is the wanted one, and else 0."""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    found = np.zeros(image.shape[:2], np.uint8)
    for turn in (-180, 0, 180):  # hues are on a circle: red lies at 179 and at 0
        low = (settings.hue - settings.hue_tolerance + turn, settings.min_saturation, settings.min_value)
        found |= cv2.inRange(hsv, low, (settings.hue + settings.hue_tolerance + turn, 255, 255))
    return found
