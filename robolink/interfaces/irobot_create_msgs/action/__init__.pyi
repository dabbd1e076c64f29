# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.irobot_create_msgs.msg

__all__ = ["AudioNoteSequence", "Dock", "DriveArc", "DriveDistance", "LedAnimation", "NavigateToPosition", "RotateAngle", "Undock", "WallFollow"]

class AudioNoteSequence(robolink.message.Action):
    """Play notes.

    The notes and how often to play them; INFINITE plays until it is cancelled.
    """
    class Goal(robolink.message.Message):
        INFINITE: typing.ClassVar[builtins.int]
        iterations: builtins.int
        note_sequence: robolink.interfaces.irobot_create_msgs.msg.AudioNoteVector
        def __init__(self, *, iterations: builtins.int = ..., note_sequence: robolink.interfaces.irobot_create_msgs.msg.AudioNoteVector = ...) -> None: ...
    class Result(robolink.message.Message):
        """Outcome: whether all was played, how often, and for how long."""
        complete: builtins.bool
        iterations_played: builtins.int
        runtime: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, complete: builtins.bool = ..., iterations_played: builtins.int = ..., runtime: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Number of times that the notes were played so far, and the time since the start."""
        iterations_played: builtins.int
        current_runtime: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, iterations_played: builtins.int = ..., current_runtime: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
class Dock(robolink.message.Action):
    """Drive onto the dock.

    Nothing.
    """
    class Goal(robolink.message.Message):
        def __init__(self) -> None: ...
    class Result(robolink.message.Message):
        """True if the robot stands on the dock."""
        is_docked: builtins.bool
        def __init__(self, *, is_docked: builtins.bool = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """True while the robot sees the dock."""
        sees_dock: builtins.bool
        def __init__(self, *, sees_dock: builtins.bool = ...) -> None: ...
class DriveArc(robolink.message.Action):
    """Drive along an arc.

    Direction, the angle of the arc in radians, its radius in metres, and the speed limit in m/s.

    A positive angle turns to the left.
    """
    class Goal(robolink.message.Message):
        TRANSLATE_FORWARD: typing.ClassVar[builtins.int]
        TRANSLATE_BACKWARD: typing.ClassVar[builtins.int]
        translate_direction: builtins.int
        angle: builtins.float
        radius: builtins.float
        max_translation_speed: builtins.float
        def __init__(self, *, translate_direction: builtins.int = ..., angle: builtins.float = ..., radius: builtins.float = ..., max_translation_speed: builtins.float = ...) -> None: ...
    class Result(robolink.message.Message):
        """Pose at the end."""
        pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
        def __init__(self, *, pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The angle that is left, in radians."""
        remaining_angle_travel: builtins.float
        def __init__(self, *, remaining_angle_travel: builtins.float = ...) -> None: ...
class DriveDistance(robolink.message.Action):
    """Drive straight.

    Distance in metres, negative for backwards, and the speed limit in m/s.
    """
    class Goal(robolink.message.Message):
        distance: builtins.float
        max_translation_speed: builtins.float
        def __init__(self, *, distance: builtins.float = ..., max_translation_speed: builtins.float = ...) -> None: ...
    class Result(robolink.message.Message):
        """Pose at the end."""
        pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
        def __init__(self, *, pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The distance that is left, in metres."""
        remaining_travel_distance: builtins.float
        def __init__(self, *, remaining_travel_distance: builtins.float = ...) -> None: ...
class LedAnimation(robolink.message.Action):
    """Let the ring of lights blink or turn.

    Kind of animation, colours, and how long it lasts.
    """
    class Goal(robolink.message.Message):
        BLINK_LIGHTS: typing.ClassVar[builtins.int]
        SPIN_LIGHTS: typing.ClassVar[builtins.int]
        animation_type: builtins.int
        lightring: robolink.interfaces.irobot_create_msgs.msg.LightringLeds
        max_runtime: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, animation_type: builtins.int = ..., lightring: robolink.interfaces.irobot_create_msgs.msg.LightringLeds = ..., max_runtime: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Result(robolink.message.Message):
        """Length of the animation."""
        runtime: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, runtime: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The time that is left."""
        remaining_runtime: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, remaining_runtime: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
class NavigateToPosition(robolink.message.Action):
    """Drive straight to a pose by odometry.

    The pose, whether its orientation matters, and the speed limits in m/s and rad/s.
    """
    class Goal(robolink.message.Message):
        goal_pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
        achieve_goal_heading: builtins.bool
        max_translation_speed: builtins.float
        max_rotation_speed: builtins.float
        def __init__(self, *, goal_pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., achieve_goal_heading: builtins.bool = ..., max_translation_speed: builtins.float = ..., max_rotation_speed: builtins.float = ...) -> None: ...
    class Result(robolink.message.Message):
        """Pose at the end."""
        pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
        def __init__(self, *, pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Current part of the movement, and the angle (rad) or distance (m) that is left of it."""
        ROTATING_TO_GOAL_POSITION: typing.ClassVar[builtins.int]
        DRIVING_TO_GOAL_POSITION: typing.ClassVar[builtins.int]
        ROTATING_TO_GOAL_ORIENTATION: typing.ClassVar[builtins.int]
        navigate_state: builtins.int
        remaining_angle_travel: builtins.float
        remaining_travel_distance: builtins.float
        def __init__(self, *, navigate_state: builtins.int = ..., remaining_angle_travel: builtins.float = ..., remaining_travel_distance: builtins.float = ...) -> None: ...
class RotateAngle(robolink.message.Action):
    """Turn on the spot.

    Angle in radians, positive to the left, and the speed limit in rad/s.
    """
    class Goal(robolink.message.Message):
        angle: builtins.float
        max_rotation_speed: builtins.float
        def __init__(self, *, angle: builtins.float = ..., max_rotation_speed: builtins.float = ...) -> None: ...
    class Result(robolink.message.Message):
        """Pose at the end."""
        pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
        def __init__(self, *, pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The angle that is left, in radians."""
        remaining_angle_travel: builtins.float
        def __init__(self, *, remaining_angle_travel: builtins.float = ...) -> None: ...
class Undock(robolink.message.Action):
    """Drive off the dock.

    Nothing.
    """
    class Goal(robolink.message.Message):
        def __init__(self) -> None: ...
    class Result(robolink.message.Message):
        """True if the robot still stands on the dock."""
        is_docked: builtins.bool
        def __init__(self, *, is_docked: builtins.bool = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class WallFollow(robolink.message.Action):
    """Drive along a wall.

    The side on which the wall is, and how long to follow it.
    """
    class Goal(robolink.message.Message):
        FOLLOW_RIGHT: typing.ClassVar[builtins.int]
        FOLLOW_LEFT: typing.ClassVar[builtins.int]
        follow_side: builtins.int
        max_runtime: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, follow_side: builtins.int = ..., max_runtime: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Result(robolink.message.Message):
        """Time for which the wall was followed."""
        runtime: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, runtime: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """True while the robot has the wall beside it."""
        engaged: builtins.bool
        def __init__(self, *, engaged: builtins.bool = ...) -> None: ...
