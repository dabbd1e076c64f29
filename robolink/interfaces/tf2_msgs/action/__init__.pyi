# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.tf2_msgs.msg

__all__ = ["LookupTransform"]

class LookupTransform(robolink.message.Action):
    """Ask a buffer server for the transform between two frames, and wait until it is known.

    Which transform: one that takes what is given in `source_frame` to `target_frame`.

    It is that of `source_time`, where zero is the latest, and is waited for `timeout` at most. If `advanced`, the
    transform leads from the source frame at `source_time` to the target frame at `target_time`, by way of
    `fixed_frame`, which does not change in between.
    """
    class Goal(robolink.message.Message):
        target_frame: builtins.str
        source_frame: builtins.str
        source_time: robolink.interfaces.builtin_interfaces.msg.Time
        timeout: robolink.interfaces.builtin_interfaces.msg.Duration
        target_time: robolink.interfaces.builtin_interfaces.msg.Time
        fixed_frame: builtins.str
        advanced: builtins.bool
        def __init__(self, *, target_frame: builtins.str = ..., source_frame: builtins.str = ..., source_time: robolink.interfaces.builtin_interfaces.msg.Time = ..., timeout: robolink.interfaces.builtin_interfaces.msg.Duration = ..., target_time: robolink.interfaces.builtin_interfaces.msg.Time = ..., fixed_frame: builtins.str = ..., advanced: builtins.bool = ...) -> None: ...
    class Result(robolink.message.Message):
        """The transform, which only counts when `error` is NO_ERROR."""
        transform: robolink.interfaces.geometry_msgs.msg.TransformStamped
        error: robolink.interfaces.tf2_msgs.msg.TF2Error
        def __init__(self, *, transform: robolink.interfaces.geometry_msgs.msg.TransformStamped = ..., error: robolink.interfaces.tf2_msgs.msg.TF2Error = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
