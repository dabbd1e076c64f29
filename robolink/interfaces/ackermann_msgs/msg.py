"""The messages of ackermann_msgs: driving commands for vehicles that steer with their front wheels, as cars do."""

from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, float32


class AckermannDrive(Message):
    """Command to a car: its steering and its speed.

    `steering_angle`, in radians, positive to the left, is that of one wheel imagined in the middle of the front axle,
    not of the steering wheel; `steering_angle_velocity`, in rad/s, is how fast to turn it, 0 for as fast as can be.
    `speed`, in m/s at the middle of the rear axle, is negative backwards; `acceleration` (m/s²) and `jerk` (m/s³) are
    magnitudes, 0 for as much as can be.
    """

    steering_angle: float32
    steering_angle_velocity: float32
    speed: float32
    acceleration: float32
    jerk: float32


class AckermannDriveStamped(Message):
    """A driving command, and when it was given."""

    header: Header
    drive: AckermannDrive
