# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geographic_msgs.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.std_msgs.msg
import robolink.interfaces.unique_identifier_msgs.msg

__all__ = ["BoundingBox", "GeoPath", "GeoPoint", "GeoPointStamped", "GeoPose", "GeoPoseStamped", "GeoPoseWithCovariance", "GeoPoseWithCovarianceStamped", "GeographicMap", "GeographicMapChanges", "KeyValue", "MapFeature", "RouteNetwork", "RoutePath", "RouteSegment", "WayPoint"]

class BoundingBox(robolink.message.Message):
    """A box on the Earth, by its south-west and its north-east corner.

    Without heights it is two-dimensional (NaN); one that crosses the date line has its smallest longitude on the right.
    """
    min_pt: robolink.interfaces.geographic_msgs.msg.GeoPoint
    max_pt: robolink.interfaces.geographic_msgs.msg.GeoPoint
    def __init__(self, *, min_pt: robolink.interfaces.geographic_msgs.msg.GeoPoint = ..., max_pt: robolink.interfaces.geographic_msgs.msg.GeoPoint = ...) -> None: ...
class GeoPath(robolink.message.Message):
    """Poses on the Earth to follow."""
    header: robolink.interfaces.std_msgs.msg.Header
    poses: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.GeoPoseStamped]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., poses: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.GeoPoseStamped] = ...) -> None: ...
class GeoPoint(robolink.message.Message):
    """A position on the Earth by WGS 84: degrees north and east, and metres above the ellipsoid.

    An altitude of NaN is unknown.
    """
    latitude: builtins.float
    longitude: builtins.float
    altitude: builtins.float
    def __init__(self, *, latitude: builtins.float = ..., longitude: builtins.float = ..., altitude: builtins.float = ...) -> None: ...
class GeoPointStamped(robolink.message.Message):
    """A position on the Earth at a time."""
    header: robolink.interfaces.std_msgs.msg.Header
    position: robolink.interfaces.geographic_msgs.msg.GeoPoint
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., position: robolink.interfaces.geographic_msgs.msg.GeoPoint = ...) -> None: ...
class GeoPose(robolink.message.Message):
    """A position on the Earth and an orientation; without rotation x points east, y north and z up."""
    position: robolink.interfaces.geographic_msgs.msg.GeoPoint
    orientation: robolink.interfaces.geometry_msgs.msg.Quaternion
    def __init__(self, *, position: robolink.interfaces.geographic_msgs.msg.GeoPoint = ..., orientation: robolink.interfaces.geometry_msgs.msg.Quaternion = ...) -> None: ...
class GeoPoseStamped(robolink.message.Message):
    """A pose on the Earth at a time."""
    header: robolink.interfaces.std_msgs.msg.Header
    pose: robolink.interfaces.geographic_msgs.msg.GeoPose
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., pose: robolink.interfaces.geographic_msgs.msg.GeoPose = ...) -> None: ...
class GeoPoseWithCovariance(robolink.message.Message):
    """A pose on the Earth and its uncertainty.

    The covariance is a matrix of 6 rows: east, north and up in metres, then rotations about these in radians.
    """
    pose: robolink.interfaces.geographic_msgs.msg.GeoPose
    covariance: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, pose: robolink.interfaces.geographic_msgs.msg.GeoPose = ..., covariance: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class GeoPoseWithCovarianceStamped(robolink.message.Message):
    """An uncertain pose on the Earth at a time."""
    header: robolink.interfaces.std_msgs.msg.Header
    pose: robolink.interfaces.geographic_msgs.msg.GeoPoseWithCovariance
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., pose: robolink.interfaces.geographic_msgs.msg.GeoPoseWithCovariance = ...) -> None: ...
class GeographicMap(robolink.message.Message):
    """A map: points, features made of them, and the box that they lie in."""
    header: robolink.interfaces.std_msgs.msg.Header
    id: robolink.interfaces.unique_identifier_msgs.msg.UUID
    bounds: robolink.interfaces.geographic_msgs.msg.BoundingBox
    points: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.WayPoint]
    features: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.MapFeature]
    props: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.KeyValue]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., id: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., bounds: robolink.interfaces.geographic_msgs.msg.BoundingBox = ..., points: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.WayPoint] = ..., features: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.MapFeature] = ..., props: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.KeyValue] = ...) -> None: ...
class GeographicMapChanges(robolink.message.Message):
    """Changes of a map: what is new or different, and the identifiers of what is gone."""
    header: robolink.interfaces.std_msgs.msg.Header
    diffs: robolink.interfaces.geographic_msgs.msg.GeographicMap
    deletes: collections.abc.MutableSequence[robolink.interfaces.unique_identifier_msgs.msg.UUID]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., diffs: robolink.interfaces.geographic_msgs.msg.GeographicMap = ..., deletes: collections.abc.Iterable[robolink.interfaces.unique_identifier_msgs.msg.UUID] = ...) -> None: ...
class KeyValue(robolink.message.Message):
    """A property of something on a map: its name and its value."""
    key: builtins.str
    value: builtins.str
    def __init__(self, *, key: builtins.str = ..., value: builtins.str = ...) -> None: ...
class MapFeature(robolink.message.Message):
    """Something on a map: the identifiers of the points and features that it is made of, and its properties."""
    id: robolink.interfaces.unique_identifier_msgs.msg.UUID
    components: collections.abc.MutableSequence[robolink.interfaces.unique_identifier_msgs.msg.UUID]
    props: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.KeyValue]
    def __init__(self, *, id: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., components: collections.abc.Iterable[robolink.interfaces.unique_identifier_msgs.msg.UUID] = ..., props: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.KeyValue] = ...) -> None: ...
class RouteNetwork(robolink.message.Message):
    """Points and the ways between them: a graph to plan routes in."""
    header: robolink.interfaces.std_msgs.msg.Header
    id: robolink.interfaces.unique_identifier_msgs.msg.UUID
    bounds: robolink.interfaces.geographic_msgs.msg.BoundingBox
    points: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.WayPoint]
    segments: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.RouteSegment]
    props: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.KeyValue]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., id: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., bounds: robolink.interfaces.geographic_msgs.msg.BoundingBox = ..., points: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.WayPoint] = ..., segments: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.RouteSegment] = ..., props: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.KeyValue] = ...) -> None: ...
class RoutePath(robolink.message.Message):
    """A route in a network, as the identifiers of its segments in their order."""
    header: robolink.interfaces.std_msgs.msg.Header
    network: robolink.interfaces.unique_identifier_msgs.msg.UUID
    segments: collections.abc.MutableSequence[robolink.interfaces.unique_identifier_msgs.msg.UUID]
    props: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.KeyValue]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., network: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., segments: collections.abc.Iterable[robolink.interfaces.unique_identifier_msgs.msg.UUID] = ..., props: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.KeyValue] = ...) -> None: ...
class RouteSegment(robolink.message.Message):
    """A way from one point to another, in one direction, by the points' identifiers."""
    id: robolink.interfaces.unique_identifier_msgs.msg.UUID
    start: robolink.interfaces.unique_identifier_msgs.msg.UUID
    end: robolink.interfaces.unique_identifier_msgs.msg.UUID
    props: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.KeyValue]
    def __init__(self, *, id: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., start: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., end: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., props: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.KeyValue] = ...) -> None: ...
class WayPoint(robolink.message.Message):
    """A position with an identifier and properties."""
    id: robolink.interfaces.unique_identifier_msgs.msg.UUID
    position: robolink.interfaces.geographic_msgs.msg.GeoPoint
    props: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.KeyValue]
    def __init__(self, *, id: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., position: robolink.interfaces.geographic_msgs.msg.GeoPoint = ..., props: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.KeyValue] = ...) -> None: ...
