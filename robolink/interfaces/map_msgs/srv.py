"""The services of map_msgs: parts of a map, and maps in a file."""

from robolink.interfaces.map_msgs.msg import ProjectedMapInfo
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.sensor_msgs.msg import PointCloud2
from robolink.interfaces.std_msgs.msg import String
from robolink.message import Message, Sequence, Service, float64


class GetMapROI(Service):
    """Return a rectangle of the map."""

    class Request(Message):
        """Centre and lengths of the rectangle, in metres."""

        x: float64
        y: float64
        l_x: float64
        l_y: float64

    class Response(Message):
        """The part of the map."""

        sub_map: OccupancyGrid


class GetPointMap(Service):
    """Return the map as points."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The points."""

        map: PointCloud2


class GetPointMapROI(Service):
    """Return the map's points within a region."""

    class Request(Message):
        """Centre, and a ball of radius `r`, or a box of lengths `l_x`, `l_y`, `l_z` if `r` is 0; in metres."""

        x: float64
        y: float64
        z: float64
        r: float64
        l_x: float64
        l_y: float64
        l_z: float64

    class Response(Message):
        """The points of the region."""

        sub_map: PointCloud2


class ProjectedMapsInfo(Service):
    """Set the layers of height of which maps are made."""

    class Request(Message):
        """The layers."""

        projected_maps_info: Sequence[ProjectedMapInfo]

    class Response(Message):
        """Nothing."""


class SaveMap(Service):
    """Save the map in a file."""

    class Request(Message):
        """The file's name."""

        filename: String

    class Response(Message):
        """Nothing."""


class SetMapProjections(Service):
    """Return the layers of height of which maps are made."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The layers."""

        projected_maps_info: Sequence[ProjectedMapInfo]
