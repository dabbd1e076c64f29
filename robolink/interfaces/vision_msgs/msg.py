"""The messages of vision_msgs: detections in pictures and in space, and their classes."""

from robolink.interfaces.geometry_msgs.msg import Pose, PoseWithCovariance, Vector3
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, float32, float64, int32, string, uint16


class Point2D(Message):
    """A point in a picture, in pixels; x to the right, y down."""

    x: float64
    y: float64


class Pose2D(Message):
    """A position in a picture, in pixels, and a rotation in radians."""

    position: Point2D
    theta: float64


class BoundingBox2D(Message):
    """A rectangle in a picture: its centre, its rotation about that, and its sizes in pixels."""

    center: Pose2D
    size_x: float64
    size_y: float64


class BoundingBox2DArray(Message):
    """Rectangles in one picture."""

    header: Header
    boxes: Sequence[BoundingBox2D]


class BoundingBox3D(Message):
    """A box in space: its centre and orientation, and its whole lengths along its own axes, in metres."""

    center: Pose
    size: Vector3


class BoundingBox3DArray(Message):
    """Boxes in one frame."""

    header: Header
    boxes: Sequence[BoundingBox3D]


class ObjectHypothesis(Message):
    """A class that an object may belong to, and the detector's score for it, usually from 0 to 1."""

    class_id: string
    score: float64


class ObjectHypothesisWithPose(Message):
    """A class that an object may belong to, with its score and the object's pose, in metres and radians."""

    hypothesis: ObjectHypothesis
    pose: PoseWithCovariance


class Classification(Message):
    """Classes that the whole of a picture or a cloud may belong to, with their scores."""

    header: Header
    results: Sequence[ObjectHypothesis]


class Detection2D(Message):
    """An object in a picture: the classes it may belong to and the rectangle around it.

    `id` is the same in successive messages for an object that is tracked; otherwise it is empty.
    """

    header: Header
    results: Sequence[ObjectHypothesisWithPose]
    bbox: BoundingBox2D
    id: string


class Detection2DArray(Message):
    """The objects detected in one picture."""

    header: Header
    detections: Sequence[Detection2D]


class Detection3D(Message):
    """An object in space: the classes it may belong to and the box around it.

    `id` is the same in successive messages for an object that is tracked; otherwise it is empty.
    """

    header: Header
    results: Sequence[ObjectHypothesisWithPose]
    bbox: BoundingBox3D
    id: string


class Detection3DArray(Message):
    """The objects detected in one cloud or picture."""

    header: Header
    detections: Sequence[Detection3D]


class VisionClass(Message):
    """Number of a class, as in a picture whose pixels are class numbers, and the class's name."""

    class_id: uint16
    class_name: string


class LabelInfo(Message):
    """Class names of a segmented picture, and the score that a pixel's class needs at least.

    Usually published once, for subscribers that come later too.
    """

    header: Header
    class_map: Sequence[VisionClass]
    threshold: float32


class VisionInfo(Message):
    """Details of a detector: its method, where the names of its classes are stored, and the version of these.

    `database_location` is often the name of a parameter. Subscribers load the names again when the version changes.
    """

    header: Header
    method: string
    database_location: string
    database_version: int32
