# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.std_msgs.msg
import robolink.interfaces.vision_msgs.msg
import robolink.interfaces.webots_ros2_msgs.msg

__all__ = ["BoolStamped", "CameraRecognitionObject", "CameraRecognitionObjects", "FloatStamped", "PenInkProperties", "StringStamped", "UrdfRobot"]

class BoolStamped(robolink.message.Message):
    """A truth value at a time."""
    header: robolink.interfaces.std_msgs.msg.Header
    data: builtins.bool
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., data: builtins.bool = ...) -> None: ...
class CameraRecognitionObject(robolink.message.Message):
    """An object that a camera recognised: its pose, its rectangle in the picture, and its colours.

    `id` is the number of the object's node in the world, `model` the name of its kind.
    """
    id: builtins.int
    pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
    bbox: robolink.interfaces.vision_msgs.msg.BoundingBox2D
    colors: collections.abc.MutableSequence[robolink.interfaces.std_msgs.msg.ColorRGBA]
    model: builtins.str
    def __init__(self, *, id: builtins.int = ..., pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., bbox: robolink.interfaces.vision_msgs.msg.BoundingBox2D = ..., colors: collections.abc.Iterable[robolink.interfaces.std_msgs.msg.ColorRGBA] = ..., model: builtins.str = ...) -> None: ...
class CameraRecognitionObjects(robolink.message.Message):
    """The objects that a camera recognised in one picture."""
    header: robolink.interfaces.std_msgs.msg.Header
    objects: collections.abc.MutableSequence[robolink.interfaces.webots_ros2_msgs.msg.CameraRecognitionObject]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., objects: collections.abc.Iterable[robolink.interfaces.webots_ros2_msgs.msg.CameraRecognitionObject] = ...) -> None: ...
class FloatStamped(robolink.message.Message):
    """A number at a time."""
    header: robolink.interfaces.std_msgs.msg.Header
    data: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., data: builtins.float = ...) -> None: ...
class PenInkProperties(robolink.message.Message):
    """Ink of a pen: its colour as 0xRRGGBB, and its density from 0 to 1."""
    color: builtins.int
    density: builtins.float
    def __init__(self, *, color: builtins.int = ..., density: builtins.float = ...) -> None: ...
class StringStamped(robolink.message.Message):
    """A text at a time."""
    header: robolink.interfaces.std_msgs.msg.Header
    data: builtins.str
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., data: builtins.str = ...) -> None: ...
class UrdfRobot(robolink.message.Message):
    """A robot to make from a URDF.

    The description is a file's name (`urdf_path`) or a text (`robot_description`). Translation, rotation and `init_pos`
    are written as in a world file.
    """
    name: builtins.str
    urdf_path: builtins.str
    robot_description: builtins.str
    relative_path_prefix: builtins.str
    translation: builtins.str
    rotation: builtins.str
    normal: builtins.bool
    box_collision: builtins.bool
    init_pos: builtins.str
    def __init__(self, *, name: builtins.str = ..., urdf_path: builtins.str = ..., robot_description: builtins.str = ..., relative_path_prefix: builtins.str = ..., translation: builtins.str = ..., rotation: builtins.str = ..., normal: builtins.bool = ..., box_collision: builtins.bool = ..., init_pos: builtins.str = ...) -> None: ...
