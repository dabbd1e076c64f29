"""The messages of apriltag_msgs: where in a picture AprilTags are."""

from typing import Annotated

from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, Size, float32, float64, int32, string


class Point(Message):
    """A point in a picture, in pixels."""

    x: float64
    y: float64


class AprilTagDetection(Message):
    """A tag in a picture: its family and number, and its place in pixels.

    `hamming` is the number of bits that were corrected, `decision_margin` a measure of how clear the bits were, larger
    is better. The corners go round the tag; the homography is a matrix of 3 rows that takes the tag's own plane, from
    -1 to 1, to pixels.
    """

    family: string
    id: int32
    hamming: int32
    goodness: float32
    decision_margin: float32
    centre: Point
    corners: Annotated[Sequence[Point], Size(4)]
    homography: Annotated[Sequence[float64], Size(9)]


class AprilTagDetectionArray(Message):
    """The tags in one picture."""

    header: Header
    detections: Sequence[AprilTagDetection]
