# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.rosbridge_msgs.msg

__all__ = ["ConnectedClient", "ConnectedClients"]

class ConnectedClient(robolink.message.Message):
    """A client: its address, and since when it is connected."""
    ip_address: builtins.str
    connection_time: robolink.interfaces.builtin_interfaces.msg.Time
    def __init__(self, *, ip_address: builtins.str = ..., connection_time: robolink.interfaces.builtin_interfaces.msg.Time = ...) -> None: ...
class ConnectedClients(robolink.message.Message):
    """All clients that are connected."""
    clients: collections.abc.MutableSequence[robolink.interfaces.rosbridge_msgs.msg.ConnectedClient]
    def __init__(self, *, clients: collections.abc.Iterable[robolink.interfaces.rosbridge_msgs.msg.ConnectedClient] = ...) -> None: ...
