# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.std_msgs.msg

__all__ = ["SensorState", "Sound", "VersionInfo"]

class SensorState(robolink.message.Message):
    """Bumpers, buttons and other sensors that hang on the robot's board.

    Encoders are in ticks, the battery is in volts; `torque` is True while the motors are on.
    """
    BUMPER_FORWARD: typing.ClassVar[builtins.int]
    BUMPER_BACKWARD: typing.ClassVar[builtins.int]
    CLIFF: typing.ClassVar[builtins.int]
    SONAR: typing.ClassVar[builtins.int]
    ILLUMINATION: typing.ClassVar[builtins.int]
    BUTTON0: typing.ClassVar[builtins.int]
    BUTTON1: typing.ClassVar[builtins.int]
    ERROR_LEFT_MOTOR: typing.ClassVar[builtins.int]
    ERROR_RIGHT_MOTOR: typing.ClassVar[builtins.int]
    TORQUE_ON: typing.ClassVar[builtins.int]
    TORQUE_OFF: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    bumper: builtins.int
    cliff: builtins.float
    sonar: builtins.float
    illumination: builtins.float
    led: builtins.int
    button: builtins.int
    torque: builtins.bool
    left_encoder: builtins.int
    right_encoder: builtins.int
    battery: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., bumper: builtins.int = ..., cliff: builtins.float = ..., sonar: builtins.float = ..., illumination: builtins.float = ..., led: builtins.int = ..., button: builtins.int = ..., torque: builtins.bool = ..., left_encoder: builtins.int = ..., right_encoder: builtins.int = ..., battery: builtins.float = ...) -> None: ...
class Sound(robolink.message.Message):
    """A sound for the robot to make."""
    OFF: typing.ClassVar[builtins.int]
    ON: typing.ClassVar[builtins.int]
    LOW_BATTERY: typing.ClassVar[builtins.int]
    ERROR: typing.ClassVar[builtins.int]
    BUTTON1: typing.ClassVar[builtins.int]
    BUTTON2: typing.ClassVar[builtins.int]
    value: builtins.int
    def __init__(self, *, value: builtins.int = ...) -> None: ...
class VersionInfo(robolink.message.Message):
    """Versions of the robot's hardware, firmware and software."""
    hardware: builtins.str
    firmware: builtins.str
    software: builtins.str
    def __init__(self, *, hardware: builtins.str = ..., firmware: builtins.str = ..., software: builtins.str = ...) -> None: ...
