"""The messages of map_msgs: parts of maps that changed, and maps of layers of height."""

from typing import ClassVar

from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.sensor_msgs.msg import PointCloud2
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, float64, int8, int32, string, uint32


class OccupancyGridUpdate(Message):
    """A changed rectangle of an occupancy grid.

    `x` and `y` are the cell of its first corner, its sizes are in cells, and the values are as in OccupancyGrid.
    """

    header: Header
    x: int32
    y: int32
    width: uint32
    height: uint32
    data: Sequence[int8]


class PointCloud2Update(Message):
    """Points to add to a cloud or to remove from it."""

    ADD: ClassVar[uint32] = 0
    DELETE: ClassVar[uint32] = 1

    header: Header
    type: uint32
    points: PointCloud2


class ProjectedMap(Message):
    """An occupancy grid of what lies between two heights, in metres."""

    map: OccupancyGrid
    min_z: float64
    max_z: float64


class ProjectedMapInfo(Message):
    """Frame, rectangle and heights of a map of a layer, in metres."""

    frame_id: string
    x: float64
    y: float64
    width: float64
    height: float64
    min_z: float64
    max_z: float64
