# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg

__all__ = ["EStop", "ResetPose", "RobotPower"]

class EStop(robolink.message.Service):
    """Stop the motors in an emergency, or release them.

    True cuts the motors' power, False returns it.
    """
    class Request(robolink.message.Message):
        e_stop_on: builtins.bool
        def __init__(self, *, e_stop_on: builtins.bool = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., message: builtins.str = ...) -> None: ...
class ResetPose(robolink.message.Service):
    """Set the pose of odometry.

    The pose that the robot has from now on.
    """
    class Request(robolink.message.Message):
        pose: robolink.interfaces.geometry_msgs.msg.Pose
        def __init__(self, *, pose: robolink.interfaces.geometry_msgs.msg.Pose = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class RobotPower(robolink.message.Service):
    """Switch the robot off.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Success and words for people; the robot may be off before they are sent."""
        success: builtins.bool
        message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., message: builtins.str = ...) -> None: ...
