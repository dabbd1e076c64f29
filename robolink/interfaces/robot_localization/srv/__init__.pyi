# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.geographic_msgs.msg
import robolink.interfaces.geometry_msgs.msg

__all__ = ["FromLL", "FromLLArray", "GetState", "SetDatum", "SetPose", "SetUTMZone", "ToLL", "ToLLArray", "ToggleFilterProcessing"]

class FromLL(robolink.message.Service):
    """Convert a position on the Earth to the map.

    The position in degrees.
    """
    class Request(robolink.message.Message):
        ll_point: robolink.interfaces.geographic_msgs.msg.GeoPoint
        def __init__(self, *, ll_point: robolink.interfaces.geographic_msgs.msg.GeoPoint = ...) -> None: ...
    class Response(robolink.message.Message):
        """The position in metres of the map's frame."""
        map_point: robolink.interfaces.geometry_msgs.msg.Point
        def __init__(self, *, map_point: robolink.interfaces.geometry_msgs.msg.Point = ...) -> None: ...
class FromLLArray(robolink.message.Service):
    """Convert positions on the Earth to the map.

    The positions in degrees.
    """
    class Request(robolink.message.Message):
        ll_points: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.GeoPoint]
        def __init__(self, *, ll_points: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.GeoPoint] = ...) -> None: ...
    class Response(robolink.message.Message):
        """The positions in metres of the map's frame."""
        map_points: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Point]
        def __init__(self, *, map_points: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Point] = ...) -> None: ...
class GetState(robolink.message.Service):
    """Return the filter's state.

    The time, and the frame in which to express the state.
    """
    class Request(robolink.message.Message):
        time_stamp: robolink.interfaces.builtin_interfaces.msg.Time
        frame_id: builtins.str
        def __init__(self, *, time_stamp: robolink.interfaces.builtin_interfaces.msg.Time = ..., frame_id: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """State and its covariance, a matrix of 15 rows.

        The state is position, rotation (roll, pitch, yaw), their velocities, and acceleration, in metres, radians and
        seconds.
        """
        state: collections.abc.MutableSequence[builtins.float]
        covariance: collections.abc.MutableSequence[builtins.float]
        def __init__(self, *, state: collections.abc.Iterable[builtins.float] = ..., covariance: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class SetDatum(robolink.message.Service):
    """Set the position on the Earth of the map's origin.

    The position in degrees, and the orientation.
    """
    class Request(robolink.message.Message):
        geo_pose: robolink.interfaces.geographic_msgs.msg.GeoPose
        def __init__(self, *, geo_pose: robolink.interfaces.geographic_msgs.msg.GeoPose = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class SetPose(robolink.message.Service):
    """Set the filter's pose.

    The pose and its uncertainty.
    """
    class Request(robolink.message.Message):
        pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovarianceStamped
        def __init__(self, *, pose: robolink.interfaces.geometry_msgs.msg.PoseWithCovarianceStamped = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class SetUTMZone(robolink.message.Service):
    """Set the zone of UTM, the grid in which positions on the Earth are converted.

    The zone, such as `31U`.
    """
    class Request(robolink.message.Message):
        utm_zone: builtins.str
        def __init__(self, *, utm_zone: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class ToLL(robolink.message.Service):
    """Convert a position on the map to one on the Earth.

    The position in metres of the map's frame.
    """
    class Request(robolink.message.Message):
        map_point: robolink.interfaces.geometry_msgs.msg.Point
        def __init__(self, *, map_point: robolink.interfaces.geometry_msgs.msg.Point = ...) -> None: ...
    class Response(robolink.message.Message):
        """The position in degrees."""
        ll_point: robolink.interfaces.geographic_msgs.msg.GeoPoint
        def __init__(self, *, ll_point: robolink.interfaces.geographic_msgs.msg.GeoPoint = ...) -> None: ...
class ToLLArray(robolink.message.Service):
    """Convert positions on the map to ones on the Earth.

    The positions in metres of the map's frame.
    """
    class Request(robolink.message.Message):
        map_points: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Point]
        def __init__(self, *, map_points: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Point] = ...) -> None: ...
    class Response(robolink.message.Message):
        """The positions in degrees."""
        ll_points: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.GeoPoint]
        def __init__(self, *, ll_points: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.GeoPoint] = ...) -> None: ...
class ToggleFilterProcessing(robolink.message.Service):
    """Switch the filter on or off.

    True is on.
    """
    class Request(robolink.message.Message):
        on: builtins.bool
        def __init__(self, *, on: builtins.bool = ...) -> None: ...
    class Response(robolink.message.Message):
        """True if that changed anything."""
        status: builtins.bool
        def __init__(self, *, status: builtins.bool = ...) -> None: ...
