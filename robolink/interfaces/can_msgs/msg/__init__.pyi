# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.std_msgs.msg

__all__ = ["Frame"]

class Frame(robolink.message.Message):
    """A frame on a CAN bus; of `data` the first `dlc` bytes count.

    `is_rtr` marks a request for data, `is_extended` an identifier of 29 bits, `is_error` an error frame.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    id: builtins.int
    is_rtr: builtins.bool
    is_extended: builtins.bool
    is_error: builtins.bool
    dlc: builtins.int
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., id: builtins.int = ..., is_rtr: builtins.bool = ..., is_extended: builtins.bool = ..., is_error: builtins.bool = ..., dlc: builtins.int = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
