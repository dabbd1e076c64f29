"""The messages of turtlebot3_msgs: sensors and sounds of the robot's board."""

from typing import ClassVar

from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, float32, int32, string, uint8


class SensorState(Message):
    """Bumpers, buttons and other sensors that hang on the robot's board.

    Encoders are in ticks, the battery is in volts; `torque` is True while the motors are on.
    """

    BUMPER_FORWARD: ClassVar[uint8] = 1
    BUMPER_BACKWARD: ClassVar[uint8] = 2
    CLIFF: ClassVar[uint8] = 1
    SONAR: ClassVar[uint8] = 1
    ILLUMINATION: ClassVar[uint8] = 1
    BUTTON0: ClassVar[uint8] = 1
    BUTTON1: ClassVar[uint8] = 2
    ERROR_LEFT_MOTOR: ClassVar[uint8] = 1
    ERROR_RIGHT_MOTOR: ClassVar[uint8] = 2
    TORQUE_ON: ClassVar[uint8] = 1
    TORQUE_OFF: ClassVar[uint8] = 2

    header: Header
    bumper: uint8
    cliff: float32
    sonar: float32
    illumination: float32
    led: uint8
    button: uint8
    torque: bool
    left_encoder: int32
    right_encoder: int32
    battery: float32


class Sound(Message):
    """A sound for the robot to make."""

    OFF: ClassVar[uint8] = 0
    ON: ClassVar[uint8] = 1
    LOW_BATTERY: ClassVar[uint8] = 2
    ERROR: ClassVar[uint8] = 3
    BUTTON1: ClassVar[uint8] = 4
    BUTTON2: ClassVar[uint8] = 5

    value: uint8


class VersionInfo(Message):
    """Versions of the robot's hardware, firmware and software."""

    hardware: string
    firmware: string
    software: string
