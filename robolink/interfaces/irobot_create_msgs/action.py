"""The actions of irobot_create_msgs: movements, the dock, lights and sounds."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.irobot_create_msgs.msg import AudioNoteVector, LightringLeds
from robolink.message import Action, Message, float32, int8, int32


class AudioNoteSequence(Action):
    """Play notes."""

    class Goal(Message):
        """The notes and how often to play them; INFINITE plays until it is cancelled."""

        INFINITE: ClassVar[int32] = -1

        iterations: int32 = 1
        note_sequence: AudioNoteVector

    class Result(Message):
        """Outcome: whether all was played, how often, and for how long."""

        complete: bool
        iterations_played: int32
        runtime: Duration

    class Feedback(Message):
        """Number of times that the notes were played so far, and the time since the start."""

        iterations_played: int32
        current_runtime: Duration


class Dock(Action):
    """Drive onto the dock."""

    class Goal(Message):
        """Nothing."""

    class Result(Message):
        """True if the robot stands on the dock."""

        is_docked: bool

    class Feedback(Message):
        """True while the robot sees the dock."""

        sees_dock: bool


class DriveArc(Action):
    """Drive along an arc."""

    class Goal(Message):
        """Direction, the angle of the arc in radians, its radius in metres, and the speed limit in m/s.

        A positive angle turns to the left.
        """

        TRANSLATE_FORWARD: ClassVar[int8] = 1
        TRANSLATE_BACKWARD: ClassVar[int8] = -1

        translate_direction: int8
        angle: float32
        radius: float32
        max_translation_speed: float32 = 0.3

    class Result(Message):
        """Pose at the end."""

        pose: PoseStamped

    class Feedback(Message):
        """The angle that is left, in radians."""

        remaining_angle_travel: float32


class DriveDistance(Action):
    """Drive straight."""

    class Goal(Message):
        """Distance in metres, negative for backwards, and the speed limit in m/s."""

        distance: float32
        max_translation_speed: float32 = 0.3

    class Result(Message):
        """Pose at the end."""

        pose: PoseStamped

    class Feedback(Message):
        """The distance that is left, in metres."""

        remaining_travel_distance: float32


class LedAnimation(Action):
    """Let the ring of lights blink or turn."""

    class Goal(Message):
        """Kind of animation, colours, and how long it lasts."""

        BLINK_LIGHTS: ClassVar[int8] = 1
        SPIN_LIGHTS: ClassVar[int8] = 2

        animation_type: int8
        lightring: LightringLeds
        max_runtime: Duration

    class Result(Message):
        """Length of the animation."""

        runtime: Duration

    class Feedback(Message):
        """The time that is left."""

        remaining_runtime: Duration


class NavigateToPosition(Action):
    """Drive straight to a pose by odometry."""

    class Goal(Message):
        """The pose, whether its orientation matters, and the speed limits in m/s and rad/s."""

        goal_pose: PoseStamped
        achieve_goal_heading: bool
        max_translation_speed: float32 = 0.3
        max_rotation_speed: float32 = 1.9

    class Result(Message):
        """Pose at the end."""

        pose: PoseStamped

    class Feedback(Message):
        """Current part of the movement, and the angle (rad) or distance (m) that is left of it."""

        ROTATING_TO_GOAL_POSITION: ClassVar[int8] = 1
        DRIVING_TO_GOAL_POSITION: ClassVar[int8] = 2
        ROTATING_TO_GOAL_ORIENTATION: ClassVar[int8] = 3

        navigate_state: int8
        remaining_angle_travel: float32
        remaining_travel_distance: float32


class RotateAngle(Action):
    """Turn on the spot."""

    class Goal(Message):
        """Angle in radians, positive to the left, and the speed limit in rad/s."""

        angle: float32
        max_rotation_speed: float32 = 1.9

    class Result(Message):
        """Pose at the end."""

        pose: PoseStamped

    class Feedback(Message):
        """The angle that is left, in radians."""

        remaining_angle_travel: float32


class Undock(Action):
    """Drive off the dock."""

    class Goal(Message):
        """Nothing."""

    class Result(Message):
        """True if the robot still stands on the dock."""

        is_docked: bool

    class Feedback(Message):
        """Nothing."""


class WallFollow(Action):
    """Drive along a wall."""

    class Goal(Message):
        """The side on which the wall is, and how long to follow it."""

        FOLLOW_RIGHT: ClassVar[int8] = -1
        FOLLOW_LEFT: ClassVar[int8] = 1

        follow_side: int8
        max_runtime: Duration

    class Result(Message):
        """Time for which the wall was followed."""

        runtime: Duration

    class Feedback(Message):
        """True while the robot has the wall beside it."""

        engaged: bool
