# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.nav_msgs.msg
import robolink.interfaces.sensor_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["OccupancyGridUpdate", "PointCloud2Update", "ProjectedMap", "ProjectedMapInfo"]

class OccupancyGridUpdate(robolink.message.Message):
    """A changed rectangle of an occupancy grid.

    `x` and `y` are the cell of its first corner, its sizes are in cells, and the values are as in OccupancyGrid.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    x: builtins.int
    y: builtins.int
    width: builtins.int
    height: builtins.int
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., x: builtins.int = ..., y: builtins.int = ..., width: builtins.int = ..., height: builtins.int = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class PointCloud2Update(robolink.message.Message):
    """Points to add to a cloud or to remove from it."""
    ADD: typing.ClassVar[builtins.int]
    DELETE: typing.ClassVar[builtins.int]
    header: robolink.interfaces.std_msgs.msg.Header
    type: builtins.int
    points: robolink.interfaces.sensor_msgs.msg.PointCloud2
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., type: builtins.int = ..., points: robolink.interfaces.sensor_msgs.msg.PointCloud2 = ...) -> None: ...
class ProjectedMap(robolink.message.Message):
    """An occupancy grid of what lies between two heights, in metres."""
    map: robolink.interfaces.nav_msgs.msg.OccupancyGrid
    min_z: builtins.float
    max_z: builtins.float
    def __init__(self, *, map: robolink.interfaces.nav_msgs.msg.OccupancyGrid = ..., min_z: builtins.float = ..., max_z: builtins.float = ...) -> None: ...
class ProjectedMapInfo(robolink.message.Message):
    """Frame, rectangle and heights of a map of a layer, in metres."""
    frame_id: builtins.str
    x: builtins.float
    y: builtins.float
    width: builtins.float
    height: builtins.float
    min_z: builtins.float
    max_z: builtins.float
    def __init__(self, *, frame_id: builtins.str = ..., x: builtins.float = ..., y: builtins.float = ..., width: builtins.float = ..., height: builtins.float = ..., min_z: builtins.float = ..., max_z: builtins.float = ...) -> None: ...
