"""Distances: laser scans, single rangers and point clouds."""

from typing import ClassVar

from robolink.interfaces.geometry_msgs.msg import Point32
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, float32, string, uint8, uint32


class LaserScan(Message):
    """One sweep of a planar laser scanner, in metres, radians and seconds.

    Beam i points to ``angle_min + i * angle_increment``, counter-clockwise about the frame's z axis from its
    x axis. A range below `range_min` or above `range_max` is no measurement. ``header.stamp`` is the time of
    the first beam, `time_increment` passes from beam to beam and `scan_time` from scan to scan. `intensities`
    have the device's own unit and may be empty.
    """

    header: Header
    angle_min: float32
    angle_max: float32
    angle_increment: float32
    time_increment: float32
    scan_time: float32
    range_min: float32
    range_max: float32
    ranges: Sequence[float32]
    intensities: Sequence[float32]


class LaserEcho(Message):
    """The ranges in metres, or the intensities, that one beam of a MultiEchoLaserScan brought back."""

    echoes: Sequence[float32]


class MultiEchoLaserScan(Message):
    """A laser scan with several echoes a beam; angles, times and limits are those of LaserScan.

    +inf is beyond reach, -inf too near to measure.
    """

    header: Header
    angle_min: float32
    angle_max: float32
    angle_increment: float32
    time_increment: float32
    scan_time: float32
    range_min: float32
    range_max: float32
    ranges: Sequence[LaserEcho]
    intensities: Sequence[LaserEcho]


class Range(Message):
    """The distance in metres that a sonar or infrared sensor found in its cone about the frame's x axis.

    `field_of_view` is the whole opening angle in radians. A `range` outside `min_range` to `max_range` is no
    measurement. Where both limits are equal the sensor only says whether something is nearer: -inf yes, +inf
    no. `variance` is in m², 0 when unknown.
    """

    ULTRASOUND: ClassVar[uint8] = 0
    INFRARED: ClassVar[uint8] = 1

    header: Header
    radiation_type: uint8
    field_of_view: float32
    min_range: float32
    max_range: float32
    range: float32
    variance: float32


class PointField(Message):
    """One channel of a PointCloud2, such as ``x`` or ``intensity``.

    It starts `offset` bytes into each point and holds `count` values of type `datatype`.
    """

    INT8: ClassVar[uint8] = 1
    UINT8: ClassVar[uint8] = 2
    INT16: ClassVar[uint8] = 3
    UINT16: ClassVar[uint8] = 4
    INT32: ClassVar[uint8] = 5
    UINT32: ClassVar[uint8] = 6
    FLOAT32: ClassVar[uint8] = 7
    FLOAT64: ClassVar[uint8] = 8

    name: string
    offset: uint32
    datatype: uint8
    count: uint32


class PointCloud2(Message):
    """Points as packed binary records: `point_step` bytes a point, `row_step` bytes a row.

    A cloud without order is one row (`height` 1). `fields` say what a record holds; coordinates are metres in
    the header's frame. `is_dense` says that every point is valid.
    """

    header: Header
    height: uint32
    width: uint32
    fields: Sequence[PointField]
    is_bigendian: bool
    point_step: uint32
    row_step: uint32
    data: Sequence[uint8]
    is_dense: bool


class ChannelFloat32(Message):
    """A named value for each point of a PointCloud, such as ``intensity``."""

    name: string
    values: Sequence[float32]


class PointCloud(Message):
    """Points in metres with one value each a channel. Deprecated in ROS 2: PointCloud2 took its place."""

    header: Header
    points: Sequence[Point32]
    channels: Sequence[ChannelFloat32]
