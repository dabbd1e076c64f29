"""The messages of tf2_msgs: transforms between frames, and why a lookup failed."""

from typing import ClassVar

from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.message import Message, Sequence, string, uint8


class TFMessage(Message):
    """Transforms from parent to child frames, as published on /tf and /tf_static."""

    transforms: Sequence[TransformStamped]


class TF2Error(Message):
    """Outcome of a transform look-up: one of the codes below, and a sentence for people."""

    NO_ERROR: ClassVar[uint8] = 0
    LOOKUP_ERROR: ClassVar[uint8] = 1
    CONNECTIVITY_ERROR: ClassVar[uint8] = 2
    EXTRAPOLATION_ERROR: ClassVar[uint8] = 3
    INVALID_ARGUMENT_ERROR: ClassVar[uint8] = 4
    TIMEOUT_ERROR: ClassVar[uint8] = 5
    TRANSFORM_ERROR: ClassVar[uint8] = 6

    error: uint8
    error_string: string
