"""Webots' sensors, from the topics of a simulated robot."""

from __future__ import annotations

import math

from robolink.interfaces.sensor_msgs.msg import Imu, LaserScan, Range
from robolink.interfaces.std_msgs.msg import Bool
from robolink.webots_controller.topic_sensor import Sensor, nothing


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
