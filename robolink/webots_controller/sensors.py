"""Webots' sensors: each has the values of its topic, once it is enabled."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import Generic, TypeVar

from robolink.interfaces.sensor_msgs.msg import Imu, JointState, LaserScan, Range
from robolink.interfaces.std_msgs.msg import Bool
from robolink.message import Message, type_name
from robolink.node import Node
from robolink.subscription import Subscription

MessageT = TypeVar("MessageT", bound=Message)


def plain(name: str) -> str:
    """Return a name without characters that ROS cannot spell, to compare: `LDS-01` is `lds_01` there.

    >>> plain("LDS-01"), plain("lds_01")
    ('lds01', 'lds01')
    """
    return "".join(filter(str.isalnum, name.lower()))


def words_of(name: str) -> set[str]:
    """Return the words and numbers of a device's name, to compare.

    >>> words_of("left_wheel sensor") == {"left", "wheel", "sensor"}, words_of("encoder1") == {"encoder", "1"}
    (True, True)
    """
    return set(re.findall(r"[^\W\d_]+|\d+", name.lower()))


class RobotTopics:
    """The topics of one robot: `prefix` is its name and a slash where there are several, else ''; or it is absolute."""

    def __init__(self, node: Node, prefix: str) -> None:
        self.node, self.prefix = node, prefix
        self.joint_states = node.resolve_topic_name(f"{prefix}joint_states")
        self._base = self.joint_states.rpartition("/")[0]

    def of_type(self, message: type[Message]) -> list[str]:
        """Return the names of the robot's topics of this type, without their common prefix.

        Topics that only have subscriptions, or publishers of this node alone, are not sensors.
        """
        expected, base = type_name(message), self._base + "/"
        found = self.node.get_topic_names_and_types()
        names = [name for name, types in found if expected in types and name.startswith(base)]
        return [name.removeprefix(base) for name in names if self._is_of_others(name)]

    def _is_of_others(self, topic: str) -> bool:
        own = (self.node.get_name(), self.node.get_namespace())
        publishers = self.node.get_publishers_info_by_topic(topic)
        return any((each.node_name, each.node_namespace) != own for each in publishers)

    def elsewhere(self) -> list[str]:
        """Return the joint_states topics of all robots."""
        expected, found = type_name(JointState), self.node.get_topic_names_and_types()
        names = [name for name, types in found if expected in types and name.endswith("/joint_states")]
        return [name for name in names if self.node.count_publishers(name)]

    def find(self, message: type[Message], name: str, *, or_only: bool) -> str:
        """Return the topic of a sensor by its name, or if `or_only` the only one of this type; '' if there is none."""
        topics = self.of_type(message)
        found = next((each for each in topics if plain(each) == plain(name)), "")
        return found or (topics[0] if or_only and len(topics) == 1 else "")


def quoted(names: Iterable[str]) -> str:
    """Return names in quotes, or 'none'."""
    return ", ".join(f"'{each}'" for each in names) or "none"


class Device:
    """Base class of devices: a name."""

    def __init__(self, topics: RobotTopics, name: str) -> None:
        self._topics, self._name = topics, name

    def getName(self) -> str:
        """Return the name that the device has in the world."""
        return self._name


class Sensor(Device, Generic[MessageT]):
    """Base class of sensors with topics of type `message`; a value comes once enabled, with the first message."""

    message: type[MessageT]
    any_name = False
    """True if any name means the only sensor of its kind, since the world does not keep the name."""

    def __init__(self, topics: RobotTopics, name: str) -> None:
        super().__init__(topics, name)
        self._period = 0
        self._subscription: Subscription[MessageT] | None = None
        self._latest: MessageT | None = None

    @classmethod
    def topic_of(cls, name: str) -> str:
        """Return the name of the topic of a device."""
        return name

    @classmethod
    def found(cls, topics: RobotTopics, name: str, *, or_only: bool) -> str:
        """Return the topic of a sensor of this class, or if `or_only` the only one of its type; '' for none."""
        return topics.find(cls.message, cls.topic_of(name), or_only=or_only)

    def enable(self, samplingPeriod: int) -> None:
        """Enable the sensor; the world decides how often it measures, not `samplingPeriod` (ms)."""
        self._period = int(samplingPeriod)
        self._subscribe()

    def disable(self) -> None:
        """Disable the sensor."""
        self._period, self._latest = 0, None
        if self._subscription is not None:
            self._topics.node.destroy_subscription(self._subscription)
            self._subscription = None

    def getSamplingPeriod(self) -> int:
        """Return the sampling period in ms; 0 if disabled."""
        return self._period

    def _subscribe(self) -> None:
        if self._subscription is None and self._period:
            topic = self.found(self._topics, self._name, or_only=self.any_name)
            if topic:
                name = f"{self._topics.prefix}{topic}"
                self._subscription = self._topics.node.create_subscription(self.message, name, self._on_message, 10)

    def _on_message(self, message: MessageT) -> None:
        self._latest = message

    @property
    def latest(self) -> MessageT | None:
        """The latest message; None if there is none."""
        self._subscribe()
        return self._latest


def nothing(count: int) -> list[float]:
    """Return `count` NaN: the value of a Webots sensor before its first measurement."""
    return [math.nan] * count


class Lidar(Sensor[LaserScan]):
    """A lidar of one layer."""

    message = LaserScan
    any_name = True

    def getRangeImage(self) -> list[float]:
        """Return the ranges in metres from left to right, inf for no return; empty before the first scan."""
        scan = self.latest
        ranges = reversed(scan.ranges) if scan else ()
        return [math.inf if math.isinf(each) else float(each) for each in ranges]

    def getLayerRangeImage(self, layer: int) -> list[float]:
        """Return the ranges of layer 0, the only one. Raises IndexError for others."""
        if layer != 0:
            raise IndexError(f"lidar '{self._name}' has no layer {layer}, only layer 0")
        return self.getRangeImage()

    def getNumberOfLayers(self) -> int:
        """Return 1."""
        return 1

    def getHorizontalResolution(self) -> int:
        """Return the number of beams; 0 before the first scan."""
        return len(self.latest.ranges) if self.latest else 0

    def getFov(self) -> float:
        """Return the field of view in radians; NaN before the first scan."""
        scan = self.latest
        if scan is None:
            return math.nan
        angle = scan.angle_increment * len(scan.ranges)
        return float(math.tau if abs(angle - math.tau) < 1e-3 else scan.angle_max - scan.angle_min)

    def getMinRange(self) -> float:
        """Return the shortest range in metres; NaN before the first scan."""
        return float(self.latest.range_min) if self.latest else math.nan

    def getMaxRange(self) -> float:
        """Return the longest range in metres; NaN before the first scan."""
        return float(self.latest.range_max) if self.latest else math.nan


class DistanceSensor(Sensor[Range]):
    """A distance sensor; it measures metres, whatever its lookupTable says."""

    message = Range

    def getValue(self) -> float:
        """Return the distance in metres, the greatest value for no echo; NaN before the first reading."""
        reading = self.latest
        if reading is None:
            return math.nan
        return float(min(max(reading.range, reading.min_range), reading.max_range))

    def getMinValue(self) -> float:
        """Return the least value in metres; NaN before the first reading."""
        return float(self.latest.min_range) if self.latest else math.nan

    def getMaxValue(self) -> float:
        """Return the greatest value in metres; NaN before the first reading."""
        return float(self.latest.max_range) if self.latest else math.nan

    def getAperture(self) -> float:
        """Return the angle of its field of view in radians; NaN before the first reading."""
        return float(self.latest.field_of_view) if self.latest else math.nan


class TouchSensor(Sensor[Bool]):
    """A bumper."""

    message = Bool

    def getValue(self) -> float:
        """Return 1 if it has been touched since the last reading, else 0; NaN before the first reading."""
        return float(self.latest.data) if self.latest else math.nan


class InertialUnit(Sensor[Imu]):
    """The robot's heading."""

    message = Imu
    any_name = True

    def getRollPitchYaw(self) -> list[float]:
        """Return three angles in radians, of which only the last may differ from 0; NaN before the first reading."""
        if self.latest is None:
            return nothing(3)
        q = self.latest.orientation
        return [0.0, 0.0, math.remainder(2.0 * math.atan2(q.z, q.w), math.tau)]

    def getQuaternion(self) -> list[float]:
        """Return x, y, z, w; NaN before the first reading."""
        if self.latest is None:
            return nothing(4)
        q = self.latest.orientation
        return [q.x, q.y, q.z, q.w]


class Gyro(Sensor[Imu]):
    """The robot's turning."""

    message = Imu
    any_name = True

    def getValues(self) -> list[float]:
        """Return the turning speeds in rad/s about x, y and z; NaN before the first reading."""
        if self.latest is None:
            return nothing(3)
        turning = self.latest.angular_velocity
        return [turning.x, turning.y, turning.z]


class Accelerometer(Sensor[Imu]):
    """The robot's acceleration, with the floor that carries it along z."""

    message = Imu
    any_name = True

    def getValues(self) -> list[float]:
        """Return the accelerations in m/s² along x, y and z; NaN before the first reading."""
        if self.latest is None:
            return nothing(3)
        acceleration = self.latest.linear_acceleration
        return [acceleration.x, acceleration.y, acceleration.z]
