# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.ackermann_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["AckermannDrive", "AckermannDriveStamped"]

class AckermannDrive(robolink.message.Message):
    """Command to a car: its steering and its speed.

    `steering_angle`, in radians, positive to the left, is that of one wheel imagined in the middle of the front axle,
    not of the steering wheel; `steering_angle_velocity`, in rad/s, is how fast to turn it, 0 for as fast as can be.
    `speed`, in m/s at the middle of the rear axle, is negative backwards; `acceleration` (m/s²) and `jerk` (m/s³) are
    magnitudes, 0 for as much as can be.
    """
    steering_angle: builtins.float
    steering_angle_velocity: builtins.float
    speed: builtins.float
    acceleration: builtins.float
    jerk: builtins.float
    def __init__(self, *, steering_angle: builtins.float = ..., steering_angle_velocity: builtins.float = ..., speed: builtins.float = ..., acceleration: builtins.float = ..., jerk: builtins.float = ...) -> None: ...
class AckermannDriveStamped(robolink.message.Message):
    """A driving command, and when it was given."""
    header: robolink.interfaces.std_msgs.msg.Header
    drive: robolink.interfaces.ackermann_msgs.msg.AckermannDrive
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., drive: robolink.interfaces.ackermann_msgs.msg.AckermannDrive = ...) -> None: ...
