# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg

__all__ = ["TF2Error", "TFMessage"]

class TF2Error(robolink.message.Message):
    """Outcome of a transform look-up: one of the codes below, and a sentence for people."""
    NO_ERROR: typing.ClassVar[builtins.int]
    LOOKUP_ERROR: typing.ClassVar[builtins.int]
    CONNECTIVITY_ERROR: typing.ClassVar[builtins.int]
    EXTRAPOLATION_ERROR: typing.ClassVar[builtins.int]
    INVALID_ARGUMENT_ERROR: typing.ClassVar[builtins.int]
    TIMEOUT_ERROR: typing.ClassVar[builtins.int]
    TRANSFORM_ERROR: typing.ClassVar[builtins.int]
    error: builtins.int
    error_string: builtins.str
    def __init__(self, *, error: builtins.int = ..., error_string: builtins.str = ...) -> None: ...
class TFMessage(robolink.message.Message):
    """Transforms from parent to child frames, as published on /tf and /tf_static."""
    transforms: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.TransformStamped]
    def __init__(self, *, transforms: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.TransformStamped] = ...) -> None: ...
