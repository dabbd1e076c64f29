"""Joysticks and gamepads."""

from typing import ClassVar

from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, float32, int32, uint8


class Joy(Message):
    """The positions of a joystick's axes (-1.0 to 1.0) and buttons (1 is pressed), when they were read."""

    header: Header
    axes: Sequence[float32]
    buttons: Sequence[int32]


class JoyFeedback(Message):
    """A joystick's light, rumble motor or buzzer number `id`: off at 0.0, fully on at 1.0."""

    TYPE_LED: ClassVar[uint8] = 0
    TYPE_RUMBLE: ClassVar[uint8] = 1
    TYPE_BUZZER: ClassVar[uint8] = 2

    type: uint8
    id: uint8
    intensity: float32


class JoyFeedbackArray(Message):
    """Several settings for a joystick at once."""

    array: Sequence[JoyFeedback]
