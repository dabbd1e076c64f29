# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["Accel", "AccelStamped", "AccelWithCovariance", "AccelWithCovarianceStamped", "Inertia", "InertiaStamped", "Point", "Point32", "PointStamped", "Polygon", "PolygonInstance", "PolygonInstanceStamped", "PolygonStamped", "Pose", "Pose2D", "PoseArray", "PoseStamped", "PoseWithCovariance", "PoseWithCovarianceStamped", "Quaternion", "QuaternionStamped", "Transform", "TransformStamped", "Twist", "TwistStamped", "TwistWithCovariance", "TwistWithCovarianceStamped", "Vector3", "Vector3Stamped", "VelocityStamped", "Wrench", "WrenchStamped"]

class Accel(robolink.message.Message):
    """An acceleration: linear in m/s², angular in rad/s² about each axis."""
    linear: robolink.interfaces.geometry_msgs.msg.Vector3
    angular: robolink.interfaces.geometry_msgs.msg.Vector3
    def __init__(self, *, linear: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., angular: robolink.interfaces.geometry_msgs.msg.Vector3 = ...) -> None: ...
class AccelStamped(robolink.message.Message):
    """An acceleration with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    accel: robolink.interfaces.geometry_msgs.msg.Accel
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., accel: robolink.interfaces.geometry_msgs.msg.Accel = ...) -> None: ...
class AccelWithCovariance(robolink.message.Message):
    """An acceleration and how sure it is: covariance in (m/s²)², m·rad/s⁴ and (rad/s²)²."""
    accel: robolink.interfaces.geometry_msgs.msg.Accel
    covariance: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, accel: robolink.interfaces.geometry_msgs.msg.Accel = ..., covariance: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class AccelWithCovarianceStamped(robolink.message.Message):
    """An uncertain acceleration with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    accel: robolink.interfaces.geometry_msgs.msg.AccelWithCovariance
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., accel: robolink.interfaces.geometry_msgs.msg.AccelWithCovariance = ...) -> None: ...
class Inertia(robolink.message.Message):
    """Inertia of a body: mass `m` in kg, centre of mass `com` in metres, inertia tensor in kg·m².

    The tensor is symmetric; the six numbers are its upper triangle, about the centre of mass.
    """
    m: builtins.float
    com: robolink.interfaces.geometry_msgs.msg.Vector3
    ixx: builtins.float
    ixy: builtins.float
    ixz: builtins.float
    iyy: builtins.float
    iyz: builtins.float
    izz: builtins.float
    def __init__(self, *, m: builtins.float = ..., com: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., ixx: builtins.float = ..., ixy: builtins.float = ..., ixz: builtins.float = ..., iyy: builtins.float = ..., iyz: builtins.float = ..., izz: builtins.float = ...) -> None: ...
class InertiaStamped(robolink.message.Message):
    """An inertia with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    inertia: robolink.interfaces.geometry_msgs.msg.Inertia
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., inertia: robolink.interfaces.geometry_msgs.msg.Inertia = ...) -> None: ...
class Point(robolink.message.Message):
    """A place in space, in metres."""
    x: builtins.float
    y: builtins.float
    z: builtins.float
    def __init__(self, *, x: builtins.float = ..., y: builtins.float = ..., z: builtins.float = ...) -> None: ...
class Point32(robolink.message.Message):
    """A place in metres in single precision, for messages with very many of them; else take Point."""
    x: builtins.float
    y: builtins.float
    z: builtins.float
    def __init__(self, *, x: builtins.float = ..., y: builtins.float = ..., z: builtins.float = ...) -> None: ...
class PointStamped(robolink.message.Message):
    """A point with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    point: robolink.interfaces.geometry_msgs.msg.Point
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., point: robolink.interfaces.geometry_msgs.msg.Point = ...) -> None: ...
class Polygon(robolink.message.Message):
    """A closed outline: corner points in metres, the last joined to the first."""
    points: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Point32]
    def __init__(self, *, points: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Point32] = ...) -> None: ...
class PolygonInstance(robolink.message.Message):
    """A polygon that can be told from others of its kind by `id`."""
    polygon: robolink.interfaces.geometry_msgs.msg.Polygon
    id: builtins.int
    def __init__(self, *, polygon: robolink.interfaces.geometry_msgs.msg.Polygon = ..., id: builtins.int = ...) -> None: ...
class PolygonInstanceStamped(robolink.message.Message):
    """A polygon instance with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    polygon: robolink.interfaces.geometry_msgs.msg.PolygonInstance
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., polygon: robolink.interfaces.geometry_msgs.msg.PolygonInstance = ...) -> None: ...
class PolygonStamped(robolink.message.Message):
    """A polygon with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    polygon: robolink.interfaces.geometry_msgs.msg.Polygon
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., polygon: robolink.interfaces.geometry_msgs.msg.Polygon = ...) -> None: ...
class Pose(robolink.message.Message):
    """Pose: a position in metres, and an orientation."""
    position: robolink.interfaces.geometry_msgs.msg.Point
    orientation: robolink.interfaces.geometry_msgs.msg.Quaternion
    def __init__(self, *, position: robolink.interfaces.geometry_msgs.msg.Point = ..., orientation: robolink.interfaces.geometry_msgs.msg.Quaternion = ...) -> None: ...
class Pose2D(robolink.message.Message):
    """A pose in the plane: metres, and radians counter-clockwise. Deprecated in ROS 2: use Pose."""
    x: builtins.float
    y: builtins.float
    theta: builtins.float
    def __init__(self, *, x: builtins.float = ..., y: builtins.float = ..., theta: builtins.float = ...) -> None: ...
class PoseArray(robolink.message.Message):
    """Several poses of one time in one frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    poses: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Pose]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., poses: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Pose] = ...) -> None: ...
class PoseStamped(robolink.message.Message):
    """A pose with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ...) -> None: ...
class PoseWithCovariance(robolink.message.Message):
    """A pose and how sure it is: covariance in m², m·rad and rad²."""
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    covariance: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., covariance: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class PoseWithCovarianceStamped(robolink.message.Message):
    """An uncertain pose with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovariance
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovariance = ...) -> None: ...
class Quaternion(robolink.message.Message):
    """An orientation as a unit quaternion; without arguments, no rotation (w is 1)."""
    x: builtins.float
    y: builtins.float
    z: builtins.float
    w: builtins.float
    def __init__(self, *, x: builtins.float = ..., y: builtins.float = ..., z: builtins.float = ..., w: builtins.float = ...) -> None: ...
class QuaternionStamped(robolink.message.Message):
    """An orientation with its time and the frame that it is relative to."""
    header: robolink.interfaces.std_msgs.msg.Header
    quaternion: robolink.interfaces.geometry_msgs.msg.Quaternion
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., quaternion: robolink.interfaces.geometry_msgs.msg.Quaternion = ...) -> None: ...
class Transform(robolink.message.Message):
    """The way from one frame to another: a translation in metres and a rotation."""
    translation: robolink.interfaces.geometry_msgs.msg.Vector3
    rotation: robolink.interfaces.geometry_msgs.msg.Quaternion
    def __init__(self, *, translation: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., rotation: robolink.interfaces.geometry_msgs.msg.Quaternion = ...) -> None: ...
class TransformStamped(robolink.message.Message):
    """Transform: pose of the frame `child_frame_id` in the frame ``header.frame_id`` at ``header.stamp``."""
    header: robolink.interfaces.std_msgs.msg.Header
    child_frame_id: builtins.str
    transform: robolink.interfaces.geometry_msgs.msg.Transform
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., child_frame_id: builtins.str = ..., transform: robolink.interfaces.geometry_msgs.msg.Transform = ...) -> None: ...
class Twist(robolink.message.Message):
    """A velocity: linear in m/s, angular in rad/s about each axis.

    On a ground robot ``linear.x`` is ahead and ``angular.z`` turns left.
    """
    linear: robolink.interfaces.geometry_msgs.msg.Vector3
    angular: robolink.interfaces.geometry_msgs.msg.Vector3
    def __init__(self, *, linear: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., angular: robolink.interfaces.geometry_msgs.msg.Vector3 = ...) -> None: ...
class TwistStamped(robolink.message.Message):
    """A velocity with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    twist: robolink.interfaces.geometry_msgs.msg.Twist
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., twist: robolink.interfaces.geometry_msgs.msg.Twist = ...) -> None: ...
class TwistWithCovariance(robolink.message.Message):
    """A velocity and how sure it is: covariance in (m/s)², m·rad/s² and (rad/s)²."""
    twist: robolink.interfaces.geometry_msgs.msg.Twist
    covariance: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, twist: robolink.interfaces.geometry_msgs.msg.Twist = ..., covariance: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class TwistWithCovarianceStamped(robolink.message.Message):
    """An uncertain velocity with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    twist: robolink.interfaces.geometry_msgs.msg.TwistWithCovariance
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., twist: robolink.interfaces.geometry_msgs.msg.TwistWithCovariance = ...) -> None: ...
class Vector3(robolink.message.Message):
    """A direction with a length; it has no place, so a transform only rotates it."""
    x: builtins.float
    y: builtins.float
    z: builtins.float
    def __init__(self, *, x: builtins.float = ..., y: builtins.float = ..., z: builtins.float = ...) -> None: ...
class Vector3Stamped(robolink.message.Message):
    """A vector with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    vector: robolink.interfaces.geometry_msgs.msg.Vector3
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., vector: robolink.interfaces.geometry_msgs.msg.Vector3 = ...) -> None: ...
class VelocityStamped(robolink.message.Message):
    """Velocity of `body_frame_id` relative to `reference_frame_id`, in m/s and rad/s along the header's axes.

    When the header's frame is the body's own, this is what is called a body twist.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    body_frame_id: builtins.str
    reference_frame_id: builtins.str
    velocity: robolink.interfaces.geometry_msgs.msg.Twist
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., body_frame_id: builtins.str = ..., reference_frame_id: builtins.str = ..., velocity: robolink.interfaces.geometry_msgs.msg.Twist = ...) -> None: ...
class Wrench(robolink.message.Message):
    """A force in newtons and a torque in newton metres."""
    force: robolink.interfaces.geometry_msgs.msg.Vector3
    torque: robolink.interfaces.geometry_msgs.msg.Vector3
    def __init__(self, *, force: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., torque: robolink.interfaces.geometry_msgs.msg.Vector3 = ...) -> None: ...
class WrenchStamped(robolink.message.Message):
    """A wrench with its time and frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    wrench: robolink.interfaces.geometry_msgs.msg.Wrench
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., wrench: robolink.interfaces.geometry_msgs.msg.Wrench = ...) -> None: ...
