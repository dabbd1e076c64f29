"""The messages of nav_msgs: odometry, paths and grid maps."""

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import (
    Point,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    TwistWithCovariance,
)
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, float32, int8, string, uint32


class Odometry(Message):
    """Odometry: the estimated pose and velocity of a robot.

    `pose` is that of `child_frame_id` (the robot's body) in ``header.frame_id`` (often ``odom``), in metres;
    `twist` is given in `child_frame_id`, in m/s and rad/s, so ``twist.twist.linear.x`` is the speed ahead.
    """

    header: Header
    child_frame_id: string
    pose: PoseWithCovariance
    twist: TwistWithCovariance


class Path(Message):
    """Poses to follow, one after the other, in the header's frame."""

    header: Header
    poses: Sequence[PoseStamped]


class Goals(Message):
    """Poses to reach, one after the other; a pose without frame or time has the header's. Kilted's: Jazzy has none."""

    header: Header
    goals: Sequence[PoseStamped]


class MapMetaData(Message):
    """Size and place of a grid map.

    `resolution` is the side of a cell in metres, `width` and `height` count cells along x and y, and `origin`
    is the pose, in the map's frame, of the corner of cell (0, 0) where x and y are smallest.
    """

    map_load_time: Time
    resolution: float32
    width: uint32
    height: uint32
    origin: Pose


class OccupancyGrid(Message):
    """A map of the plane: for each cell how likely it is occupied.

    Cell (x, y) is ``data[y * info.width + x]``: usually a probability from 0 (free) to 100 (occupied), -1 for
    unknown.
    """

    header: Header
    info: MapMetaData
    data: Sequence[int8]


class GridCells(Message):
    """A set of equal cells, each given by its centre; width (x) and height (y) of a cell in metres."""

    header: Header
    cell_width: float32
    cell_height: float32
    cells: Sequence[Point]
