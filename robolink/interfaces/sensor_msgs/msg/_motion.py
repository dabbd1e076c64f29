"""Motion and position of a robot: inertial sensors, joints and satellite fixes.

Covariances are 3 x 3 matrices, row by row; all zeros mean that the covariance is unknown.
"""

from typing import Annotated, ClassVar

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import Quaternion, Transform, Twist, Vector3, Wrench
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, Size, float64, int8, string, uint8, uint16


class Imu(Message):
    """Measurement of an inertial measurement unit along the header's axes: orientation, rad/s and m/s².

    A covariance that begins with -1 says that its quantity is not measured.
    """

    header: Header
    orientation: Quaternion
    orientation_covariance: Annotated[Sequence[float64], Size(9)]
    angular_velocity: Vector3
    angular_velocity_covariance: Annotated[Sequence[float64], Size(9)]
    linear_acceleration: Vector3
    linear_acceleration_covariance: Annotated[Sequence[float64], Size(9)]


class MagneticField(Message):
    """The magnetic field in tesla along the header's axes; an axis that is not measured is NaN."""

    header: Header
    magnetic_field: Vector3
    magnetic_field_covariance: Annotated[Sequence[float64], Size(9)]


class JointState(Message):
    """The state of joints, all at the same time: element i of each list is about the joint ``name[i]``.

    Revolute joints are given in rad, rad/s and N·m, prismatic ones in m, m/s and N. A list may be empty when
    its quantity is not known.
    """

    header: Header
    name: Sequence[string]
    position: Sequence[float64]
    velocity: Sequence[float64]
    effort: Sequence[float64]


class MultiDOFJointState(Message):
    """The state of joints with several degrees of freedom; element i of each list is ``joint_names[i]``'s.

    A joint's position is the transform across it, in metres. A list may be empty when its quantity is not
    known.
    """

    header: Header
    joint_names: Sequence[string]
    transforms: Sequence[Transform]
    twist: Sequence[Twist]
    wrench: Sequence[Wrench]


class NavSatStatus(Message):
    """Status of a satellite receiver: it has a fix if `status` is at least STATUS_FIX, from the systems of `service`.

    `service` adds up the SERVICE codes of the systems in use.
    """

    STATUS_UNKNOWN: ClassVar[int8] = -2
    STATUS_NO_FIX: ClassVar[int8] = -1
    STATUS_FIX: ClassVar[int8] = 0
    STATUS_SBAS_FIX: ClassVar[int8] = 1
    STATUS_GBAS_FIX: ClassVar[int8] = 2
    SERVICE_UNKNOWN: ClassVar[uint16] = 0
    SERVICE_GPS: ClassVar[uint16] = 1
    SERVICE_GLONASS: ClassVar[uint16] = 2
    SERVICE_COMPASS: ClassVar[uint16] = 4
    SERVICE_GALILEO: ClassVar[uint16] = 8

    status: int8 = -2
    service: uint16


class NavSatFix(Message):
    """A place on earth (WGS 84): degrees north and degrees east, and metres above the ellipsoid.

    The covariance is in m² over east, north and up; `position_covariance_type` says how far to trust it. The
    header's frame is the antenna. An altitude that is not known is NaN.
    """

    COVARIANCE_TYPE_UNKNOWN: ClassVar[uint8] = 0
    COVARIANCE_TYPE_APPROXIMATED: ClassVar[uint8] = 1
    COVARIANCE_TYPE_DIAGONAL_KNOWN: ClassVar[uint8] = 2
    COVARIANCE_TYPE_KNOWN: ClassVar[uint8] = 3

    header: Header
    status: NavSatStatus
    latitude: float64
    longitude: float64
    altitude: float64
    position_covariance: Annotated[Sequence[float64], Size(9)]
    position_covariance_type: uint8


class TimeReference(Message):
    """Time of another clock, named `source`, at the system time ``header.stamp``."""

    header: Header
    time_ref: Time
    source: string
