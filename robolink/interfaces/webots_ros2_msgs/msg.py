"""The messages of webots_ros2_msgs: values of Webots' devices."""

from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.std_msgs.msg import ColorRGBA, Header
from robolink.interfaces.vision_msgs.msg import BoundingBox2D
from robolink.message import Message, Sequence, float32, float64, int32, string


class BoolStamped(Message):
    """A truth value at a time."""

    header: Header
    data: bool


class FloatStamped(Message):
    """A number at a time."""

    header: Header
    data: float64


class StringStamped(Message):
    """A text at a time."""

    header: Header
    data: string


class PenInkProperties(Message):
    """Ink of a pen: its colour as 0xRRGGBB, and its density from 0 to 1."""

    color: int32
    density: float32


class CameraRecognitionObject(Message):
    """An object that a camera recognised: its pose, its rectangle in the picture, and its colours.

    `id` is the number of the object's node in the world, `model` the name of its kind.
    """

    id: int32
    pose: PoseStamped
    bbox: BoundingBox2D
    colors: Sequence[ColorRGBA]
    model: string


class CameraRecognitionObjects(Message):
    """The objects that a camera recognised in one picture."""

    header: Header
    objects: Sequence[CameraRecognitionObject]


class UrdfRobot(Message):
    """A robot to make from a URDF.

    The description is a file's name (`urdf_path`) or a text (`robot_description`). Translation, rotation and `init_pos`
    are written as in a world file.
    """

    name: string
    urdf_path: string
    robot_description: string
    relative_path_prefix: string
    translation: string
    rotation: string
    normal: bool
    box_collision: bool
    init_pos: string
