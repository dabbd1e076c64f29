# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.std_msgs.msg
import robolink.interfaces.vision_msgs.msg

__all__ = ["BoundingBox2D", "BoundingBox2DArray", "BoundingBox3D", "BoundingBox3DArray", "Classification", "Detection2D", "Detection2DArray", "Detection3D", "Detection3DArray", "LabelInfo", "ObjectHypothesis", "ObjectHypothesisWithPose", "Point2D", "Pose2D", "VisionClass", "VisionInfo"]

class BoundingBox2D(robolink.message.Message):
    """A rectangle in a picture: its centre, its rotation about that, and its sizes in pixels."""
    center: robolink.interfaces.vision_msgs.msg.Pose2D
    size_x: builtins.float
    size_y: builtins.float
    def __init__(self, *, center: robolink.interfaces.vision_msgs.msg.Pose2D = ..., size_x: builtins.float = ..., size_y: builtins.float = ...) -> None: ...
class BoundingBox2DArray(robolink.message.Message):
    """Rectangles in one picture."""
    header: robolink.interfaces.std_msgs.msg.Header
    boxes: collections.abc.MutableSequence[robolink.interfaces.vision_msgs.msg.BoundingBox2D]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., boxes: collections.abc.Iterable[robolink.interfaces.vision_msgs.msg.BoundingBox2D] = ...) -> None: ...
class BoundingBox3D(robolink.message.Message):
    """A box in space: its centre and orientation, and its whole lengths along its own axes, in metres."""
    center: robolink.interfaces.geometry_msgs.msg.Pose
    size: robolink.interfaces.geometry_msgs.msg.Vector3
    def __init__(self, *, center: robolink.interfaces.geometry_msgs.msg.Pose = ..., size: robolink.interfaces.geometry_msgs.msg.Vector3 = ...) -> None: ...
class BoundingBox3DArray(robolink.message.Message):
    """Boxes in one frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    boxes: collections.abc.MutableSequence[robolink.interfaces.vision_msgs.msg.BoundingBox3D]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., boxes: collections.abc.Iterable[robolink.interfaces.vision_msgs.msg.BoundingBox3D] = ...) -> None: ...
class Classification(robolink.message.Message):
    """Classes that the whole of a picture or a cloud may belong to, with their scores."""
    header: robolink.interfaces.std_msgs.msg.Header
    results: collections.abc.MutableSequence[robolink.interfaces.vision_msgs.msg.ObjectHypothesis]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., results: collections.abc.Iterable[robolink.interfaces.vision_msgs.msg.ObjectHypothesis] = ...) -> None: ...
class Detection2D(robolink.message.Message):
    """An object in a picture: the classes it may belong to and the rectangle around it.

    `id` is the same in successive messages for an object that is tracked; otherwise it is empty.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    results: collections.abc.MutableSequence[robolink.interfaces.vision_msgs.msg.ObjectHypothesisWithPose]
    bbox: robolink.interfaces.vision_msgs.msg.BoundingBox2D
    id: builtins.str
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., results: collections.abc.Iterable[robolink.interfaces.vision_msgs.msg.ObjectHypothesisWithPose] = ..., bbox: robolink.interfaces.vision_msgs.msg.BoundingBox2D = ..., id: builtins.str = ...) -> None: ...
class Detection2DArray(robolink.message.Message):
    """The objects detected in one picture."""
    header: robolink.interfaces.std_msgs.msg.Header
    detections: collections.abc.MutableSequence[robolink.interfaces.vision_msgs.msg.Detection2D]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., detections: collections.abc.Iterable[robolink.interfaces.vision_msgs.msg.Detection2D] = ...) -> None: ...
class Detection3D(robolink.message.Message):
    """An object in space: the classes it may belong to and the box around it.

    `id` is the same in successive messages for an object that is tracked; otherwise it is empty.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    results: collections.abc.MutableSequence[robolink.interfaces.vision_msgs.msg.ObjectHypothesisWithPose]
    bbox: robolink.interfaces.vision_msgs.msg.BoundingBox3D
    id: builtins.str
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., results: collections.abc.Iterable[robolink.interfaces.vision_msgs.msg.ObjectHypothesisWithPose] = ..., bbox: robolink.interfaces.vision_msgs.msg.BoundingBox3D = ..., id: builtins.str = ...) -> None: ...
class Detection3DArray(robolink.message.Message):
    """The objects detected in one cloud or picture."""
    header: robolink.interfaces.std_msgs.msg.Header
    detections: collections.abc.MutableSequence[robolink.interfaces.vision_msgs.msg.Detection3D]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., detections: collections.abc.Iterable[robolink.interfaces.vision_msgs.msg.Detection3D] = ...) -> None: ...
class LabelInfo(robolink.message.Message):
    """Class names of a segmented picture, and the score that a pixel's class needs at least.

    Usually published once, for subscribers that come later too.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    class_map: collections.abc.MutableSequence[robolink.interfaces.vision_msgs.msg.VisionClass]
    threshold: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., class_map: collections.abc.Iterable[robolink.interfaces.vision_msgs.msg.VisionClass] = ..., threshold: builtins.float = ...) -> None: ...
class ObjectHypothesis(robolink.message.Message):
    """A class that an object may belong to, and the detector's score for it, usually from 0 to 1."""
    class_id: builtins.str
    score: builtins.float
    def __init__(self, *, class_id: builtins.str = ..., score: builtins.float = ...) -> None: ...
class ObjectHypothesisWithPose(robolink.message.Message):
    """A class that an object may belong to, with its score and the object's pose, in metres and radians."""
    hypothesis: robolink.interfaces.vision_msgs.msg.ObjectHypothesis
    pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovariance
    def __init__(self, *, hypothesis: robolink.interfaces.vision_msgs.msg.ObjectHypothesis = ..., pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovariance = ...) -> None: ...
class Point2D(robolink.message.Message):
    """A point in a picture, in pixels; x to the right, y down."""
    x: builtins.float
    y: builtins.float
    def __init__(self, *, x: builtins.float = ..., y: builtins.float = ...) -> None: ...
class Pose2D(robolink.message.Message):
    """A position in a picture, in pixels, and a rotation in radians."""
    position: robolink.interfaces.vision_msgs.msg.Point2D
    theta: builtins.float
    def __init__(self, *, position: robolink.interfaces.vision_msgs.msg.Point2D = ..., theta: builtins.float = ...) -> None: ...
class VisionClass(robolink.message.Message):
    """Number of a class, as in a picture whose pixels are class numbers, and the class's name."""
    class_id: builtins.int
    class_name: builtins.str
    def __init__(self, *, class_id: builtins.int = ..., class_name: builtins.str = ...) -> None: ...
class VisionInfo(robolink.message.Message):
    """Details of a detector: its method, where the names of its classes are stored, and the version of these.

    `database_location` is often the name of a parameter. Subscribers load the names again when the version changes.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    method: builtins.str
    database_location: builtins.str
    database_version: builtins.int
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., method: builtins.str = ..., database_location: builtins.str = ..., database_version: builtins.int = ...) -> None: ...
