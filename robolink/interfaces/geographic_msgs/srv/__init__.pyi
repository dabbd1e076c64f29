# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geographic_msgs.msg
import robolink.interfaces.unique_identifier_msgs.msg

__all__ = ["GetGeoPath", "GetGeographicMap", "GetRoutePlan", "UpdateGeographicMap"]

class GetGeoPath(robolink.message.Service):
    """Plan a path between two positions.

    Where it begins and ends.
    """
    class Request(robolink.message.Message):
        start: robolink.interfaces.geographic_msgs.msg.GeoPoint
        goal: robolink.interfaces.geographic_msgs.msg.GeoPoint
        def __init__(self, *, start: robolink.interfaces.geographic_msgs.msg.GeoPoint = ..., goal: robolink.interfaces.geographic_msgs.msg.GeoPoint = ...) -> None: ...
    class Response(robolink.message.Message):
        """Path, its length in metres, and the network and the segments at which it begins and ends.

        `status` has words for people.
        """
        success: builtins.bool
        status: builtins.str
        plan: robolink.interfaces.geographic_msgs.msg.GeoPath
        network: robolink.interfaces.unique_identifier_msgs.msg.UUID
        start_seg: robolink.interfaces.unique_identifier_msgs.msg.UUID
        goal_seg: robolink.interfaces.unique_identifier_msgs.msg.UUID
        distance: builtins.float
        def __init__(self, *, success: builtins.bool = ..., status: builtins.str = ..., plan: robolink.interfaces.geographic_msgs.msg.GeoPath = ..., network: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., start_seg: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., goal_seg: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., distance: builtins.float = ...) -> None: ...
class GetGeographicMap(robolink.message.Service):
    """Read a map.

    The map's address, such as a file's URL, and the box to read; a box of zeros is the whole map.
    """
    class Request(robolink.message.Message):
        url: builtins.str
        bounds: robolink.interfaces.geographic_msgs.msg.BoundingBox
        def __init__(self, *, url: builtins.str = ..., bounds: robolink.interfaces.geographic_msgs.msg.BoundingBox = ...) -> None: ...
    class Response(robolink.message.Message):
        """The map, or no success and words for people."""
        success: builtins.bool
        status: builtins.str
        map: robolink.interfaces.geographic_msgs.msg.GeographicMap
        def __init__(self, *, success: builtins.bool = ..., status: builtins.str = ..., map: robolink.interfaces.geographic_msgs.msg.GeographicMap = ...) -> None: ...
class GetRoutePlan(robolink.message.Service):
    """Plan a route in a network.

    Identifiers of the network and of the points at which to begin and end.
    """
    class Request(robolink.message.Message):
        network: robolink.interfaces.unique_identifier_msgs.msg.UUID
        start: robolink.interfaces.unique_identifier_msgs.msg.UUID
        goal: robolink.interfaces.unique_identifier_msgs.msg.UUID
        def __init__(self, *, network: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., start: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., goal: robolink.interfaces.unique_identifier_msgs.msg.UUID = ...) -> None: ...
    class Response(robolink.message.Message):
        """The route, or no success and words for people."""
        success: builtins.bool
        status: builtins.str
        plan: robolink.interfaces.geographic_msgs.msg.RoutePath
        def __init__(self, *, success: builtins.bool = ..., status: builtins.str = ..., plan: robolink.interfaces.geographic_msgs.msg.RoutePath = ...) -> None: ...
class UpdateGeographicMap(robolink.message.Service):
    """Change a map.

    The changes.
    """
    class Request(robolink.message.Message):
        updates: robolink.interfaces.geographic_msgs.msg.GeographicMapChanges
        def __init__(self, *, updates: robolink.interfaces.geographic_msgs.msg.GeographicMapChanges = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        status: builtins.str
        def __init__(self, *, success: builtins.bool = ..., status: builtins.str = ...) -> None: ...
