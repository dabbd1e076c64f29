# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.map_msgs.msg
import robolink.interfaces.nav_msgs.msg
import robolink.interfaces.sensor_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["GetMapROI", "GetPointMap", "GetPointMapROI", "ProjectedMapsInfo", "SaveMap", "SetMapProjections"]

class GetMapROI(robolink.message.Service):
    """Return a rectangle of the map.

    Centre and lengths of the rectangle, in metres.
    """
    class Request(robolink.message.Message):
        x: builtins.float
        y: builtins.float
        l_x: builtins.float
        l_y: builtins.float
        def __init__(self, *, x: builtins.float = ..., y: builtins.float = ..., l_x: builtins.float = ..., l_y: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """The part of the map."""
        sub_map: robolink.interfaces.nav_msgs.msg.OccupancyGrid
        def __init__(self, *, sub_map: robolink.interfaces.nav_msgs.msg.OccupancyGrid = ...) -> None: ...
class GetPointMap(robolink.message.Service):
    """Return the map as points.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The points."""
        map: robolink.interfaces.sensor_msgs.msg.PointCloud2
        def __init__(self, *, map: robolink.interfaces.sensor_msgs.msg.PointCloud2 = ...) -> None: ...
class GetPointMapROI(robolink.message.Service):
    """Return the map's points within a region.

    Centre, and a ball of radius `r`, or a box of lengths `l_x`, `l_y`, `l_z` if `r` is 0; in metres.
    """
    class Request(robolink.message.Message):
        x: builtins.float
        y: builtins.float
        z: builtins.float
        r: builtins.float
        l_x: builtins.float
        l_y: builtins.float
        l_z: builtins.float
        def __init__(self, *, x: builtins.float = ..., y: builtins.float = ..., z: builtins.float = ..., r: builtins.float = ..., l_x: builtins.float = ..., l_y: builtins.float = ..., l_z: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """The points of the region."""
        sub_map: robolink.interfaces.sensor_msgs.msg.PointCloud2
        def __init__(self, *, sub_map: robolink.interfaces.sensor_msgs.msg.PointCloud2 = ...) -> None: ...
class ProjectedMapsInfo(robolink.message.Service):
    """Set the layers of height of which maps are made.

    The layers.
    """
    class Request(robolink.message.Message):
        projected_maps_info: collections.abc.MutableSequence[robolink.interfaces.map_msgs.msg.ProjectedMapInfo]
        def __init__(self, *, projected_maps_info: collections.abc.Iterable[robolink.interfaces.map_msgs.msg.ProjectedMapInfo] = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class SaveMap(robolink.message.Service):
    """Save the map in a file.

    The file's name.
    """
    class Request(robolink.message.Message):
        filename: robolink.interfaces.std_msgs.msg.String
        def __init__(self, *, filename: robolink.interfaces.std_msgs.msg.String = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class SetMapProjections(robolink.message.Service):
    """Return the layers of height of which maps are made.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The layers."""
        projected_maps_info: collections.abc.MutableSequence[robolink.interfaces.map_msgs.msg.ProjectedMapInfo]
        def __init__(self, *, projected_maps_info: collections.abc.Iterable[robolink.interfaces.map_msgs.msg.ProjectedMapInfo] = ...) -> None: ...
