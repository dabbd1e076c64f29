# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg

__all__ = ["QueryCalibrationState", "QueryTrajectoryState", "SetOdometry"]

class QueryCalibrationState(robolink.message.Service):
    """Ask whether a robot is calibrated.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """True once it is."""
        is_calibrated: builtins.bool
        def __init__(self, *, is_calibrated: builtins.bool = ...) -> None: ...
class QueryTrajectoryState(robolink.message.Service):
    """Ask a joint trajectory controller where the joints should be at a time.

    The time.
    """
    class Request(robolink.message.Message):
        time: robolink.interfaces.builtin_interfaces.msg.Time
        def __init__(self, *, time: robolink.interfaces.builtin_interfaces.msg.Time = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and a sentence for people.

        For each joint of `name`: radians or metres, and these per second and per second².
        """
        success: builtins.bool
        message: builtins.str
        name: collections.abc.MutableSequence[builtins.str]
        position: collections.abc.MutableSequence[builtins.float]
        velocity: collections.abc.MutableSequence[builtins.float]
        acceleration: collections.abc.MutableSequence[builtins.float]
        def __init__(self, *, success: builtins.bool = ..., message: builtins.str = ..., name: collections.abc.Iterable[builtins.str] = ..., position: collections.abc.Iterable[builtins.float] = ..., velocity: collections.abc.Iterable[builtins.float] = ..., acceleration: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class SetOdometry(robolink.message.Service):
    """Set the pose of a robot in its odometry.

    The position in metres and the angles in radians.
    """
    class Request(robolink.message.Message):
        x: builtins.float
        y: builtins.float
        z: builtins.float
        roll: builtins.float
        pitch: builtins.float
        yaw: builtins.float
        def __init__(self, *, x: builtins.float = ..., y: builtins.float = ..., z: builtins.float = ..., roll: builtins.float = ..., pitch: builtins.float = ..., yaw: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and a sentence for people."""
        success: builtins.bool
        message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., message: builtins.str = ...) -> None: ...
