# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["AddSubmap", "Clear", "ClearQueue", "DeserializePoseGraph", "LoopClosure", "MergeMaps", "Pause", "Reset", "SaveMap", "SerializePoseGraph", "ToggleInteractive"]

class AddSubmap(robolink.message.Service):
    """Add a saved map to those that are merged.

    The file's name without ending.
    """
    class Request(robolink.message.Message):
        filename: builtins.str
        def __init__(self, *, filename: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class Clear(robolink.message.Service):
    """Forget the changes that were made by hand and are not saved.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class ClearQueue(robolink.message.Service):
    """Forget the scans that wait to be used.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """True if that worked."""
        status: builtins.bool
        def __init__(self, *, status: builtins.bool = ...) -> None: ...
class DeserializePoseGraph(robolink.message.Service):
    """Go on from a pose graph that was saved.

    The file's name without ending, and where the robot is.

    It is at the first node, at the pose, or near the pose and only localizes itself from there on.
    """
    class Request(robolink.message.Message):
        UNSET: typing.ClassVar[builtins.int]
        START_AT_FIRST_NODE: typing.ClassVar[builtins.int]
        START_AT_GIVEN_POSE: typing.ClassVar[builtins.int]
        LOCALIZE_AT_POSE: typing.ClassVar[builtins.int]
        filename: builtins.str
        match_type: builtins.int
        initial_pose: robolink.interfaces.geometry_msgs.msg.Pose2D
        def __init__(self, *, filename: builtins.str = ..., match_type: builtins.int = ..., initial_pose: robolink.interfaces.geometry_msgs.msg.Pose2D = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class LoopClosure(robolink.message.Service):
    """Accept the changes of the pose graph that were made by hand.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class MergeMaps(robolink.message.Service):
    """Merge the maps that were added.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class Pause(robolink.message.Service):
    """Pause new measurements, or go on.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """True if that worked."""
        status: builtins.bool
        def __init__(self, *, status: builtins.bool = ...) -> None: ...
class Reset(robolink.message.Service):
    """Begin with an empty map.

    True pauses new measurements after that.
    """
    class Request(robolink.message.Message):
        pause_new_measurements: builtins.bool
        def __init__(self, *, pause_new_measurements: builtins.bool = ...) -> None: ...
    class Response(robolink.message.Message):
        """Outcome: RESULT_SUCCESS."""
        RESULT_SUCCESS: typing.ClassVar[builtins.int]
        result: builtins.int
        def __init__(self, *, result: builtins.int = ...) -> None: ...
class SaveMap(robolink.message.Service):
    """Save the map in files.

    The files' name without ending; an empty one takes the usual.
    """
    class Request(robolink.message.Message):
        name: robolink.interfaces.std_msgs.msg.String
        def __init__(self, *, name: robolink.interfaces.std_msgs.msg.String = ...) -> None: ...
    class Response(robolink.message.Message):
        """Outcome: RESULT_SUCCESS or the kind of failure."""
        RESULT_SUCCESS: typing.ClassVar[builtins.int]
        RESULT_NO_MAP_RECEIEVD: typing.ClassVar[builtins.int]
        RESULT_UNDEFINED_FAILURE: typing.ClassVar[builtins.int]
        result: builtins.int
        def __init__(self, *, result: builtins.int = ...) -> None: ...
class SerializePoseGraph(robolink.message.Service):
    """Save the pose graph, so that mapping can go on from it later.

    The file's name without ending.
    """
    class Request(robolink.message.Message):
        filename: builtins.str
        def __init__(self, *, filename: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Outcome: RESULT_SUCCESS or the kind of failure."""
        RESULT_SUCCESS: typing.ClassVar[builtins.int]
        RESULT_FAILED_TO_WRITE_FILE: typing.ClassVar[builtins.int]
        result: builtins.int
        def __init__(self, *, result: builtins.int = ...) -> None: ...
class ToggleInteractive(robolink.message.Service):
    """Switch changing the pose graph by hand on or off.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
