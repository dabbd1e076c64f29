# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.nav_msgs.msg

__all__ = ["GetMap", "GetPlan", "LoadMap", "SetMap"]

class GetMap(robolink.message.Service):
    """Ask a map server for its map.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The map as it is now."""
        map: robolink.interfaces.nav_msgs.msg.OccupancyGrid
        def __init__(self, *, map: robolink.interfaces.nav_msgs.msg.OccupancyGrid = ...) -> None: ...
class GetPlan(robolink.message.Service):
    """Ask for a way from one pose to another.

    Start and goal; when the goal is blocked the plan may end up to `tolerance` metres beside it.
    """
    class Request(robolink.message.Message):
        start: robolink.interfaces.geometry_msgs.msg.PoseStamped
        goal: robolink.interfaces.geometry_msgs.msg.PoseStamped
        tolerance: builtins.float
        def __init__(self, *, start: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., goal: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., tolerance: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """The way, from start to goal; empty when there is none."""
        plan: robolink.interfaces.nav_msgs.msg.Path
        def __init__(self, *, plan: robolink.interfaces.nav_msgs.msg.Path = ...) -> None: ...
class LoadMap(robolink.message.Service):
    """Load a map from a file into a map server, which serves it.

    Place of the map's YAML file: ``file:///...``, or ``package://name/...`` in a package.
    """
    class Request(robolink.message.Message):
        map_url: builtins.str
        def __init__(self, *, map_url: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The map, which only counts when `result` is RESULT_SUCCESS."""
        RESULT_SUCCESS: typing.ClassVar[builtins.int]
        RESULT_MAP_DOES_NOT_EXIST: typing.ClassVar[builtins.int]
        RESULT_INVALID_MAP_DATA: typing.ClassVar[builtins.int]
        RESULT_INVALID_MAP_METADATA: typing.ClassVar[builtins.int]
        RESULT_UNDEFINED_FAILURE: typing.ClassVar[builtins.int]
        map: robolink.interfaces.nav_msgs.msg.OccupancyGrid
        result: builtins.int
        def __init__(self, *, map: robolink.interfaces.nav_msgs.msg.OccupancyGrid = ..., result: builtins.int = ...) -> None: ...
class SetMap(robolink.message.Service):
    """Hand over a map, and where the robot is in it.

    The map, and the pose from which localisation shall start.
    """
    class Request(robolink.message.Message):
        map: robolink.interfaces.nav_msgs.msg.OccupancyGrid
        initial_pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovarianceStamped
        def __init__(self, *, map: robolink.interfaces.nav_msgs.msg.OccupancyGrid = ..., initial_pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovarianceStamped = ...) -> None: ...
    class Response(robolink.message.Message):
        """True if the map was taken."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
