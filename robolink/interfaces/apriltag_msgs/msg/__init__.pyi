# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.apriltag_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["AprilTagDetection", "AprilTagDetectionArray", "Point"]

class AprilTagDetection(robolink.message.Message):
    """A tag in a picture: its family and number, and its place in pixels.

    `hamming` is the number of bits that were corrected, `decision_margin` a measure of how clear the bits were, larger
    is better. The corners go round the tag; the homography is a matrix of 3 rows that takes the tag's own plane, from
    -1 to 1, to pixels.
    """
    family: builtins.str
    id: builtins.int
    hamming: builtins.int
    goodness: builtins.float
    decision_margin: builtins.float
    centre: robolink.interfaces.apriltag_msgs.msg.Point
    corners: collections.abc.MutableSequence[robolink.interfaces.apriltag_msgs.msg.Point]
    homography: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, family: builtins.str = ..., id: builtins.int = ..., hamming: builtins.int = ..., goodness: builtins.float = ..., decision_margin: builtins.float = ..., centre: robolink.interfaces.apriltag_msgs.msg.Point = ..., corners: collections.abc.Iterable[robolink.interfaces.apriltag_msgs.msg.Point] = ..., homography: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class AprilTagDetectionArray(robolink.message.Message):
    """The tags in one picture."""
    header: robolink.interfaces.std_msgs.msg.Header
    detections: collections.abc.MutableSequence[robolink.interfaces.apriltag_msgs.msg.AprilTagDetection]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., detections: collections.abc.Iterable[robolink.interfaces.apriltag_msgs.msg.AprilTagDetection] = ...) -> None: ...
class Point(robolink.message.Message):
    """A point in a picture, in pixels."""
    x: builtins.float
    y: builtins.float
    def __init__(self, *, x: builtins.float = ..., y: builtins.float = ...) -> None: ...
