"""Messages of a simulated robot: poses, odometry and its covariances, and what sensors measure."""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from robolink.image import to_message
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import (
    Point,
    PoseWithCovariance,
    Quaternion,
    Transform,
    TransformStamped,
    Twist,
    TwistWithCovariance,
    Vector3,
)
from robolink.interfaces.geometry_msgs.msg import Pose as PoseMessage
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import CameraInfo, Image, JointState, LaserScan, Range
from robolink.interfaces.sensor_msgs.msg import Imu as ImuMessage
from robolink.interfaces.std_msgs.msg import Bool, Header
from robolink.message import Message
from robolink.sim import Inertia, Pose, Scan, Shot, Velocity, WheelState
from robolink.sim.description import GRAVITY, OdomNoise
from robolink.sim.rendering.pinhole import Pinhole
from robolink.sim.sensors import Bumper, Camera, Encoders, Imu, Lidar, RangeFinder, Sensor, kind_of

# Covariances of a robot's odometry, propagated from the noise that its world file states.
#
# Noise is a share of the speeds, drawn at each step, so that errors grow with the root of the way.


Covariance: TypeAlias = npt.NDArray[np.float64]
"""The 36 numbers of a 6 x 6 matrix, row by row: x, y, z, and the turns about them."""

_IN_PLANE = np.ix_((0, 1, 5), (0, 1, 5))
"""Rows and columns of x, y and the heading in such a matrix."""


class Uncertainty:
    """The covariance of a robot's odometry since its start; `dt` is the length of a step in seconds."""

    def __init__(self, noise: OdomNoise, dt: float) -> None:
        self._noise, self._dt = noise, dt
        self._matrix = np.zeros((3, 3))

    def advance(self, pose: Pose, twist: Velocity, steps: int) -> None:
        """Add the uncertainty of a number of steps at about these speeds, which led to `pose`."""
        dt, noise = self._dt, self._noise
        sin, cos = math.sin(pose.theta), math.cos(pose.theta)
        ahead, across = twist.v * dt, twist.sideways * dt
        to_world = np.array(((cos, -sin, 0.0), (sin, cos, 0.0), (0.0, 0.0, 1.0)))
        errors = np.diag(((noise.v * ahead) ** 2, (noise.v * across) ** 2, (noise.w * twist.w * dt) ** 2))
        turned = np.eye(3)  # a wrong heading leads the whole way astray
        turned[:2, 2] = to_world[:2, :2] @ (-across * steps, ahead * steps)
        self._matrix = turned @ self._matrix @ turned.T + steps * to_world @ errors @ to_world.T

    def of_pose(self) -> Covariance:
        """Return the covariance of the pose, in the frame of the odometry."""
        whole = np.zeros((6, 6))
        whole[_IN_PLANE] = self._matrix
        return whole.ravel()

    def of_twist(self, twist: Velocity) -> Covariance:
        """Return the covariance of these speeds, in the robot's own frame."""
        noise = self._noise
        return np.diag(
            ((noise.v * twist.v) ** 2, (noise.v * twist.sideways) ** 2, 0.0, 0.0, 0.0, (noise.w * twist.w) ** 2)
        ).ravel()


NANOSECONDS = 1_000_000_000
NOTHING_SAID: Covariance = np.zeros(36)
"""An unknown covariance, as ROS reads zeros."""


def sensor_type(sensor: Sensor) -> type[Message]:
    """Return the type of message that a sensor publishes."""
    found: type[Message] = kind_of(sensor).part("message")
    return found


def sensor_message(sensor: Sensor, value: Any, header: Header) -> Message:
    """Make the message of a sensor's measurement, of its `sensor_type`."""
    made: Message = kind_of(sensor).part("convert")(value, header, sensor)
    return made


def time_message(nanoseconds: int) -> Time:
    """Make the message of a time."""
    return Time(sec=nanoseconds // NANOSECONDS, nanosec=nanoseconds % NANOSECONDS)


def scan_message(scan: Scan, header: Header, sensor: Lidar) -> LaserScan:
    """Make the message of a scan; all its beams are of one instant, and the next comes after the lidar's period."""
    return LaserScan(
        header=header,
        angle_min=scan.angle_min,
        angle_max=scan.angle_max,
        angle_increment=scan.angle_increment,
        scan_time=1.0 / sensor.rate,
        range_min=scan.range_min,
        range_max=scan.range_max,
        ranges=_floats(scan.ranges),
        intensities=_floats(scan.intensities) if scan.intensities is not None else array("f"),
    )


def _floats(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> array[float]:
    return array("f", values.astype(np.float32).tobytes())


def odometry_message(
    header: Header,
    child: str,
    pose: Pose,
    twist: Velocity,
    of_pose: Covariance = NOTHING_SAID,
    of_twist: Covariance = NOTHING_SAID,
) -> Odometry:
    """Make the message of a pose in the header's frame, and of the speeds in the frame `child`, which is there.

    `of_pose` and `of_twist` are their 6 x 6 covariances by rows: of x, y, z and the turns about them.
    """
    v, w, sideways = twist
    there = PoseMessage(position=Point(x=pose.x, y=pose.y), orientation=facing(pose.theta))
    speeds = Twist(linear=Vector3(x=v, y=sideways), angular=Vector3(z=w))
    return Odometry(
        header=header,
        child_frame_id=child,
        pose=PoseWithCovariance(pose=there, covariance=of_pose),
        twist=TwistWithCovariance(twist=speeds, covariance=of_twist),
    )


def imu_message(inertia: Inertia, header: Header, sensor: Imu) -> ImuMessage:
    """Make the message of an inertial unit that lies flat: like a real one it feels the floor carry it, along z."""
    noise = sensor.noise
    return ImuMessage(
        header=header,
        orientation=facing(inertia.heading),
        angular_velocity=Vector3(z=inertia.turning),
        angular_velocity_covariance=np.diag((0.0, 0.0, noise.gyro**2)).ravel(),
        linear_acceleration=Vector3(x=inertia.ax, y=inertia.ay, z=GRAVITY),
        linear_acceleration_covariance=np.diag((noise.accel**2, noise.accel**2, 0.0)).ravel(),
    )


def range_message(distance: float, header: Header, sensor: RangeFinder) -> Range:
    """Make the message of a sonar or infrared sensor; inf is nothing near, -inf something too near (REP 117)."""
    low, high = sensor.range
    return Range(
        header=header,
        radiation_type=Range.INFRARED if sensor.radiation == "infrared" else Range.ULTRASOUND,
        field_of_view=math.radians(sensor.aperture or sensor.fov),
        min_range=low,
        max_range=high,
        range=distance,
        variance=sensor.noise**2,
    )


def joint_state_message(wheels: Sequence[WheelState], header: Header, sensor: Encoders | None = None) -> JointState:
    """Make the message of the angles of wheels, in radians, and their speeds, in rad/s."""
    return JointState(
        header=header,
        name=[each.motor for each in wheels],
        position=[each.position for each in wheels],
        velocity=[each.speed for each in wheels],
    )


def bumper_message(touched: bool, header: Header, sensor: Bumper) -> Bool:
    """Make the message of a bumper, true if it was touched; it has no header."""
    return Bool(data=touched)


def transform_message(header: Header, child: str, pose: Pose) -> TransformStamped:
    """Make the transform of a frame that stands at a pose in the header's frame."""
    there = Transform(translation=Vector3(x=pose.x, y=pose.y), rotation=facing(pose.theta))
    return TransformStamped(header=header, child_frame_id=child, transform=there)


def facing(theta: float) -> Quaternion:
    """Return the rotation by `theta` radians about z."""
    return Quaternion(z=math.sin(theta / 2), w=math.cos(theta / 2))


def image_message(shot: Shot, header: Header, sensor: Camera) -> Image:
    """Make the message of a camera's image."""
    return to_message(shot.image(), sensor.encoding, header)


def camera_info_message(header: Header, sensor: Camera) -> CameraInfo:
    """Make the message of a camera's calibration: a pinhole without distortion.

    The right camera of a stereo pair has the left one's distance times the focal length in P (sensor_msgs/CameraInfo).
    """
    pinhole = Pinhole(sensor.width, sensor.height, sensor.fov)
    focal, (u, v) = pinhole.focal, pinhole.centre
    return CameraInfo(
        header=header,
        height=sensor.height,
        width=sensor.width,
        distortion_model="plumb_bob",
        d=[0.0] * 5,
        k=np.array((focal, 0.0, u, 0.0, focal, v, 0.0, 0.0, 1.0)),
        r=np.eye(3).ravel(),
        p=np.array((focal, 0.0, u, -focal * sensor.baseline, 0.0, focal, v, 0.0, 0.0, 0.0, 1.0, 0.0)),
    )


def camera_transforms(stamp: Time, base: str, link: str, optical: str, sensor: Camera) -> tuple[TransformStamped, ...]:
    """Make the transforms of a camera's body (x ahead) on the robot, and of its optical frame (z ahead, REP 103)."""
    mount, half = sensor.offset, math.radians(sensor.pitch) / 2
    yaw, pitch = (math.cos(mount.theta / 2), math.sin(mount.theta / 2)), (math.cos(half), math.sin(half))
    turned = Quaternion(x=-yaw[1] * pitch[1], y=yaw[0] * pitch[1], z=yaw[1] * pitch[0], w=yaw[0] * pitch[0])
    there = Transform(translation=Vector3(x=mount.x, y=mount.y, z=sensor.z), rotation=turned)
    ahead = Transform(rotation=Quaternion(x=-0.5, y=0.5, z=-0.5, w=0.5))
    return (
        TransformStamped(header=Header(stamp=stamp, frame_id=base), child_frame_id=link, transform=there),
        TransformStamped(header=Header(stamp=stamp, frame_id=link), child_frame_id=optical, transform=ahead),
    )
