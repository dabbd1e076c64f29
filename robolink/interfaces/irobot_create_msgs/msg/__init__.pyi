# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.irobot_create_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["AudioNote", "AudioNoteVector", "Button", "DockStatus", "HazardDetection", "HazardDetectionVector", "InterfaceButtons", "IrIntensity", "IrIntensityVector", "IrOpcode", "KidnapStatus", "LedColor", "LightringLeds", "Mouse", "SlipStatus", "StopStatus", "WheelStatus", "WheelTicks", "WheelVels"]

class AudioNote(robolink.message.Message):
    """A note: its frequency in Hz and how long it lasts."""
    frequency: builtins.int
    max_runtime: robolink.interfaces.builtin_interfaces.msg.Duration
    def __init__(self, *, frequency: builtins.int = ..., max_runtime: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
class AudioNoteVector(robolink.message.Message):
    """Notes to play one after the other; `append` plays them after those that play already, not instead."""
    header: robolink.interfaces.std_msgs.msg.Header
    notes: collections.abc.MutableSequence[robolink.interfaces.irobot_create_msgs.msg.AudioNote]
    append: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., notes: collections.abc.Iterable[robolink.interfaces.irobot_create_msgs.msg.AudioNote] = ..., append: builtins.bool = ...) -> None: ...
class Button(robolink.message.Message):
    """A button: whether it is down, when it was last pressed, and how long it was held."""
    header: robolink.interfaces.std_msgs.msg.Header
    is_pressed: builtins.bool
    last_start_pressed_time: robolink.interfaces.builtin_interfaces.msg.Time
    last_pressed_duration: robolink.interfaces.builtin_interfaces.msg.Duration
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., is_pressed: builtins.bool = ..., last_start_pressed_time: robolink.interfaces.builtin_interfaces.msg.Time = ..., last_pressed_duration: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
class DockStatus(robolink.message.Message):
    """The dock: whether the robot sees it, and whether it stands on it."""
    header: robolink.interfaces.std_msgs.msg.Header
    dock_visible: builtins.bool
    is_docked: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., dock_visible: builtins.bool = ..., is_docked: builtins.bool = ...) -> None: ...
class HazardDetection(robolink.message.Message):
    """A danger that the robot noticed; the frame of the header is the sensor that did."""
    BACKUP_LIMIT: typing.ClassVar[builtins.int]
    BUMP: typing.ClassVar[builtins.int]
    CLIFF: typing.ClassVar[builtins.int]
    STALL: typing.ClassVar[builtins.int]
    WHEEL_DROP: typing.ClassVar[builtins.int]
    OBJECT_PROXIMITY: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    type: builtins.int
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., type: builtins.int = ...) -> None: ...
class HazardDetectionVector(robolink.message.Message):
    """The dangers that the robot notices at present."""
    header: robolink.interfaces.std_msgs.msg.Header
    detections: collections.abc.MutableSequence[robolink.interfaces.irobot_create_msgs.msg.HazardDetection]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., detections: collections.abc.Iterable[robolink.interfaces.irobot_create_msgs.msg.HazardDetection] = ...) -> None: ...
class InterfaceButtons(robolink.message.Message):
    """The three buttons on top of the robot: one dot on the left, power in the middle, two dots on the right."""
    header: robolink.interfaces.std_msgs.msg.Header
    button_1: robolink.interfaces.irobot_create_msgs.msg.Button
    button_power: robolink.interfaces.irobot_create_msgs.msg.Button
    button_2: robolink.interfaces.irobot_create_msgs.msg.Button
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., button_1: robolink.interfaces.irobot_create_msgs.msg.Button = ..., button_power: robolink.interfaces.irobot_create_msgs.msg.Button = ..., button_2: robolink.interfaces.irobot_create_msgs.msg.Button = ...) -> None: ...
class IrIntensity(robolink.message.Message):
    """Brightness of what an infrared sensor sees of its own light, without unit; the frame is the sensor."""
    header: robolink.interfaces.std_msgs.msg.Header
    value: builtins.int
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., value: builtins.int = ...) -> None: ...
class IrIntensityVector(robolink.message.Message):
    """The brightnesses that all infrared sensors see."""
    header: robolink.interfaces.std_msgs.msg.Header
    readings: collections.abc.MutableSequence[robolink.interfaces.irobot_create_msgs.msg.IrIntensity]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., readings: collections.abc.Iterable[robolink.interfaces.irobot_create_msgs.msg.IrIntensity] = ...) -> None: ...
class IrOpcode(robolink.message.Message):
    """A code of infrared light, such as a dock or a virtual wall sends, and the sensor that saw it."""
    CODE_IR_FORCE_FIELD: typing.ClassVar[builtins.int]
    CODE_IR_VIRTUAL_WALL: typing.ClassVar[builtins.int]
    CODE_IR_BUOY_GREEN: typing.ClassVar[builtins.int]
    CODE_IR_BUOY_RED: typing.ClassVar[builtins.int]
    CODE_IR_BUOY_BOTH: typing.ClassVar[builtins.int]
    CODE_IR_EVAC_GREEN_FIELD: typing.ClassVar[builtins.int]
    CODE_IR_EVAC_RED_FIELD: typing.ClassVar[builtins.int]
    CODE_IR_EVAC_BOTH_FIELD: typing.ClassVar[builtins.int]
    SENSOR_OMNI: typing.ClassVar[builtins.int]
    SENSOR_DIRECTIONAL_FRONT: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    opcode: builtins.int
    sensor: builtins.int
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., opcode: builtins.int = ..., sensor: builtins.int = ...) -> None: ...
class KidnapStatus(robolink.message.Message):
    """State of being lifted: True while the robot is held in the air."""
    header: robolink.interfaces.std_msgs.msg.Header
    is_kidnapped: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., is_kidnapped: builtins.bool = ...) -> None: ...
class LedColor(robolink.message.Message):
    """Colour of a light, each part from 0 to 255."""
    red: builtins.int
    green: builtins.int
    blue: builtins.int
    def __init__(self, *, red: builtins.int = ..., green: builtins.int = ..., blue: builtins.int = ...) -> None: ...
class LightringLeds(robolink.message.Message):
    """Colours of the six lights of the ring; `override_system` False gives the ring back to the robot."""
    header: robolink.interfaces.std_msgs.msg.Header
    leds: collections.abc.MutableSequence[robolink.interfaces.irobot_create_msgs.msg.LedColor]
    override_system: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., leds: collections.abc.Iterable[robolink.interfaces.irobot_create_msgs.msg.LedColor] = ..., override_system: builtins.bool = ...) -> None: ...
class Mouse(robolink.message.Message):
    """Motion over the ground by the optical sensor, summed, in metres.

    `frame_id` counts how often the sensor lost track; `last_squal` is the quality of the ground, more is better.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    integrated_x: builtins.float
    integrated_y: builtins.float
    frame_id: builtins.int
    last_squal: builtins.int
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., integrated_x: builtins.float = ..., integrated_y: builtins.float = ..., frame_id: builtins.int = ..., last_squal: builtins.int = ...) -> None: ...
class SlipStatus(robolink.message.Message):
    """Slipping of the wheels: True while the robot does not move as they turn."""
    header: robolink.interfaces.std_msgs.msg.Header
    is_slipping: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., is_slipping: builtins.bool = ...) -> None: ...
class StopStatus(robolink.message.Message):
    """Standstill: True while the robot does not move."""
    header: robolink.interfaces.std_msgs.msg.Header
    is_stopped: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., is_stopped: builtins.bool = ...) -> None: ...
class WheelStatus(robolink.message.Message):
    """Currents of the wheels' motors in mA and their duty cycles, where 32767 is 100 %.

    `wheels_enabled` is False after an emergency stop.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    current_ma_left: builtins.int
    current_ma_right: builtins.int
    pwm_left: builtins.int
    pwm_right: builtins.int
    wheels_enabled: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., current_ma_left: builtins.int = ..., current_ma_right: builtins.int = ..., pwm_left: builtins.int = ..., pwm_right: builtins.int = ..., wheels_enabled: builtins.bool = ...) -> None: ...
class WheelTicks(robolink.message.Message):
    """Counts of the wheels' encoders."""
    header: robolink.interfaces.std_msgs.msg.Header
    ticks_left: builtins.int
    ticks_right: builtins.int
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., ticks_left: builtins.int = ..., ticks_right: builtins.int = ...) -> None: ...
class WheelVels(robolink.message.Message):
    """Speeds of the wheels in rad/s."""
    header: robolink.interfaces.std_msgs.msg.Header
    velocity_left: builtins.float
    velocity_right: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., velocity_left: builtins.float = ..., velocity_right: builtins.float = ...) -> None: ...
