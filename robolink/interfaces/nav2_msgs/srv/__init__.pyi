# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.nav2_msgs.msg
import robolink.interfaces.nav_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["ClearCostmapAroundPose", "ClearCostmapAroundRobot", "ClearCostmapExceptRegion", "ClearEntireCostmap", "DynamicEdges", "GetCost", "GetCostmap", "GetCosts", "IsPathValid", "LoadMap", "ManageLifecycleNodes", "ReloadDockDatabase", "SaveMap", "SetInitialPose", "SetRouteGraph", "Toggle"]

class ClearCostmapAroundPose(robolink.message.Service):
    """Clear a square of a costmap around a pose.

    The pose, and half a side of the square, in metres.
    """
    class Request(robolink.message.Message):
        pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
        reset_distance: builtins.float
        def __init__(self, *, pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., reset_distance: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing of meaning."""
        response: robolink.interfaces.std_msgs.msg.Empty
        def __init__(self, *, response: robolink.interfaces.std_msgs.msg.Empty = ...) -> None: ...
class ClearCostmapAroundRobot(robolink.message.Service):
    """Clear a square of a costmap around the robot.

    Half a side of the square, in metres.
    """
    class Request(robolink.message.Message):
        reset_distance: builtins.float
        def __init__(self, *, reset_distance: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing of meaning."""
        response: robolink.interfaces.std_msgs.msg.Empty
        def __init__(self, *, response: robolink.interfaces.std_msgs.msg.Empty = ...) -> None: ...
class ClearCostmapExceptRegion(robolink.message.Service):
    """Clear a costmap but for a square around the robot.

    Half a side of the square, in metres.
    """
    class Request(robolink.message.Message):
        reset_distance: builtins.float
        def __init__(self, *, reset_distance: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing of meaning."""
        response: robolink.interfaces.std_msgs.msg.Empty
        def __init__(self, *, response: robolink.interfaces.std_msgs.msg.Empty = ...) -> None: ...
class ClearEntireCostmap(robolink.message.Service):
    """Clear a costmap.

    Nothing of meaning.
    """
    class Request(robolink.message.Message):
        request: robolink.interfaces.std_msgs.msg.Empty
        def __init__(self, *, request: robolink.interfaces.std_msgs.msg.Empty = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing of meaning."""
        response: robolink.interfaces.std_msgs.msg.Empty
        def __init__(self, *, response: robolink.interfaces.std_msgs.msg.Empty = ...) -> None: ...
class DynamicEdges(robolink.message.Service):
    """Change edges of the route graph.

    Edges to close, edges to open again, and edges with another cost.
    """
    class Request(robolink.message.Message):
        closed_edges: collections.abc.MutableSequence[builtins.int]
        opened_edges: collections.abc.MutableSequence[builtins.int]
        adjust_edges: collections.abc.MutableSequence[robolink.interfaces.nav2_msgs.msg.EdgeCost]
        def __init__(self, *, closed_edges: collections.abc.Iterable[builtins.int] = ..., opened_edges: collections.abc.Iterable[builtins.int] = ..., adjust_edges: collections.abc.Iterable[robolink.interfaces.nav2_msgs.msg.EdgeCost] = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class GetCost(robolink.message.Service):
    """Return the cost at a point. Jazzy's; Kilted has GetCosts.

    The point in metres; with `use_footprint` the greatest cost under the robot, turned by `theta` radians.
    """
    class Request(robolink.message.Message):
        use_footprint: builtins.bool
        x: builtins.float
        y: builtins.float
        theta: builtins.float
        def __init__(self, *, use_footprint: builtins.bool = ..., x: builtins.float = ..., y: builtins.float = ..., theta: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """The cost, -1 off the map."""
        cost: builtins.float
        def __init__(self, *, cost: builtins.float = ...) -> None: ...
class GetCostmap(robolink.message.Service):
    """Return a costmap.

    Ignored by Nav2's servers.
    """
    class Request(robolink.message.Message):
        specs: robolink.interfaces.nav2_msgs.msg.CostmapMetaData
        def __init__(self, *, specs: robolink.interfaces.nav2_msgs.msg.CostmapMetaData = ...) -> None: ...
    class Response(robolink.message.Message):
        """The costmap."""
        map: robolink.interfaces.nav2_msgs.msg.Costmap
        def __init__(self, *, map: robolink.interfaces.nav2_msgs.msg.Costmap = ...) -> None: ...
class GetCosts(robolink.message.Service):
    """Return the costs at poses. Kilted's; Jazzy has GetCost.

    The poses; with `use_footprint` the greatest cost under the robot there.
    """
    class Request(robolink.message.Message):
        use_footprint: builtins.bool
        poses: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.PoseStamped]
        def __init__(self, *, use_footprint: builtins.bool = ..., poses: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.PoseStamped] = ...) -> None: ...
    class Response(robolink.message.Message):
        """The costs in the order of the poses, and success."""
        costs: collections.abc.MutableSequence[builtins.float]
        success: builtins.bool
        def __init__(self, *, costs: collections.abc.Iterable[builtins.float] = ..., success: builtins.bool = ...) -> None: ...
class IsPathValid(robolink.message.Service):
    """Return whether a path is free.

    The path.
    """
    class Request(robolink.message.Message):
        path: robolink.interfaces.nav_msgs.msg.Path
        def __init__(self, *, path: robolink.interfaces.nav_msgs.msg.Path = ...) -> None: ...
    class Response(robolink.message.Message):
        """Outcome: `is_valid` if it is free, and the places in the list of the poses that are not."""
        is_valid: builtins.bool
        invalid_pose_indices: collections.abc.MutableSequence[builtins.int]
        def __init__(self, *, is_valid: builtins.bool = ..., invalid_pose_indices: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class LoadMap(robolink.message.Service):
    """Load a map into the map server.

    The map's YAML file, as a path or a URL.
    """
    class Request(robolink.message.Message):
        map_url: builtins.str
        def __init__(self, *, map_url: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The map, or why there is none."""
        RESULT_SUCCESS: typing.ClassVar[builtins.int]
        RESULT_MAP_DOES_NOT_EXIST: typing.ClassVar[builtins.int]
        RESULT_INVALID_MAP_DATA: typing.ClassVar[builtins.int]
        RESULT_INVALID_MAP_METADATA: typing.ClassVar[builtins.int]
        RESULT_UNDEFINED_FAILURE: typing.ClassVar[builtins.int]
        map: robolink.interfaces.nav_msgs.msg.OccupancyGrid
        result: builtins.int
        def __init__(self, *, map: robolink.interfaces.nav_msgs.msg.OccupancyGrid = ..., result: builtins.int = ...) -> None: ...
class ManageLifecycleNodes(robolink.message.Service):
    """Change the state of all nodes of a lifecycle manager.

    The command.
    """
    class Request(robolink.message.Message):
        STARTUP: typing.ClassVar[builtins.int]
        PAUSE: typing.ClassVar[builtins.int]
        RESUME: typing.ClassVar[builtins.int]
        RESET: typing.ClassVar[builtins.int]
        SHUTDOWN: typing.ClassVar[builtins.int]
        CONFIGURE: typing.ClassVar[builtins.int]
        CLEANUP: typing.ClassVar[builtins.int]
        command: builtins.int
        def __init__(self, *, command: builtins.int = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class ReloadDockDatabase(robolink.message.Service):
    """Load the database of docks.

    The YAML file.
    """
    class Request(robolink.message.Message):
        filepath: builtins.str
        def __init__(self, *, filepath: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class SaveMap(robolink.message.Service):
    """Save a map in files.

    Topic of the map, files without their ending, format of the picture, and what cells mean.

    The mode is trinary, scale or raw; thresholds go from 0 to 1, and 0 takes the default.
    """
    class Request(robolink.message.Message):
        map_topic: builtins.str
        map_url: builtins.str
        image_format: builtins.str
        map_mode: builtins.str
        free_thresh: builtins.float
        occupied_thresh: builtins.float
        def __init__(self, *, map_topic: builtins.str = ..., map_url: builtins.str = ..., image_format: builtins.str = ..., map_mode: builtins.str = ..., free_thresh: builtins.float = ..., occupied_thresh: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        result: builtins.bool
        def __init__(self, *, result: builtins.bool = ...) -> None: ...
class SetInitialPose(robolink.message.Service):
    """Set the pose from which localization begins.

    The pose and its uncertainty.
    """
    class Request(robolink.message.Message):
        pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovarianceStamped
        def __init__(self, *, pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovarianceStamped = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class SetRouteGraph(robolink.message.Service):
    """Load the graph of routes.

    The graph's file.
    """
    class Request(robolink.message.Message):
        graph_filepath: builtins.str
        def __init__(self, *, graph_filepath: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class Toggle(robolink.message.Service):
    """Switch a server on or off.

    True is on.
    """
    class Request(robolink.message.Message):
        enable: builtins.bool
        def __init__(self, *, enable: builtins.bool = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., message: builtins.str = ...) -> None: ...
