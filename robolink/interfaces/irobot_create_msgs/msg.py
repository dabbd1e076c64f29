"""The messages of irobot_create_msgs: what a Create 3 senses, and its lights and sounds."""

from typing import Annotated, ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration, Time
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, Size, float32, int16, int32, uint8, uint16, uint32


class AudioNote(Message):
    """A note: its frequency in Hz and how long it lasts."""

    frequency: uint16
    max_runtime: Duration


class AudioNoteVector(Message):
    """Notes to play one after the other; `append` plays them after those that play already, not instead."""

    header: Header
    notes: Sequence[AudioNote]
    append: bool


class Button(Message):
    """A button: whether it is down, when it was last pressed, and how long it was held."""

    header: Header
    is_pressed: bool
    last_start_pressed_time: Time
    last_pressed_duration: Duration


class InterfaceButtons(Message):
    """The three buttons on top of the robot: one dot on the left, power in the middle, two dots on the right."""

    header: Header
    button_1: Button
    button_power: Button
    button_2: Button


class DockStatus(Message):
    """The dock: whether the robot sees it, and whether it stands on it."""

    header: Header
    dock_visible: bool
    is_docked: bool


class HazardDetection(Message):
    """A danger that the robot noticed; the frame of the header is the sensor that did."""

    BACKUP_LIMIT: ClassVar[uint8] = 0
    BUMP: ClassVar[uint8] = 1
    CLIFF: ClassVar[uint8] = 2
    STALL: ClassVar[uint8] = 3
    WHEEL_DROP: ClassVar[uint8] = 4
    OBJECT_PROXIMITY: ClassVar[uint8] = 5

    header: Header
    type: uint8


class HazardDetectionVector(Message):
    """The dangers that the robot notices at present."""

    header: Header
    detections: Sequence[HazardDetection]


class IrIntensity(Message):
    """Brightness of what an infrared sensor sees of its own light, without unit; the frame is the sensor."""

    header: Header
    value: int16


class IrIntensityVector(Message):
    """The brightnesses that all infrared sensors see."""

    header: Header
    readings: Sequence[IrIntensity]


class IrOpcode(Message):
    """A code of infrared light, such as a dock or a virtual wall sends, and the sensor that saw it."""

    CODE_IR_FORCE_FIELD: ClassVar[uint8] = 161
    CODE_IR_VIRTUAL_WALL: ClassVar[uint8] = 162
    CODE_IR_BUOY_GREEN: ClassVar[uint8] = 164
    CODE_IR_BUOY_RED: ClassVar[uint8] = 168
    CODE_IR_BUOY_BOTH: ClassVar[uint8] = 172
    CODE_IR_EVAC_GREEN_FIELD: ClassVar[uint8] = 244
    CODE_IR_EVAC_RED_FIELD: ClassVar[uint8] = 248
    CODE_IR_EVAC_BOTH_FIELD: ClassVar[uint8] = 252
    SENSOR_OMNI: ClassVar[uint8] = 0
    SENSOR_DIRECTIONAL_FRONT: ClassVar[uint8] = 1

    header: Header
    opcode: uint8
    sensor: uint8


class KidnapStatus(Message):
    """State of being lifted: True while the robot is held in the air."""

    header: Header
    is_kidnapped: bool


class LedColor(Message):
    """Colour of a light, each part from 0 to 255."""

    red: uint8
    green: uint8
    blue: uint8


class LightringLeds(Message):
    """Colours of the six lights of the ring; `override_system` False gives the ring back to the robot."""

    header: Header
    leds: Annotated[Sequence[LedColor], Size(6)]
    override_system: bool


class Mouse(Message):
    """Motion over the ground by the optical sensor, summed, in metres.

    `frame_id` counts how often the sensor lost track; `last_squal` is the quality of the ground, more is better.
    """

    header: Header
    integrated_x: float32
    integrated_y: float32
    frame_id: uint32
    last_squal: uint8


class SlipStatus(Message):
    """Slipping of the wheels: True while the robot does not move as they turn."""

    header: Header
    is_slipping: bool


class StopStatus(Message):
    """Standstill: True while the robot does not move."""

    header: Header
    is_stopped: bool


class WheelStatus(Message):
    """Currents of the wheels' motors in mA and their duty cycles, where 32767 is 100 %.

    `wheels_enabled` is False after an emergency stop.
    """

    header: Header
    current_ma_left: int16
    current_ma_right: int16
    pwm_left: int16
    pwm_right: int16
    wheels_enabled: bool


class WheelTicks(Message):
    """Counts of the wheels' encoders."""

    header: Header
    ticks_left: int32
    ticks_right: int32


class WheelVels(Message):
    """Speeds of the wheels in rad/s."""

    header: Header
    velocity_left: float32
    velocity_right: float32
