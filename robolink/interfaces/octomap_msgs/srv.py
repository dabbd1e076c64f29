"""The services of octomap_msgs: read the map, or clear a box of it."""

from robolink.interfaces.geometry_msgs.msg import Point
from robolink.interfaces.octomap_msgs.msg import Octomap
from robolink.message import Message, Service


class GetOctomap(Service):
    """Return the map."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The map."""

        map: Octomap


class BoundingBoxQuery(Service):
    """Apply something to a box of the map, such as clearing it."""

    class Request(Message):
        """Smallest and largest corner, in metres."""

        min: Point
        max: Point

    class Response(Message):
        """Nothing."""
