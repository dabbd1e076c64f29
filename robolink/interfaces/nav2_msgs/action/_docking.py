"""Driving onto docks and off them."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.message import Action, Message, float32, string, uint16


class DockRobot(Action):
    """Drive onto a dock."""

    class Goal(Message):
        """The dock, by its name or by pose and kind, and how to come near to it; times in seconds."""

        use_dock_id: bool = True
        dock_id: string
        dock_pose: PoseStamped
        dock_type: string
        max_staging_time: float32 = 1000.0
        navigate_to_staging_pose: bool = True

    class Result(Message):
        """Success or the kind of failure, and the number of attempts."""

        NONE: ClassVar[uint16] = 0
        DOCK_NOT_IN_DB: ClassVar[uint16] = 901
        DOCK_NOT_VALID: ClassVar[uint16] = 902
        FAILED_TO_STAGE: ClassVar[uint16] = 903
        FAILED_TO_DETECT_DOCK: ClassVar[uint16] = 904
        FAILED_TO_CONTROL: ClassVar[uint16] = 905
        FAILED_TO_CHARGE: ClassVar[uint16] = 906
        UNKNOWN: ClassVar[uint16] = 999

        success: bool = True
        error_code: uint16 = 0
        num_retries: uint16 = 0
        error_msg: string

    class Feedback(Message):
        """State of the docking, the time since its start, and the number of attempts."""

        NONE: ClassVar[uint16] = 0
        NAV_TO_STAGING_POSE: ClassVar[uint16] = 1
        INITIAL_PERCEPTION: ClassVar[uint16] = 2
        CONTROLLING: ClassVar[uint16] = 3
        WAIT_FOR_CHARGE: ClassVar[uint16] = 4
        RETRY: ClassVar[uint16] = 5

        state: uint16
        docking_time: Duration
        num_retries: uint16 = 0


class UndockRobot(Action):
    """Drive off a dock."""

    class Goal(Message):
        """Kind of the dock, and the time in seconds to give up after."""

        dock_type: string
        max_undocking_time: float32 = 30.0

    class Result(Message):
        """Success or the kind of failure."""

        NONE: ClassVar[uint16] = 0
        DOCK_NOT_VALID: ClassVar[uint16] = 902
        FAILED_TO_CONTROL: ClassVar[uint16] = 905
        UNKNOWN: ClassVar[uint16] = 999

        success: bool = True
        error_code: uint16 = 0
        error_msg: string

    class Feedback(Message):
        """Nothing."""
