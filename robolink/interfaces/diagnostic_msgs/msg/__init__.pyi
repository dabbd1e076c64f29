# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.diagnostic_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["DiagnosticArray", "DiagnosticStatus", "KeyValue"]

class DiagnosticArray(robolink.message.Message):
    """The state of several parts, all seen at the time that the header has."""
    header: robolink.interfaces.std_msgs.msg.Header
    status: collections.abc.MutableSequence[robolink.interfaces.diagnostic_msgs.msg.DiagnosticStatus]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., status: collections.abc.Iterable[robolink.interfaces.diagnostic_msgs.msg.DiagnosticStatus] = ...) -> None: ...
class DiagnosticStatus(robolink.message.Message):
    """State of one part of the robot, say its left motor.

    `level` is OK, WARN, ERROR, or STALE where the part has not been heard of for too long. `name` says which part or
    test it is, `message` what is the matter, in words for people; `hardware_id` tells one piece of hardware from
    others of its kind. `values` has whatever else was measured.
    """
    OK: typing.ClassVar[builtins.bytes]
    WARN: typing.ClassVar[builtins.bytes]
    ERROR: typing.ClassVar[builtins.bytes]
    STALE: typing.ClassVar[builtins.bytes]
    level: builtins.bytes
    name: builtins.str
    message: builtins.str
    hardware_id: builtins.str
    values: collections.abc.MutableSequence[robolink.interfaces.diagnostic_msgs.msg.KeyValue]
    def __init__(self, *, level: builtins.bytes = ..., name: builtins.str = ..., message: builtins.str = ..., hardware_id: builtins.str = ..., values: collections.abc.Iterable[robolink.interfaces.diagnostic_msgs.msg.KeyValue] = ...) -> None: ...
class KeyValue(robolink.message.Message):
    """One thing measured of a part, both its name and its value as text: ``voltage``, ``24.1``."""
    key: builtins.str
    value: builtins.str
    def __init__(self, *, key: builtins.str = ..., value: builtins.str = ...) -> None: ...
