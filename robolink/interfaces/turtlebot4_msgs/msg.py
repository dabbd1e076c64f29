"""The messages of turtlebot4_msgs: the robot's user interface."""

from typing import Annotated, ClassVar

from robolink.message import Message, Sequence, Size, boolean, float64, int32, string, uint8, uint32


class UserButton(Message):
    """The four buttons; True is pressed."""

    button: Annotated[Sequence[boolean], Size(4)]


class UserLed(Message):
    """Colour of a light and its blinking: the period in milliseconds, and the part of it that the light is on."""

    USER_LED_1: ClassVar[uint8] = 0
    USER_LED_2: ClassVar[uint8] = 1
    COLOR_OFF: ClassVar[uint8] = 0
    COLOR_GREEN: ClassVar[uint8] = 1
    COLOR_RED: ClassVar[uint8] = 2
    COLOR_YELLOW: ClassVar[uint8] = 3

    led: uint8
    color: uint8
    blink_period: uint32
    duty_cycle: float64


class UserDisplay(Message):
    """The display: address, battery, five lines of the menu, and the one that is chosen."""

    ip: string
    battery: string
    entries: Annotated[Sequence[string], Size(5)]
    selected_entry: int32
