# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.visualization_msgs.msg

__all__ = ["GetInteractiveMarkers"]

class GetInteractiveMarkers(robolink.message.Service):
    """Ask a server for all its interactive markers.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """All markers, and the number of the last update that they contain."""
        sequence_number: builtins.int
        markers: collections.abc.MutableSequence[robolink.interfaces.visualization_msgs.msg.InteractiveMarker]
        def __init__(self, *, sequence_number: builtins.int = ..., markers: collections.abc.Iterable[robolink.interfaces.visualization_msgs.msg.InteractiveMarker] = ...) -> None: ...
