# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.webots_ros2_msgs.msg

__all__ = ["EmitterSendString", "GetBool", "SetString", "SpawnNodeFromString", "SpawnUrdfRobot"]

class EmitterSendString(robolink.message.Service):
    """Send a text by an emitter.

    The text.
    """
    class Request(robolink.message.Message):
        value: builtins.str
        def __init__(self, *, value: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """1 if the text was sent, 0 if the queue was full."""
        result: builtins.int
        def __init__(self, *, result: builtins.int = ...) -> None: ...
class GetBool(robolink.message.Service):
    """Ask a question that has a truth value for an answer.

    Ignored.
    """
    class Request(robolink.message.Message):
        ask: builtins.bool
        def __init__(self, *, ask: builtins.bool = ...) -> None: ...
    class Response(robolink.message.Message):
        """The answer."""
        value: builtins.bool
        def __init__(self, *, value: builtins.bool = ...) -> None: ...
class SetString(robolink.message.Service):
    """Set a text.

    The text.
    """
    class Request(robolink.message.Message):
        value: builtins.str
        def __init__(self, *, value: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class SpawnNodeFromString(robolink.message.Service):
    """Add a node to the world.

    The node, written as in a world file.
    """
    class Request(robolink.message.Message):
        data: builtins.str
        def __init__(self, *, data: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class SpawnUrdfRobot(robolink.message.Service):
    """Add a robot to the world, made from a URDF.

    The robot.
    """
    class Request(robolink.message.Message):
        robot: robolink.interfaces.webots_ros2_msgs.msg.UrdfRobot
        def __init__(self, *, robot: robolink.interfaces.webots_ros2_msgs.msg.UrdfRobot = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
