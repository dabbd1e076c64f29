# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg

__all__ = ["ServiceEventInfo"]

class ServiceEventInfo(robolink.message.Message):
    """Which step of which call an event tells of.

    `client_gid` and `sequence_number` together identify the call as long as the client lives; `stamp` is when
    the request or response was sent or received.
    """
    REQUEST_SENT: typing.ClassVar[builtins.int]
    REQUEST_RECEIVED: typing.ClassVar[builtins.int]
    RESPONSE_SENT: typing.ClassVar[builtins.int]
    RESPONSE_RECEIVED: typing.ClassVar[builtins.int]
    event_type: builtins.int
    stamp: robolink.interfaces.builtin_interfaces.msg.Time
    client_gid: collections.abc.MutableSequence[builtins.int]
    sequence_number: builtins.int
    def __init__(self, *, event_type: builtins.int = ..., stamp: robolink.interfaces.builtin_interfaces.msg.Time = ..., client_gid: collections.abc.Iterable[builtins.int] = ..., sequence_number: builtins.int = ...) -> None: ...
