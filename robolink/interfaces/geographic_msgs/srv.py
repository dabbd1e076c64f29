"""The services of geographic_msgs: maps to read and change, routes to plan."""

from robolink.interfaces.geographic_msgs.msg import (
    BoundingBox,
    GeographicMap,
    GeographicMapChanges,
    GeoPath,
    GeoPoint,
    RoutePath,
)
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.message import Message, Service, float64, string


class GetGeoPath(Service):
    """Plan a path between two positions."""

    class Request(Message):
        """Where it begins and ends."""

        start: GeoPoint
        goal: GeoPoint

    class Response(Message):
        """Path, its length in metres, and the network and the segments at which it begins and ends.

        `status` has words for people.
        """

        success: bool
        status: string
        plan: GeoPath
        network: UUID
        start_seg: UUID
        goal_seg: UUID
        distance: float64


class GetGeographicMap(Service):
    """Read a map."""

    class Request(Message):
        """The map's address, such as a file's URL, and the box to read; a box of zeros is the whole map."""

        url: string
        bounds: BoundingBox

    class Response(Message):
        """The map, or no success and words for people."""

        success: bool
        status: string
        map: GeographicMap


class GetRoutePlan(Service):
    """Plan a route in a network."""

    class Request(Message):
        """Identifiers of the network and of the points at which to begin and end."""

        network: UUID
        start: UUID
        goal: UUID

    class Response(Message):
        """The route, or no success and words for people."""

        success: bool
        status: string
        plan: RoutePath


class UpdateGeographicMap(Service):
    """Change a map."""

    class Request(Message):
        """The changes."""

        updates: GeographicMapChanges

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        status: string
