"""The messages of geometry_msgs: metres, radians, seconds, kilograms and newtons, in right-handed frames.

A type with a header says in ``header.frame_id`` which frame its numbers are given in. A covariance is a 6 x 6
matrix, row by row, over (x, y, z, rotation about x, about y, about z) with fixed axes.
"""

from typing import Annotated

from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, Size, float32, float64, int64, string


class Vector3(Message):
    """A direction with a length; it has no place, so a transform only rotates it."""

    x: float64
    y: float64
    z: float64


class Vector3Stamped(Message):
    """A vector with its time and frame."""

    header: Header
    vector: Vector3


class Point(Message):
    """A place in space, in metres."""

    x: float64
    y: float64
    z: float64


class Point32(Message):
    """A place in metres in single precision, for messages with very many of them; else take Point."""

    x: float32
    y: float32
    z: float32


class PointStamped(Message):
    """A point with its time and frame."""

    header: Header
    point: Point


class Polygon(Message):
    """A closed outline: corner points in metres, the last joined to the first."""

    points: Sequence[Point32]


class PolygonStamped(Message):
    """A polygon with its time and frame."""

    header: Header
    polygon: Polygon


class PolygonInstance(Message):
    """A polygon that can be told from others of its kind by `id`."""

    polygon: Polygon
    id: int64


class PolygonInstanceStamped(Message):
    """A polygon instance with its time and frame."""

    header: Header
    polygon: PolygonInstance


class Quaternion(Message):
    """An orientation as a unit quaternion; without arguments, no rotation (w is 1)."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0
    w: float64 = 1.0


class QuaternionStamped(Message):
    """An orientation with its time and the frame that it is relative to."""

    header: Header
    quaternion: Quaternion


class Pose(Message):
    """Pose: a position in metres, and an orientation."""

    position: Point
    orientation: Quaternion


class Pose2D(Message):
    """A pose in the plane: metres, and radians counter-clockwise. Deprecated in ROS 2: use Pose."""

    x: float64
    y: float64
    theta: float64


class PoseArray(Message):
    """Several poses of one time in one frame."""

    header: Header
    poses: Sequence[Pose]


class PoseStamped(Message):
    """A pose with its time and frame."""

    header: Header
    pose: Pose


class PoseWithCovariance(Message):
    """A pose and how sure it is: covariance in m², m·rad and rad²."""

    pose: Pose
    covariance: Annotated[Sequence[float64], Size(36)]


class PoseWithCovarianceStamped(Message):
    """An uncertain pose with its time and frame."""

    header: Header
    pose: PoseWithCovariance


class Transform(Message):
    """The way from one frame to another: a translation in metres and a rotation."""

    translation: Vector3
    rotation: Quaternion


class TransformStamped(Message):
    """Transform: pose of the frame `child_frame_id` in the frame ``header.frame_id`` at ``header.stamp``."""

    header: Header
    child_frame_id: string
    transform: Transform


class Twist(Message):
    """A velocity: linear in m/s, angular in rad/s about each axis.

    On a ground robot ``linear.x`` is ahead and ``angular.z`` turns left.
    """

    linear: Vector3
    angular: Vector3


class TwistStamped(Message):
    """A velocity with its time and frame."""

    header: Header
    twist: Twist


class TwistWithCovariance(Message):
    """A velocity and how sure it is: covariance in (m/s)², m·rad/s² and (rad/s)²."""

    twist: Twist
    covariance: Annotated[Sequence[float64], Size(36)]


class TwistWithCovarianceStamped(Message):
    """An uncertain velocity with its time and frame."""

    header: Header
    twist: TwistWithCovariance


class VelocityStamped(Message):
    """Velocity of `body_frame_id` relative to `reference_frame_id`, in m/s and rad/s along the header's axes.

    When the header's frame is the body's own, this is what is called a body twist.
    """

    header: Header
    body_frame_id: string
    reference_frame_id: string
    velocity: Twist


class Accel(Message):
    """An acceleration: linear in m/s², angular in rad/s² about each axis."""

    linear: Vector3
    angular: Vector3


class AccelStamped(Message):
    """An acceleration with its time and frame."""

    header: Header
    accel: Accel


class AccelWithCovariance(Message):
    """An acceleration and how sure it is: covariance in (m/s²)², m·rad/s⁴ and (rad/s²)²."""

    accel: Accel
    covariance: Annotated[Sequence[float64], Size(36)]


class AccelWithCovarianceStamped(Message):
    """An uncertain acceleration with its time and frame."""

    header: Header
    accel: AccelWithCovariance


class Wrench(Message):
    """A force in newtons and a torque in newton metres."""

    force: Vector3
    torque: Vector3


class WrenchStamped(Message):
    """A wrench with its time and frame."""

    header: Header
    wrench: Wrench


class Inertia(Message):
    """Inertia of a body: mass `m` in kg, centre of mass `com` in metres, inertia tensor in kg·m².

    The tensor is symmetric; the six numbers are its upper triangle, about the centre of mass.
    """

    m: float64
    com: Vector3
    ixx: float64
    ixy: float64
    ixz: float64
    iyy: float64
    iyz: float64
    izz: float64


class InertiaStamped(Message):
    """An inertia with its time and frame."""

    header: Header
    inertia: Inertia
