# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.octomap_msgs.msg

__all__ = ["BoundingBoxQuery", "GetOctomap"]

class BoundingBoxQuery(robolink.message.Service):
    """Apply something to a box of the map, such as clearing it.

    Smallest and largest corner, in metres.
    """
    class Request(robolink.message.Message):
        min: robolink.interfaces.geometry_msgs.msg.Point
        max: robolink.interfaces.geometry_msgs.msg.Point
        def __init__(self, *, min: robolink.interfaces.geometry_msgs.msg.Point = ..., max: robolink.interfaces.geometry_msgs.msg.Point = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class GetOctomap(robolink.message.Service):
    """Return the map.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The map."""
        map: robolink.interfaces.octomap_msgs.msg.Octomap
        def __init__(self, *, map: robolink.interfaces.octomap_msgs.msg.Octomap = ...) -> None: ...
