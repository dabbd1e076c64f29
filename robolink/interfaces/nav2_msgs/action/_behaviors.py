"""Small movements, most of which recoveries use."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geometry_msgs.msg import Point
from robolink.interfaces.std_msgs.msg import String
from robolink.message import Action, Message, float32, string, uint16


class Spin(Action):
    """Turn on the spot."""

    class Goal(Message):
        """By how much, in radians, and the time to give up after."""

        target_yaw: float32
        time_allowance: Duration

    class Result(Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 700
        TIMEOUT: ClassVar[uint16] = 701
        TF_ERROR: ClassVar[uint16] = 702
        COLLISION_AHEAD: ClassVar[uint16] = 703

        total_elapsed_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """The angle turned so far, in radians."""

        angular_distance_traveled: float32


class BackUp(Action):
    """Drive backwards."""

    class Goal(Message):
        """Distance back (`x` of the target, in metres), speed (m/s), and the time to give up after."""

        target: Point
        speed: float32
        time_allowance: Duration

    class Result(Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 710
        TIMEOUT: ClassVar[uint16] = 711
        TF_ERROR: ClassVar[uint16] = 712
        INVALID_INPUT: ClassVar[uint16] = 713
        COLLISION_AHEAD: ClassVar[uint16] = 714

        total_elapsed_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """Metres driven so far."""

        distance_traveled: float32


class DriveOnHeading(Action):
    """Drive straight ahead."""

    class Goal(Message):
        """Distance (`x` of the target, in metres), speed (m/s), and the time to give up after."""

        target: Point
        speed: float32
        time_allowance: Duration

    class Result(Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 720
        TIMEOUT: ClassVar[uint16] = 721
        TF_ERROR: ClassVar[uint16] = 722
        COLLISION_AHEAD: ClassVar[uint16] = 723
        INVALID_INPUT: ClassVar[uint16] = 724

        total_elapsed_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """Metres driven so far."""

        distance_traveled: float32


class Wait(Action):
    """Stand still for a while."""

    class Goal(Message):
        """Length of the wait."""

        time: Duration

    class Result(Message):
        """Outcome, and the length of the wait."""

        total_elapsed_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """The time that is left."""

        time_left: Duration


class AssistedTeleop(Action):
    """Drive by hand, with stops before collisions."""

    class Goal(Message):
        """The time to give up after."""

        time_allowance: Duration

    class Result(Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 730
        TIMEOUT: ClassVar[uint16] = 731
        TF_ERROR: ClassVar[uint16] = 732

        total_elapsed_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """The time since the start."""

        current_teleop_duration: Duration


class DummyBehavior(Action):
    """Do nothing: Nav2's tests use it."""

    class Goal(Message):
        """Words to react to."""

        command: String

    class Result(Message):
        """Outcome, and the time that it took."""

        total_elapsed_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """Nothing."""
