# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.octomap_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["Octomap", "OctomapWithPose"]

class Octomap(robolink.message.Message):
    """An octree as OctoMap writes it, and the side of its smallest cell in metres.

    `binary` trees only know free and occupied; `id` is the kind of tree.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    binary: builtins.bool
    id: builtins.str
    resolution: builtins.float
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., binary: builtins.bool = ..., id: builtins.str = ..., resolution: builtins.float = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class OctomapWithPose(robolink.message.Message):
    """An octree and the pose of its origin."""
    header: robolink.interfaces.std_msgs.msg.Header
    origin: robolink.interfaces.geometry_msgs.msg.Pose
    octomap: robolink.interfaces.octomap_msgs.msg.Octomap
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., origin: robolink.interfaces.geometry_msgs.msg.Pose = ..., octomap: robolink.interfaces.octomap_msgs.msg.Octomap = ...) -> None: ...
