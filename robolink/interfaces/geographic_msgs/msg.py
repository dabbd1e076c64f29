"""The messages of geographic_msgs: WGS 84 positions in degrees and metres, maps, routes."""

from typing import Annotated

from robolink.interfaces.geometry_msgs.msg import Quaternion
from robolink.interfaces.std_msgs.msg import Header
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.message import Message, Sequence, Size, float64, string


class KeyValue(Message):
    """A property of something on a map: its name and its value."""

    key: string
    value: string


class GeoPoint(Message):
    """A position on the Earth by WGS 84: degrees north and east, and metres above the ellipsoid.

    An altitude of NaN is unknown.
    """

    latitude: float64
    longitude: float64
    altitude: float64


class GeoPointStamped(Message):
    """A position on the Earth at a time."""

    header: Header
    position: GeoPoint


class GeoPose(Message):
    """A position on the Earth and an orientation; without rotation x points east, y north and z up."""

    position: GeoPoint
    orientation: Quaternion


class GeoPoseStamped(Message):
    """A pose on the Earth at a time."""

    header: Header
    pose: GeoPose


class GeoPoseWithCovariance(Message):
    """A pose on the Earth and its uncertainty.

    The covariance is a matrix of 6 rows: east, north and up in metres, then rotations about these in radians.
    """

    pose: GeoPose
    covariance: Annotated[Sequence[float64], Size(36)]


class GeoPoseWithCovarianceStamped(Message):
    """An uncertain pose on the Earth at a time."""

    header: Header
    pose: GeoPoseWithCovariance


class GeoPath(Message):
    """Poses on the Earth to follow."""

    header: Header
    poses: Sequence[GeoPoseStamped]


class BoundingBox(Message):
    """A box on the Earth, by its south-west and its north-east corner.

    Without heights it is two-dimensional (NaN); one that crosses the date line has its smallest longitude on the right.
    """

    min_pt: GeoPoint
    max_pt: GeoPoint


class WayPoint(Message):
    """A position with an identifier and properties."""

    id: UUID
    position: GeoPoint
    props: Sequence[KeyValue]


class MapFeature(Message):
    """Something on a map: the identifiers of the points and features that it is made of, and its properties."""

    id: UUID
    components: Sequence[UUID]
    props: Sequence[KeyValue]


class GeographicMap(Message):
    """A map: points, features made of them, and the box that they lie in."""

    header: Header
    id: UUID
    bounds: BoundingBox
    points: Sequence[WayPoint]
    features: Sequence[MapFeature]
    props: Sequence[KeyValue]


class GeographicMapChanges(Message):
    """Changes of a map: what is new or different, and the identifiers of what is gone."""

    header: Header
    diffs: GeographicMap
    deletes: Sequence[UUID]


class RouteSegment(Message):
    """A way from one point to another, in one direction, by the points' identifiers."""

    id: UUID
    start: UUID
    end: UUID
    props: Sequence[KeyValue]


class RouteNetwork(Message):
    """Points and the ways between them: a graph to plan routes in."""

    header: Header
    id: UUID
    bounds: BoundingBox
    points: Sequence[WayPoint]
    segments: Sequence[RouteSegment]
    props: Sequence[KeyValue]


class RoutePath(Message):
    """A route in a network, as the identifiers of its segments in their order."""

    header: Header
    network: UUID
    segments: Sequence[UUID]
    props: Sequence[KeyValue]
