# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.sensor_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["BatteryState", "CameraInfo", "ChannelFloat32", "CompressedImage", "FluidPressure", "Illuminance", "Image", "Imu", "JointState", "Joy", "JoyFeedback", "JoyFeedbackArray", "LaserEcho", "LaserScan", "MagneticField", "MultiDOFJointState", "MultiEchoLaserScan", "NavSatFix", "NavSatStatus", "PointCloud", "PointCloud2", "PointField", "Range", "RegionOfInterest", "RelativeHumidity", "Temperature", "TimeReference"]

class BatteryState(robolink.message.Message):
    """A battery's charge and health; a number that is not measured is NaN.

    `voltage` is in volts, `temperature` in degrees Celsius, `current` in amperes (negative while
    discharging), `charge` (now), `capacity` (when last full) and `design_capacity` in ampere hours,
    `percentage` from 0.0 to 1.0. `cell_voltage` and `cell_temperature` have an element for each cell;
    `location` is the slot.
    """
    POWER_SUPPLY_STATUS_UNKNOWN: typing.ClassVar[builtins.int]
    POWER_SUPPLY_STATUS_CHARGING: typing.ClassVar[builtins.int]
    POWER_SUPPLY_STATUS_DISCHARGING: typing.ClassVar[builtins.int]
    POWER_SUPPLY_STATUS_NOT_CHARGING: typing.ClassVar[builtins.int]
    POWER_SUPPLY_STATUS_FULL: typing.ClassVar[builtins.int]
    POWER_SUPPLY_HEALTH_UNKNOWN: typing.ClassVar[builtins.int]
    POWER_SUPPLY_HEALTH_GOOD: typing.ClassVar[builtins.int]
    POWER_SUPPLY_HEALTH_OVERHEAT: typing.ClassVar[builtins.int]
    POWER_SUPPLY_HEALTH_DEAD: typing.ClassVar[builtins.int]
    POWER_SUPPLY_HEALTH_OVERVOLTAGE: typing.ClassVar[builtins.int]
    POWER_SUPPLY_HEALTH_UNSPEC_FAILURE: typing.ClassVar[builtins.int]
    POWER_SUPPLY_HEALTH_COLD: typing.ClassVar[builtins.int]
    POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE: typing.ClassVar[builtins.int]
    POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE: typing.ClassVar[builtins.int]
    POWER_SUPPLY_TECHNOLOGY_UNKNOWN: typing.ClassVar[builtins.int]
    POWER_SUPPLY_TECHNOLOGY_NIMH: typing.ClassVar[builtins.int]
    POWER_SUPPLY_TECHNOLOGY_LION: typing.ClassVar[builtins.int]
    POWER_SUPPLY_TECHNOLOGY_LIPO: typing.ClassVar[builtins.int]
    POWER_SUPPLY_TECHNOLOGY_LIFE: typing.ClassVar[builtins.int]
    POWER_SUPPLY_TECHNOLOGY_NICD: typing.ClassVar[builtins.int]
    POWER_SUPPLY_TECHNOLOGY_LIMN: typing.ClassVar[builtins.int]
    POWER_SUPPLY_TECHNOLOGY_TERNARY: typing.ClassVar[builtins.int]
    POWER_SUPPLY_TECHNOLOGY_VRLA: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    voltage: builtins.float
    temperature: builtins.float
    current: builtins.float
    charge: builtins.float
    capacity: builtins.float
    design_capacity: builtins.float
    percentage: builtins.float
    power_supply_status: builtins.int
    power_supply_health: builtins.int
    power_supply_technology: builtins.int
    present: builtins.bool
    cell_voltage: collections.abc.MutableSequence[builtins.float]
    cell_temperature: collections.abc.MutableSequence[builtins.float]
    location: builtins.str
    serial_number: builtins.str
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., voltage: builtins.float = ..., temperature: builtins.float = ..., current: builtins.float = ..., charge: builtins.float = ..., capacity: builtins.float = ..., design_capacity: builtins.float = ..., percentage: builtins.float = ..., power_supply_status: builtins.int = ..., power_supply_health: builtins.int = ..., power_supply_technology: builtins.int = ..., present: builtins.bool = ..., cell_voltage: collections.abc.Iterable[builtins.float] = ..., cell_temperature: collections.abc.Iterable[builtins.float] = ..., location: builtins.str = ..., serial_number: builtins.str = ...) -> None: ...
class CameraInfo(robolink.message.Message):
    """A camera's calibration, sent along with each of its images. Matrices are row by row, in pixels.

    `k` (3 x 3) projects points of the optical frame to the raw image, `d` are the coefficients of the
    `distortion_model` (``plumb_bob``: k1, k2, t1, t2, k3), `r` (3 x 3) turns the camera so that a stereo
    pair's rows align, and `p` (3 x 4) projects to the rectified image; its last column holds the stereo
    baseline times the focal length. `width` and `height` are those of the calibration. ``k[0] == 0`` means:
    not calibrated. A binning of 0 is the same as 1.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    height: builtins.int
    width: builtins.int
    distortion_model: builtins.str
    d: collections.abc.MutableSequence[builtins.float]
    k: collections.abc.MutableSequence[builtins.float]
    r: collections.abc.MutableSequence[builtins.float]
    p: collections.abc.MutableSequence[builtins.float]
    binning_x: builtins.int
    binning_y: builtins.int
    roi: robolink.interfaces.sensor_msgs.msg.RegionOfInterest
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., height: builtins.int = ..., width: builtins.int = ..., distortion_model: builtins.str = ..., d: collections.abc.Iterable[builtins.float] = ..., k: collections.abc.Iterable[builtins.float] = ..., r: collections.abc.Iterable[builtins.float] = ..., p: collections.abc.Iterable[builtins.float] = ..., binning_x: builtins.int = ..., binning_y: builtins.int = ..., roi: robolink.interfaces.sensor_msgs.msg.RegionOfInterest = ...) -> None: ...
class ChannelFloat32(robolink.message.Message):
    """A named value for each point of a PointCloud, such as ``intensity``."""
    name: builtins.str
    values: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, name: builtins.str = ..., values: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class CompressedImage(robolink.message.Message):
    """A picture as the bytes of a JPEG, PNG or similar file.

    `format` is the pixels' encoding and the codec (``rgb8; jpeg compressed bgr8``), or just ``jpeg`` or
    ``png``.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    format: builtins.str
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., format: builtins.str = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class FluidPressure(robolink.message.Message):
    """The absolute pressure of air or water, in pascals, and its variance in Pa²."""
    header: robolink.interfaces.std_msgs.msg.Header
    fluid_pressure: builtins.float
    variance: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., fluid_pressure: builtins.float = ..., variance: builtins.float = ...) -> None: ...
class Illuminance(robolink.message.Message):
    """The brightness of light that falls on the sensor along its x axis, in lux, and its variance in lux²."""
    header: robolink.interfaces.std_msgs.msg.Header
    illuminance: builtins.float
    variance: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., illuminance: builtins.float = ..., variance: builtins.float = ...) -> None: ...
class Image(robolink.message.Message):
    """A picture as raw pixels, row by row from the top left.

    `height` and `width` count pixels, `step` is the length of a row in bytes, so `data` holds ``step *
    height``. `encoding` names channels, order and size of a pixel: ``mono8``, ``rgb8``, ``bgr8``, ``16UC1``,
    ``32FC1`` ...
    """
    header: robolink.interfaces.std_msgs.msg.Header
    height: builtins.int
    width: builtins.int
    encoding: builtins.str
    is_bigendian: builtins.int
    step: builtins.int
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., height: builtins.int = ..., width: builtins.int = ..., encoding: builtins.str = ..., is_bigendian: builtins.int = ..., step: builtins.int = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class Imu(robolink.message.Message):
    """Measurement of an inertial measurement unit along the header's axes: orientation, rad/s and m/s².

    A covariance that begins with -1 says that its quantity is not measured.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    orientation: robolink.interfaces.geometry_msgs.msg.Quaternion
    orientation_covariance: collections.abc.MutableSequence[builtins.float]
    angular_velocity: robolink.interfaces.geometry_msgs.msg.Vector3
    angular_velocity_covariance: collections.abc.MutableSequence[builtins.float]
    linear_acceleration: robolink.interfaces.geometry_msgs.msg.Vector3
    linear_acceleration_covariance: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., orientation: robolink.interfaces.geometry_msgs.msg.Quaternion = ..., orientation_covariance: collections.abc.Iterable[builtins.float] = ..., angular_velocity: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., angular_velocity_covariance: collections.abc.Iterable[builtins.float] = ..., linear_acceleration: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., linear_acceleration_covariance: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class JointState(robolink.message.Message):
    """The state of joints, all at the same time: element i of each list is about the joint ``name[i]``.

    Revolute joints are given in rad, rad/s and N·m, prismatic ones in m, m/s and N. A list may be empty when
    its quantity is not known.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    name: collections.abc.MutableSequence[builtins.str]
    position: collections.abc.MutableSequence[builtins.float]
    velocity: collections.abc.MutableSequence[builtins.float]
    effort: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., name: collections.abc.Iterable[builtins.str] = ..., position: collections.abc.Iterable[builtins.float] = ..., velocity: collections.abc.Iterable[builtins.float] = ..., effort: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class Joy(robolink.message.Message):
    """The positions of a joystick's axes (-1.0 to 1.0) and buttons (1 is pressed), when they were read."""
    header: robolink.interfaces.std_msgs.msg.Header
    axes: collections.abc.MutableSequence[builtins.float]
    buttons: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., axes: collections.abc.Iterable[builtins.float] = ..., buttons: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class JoyFeedback(robolink.message.Message):
    """A joystick's light, rumble motor or buzzer number `id`: off at 0.0, fully on at 1.0."""
    TYPE_LED: typing.ClassVar[builtins.int]
    TYPE_RUMBLE: typing.ClassVar[builtins.int]
    TYPE_BUZZER: typing.ClassVar[builtins.int]
    type: builtins.int
    id: builtins.int
    intensity: builtins.float
    def __init__(self, *, type: builtins.int = ..., id: builtins.int = ..., intensity: builtins.float = ...) -> None: ...
class JoyFeedbackArray(robolink.message.Message):
    """Several settings for a joystick at once."""
    array: collections.abc.MutableSequence[robolink.interfaces.sensor_msgs.msg.JoyFeedback]
    def __init__(self, *, array: collections.abc.Iterable[robolink.interfaces.sensor_msgs.msg.JoyFeedback] = ...) -> None: ...
class LaserEcho(robolink.message.Message):
    """The ranges in metres, or the intensities, that one beam of a MultiEchoLaserScan brought back."""
    echoes: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, echoes: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class LaserScan(robolink.message.Message):
    """One sweep of a planar laser scanner, in metres, radians and seconds.

    Beam i points to ``angle_min + i * angle_increment``, counter-clockwise about the frame's z axis from its
    x axis. A range below `range_min` or above `range_max` is not a measurement. ``header.stamp`` is the time of
    the first beam, `time_increment` passes from beam to beam and `scan_time` from scan to scan. `intensities`
    have the device's own unit and may be empty.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    angle_min: builtins.float
    angle_max: builtins.float
    angle_increment: builtins.float
    time_increment: builtins.float
    scan_time: builtins.float
    range_min: builtins.float
    range_max: builtins.float
    ranges: collections.abc.MutableSequence[builtins.float]
    intensities: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., angle_min: builtins.float = ..., angle_max: builtins.float = ..., angle_increment: builtins.float = ..., time_increment: builtins.float = ..., scan_time: builtins.float = ..., range_min: builtins.float = ..., range_max: builtins.float = ..., ranges: collections.abc.Iterable[builtins.float] = ..., intensities: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class MagneticField(robolink.message.Message):
    """The magnetic field in tesla along the header's axes; an axis that is not measured is NaN."""
    header: robolink.interfaces.std_msgs.msg.Header
    magnetic_field: robolink.interfaces.geometry_msgs.msg.Vector3
    magnetic_field_covariance: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., magnetic_field: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., magnetic_field_covariance: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class MultiDOFJointState(robolink.message.Message):
    """The state of joints with several degrees of freedom; element i of each list is ``joint_names[i]``'s.

    A joint's position is the transform across it, in metres. A list may be empty when its quantity is not
    known.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    joint_names: collections.abc.MutableSequence[builtins.str]
    transforms: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Transform]
    twist: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Twist]
    wrench: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Wrench]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., joint_names: collections.abc.Iterable[builtins.str] = ..., transforms: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Transform] = ..., twist: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Twist] = ..., wrench: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Wrench] = ...) -> None: ...
class MultiEchoLaserScan(robolink.message.Message):
    """A laser scan with several echoes a beam; angles, times and limits are those of LaserScan.

    +inf is beyond reach, -inf too near to measure.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    angle_min: builtins.float
    angle_max: builtins.float
    angle_increment: builtins.float
    time_increment: builtins.float
    scan_time: builtins.float
    range_min: builtins.float
    range_max: builtins.float
    ranges: collections.abc.MutableSequence[robolink.interfaces.sensor_msgs.msg.LaserEcho]
    intensities: collections.abc.MutableSequence[robolink.interfaces.sensor_msgs.msg.LaserEcho]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., angle_min: builtins.float = ..., angle_max: builtins.float = ..., angle_increment: builtins.float = ..., time_increment: builtins.float = ..., scan_time: builtins.float = ..., range_min: builtins.float = ..., range_max: builtins.float = ..., ranges: collections.abc.Iterable[robolink.interfaces.sensor_msgs.msg.LaserEcho] = ..., intensities: collections.abc.Iterable[robolink.interfaces.sensor_msgs.msg.LaserEcho] = ...) -> None: ...
class NavSatFix(robolink.message.Message):
    """A place on earth (WGS 84): degrees north and degrees east, and metres above the ellipsoid.

    The covariance is in m² over east, north and up; `position_covariance_type` says how far to trust it. The
    header's frame is the antenna. An altitude that is not known is NaN.
    """
    COVARIANCE_TYPE_UNKNOWN: typing.ClassVar[builtins.int]
    COVARIANCE_TYPE_APPROXIMATED: typing.ClassVar[builtins.int]
    COVARIANCE_TYPE_DIAGONAL_KNOWN: typing.ClassVar[builtins.int]
    COVARIANCE_TYPE_KNOWN: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    status: robolink.interfaces.sensor_msgs.msg.NavSatStatus
    latitude: builtins.float
    longitude: builtins.float
    altitude: builtins.float
    position_covariance: collections.abc.MutableSequence[builtins.float]
    position_covariance_type: builtins.int
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., status: robolink.interfaces.sensor_msgs.msg.NavSatStatus = ..., latitude: builtins.float = ..., longitude: builtins.float = ..., altitude: builtins.float = ..., position_covariance: collections.abc.Iterable[builtins.float] = ..., position_covariance_type: builtins.int = ...) -> None: ...
class NavSatStatus(robolink.message.Message):
    """Status of a satellite receiver: it has a fix if `status` is at least STATUS_FIX, from the systems of `service`.

    `service` adds up the SERVICE codes of the systems in use.
    """
    STATUS_UNKNOWN: typing.ClassVar[builtins.int]
    STATUS_NO_FIX: typing.ClassVar[builtins.int]
    STATUS_FIX: typing.ClassVar[builtins.int]
    STATUS_SBAS_FIX: typing.ClassVar[builtins.int]
    STATUS_GBAS_FIX: typing.ClassVar[builtins.int]
    SERVICE_UNKNOWN: typing.ClassVar[builtins.int]
    SERVICE_GPS: typing.ClassVar[builtins.int]
    SERVICE_GLONASS: typing.ClassVar[builtins.int]
    SERVICE_COMPASS: typing.ClassVar[builtins.int]
    SERVICE_GALILEO: typing.ClassVar[builtins.int]
    status: builtins.int
    service: builtins.int
    def __init__(self, *, status: builtins.int = ..., service: builtins.int = ...) -> None: ...
class PointCloud(robolink.message.Message):
    """Points in metres with one value each a channel. Deprecated in ROS 2: PointCloud2 took its place."""
    header: robolink.interfaces.std_msgs.msg.Header
    points: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Point32]
    channels: collections.abc.MutableSequence[robolink.interfaces.sensor_msgs.msg.ChannelFloat32]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., points: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Point32] = ..., channels: collections.abc.Iterable[robolink.interfaces.sensor_msgs.msg.ChannelFloat32] = ...) -> None: ...
class PointCloud2(robolink.message.Message):
    """Points as packed binary records: `point_step` bytes a point, `row_step` bytes a row.

    A cloud without order is one row (`height` 1). `fields` say what a record holds; coordinates are metres in
    the header's frame. `is_dense` says that every point is valid.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    height: builtins.int
    width: builtins.int
    fields: collections.abc.MutableSequence[robolink.interfaces.sensor_msgs.msg.PointField]
    is_bigendian: builtins.bool
    point_step: builtins.int
    row_step: builtins.int
    data: collections.abc.MutableSequence[builtins.int]
    is_dense: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., height: builtins.int = ..., width: builtins.int = ..., fields: collections.abc.Iterable[robolink.interfaces.sensor_msgs.msg.PointField] = ..., is_bigendian: builtins.bool = ..., point_step: builtins.int = ..., row_step: builtins.int = ..., data: collections.abc.Iterable[builtins.int] = ..., is_dense: builtins.bool = ...) -> None: ...
class PointField(robolink.message.Message):
    """One channel of a PointCloud2, such as ``x`` or ``intensity``.

    It starts `offset` bytes into each point and holds `count` values of type `datatype`.
    """
    INT8: typing.ClassVar[builtins.int]
    UINT8: typing.ClassVar[builtins.int]
    INT16: typing.ClassVar[builtins.int]
    UINT16: typing.ClassVar[builtins.int]
    INT32: typing.ClassVar[builtins.int]
    UINT32: typing.ClassVar[builtins.int]
    FLOAT32: typing.ClassVar[builtins.int]
    FLOAT64: typing.ClassVar[builtins.int]
    name: builtins.str
    offset: builtins.int
    datatype: builtins.int
    count: builtins.int
    def __init__(self, *, name: builtins.str = ..., offset: builtins.int = ..., datatype: builtins.int = ..., count: builtins.int = ...) -> None: ...
class Range(robolink.message.Message):
    """The distance in metres that a sonar or infrared sensor found in its cone about the frame's x axis.

    `field_of_view` is the whole opening angle in radians. A `range` outside `min_range` to `max_range` is no
    measurement. Where both limits are equal the sensor only says whether something is nearer: -inf yes, +inf
    no. `variance` is in m², 0 when unknown.
    """
    ULTRASOUND: typing.ClassVar[builtins.int]
    INFRARED: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    radiation_type: builtins.int
    field_of_view: builtins.float
    min_range: builtins.float
    max_range: builtins.float
    range: builtins.float
    variance: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., radiation_type: builtins.int = ..., field_of_view: builtins.float = ..., min_range: builtins.float = ..., max_range: builtins.float = ..., range: builtins.float = ..., variance: builtins.float = ...) -> None: ...
class RegionOfInterest(robolink.message.Message):
    """A rectangle of pixels in an image of full resolution; all zeros stand for the whole image.

    `do_rectify` says that the rectangle was cut out, and that a rectified one is to be computed from it.
    """
    x_offset: builtins.int
    y_offset: builtins.int
    height: builtins.int
    width: builtins.int
    do_rectify: builtins.bool
    def __init__(self, *, x_offset: builtins.int = ..., y_offset: builtins.int = ..., height: builtins.int = ..., width: builtins.int = ..., do_rectify: builtins.bool = ...) -> None: ...
class RelativeHumidity(robolink.message.Message):
    """The humidity of air, from 0.0 (dry) to 1.0 (saturated), and its variance."""
    header: robolink.interfaces.std_msgs.msg.Header
    relative_humidity: builtins.float
    variance: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., relative_humidity: builtins.float = ..., variance: builtins.float = ...) -> None: ...
class Temperature(robolink.message.Message):
    """A temperature in degrees Celsius, and its variance."""
    header: robolink.interfaces.std_msgs.msg.Header
    temperature: builtins.float
    variance: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., temperature: builtins.float = ..., variance: builtins.float = ...) -> None: ...
class TimeReference(robolink.message.Message):
    """Time of another clock, named `source`, at the system time ``header.stamp``."""
    header: robolink.interfaces.std_msgs.msg.Header
    time_ref: robolink.interfaces.builtin_interfaces.msg.Time
    source: builtins.str
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., time_ref: robolink.interfaces.builtin_interfaces.msg.Time = ..., source: builtins.str = ...) -> None: ...
