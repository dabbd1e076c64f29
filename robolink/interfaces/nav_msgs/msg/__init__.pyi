# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.nav_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["Goals", "GridCells", "MapMetaData", "OccupancyGrid", "Odometry", "Path"]

class Goals(robolink.message.Message):
    """Poses to reach, one after the other; a pose without frame or time has the header's. Kilted's: Jazzy has none."""
    header: robolink.interfaces.std_msgs.msg.Header
    goals: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.PoseStamped]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., goals: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.PoseStamped] = ...) -> None: ...
class GridCells(robolink.message.Message):
    """A set of equal cells, each given by its centre; width (x) and height (y) of a cell in metres."""
    header: robolink.interfaces.std_msgs.msg.Header
    cell_width: builtins.float
    cell_height: builtins.float
    cells: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Point]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., cell_width: builtins.float = ..., cell_height: builtins.float = ..., cells: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Point] = ...) -> None: ...
class MapMetaData(robolink.message.Message):
    """Size and place of a grid map.

    `resolution` is the side of a cell in metres, `width` and `height` count cells along x and y, and `origin`
    is the pose, in the map's frame, of the corner of cell (0, 0) where x and y are smallest.
    """
    map_load_time: robolink.interfaces.builtin_interfaces.msg.Time
    resolution: builtins.float
    width: builtins.int
    height: builtins.int
    origin: robolink.interfaces.geometry_msgs.msg.Pose
    def __init__(self, *, map_load_time: robolink.interfaces.builtin_interfaces.msg.Time = ..., resolution: builtins.float = ..., width: builtins.int = ..., height: builtins.int = ..., origin: robolink.interfaces.geometry_msgs.msg.Pose = ...) -> None: ...
class OccupancyGrid(robolink.message.Message):
    """A map of the plane: for each cell how likely it is occupied.

    Cell (x, y) is ``data[y * info.width + x]``: usually a probability from 0 (free) to 100 (occupied), -1 for
    unknown.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    info: robolink.interfaces.nav_msgs.msg.MapMetaData
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., info: robolink.interfaces.nav_msgs.msg.MapMetaData = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class Odometry(robolink.message.Message):
    """Odometry: the estimated pose and velocity of a robot.

    `pose` is that of `child_frame_id` (the robot's body) in ``header.frame_id`` (often ``odom``), in metres;
    `twist` is given in `child_frame_id`, in m/s and rad/s, so ``twist.twist.linear.x`` is the speed ahead.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    child_frame_id: builtins.str
    pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovariance
    twist: robolink.interfaces.geometry_msgs.msg.TwistWithCovariance
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., child_frame_id: builtins.str = ..., pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovariance = ..., twist: robolink.interfaces.geometry_msgs.msg.TwistWithCovariance = ...) -> None: ...
class Path(robolink.message.Message):
    """Poses to follow, one after the other, in the header's frame."""
    header: robolink.interfaces.std_msgs.msg.Header
    poses: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.PoseStamped]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., poses: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.PoseStamped] = ...) -> None: ...
