"""Relays of a robot's devices: what the world publishes, on the topics that Webots' driver has for them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

from robolink.counterparts.webots_ros2_driver.section import Device, Section
from robolink.exceptions import nearest
from robolink.interfaces.sensor_msgs.msg import CameraInfo, Image, Imu, LaserScan, Range
from robolink.message import Message
from robolink.node import Node
from robolink.subscription import Subscription
from robolink.text.names import spelled
from robolink.webots_controller.cameras import Camera, RangeFinder
from robolink.webots_controller.sensors import DistanceSensor, InertialUnit, Lidar, RobotTopics, Sensor

KINDS: dict[str, type[Sensor[Any]]] = {
    "Lidar": Lidar,
    "DistanceSensor": DistanceSensor,
    "RangeFinder": RangeFinder,
    "Camera": Camera,
}
"""Kinds of devices that have topics; whatever has depths is a range finder."""
IMAGES = {"Camera": "/image_color", "RangeFinder": "/image"}
"""Last part of the image topics of Webots' driver."""
EARLY = 0.1
"""Part of the period by which a message may come too early."""


class DeviceError(ValueError):
    """A device's settings have a mistake, or the world lacks the device."""


class Stream(NamedTuple):
    """Messages of one type, from a topic of the world to one of the driver."""

    message: type[Message]
    source: str
    target: str


class Relay:
    """Passes on the messages of a stream, while somebody listens.

    Args:
        node: The driver.
        stream: From where to where.
        settings: `alwaysOn`, `updateRate` in Hz, and `frameName`.

    Raises:
        DeviceError: for settings that are none.
    """

    def __init__(self, node: Node, stream: Stream, settings: dict[str, str]) -> None:
        self._node, self._stream = node, stream
        self._always = settings.get("alwaysOn", "").lower() == "true"
        self._frame, self._period = settings.get("frameName", ""), period(settings.get("updateRate", ""))
        self._last = -math.inf
        self._publisher = node.create_publisher(stream.message, stream.target, 10)
        self._subscription: Subscription[Any] | None = None

    def look(self) -> None:
        """Begin to listen, or stop it, as there are listeners."""
        is_needed = self._always or self._publisher.get_subscription_count() > 0
        if is_needed and self._subscription is None:
            self._subscription = self._node.create_subscription(
                self._stream.message, self._stream.source, self._pass_on, 10
            )
        elif not is_needed and self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None

    def _pass_on(self, message: Any) -> None:
        stamp = message.header.stamp.sec + message.header.stamp.nanosec / 1e9
        if 0.0 <= stamp - self._last < self._period * (1.0 - EARLY):
            return
        self._last = stamp
        if self._frame:
            message.header.frame_id = self._frame
        if isinstance(message, Range):
            as_webots_range(message)
        elif isinstance(message, LaserScan):
            as_webots_scan(message)
        self._publisher.publish(message)


def as_webots_range(message: Range) -> None:
    """Convert a message to the form of Webots' driver: all is infrared, and nothing there is the end of the range."""
    message.radiation_type = Range.INFRARED
    message.range = min(max(message.range, message.min_range), message.max_range)


def as_webots_scan(message: LaserScan) -> None:
    """Turn a scan round: Webots' lidars scan from left to right, so that programs count their beams from the left."""
    message.angle_min, message.angle_max = message.angle_max, message.angle_min
    message.angle_increment = -message.angle_increment
    message.ranges = message.ranges[::-1]
    message.intensities = message.intensities[::-1]


def make_relays(node: Node, topics: RobotTopics, section: Section, imus: list[dict[str, str]]) -> list[Relay]:
    """Return the relays of a robot; what cannot be relayed is logged.

    Args:
        node: The driver.
        topics: Topics of the robot in the world.
        section: Devices and their settings.
        imus: Settings of the plugins for an inertial unit.
    """
    others = [Device(name, kind, {}, element) for name, kind, element in _unnamed(topics, section)]
    relays: list[Relay] = []
    for device in [*section.devices, *others]:
        if device.settings.get("enabled", "true").lower() == "false":
            continue
        try:
            found = [Relay(node, each, device.settings) for each in _streams(node, topics, device)]
        except DeviceError as error:
            node.get_logger().warning(f"left out: device '{device.name}': {error}")
            continue
        relays += found
    for settings in imus:
        source = InertialUnit.found(topics, "imu", or_only=True)
        stream = Stream(Imu, f"{topics.prefix}{source}", settings.get("topicName", "~/imu"))
        if source and not _is_same(node, stream):
            relays.append(Relay(node, stream, settings))
    return relays


def period(rate: str) -> float:
    """Return the period in seconds of a rate in Hz; 0 for no rate.

    Raises:
        DeviceError: for a text that is not a positive number.
    """
    try:
        value = float(rate or "inf")
    except ValueError:
        value = math.nan
    if not value > 0.0:
        raise DeviceError(f"<updateRate> is a positive number of Hz, got '{rate[:40]}'")
    return 1.0 / value


def _streams(node: Node, topics: RobotTopics, device: Device) -> list[Stream]:
    """Return the streams of a device, but for those that the world serves itself by that name."""
    if device.kind and device.kind not in KINDS:
        raise DeviceError(f"the world publishes nothing of a {device.kind}")
    kinds = [device.kind] if device.kind else list(KINDS)
    found = [(kind, KINDS[kind].found(topics, device.name, or_only=KINDS[kind].any_name)) for kind in kinds]
    kind, source = next((each for each in found if each[1]), ("", ""))
    if not source:
        known = [name for name, _ in devices_in(topics)]
        raise DeviceError(f"the world's robot has none of this name{nearest(device.name, known)}")
    full, target = f"{topics.prefix}{source}", device.settings.get("topicName", f"~/{spelled(device.name, 'device')}")
    if kind in IMAGES:
        image = Stream(Image, full, target + device.settings.get("imageSuffix", IMAGES[kind]))
        about = full.removesuffix("image_raw") + "camera_info"
        info = Stream(CameraInfo, about, target + device.settings.get("cameraInfoSuffix", "/camera_info"))
        streams = [image, info]
    else:
        streams = [Stream(KINDS[kind].message, full, target)]
    return [each for each in streams if not _is_same(node, each)]


def _is_same(node: Node, stream: Stream) -> bool:
    return node.resolve_topic_name(stream.source) == node.resolve_topic_name(stream.target)


def devices_in(topics: RobotTopics) -> Iterator[tuple[str, str]]:
    """Yield name and kind of each device of a robot that has topics, as the world spells the names."""
    yield from ((each, "Lidar") for each in topics.of_type(LaserScan))
    yield from ((each, "DistanceSensor") for each in topics.of_type(Range))
    for each in topics.of_type(Image):
        kind = "RangeFinder" if each.endswith(RangeFinder.topic_of("")) else "Camera"
        if each.endswith(KINDS[kind].topic_of("")):
            yield each.removesuffix(KINDS[kind].topic_of("")), kind


def _unnamed(topics: RobotTopics, section: Section) -> Iterator[tuple[str, str, Any]]:
    """Yield name and kind of the devices that the section does not speak of."""
    named = {spelled(each.name, "device").lower() for each in section.devices}
    for name, kind in devices_in(topics):
        is_only_lidar = kind == "Lidar" and any(each.kind == "Lidar" for each in section.devices)
        if spelled(name, "device").lower() not in named and not is_only_lidar:
            yield name, kind, None
