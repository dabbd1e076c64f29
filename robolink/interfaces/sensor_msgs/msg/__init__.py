"""The messages of sensor_msgs: what lasers, cameras, inertial and other sensors measure."""

from robolink.interfaces.sensor_msgs.msg._camera import CameraInfo, CompressedImage, Image, RegionOfInterest
from robolink.interfaces.sensor_msgs.msg._environment import (
    BatteryState,
    FluidPressure,
    Illuminance,
    RelativeHumidity,
    Temperature,
)
from robolink.interfaces.sensor_msgs.msg._joystick import Joy, JoyFeedback, JoyFeedbackArray
from robolink.interfaces.sensor_msgs.msg._motion import (
    Imu,
    JointState,
    MagneticField,
    MultiDOFJointState,
    NavSatFix,
    NavSatStatus,
    TimeReference,
)
from robolink.interfaces.sensor_msgs.msg._ranging import (
    ChannelFloat32,
    LaserEcho,
    LaserScan,
    MultiEchoLaserScan,
    PointCloud,
    PointCloud2,
    PointField,
    Range,
)

__all__ = [
    "BatteryState",
    "CameraInfo",
    "ChannelFloat32",
    "CompressedImage",
    "FluidPressure",
    "Illuminance",
    "Image",
    "Imu",
    "JointState",
    "Joy",
    "JoyFeedback",
    "JoyFeedbackArray",
    "LaserEcho",
    "LaserScan",
    "MagneticField",
    "MultiDOFJointState",
    "MultiEchoLaserScan",
    "NavSatFix",
    "NavSatStatus",
    "PointCloud",
    "PointCloud2",
    "PointField",
    "Range",
    "RegionOfInterest",
    "RelativeHumidity",
    "Temperature",
    "TimeReference",
]
