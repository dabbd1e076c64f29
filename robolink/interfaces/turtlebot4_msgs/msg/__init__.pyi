# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["UserButton", "UserDisplay", "UserLed"]

class UserButton(robolink.message.Message):
    """The four buttons; True is pressed."""
    button: collections.abc.MutableSequence[builtins.bool]
    def __init__(self, *, button: collections.abc.Iterable[builtins.bool] = ...) -> None: ...
class UserDisplay(robolink.message.Message):
    """The display: address, battery, five lines of the menu, and the one that is chosen."""
    ip: builtins.str
    battery: builtins.str
    entries: collections.abc.MutableSequence[builtins.str]
    selected_entry: builtins.int
    def __init__(self, *, ip: builtins.str = ..., battery: builtins.str = ..., entries: collections.abc.Iterable[builtins.str] = ..., selected_entry: builtins.int = ...) -> None: ...
class UserLed(robolink.message.Message):
    """Colour of a light and its blinking: the period in milliseconds, and the part of it that the light is on."""
    USER_LED_1: typing.ClassVar[builtins.int]
    USER_LED_2: typing.ClassVar[builtins.int]
    COLOR_OFF: typing.ClassVar[builtins.int]
    COLOR_GREEN: typing.ClassVar[builtins.int]
    COLOR_RED: typing.ClassVar[builtins.int]
    COLOR_YELLOW: typing.ClassVar[builtins.int]
    led: builtins.int
    color: builtins.int
    blink_period: builtins.int
    duty_cycle: builtins.float
    def __init__(self, *, led: builtins.int = ..., color: builtins.int = ..., blink_period: builtins.int = ..., duty_cycle: builtins.float = ...) -> None: ...
